//! From vertex to vertex: what paths meet.

use super::{
    PathTracer, Sample, Workspace,
    passing::Chance,
    path::Path,
    spectral::{DispersionRule, Lanes},
    tracer::RayCounts,
    vertices::Vertices,
    wave::Wave,
    weights::Weights,
};
use crate::{
    bxdf::{Bsdf, ScatterStrategy, WideBxdf},
    material::{Material, Waves},
    scene::Surface,
    texture::TextureContext,
};
use tenfold_geometry::{Candidate, Hit, PlainSurfaces, PrimitiveId, ReferencePoint, SurfaceInteraction};
use tenfold_math::{Frame, Id, Ray, Slots, Vec3, WIDTH};
use tenfold_sampling::{Dimension, Variable, hash};
use tenfold_spectrum::SpectraToEvaluate;

/// Passing through this many interfaces ends a path: a bound for scenes with interfaces without end.
const MOST_PASSES: u32 = 1024;

impl<'a> PathTracer<'a> {
    /// Takes the paths in the slots `live` to their next vertices, or to their ends.
    pub(super) fn go_on(
        &self,
        live: Slots,
        samples: &mut [Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) -> Vertices {
        let Workspace { wave, courses, surfaces, albedos, rays, .. } = workspace;
        rays.path += live.len() as u64;
        let mut hits = [None; WIDTH];
        let stops = |slot: usize, c: &Candidate<'_>| {
            let chance = Chance { sampler: samples[slot].sampler, bounce: wave.paths[slot].bounce };
            self.stops(&wave.rays.get(slot), c, chance)
        };
        self.scene.world.intersect_slots(live, &wave.rays, courses, stops, &mut hits);
        let mut vertices = Vertices::default();
        let plain = self.meet_plain(live, &hits, samples, wave, surfaces, albedos, &mut vertices);
        for slot in live.without(plain) {
            self.meet(slot, hits[slot], &mut samples[slot], wave, rays, &mut vertices);
        }
        vertices
    }

    /// Takes those of the paths in the slots `live` to their next vertices, or to their ends, that have met surfaces like most: nothing that
    /// emits, and neither relief nor chance. Returns their slots.
    fn meet_plain(
        &self,
        live: Slots,
        hits: &[Option<Hit>; WIDTH],
        samples: &[Sample<'_>],
        wave: &mut Wave<'a>,
        surfaces: &mut PlainSurfaces,
        albedos: &mut SpectraToEvaluate,
        vertices: &mut Vertices,
    ) -> Slots {
        let scene = self.scene;
        if scene.needs_footprint {
            return Slots::NONE;
        }
        let (mut ended, mut candidates, mut textured) = (Slots::NONE, Slots::NONE, Slots::NONE);
        for slot in live {
            let Some(hit) = &hits[slot] else { continue };
            let look = self.look(hit.primitive);
            if look.lights.is_some() {
                continue;
            }
            let at_end = wave.paths[slot].bounce >= scene.max_depth;
            if at_end && !scene.materials.may_be_interface(look.material) {
                ended.insert(slot);
            } else if scene.materials.is_plain(look.material) {
                candidates.insert(slot);
                if scene.materials.is_textured(look.material) {
                    textured.insert(slot);
                }
            }
        }
        let plain = scene.world.plain_surfaces(candidates, textured, &wave.rays, hits, surfaces);
        let mut even = Slots::NONE;
        for slot in plain {
            let Some(hit) = &hits[slot] else { continue };
            let at = TextureContext {
                p: surfaces.p.get(slot),
                n: surfaces.n.get(slot),
                uv: surfaces.uv.get(slot),
                face_index: surfaces.face_index[slot],
                ..TextureContext::default()
            };
            let sample = &samples[slot];
            let material = self.look(hit.primitive).material;
            if self.scatters_by_itself(sample)
                && let Some(albedo) = scene.materials.even_albedo(material)
            {
                let w = &sample.wavelengths;
                match scene.textures.settle(albedo, &at) {
                    Some(spectrum) => albedos.set(slot, spectrum, w),
                    None => albedos.set_values(slot, scene.textures.spectrum(albedo, &at, w)),
                }
                even.insert(slot);
                continue;
            }
            let (n, tangent, wo) = (at.n, surfaces.dpdu.get(slot), surfaces.wo.get(slot));
            let (p, p_error, time) = (at.p, surfaces.p_error.get(slot), wave.rays.time[slot]);
            let from = ReferencePoint { p, p_error, n, ns: n, one_sided: false, time };
            if let Some(bxdf) = self.wide_bxdf(material, &at, sample) {
                wave.arrive_at(slot, from, wo, [n, tangent], &bxdf, vertices);
                continue;
            }
            let bxdf = scene.materials.bxdf(material, &scene.textures, &at, self.waves(sample));
            let frame = Frame::from_z_and_tangent(n, tangent);
            wave.bsdfs[slot] = bxdf.map(|bxdf| self.at_work(Bsdf::new(frame, bxdf), sample));
            self.arrive(slot, from, wo, wave, vertices);
        }
        if !even.is_empty() {
            wave.arrive_at_even(even, surfaces, albedos, vertices);
        }
        ended.or(plain)
    }

    /// Whether directions are sampled by the own density of what scatters.
    #[inline]
    fn scatters_by_itself(&self, sample: &Sample<'_>) -> bool {
        self.strategies.scatter == ScatterStrategy::Bsdf
            && sample.sampler.held(Variable::ScatterDirection).is_none()
    }

    /// The scattering function of a plain surface, where it is computed side by side and samples directions by its own density.
    #[inline(always)]
    fn wide_bxdf(
        &self,
        material: Id<Material>,
        at: &TextureContext,
        sample: &Sample<'_>,
    ) -> Option<WideBxdf> {
        let scene = self.scene;
        if !self.scatters_by_itself(sample) {
            return None;
        }
        scene.materials.wide_bxdf(material, &scene.textures, at, self.waves(sample))
    }

    /// Puts the path in `slot` at a vertex where it scatters as [`Wave::bsdfs`] says.
    #[inline]
    fn arrive(
        &self,
        slot: usize,
        from: ReferencePoint,
        wo: Vec3,
        wave: &mut Wave<'a>,
        vertices: &mut Vertices,
    ) {
        let (path, Some(bsdf)) = (&mut wave.paths[slot], &wave.bsdfs[slot]) else { return };
        if self.rule == DispersionRule::Terminate && path.lanes.count() > 1 && bsdf.is_dispersive() {
            let weights = terminate_secondary(path, &wave.weights.get(slot));
            wave.weights.set(slot, &weights, &path.lanes);
        }
        if path.lanes.count() > 1 && bsdf.parts_wavelengths() {
            let mut weights = wave.weights.get(slot);
            weights.settle(&path.lanes);
            wave.weights.set(slot, &weights, &path.lanes);
            vertices.parting.insert(slot);
        }
        let lobes = bsdf.lobes();
        if lobes.has_density() {
            vertices.glossy.insert(slot);
        }
        wave.from.set(slot, if lobes.is_transmissive() { from } else { from.seen_from(wo) });
        wave.wo.set(slot, wo);
        vertices.other.insert(slot);
    }

    /// Takes the path in `slot`, which has met `hit`, to its next vertex, through interfaces, or to its end.
    #[inline]
    fn meet(
        &self,
        slot: usize,
        mut hit: Option<Hit>,
        sample: &mut Sample<'_>,
        wave: &mut Wave<'a>,
        rays: &mut RayCounts,
        vertices: &mut Vertices,
    ) {
        let scene = self.scene;
        let mut passes = 0;
        let mut ray = wave.rays.get(slot);
        loop {
            let Some(found) = &hit else {
                self.add_escaped(wave, slot, &ray, sample);
                return;
            };
            let surface = scene.world.interaction(&ray, found);
            self.add_emitted(wave, slot, &ray, &surface, sample);
            let path = &mut wave.paths[slot];
            let at_end = path.bounce >= scene.max_depth;
            let material = self.look(surface.primitive).material;
            // A path that has met all the surfaces it may still passes those that are none.
            if at_end && !scene.materials.may_be_interface(material) {
                return;
            }
            let at = self.context(&surface);
            if !at_end && let Some(bxdf) = self.wide_bxdf(material, &at, sample) {
                let axes = [surface.shading.n, surface.shading.dpdu];
                wave.arrive_at(slot, surface.reference(), surface.wo, axes, &bxdf, vertices);
                return;
            }
            wave.bsdfs[slot] = self.bsdf(path, &surface, &at, passes, sample);
            if wave.bsdfs[slot].is_some() {
                if !at_end {
                    self.arrive(slot, surface.reference(), surface.wo, wave, vertices);
                }
                return;
            }
            passes += 1;
            if passes > MOST_PASSES {
                return;
            }
            if !scene.materials.is_interface(material) {
                // Shadow rays stop at what is an interface by chance alone: no light sample could have come this way.
                path.specular = true;
            }
            ray = surface.spawn_ray(ray.direction);
            rays.path += 1;
            let chance = Chance { sampler: sample.sampler, bounce: path.bounce };
            hit = scene.world.intersect(&ray, f32::INFINITY, |c| self.stops(&ray, c, chance));
        }
    }

    /// A point of a surface as textures see it.
    #[inline]
    fn context(&self, surface: &SurfaceInteraction) -> TextureContext {
        let scene = self.scene;
        if !scene.needs_footprint {
            return TextureContext::at(surface);
        }
        let seen = scene.camera.pixel_differentials(surface.p, surface.n, surface.time, self.footprint_scale);
        TextureContext::with_differentials(surface, seen.dpdx, seen.dpdy)
    }

    /// The wavelengths at which the materials that a path meets are evaluated.
    #[inline]
    fn waves<'w>(&'w self, sample: &'w Sample<'_>) -> Waves<'w> {
        Waves { light: &sample.wavelengths, indices: self.indices.as_ref().unwrap_or(&sample.wavelengths) }
    }

    /// The scattering function where `path` has met `surface`, after passing `passes` interfaces; `None` for a further one.
    #[inline]
    fn bsdf(
        &self,
        path: &Path,
        surface: &SurfaceInteraction,
        at: &TextureContext,
        passes: u32,
        sample: &Sample<'_>,
    ) -> Option<Bsdf<'a>> {
        let scene = self.scene;
        let u_mix = || {
            let dimension = Dimension::material_mix(path.bounce);
            if passes == 0 || sample.sampler.held(dimension.variable).is_some() {
                return sample.sampler.get_1d(dimension);
            }
            // Surfaces behind an interface are at the same vertex, and need numbers of their own.
            hash::unit_f32(hash::combine(sample.sampler.hash(dimension), passes.into()) as u32)
        };
        let material = self.look(surface.primitive).material;
        let bsdf = scene.materials.bsdf(material, &scene.textures, surface, at, self.waves(sample), u_mix);
        bsdf.map(|bsdf| self.at_work(bsdf, sample))
    }

    /// A scattering function, sampled as this tracer and the numbers of `sample` have it.
    #[inline]
    fn at_work(&self, mut bsdf: Bsdf<'a>, sample: &Sample<'_>) -> Bsdf<'a> {
        bsdf.set_strategy(self.strategies.scatter);
        if sample.sampler.held(Variable::ScatterDirection).is_some() {
            bsdf.hold_direction();
        }
        bsdf
    }

    /// What a surface that was hit looks like.
    #[inline]
    fn look(&self, primitive: PrimitiveId) -> &'a Surface {
        let geometry = self.scene.world.geometry(primitive.geometry);
        &self.scene.surfaces[geometry.user as usize]
    }

    /// Light that arrives from beyond the scene.
    #[inline]
    fn add_escaped(&self, wave: &Wave<'_>, slot: usize, ray: &Ray, sample: &mut Sample<'_>) {
        let lights = &self.scene.lights;
        for &id in lights.infinite() {
            let emitted = lights.escaped(id, ray.direction, &sample.wavelengths);
            if emitted.is_black() {
                continue;
            }
            let pdf = || lights.pdf_escaped(self.strategies.light, &wave.from.get(slot), id, ray.direction);
            sample.radiance += wave.carried(slot, self.strategies.combine, emitted, pdf);
        }
    }

    /// Light that the surface itself emits toward the path.
    #[inline]
    fn add_emitted(
        &self,
        wave: &Wave<'_>,
        slot: usize,
        ray: &Ray,
        surface: &SurfaceInteraction,
        sample: &mut Sample<'_>,
    ) {
        let lights = &self.scene.lights;
        let Some(id) = self.look(surface.primitive).light(surface.primitive) else { return };
        let emitted = lights.emitted(id, surface, surface.wo, &sample.wavelengths);
        if emitted.is_black() {
            return;
        }
        let pdf = || lights.pdf_hit(self.strategies.light, &wave.from.get(slot), id, surface, ray.direction);
        sample.radiance += wave.carried(slot, self.strategies.combine, emitted, pdf);
    }
}

/// Goes on with the hero alone, in place of all lanes: with these weights.
fn terminate_secondary(path: &mut Path, weights: &Weights) -> Weights {
    let count = path.lanes.count() as f32;
    path.lanes = Lanes::one(path.lanes.hero());
    let mut weights = weights.with_lanes(&path.lanes);
    weights.beta *= count;
    weights
}
