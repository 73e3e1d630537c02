//! Light from points sampled on lights.

use super::{
    PathTracer, Sample, Strategies, Workspace, even, passing::Chance, wave::Vertices, weights::weigh_sampled,
};
use crate::{bxdf::BsdfValue, light::LightSamples};
use tenfold_geometry::RayCourses;
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
        let seeing = vertices.even.or(vertices.glossy);
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
        even::evaluate(&wave.even, &wave.wo, &light.wi, scattering);
        let mut parts = [false; WIDTH];
        for slot in lit.without(vertices.even) {
            let Some(bsdf) = &wave.bsdfs[slot] else { continue };
            let wi = light.wi.get(slot);
            let BsdfValue { f, pdf } = bsdf.eval_and_pdf(wave.wo.get(slot), wi);
            scattering.set(slot, f, pdf, wave.paths[slot].lanes.hero(), wi.dot(bsdf.frame().z).abs());
            parts[slot] = vertices.parting.contains(slot);
        }
        courses.prepare(&light.shadow);
        weigh_sampled(combine, &wave.weights, scattering, light, &parts, arriving);
        for slot in lit {
            let arriving = arriving.get(slot);
            if arriving.is_black() {
                continue;
            }
            rays.shadow += 1;
            let sample = &mut samples[slot];
            let chance = Chance { sampler: sample.sampler, bounce: wave.paths[slot].bounce };
            if !self.is_shadowed(slot, light, courses, chance) {
                sample.radiance += arriving;
            }
        }
    }

    #[inline]
    fn is_shadowed(
        &self,
        slot: usize,
        light: &LightSamples,
        courses: &RayCourses,
        chance: Chance<'_>,
    ) -> bool {
        let ray = light.shadow.get(slot);
        self.scene.world.occluded_slot(slot, &light.shadow, courses, light.t_max[slot], |c| {
            // Light passes from one medium into the next.
            let material = self.scene.surfaces[c.user as usize].material;
            !self.scene.materials.is_interface(material) && self.stops(&ray, c, chance)
        })
    }
}
