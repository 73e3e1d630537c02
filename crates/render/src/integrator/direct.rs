//! Light from points sampled on lights.

use super::{
    PathTracer, Sample, Strategies, Workspace, kinds, passing::Chance, vertices::Vertices,
    weights::weigh_sampled,
};
use crate::bxdf::BsdfValue;
use tenfold_geometry::Candidate;
use tenfold_math::WIDTH;
use tenfold_sampling::{Dimension, SampleGroup};

impl<'a> PathTracer<'a> {
    /// Light from points sampled on lights.
    pub(super) fn add_direct(
        &self,
        vertices: &Vertices,
        group: &SampleGroup<'_>,
        samples: &mut [Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) {
        let Strategies { light: strategy, combine, .. } = self.strategies;
        let Workspace { wave, lights: light, courses, scattering, arriving, rays, .. } = workspace;
        let scene_lights = &self.scene.lights;
        let count = scene_lights.sampled(strategy);
        let seeing = vertices.wide().or(vertices.glossy);
        if count == 0 || seeing.is_empty() {
            return;
        }
        let u_choice = match count {
            1 => [0.0; WIDTH],
            _ => wave.numbers_1d(group, seeing, Dimension::light_choice),
        };
        let u = wave.numbers_2d(group, seeing, Dimension::light_point);
        let wavelengths = |slot: usize| &samples[slot].wavelengths;
        let lit = scene_lights.samples(strategy, seeing, &wave.from, &u_choice, &u, wavelengths, light);
        if lit.is_empty() {
            return;
        }
        kinds::evaluate(&wave.surfaces, vertices, &wave.wo, &light.wi, scattering);
        let mut parts = [false; WIDTH];
        for slot in lit.without(vertices.wide()) {
            let Some(bsdf) = &wave.bsdfs[slot] else { continue };
            let wi = light.wi.get(slot);
            let BsdfValue { f, pdf } = bsdf.eval_and_pdf(wave.wo.get(slot), wi);
            scattering.set(slot, f, pdf, wave.paths[slot].lanes.hero(), wi.dot(bsdf.frame().z).abs());
            parts[slot] = vertices.parting.contains(slot);
        }
        weigh_sampled(combine, &wave.weights, scattering, light, &parts, arriving);
        let lit = lit.keep(|slot| !arriving.get(slot).is_black());
        if lit.is_empty() {
            return;
        }
        rays.shadow += lit.len() as u64;
        let stops = |slot: usize, c: &Candidate<'_>| {
            // Light passes from one medium into the next.
            let material = self.scene.surfaces[c.user as usize].material;
            let chance = Chance { sampler: samples[slot].sampler, bounce: wave.paths[slot].bounce };
            !self.scene.materials.is_interface(material) && self.stops(&light.shadow.get(slot), c, chance)
        };
        let shadowed = self.scene.world.occluded_slots(lit, &light.shadow, courses, &light.t_max, stops);
        for slot in lit.without(shadowed) {
            samples[slot].radiance += arriving.get(slot);
        }
    }
}
