use super::{
    Strategies, even,
    path::{Path, Waiting},
    spectral::{DispersionRule, Lanes},
    wave::{Vertices, Wave},
    weights::{Scattering, Weights, advance, weigh_sampled},
};
use crate::{
    bxdf::{Bsdf, BsdfSample, BsdfValue, Lobe, ScatterStrategy},
    light::LightSamples,
    material::{Material, Waves},
    scene::{Scene, Surface},
    texture::TextureContext,
};
use tenfold_geometry::{
    Candidate, FlatSurfaces, Hit, PrimitiveId, RayCourses, ReferencePoint, SurfaceInteraction,
};
use tenfold_math::{Frame, Id, Ray, Rays, Slots, Vec3, WIDTH};
use tenfold_sampling::{Dimension, PixelSample, SampleGroup, Variable, hash};
use tenfold_spectrum::{N, SampledSpectrum, SampledWavelengths, Spectra};

/// Passing through this many interfaces ends a path: a bound for scenes with interfaces without end.
const MOST_PASSES: u32 = 1024;

/// How many rays have been traced.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Rays from the camera and rays scattered.
    pub path: u64,
    /// Rays toward lights.
    pub shadow: u64,
}

impl RayCounts {
    /// All rays.
    pub fn total(&self) -> u64 {
        self.path + self.shadow
    }

    /// Adds the rays of `other`.
    pub fn merge(&mut self, other: &Self) {
        self.path += other.path;
        self.shadow += other.shadow;
    }
}

/// Traces the paths of samples through a scene.
#[derive(Copy, Clone, Debug)]
pub struct PathTracer<'a> {
    scene: &'a Scene,
    rule: DispersionRule,
    strategies: Strategies,
    footprint_scale: f32,
    /// Where indices of refraction are looked up, if not at the wavelengths of the path.
    indices: Option<SampledWavelengths>,
}

/// A sample of a pixel whose path is traced.
#[derive(Copy, Clone, Debug)]
pub struct Sample<'s> {
    /// Whom it asks for numbers.
    pub sampler: &'s PixelSample<'s>,
    /// The wavelengths of the path.
    pub wavelengths: SampledWavelengths,
    /// The estimate of the spectral radiance that arrives along its ray, against its direction, in the lanes of `wavelengths`, not
    /// yet divided by their densities.
    pub radiance: SampledSpectrum,
}

impl<'s> Sample<'s> {
    /// A sample that has found no light yet.
    #[inline]
    pub fn new(sampler: &'s PixelSample<'s>, wavelengths: SampledWavelengths) -> Self {
        Self { sampler, wavelengths, radiance: SampledSpectrum::ZERO }
    }
}

/// What tracing needs room for, to be used again for sample after sample.
#[derive(Debug, Default)]
pub struct Workspace<'a> {
    wave: Wave<'a>,
    courses: RayCourses,
    surfaces: FlatSurfaces,
    lights: LightSamples,
    scattering: Scattering,
    arriving: Spectra,
    /// Paths that wait for their turn. Every split leaves each lane on one path only: a sample has never more than lanes.
    pending: Vec<Waiting>,
    /// Rays traced so far.
    pub rays: RayCounts,
}

impl<'a> PathTracer<'a> {
    /// A tracer of `scene` for renders with `spp` samples a pixel.
    pub fn new(scene: &'a Scene, rule: DispersionRule, strategies: Strategies, spp: u32) -> Self {
        // Many samples average detail by themselves: narrow the footprint of each, as pbrt does.
        let footprint_scale = (1.0 / (spp.max(1) as f32).sqrt()).max(0.125);
        Self { scene, rule, strategies, footprint_scale, indices: None }
    }

    /// The same with all light refracted as that of one wavelength, in nm, if any is given: nothing disperses.
    #[must_use]
    pub fn with_indices_at(self, wavelength: Option<f32>) -> Self {
        Self { indices: wavelength.map(SampledWavelengths::fixed), ..self }
    }

    /// Estimates the radiance of `samples`, at most [`WIDTH`], with their `rays` from the camera in the first slots, by paths that take each step
    /// together. The estimate of each is the same, whichever others are with it.
    pub fn trace(
        &self,
        group: &SampleGroup<'_>,
        rays: &Rays,
        samples: &mut [Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) {
        let mut live = workspace.wave.start(samples.len(), rays);
        loop {
            while !live.is_empty() {
                let vertices = self.go_on(live, samples, workspace);
                self.add_direct(&vertices, group, samples, workspace);
                live = self.scatter(&vertices, group, samples, workspace);
            }
            let Some(waiting) = workspace.pending.pop() else { return };
            live = workspace.wave.resume(waiting);
        }
    }

    /// Takes the paths in the slots `live` to their next vertices, or to their ends.
    fn go_on(&self, live: Slots, samples: &mut [Sample<'_>], workspace: &mut Workspace<'a>) -> Vertices {
        let Workspace { wave, courses, surfaces, rays, .. } = workspace;
        rays.path += live.len() as u64;
        courses.prepare(&wave.rays);
        let mut hits = [None; WIDTH];
        for slot in live {
            let (path, ray) = (&wave.paths[slot], wave.rays.get(slot));
            let chance = Chance { sampler: samples[path.sample].sampler, bounce: path.bounce };
            let stops = |c: &Candidate<'_>| self.stops(&ray, c, chance);
            hits[slot] = self.scene.world.intersect_slot(slot, &wave.rays, courses, f32::INFINITY, stops);
        }
        let mut vertices = Vertices::default();
        let plain = self.meet_plain(live, &hits, samples, wave, surfaces, &mut vertices);
        for slot in live.without(plain) {
            let sample = &mut samples[wave.paths[slot].sample];
            self.meet(slot, hits[slot], sample, wave, rays, &mut vertices);
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
        surfaces: &mut FlatSurfaces,
        vertices: &mut Vertices,
    ) -> Slots {
        let scene = self.scene;
        if scene.needs_footprint {
            return Slots::NONE;
        }
        let (mut ended, mut candidates) = (Slots::NONE, Slots::NONE);
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
            }
        }
        let flat = scene.world.flat_surfaces(candidates, &wave.rays, hits, surfaces);
        for slot in flat {
            let Some(hit) = &hits[slot] else { continue };
            let at = TextureContext {
                p: surfaces.p.get(slot),
                n: surfaces.n.get(slot),
                uv: surfaces.uv.get(slot),
                face_index: surfaces.face_index[slot],
                ..TextureContext::default()
            };
            let sample = &samples[wave.paths[slot].sample];
            let material = self.look(hit.primitive).material;
            let (n, tangent, wo) = (at.n, surfaces.dpdu.get(slot), surfaces.wo.get(slot));
            let (p, p_error, time) = (at.p, surfaces.p_error.get(slot), wave.rays.time[slot]);
            let from = ReferencePoint { p, p_error, n, ns: n, one_sided: false, time };
            if let Some(reflectance) = self.even_reflectance(material, &at, sample) {
                wave.arrive_at_even(slot, from, wo, [n, tangent], reflectance, vertices);
                continue;
            }
            let bxdf = scene.materials.bxdf(material, &scene.textures, &at, self.waves(sample));
            let frame = Frame::from_z_and_tangent(n, tangent);
            wave.bsdfs[slot] = bxdf.map(|bxdf| self.at_work(Bsdf::new(frame, bxdf), sample));
            self.arrive(slot, from, wo, wave, vertices);
        }
        ended.or(flat)
    }

    /// The albedo of what scatters as an even reflector, by its own density.
    #[inline]
    fn even_reflectance(
        &self,
        material: Id<Material>,
        at: &TextureContext,
        sample: &Sample<'_>,
    ) -> Option<SampledSpectrum> {
        let scene = self.scene;
        let by_itself = self.strategies.scatter == ScatterStrategy::Bsdf;
        let reflectance =
            || scene.materials.even_reflectance(material, &scene.textures, at, self.waves(sample));
        by_itself.then(reflectance).flatten()
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
            if !at_end && let Some(reflectance) = self.even_reflectance(material, &at, sample) {
                let axes = [surface.shading.n, surface.shading.dpdu];
                wave.arrive_at_even(slot, surface.reference(), surface.wo, axes, reflectance, vertices);
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

    /// Light from points sampled on lights.
    fn add_direct(
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
        let wavelengths = |slot: usize| &samples[wave.paths[slot].sample].wavelengths;
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
            let path = &wave.paths[slot];
            let sample = &mut samples[path.sample];
            let chance = Chance { sampler: sample.sampler, bounce: path.bounce };
            if !self.is_shadowed(slot, light, courses, chance) {
                sample.radiance += arriving;
            }
        }
    }

    /// Sends the paths on; the slots of those that go on.
    fn scatter(
        &self,
        vertices: &Vertices,
        group: &SampleGroup<'_>,
        samples: &[Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) -> Slots {
        let Workspace { wave, scattering, pending, .. } = workspace;
        if !vertices.even.is_empty() {
            let u = wave.numbers_2d(group, vertices.even, Dimension::scatter_direction);
            even::scatter(&wave.even, &wave.wo, &wave.from, &u, &mut wave.rays, scattering);
        }
        let mut scattered = vertices.even.keep(|slot| scattering.hero_pdf[slot] > 0.0);
        for slot in vertices.other {
            let Some(bsdf) = &wave.bsdfs[slot] else { continue };
            let path = &mut wave.paths[slot];
            let (wo, from, sample) = (wave.wo.get(slot), wave.from.get(slot), &samples[path.sample]);
            if vertices.parting.contains(slot) {
                self.part(path, &wave.weights.get(slot), wo, &from, bsdf, sample, pending);
                continue;
            }
            let u_lobe = if bsdf.chooses_lobe() {
                sample.sampler.get_1d(Dimension::scatter_lobe(path.bounce))
            } else {
                0.0
            };
            let u = sample.sampler.get_2d(Dimension::scatter_direction(path.bounce));
            let Some(s) = &bsdf.sample(wo, u_lobe, u, path.lanes.hero()) else { continue };
            scattering.set(slot, s.f, s.pdf, path.lanes.hero(), s.wi.dot(bsdf.frame().z).abs());
            wave.weights.eta_scale[slot] *= s.eta * s.eta;
            path.specular = s.lobe.is_specular();
            wave.rays.set(slot, from.spawn_ray(s.wi));
            scattered.insert(slot);
        }
        let mut carried = [0.0; WIDTH];
        advance(&mut wave.weights, scattering, &mut carried);
        vertices.even.for_each(|slot| wave.paths[slot].specular = false);
        scattered.keep(|slot| {
            let path = &mut wave.paths[slot];
            path.bounce += 1;
            let survival = survival(path, carried[slot], &samples[path.sample]);
            if survival < 1.0 {
                wave.weights.strengthen(slot, survival);
            }
            survival > 0.0
        })
    }

    /// Sends every lane of a settled path its own way. Lanes that are reflected stay together: reflection does not
    /// disperse.
    fn part(
        &self,
        path: &Path,
        weights: &Weights,
        wo: Vec3,
        from: &ReferencePoint,
        bsdf: &Bsdf<'_>,
        sample: &Sample<'_>,
        pending: &mut Vec<Waiting>,
    ) {
        let mut push = |lanes: Lanes, mut weights: Weights, s: &BsdfSample| {
            let specular = s.lobe.is_specular();
            let path = Path { lanes, bounce: path.bounce + 1, specular, ..*path };
            weights.eta_scale *= s.eta * s.eta;
            let survival = survival(&path, weights.carried(&lanes), sample);
            if survival > 0.0 {
                if survival < 1.0 {
                    weights.beta /= survival;
                }
                pending.push(Waiting { path, weights, ray: from.spawn_ray(s.wi), from: *from });
            }
        };
        // All lanes use the same random numbers: as dispersion tends to zero, so do their differences.
        let u_lobe = sample.sampler.get_1d(Dimension::scatter_lobe(path.bounce));
        let u = sample.sampler.get_2d(Dimension::scatter_direction(path.bounce));
        let mut reflected = 0u8;
        let mut reflection: Option<BsdfSample> = None;
        for lane in (0..N).filter(|&lane| path.lanes.carries(lane)) {
            let Some(s) = bsdf.sample(wo, u_lobe, u, lane) else { continue };
            if s.lobe.contains(Lobe::REFLECTION) && s.lobe.is_specular() {
                reflected |= 1 << lane;
                // Per lane its own weight and probability, whichever lanes were reflected.
                let joint = reflection.get_or_insert(s);
                joint.f.set_lane(lane, s.f.lane(lane));
                joint.pdf.set_lane(lane, s.pdf.lane(lane));
                continue;
            }
            let lanes = Lanes::one(lane);
            let mut child = weights.with_lanes(&lanes);
            child.advance(s.f, s.pdf, s.pdf.lane(lane), s.wi.dot(bsdf.frame().z).abs());
            push(lanes, child, &s);
        }
        if let Some(s) = reflection {
            let u_hero = sample.sampler.get_1d(Dimension::hero(path.bounce));
            let lanes = Lanes::subset(reflected, u_hero);
            let mut child = weights.with_lanes(&lanes);
            // Each lane was reflected by its own choice: its own probability divides it, and nothing is left to weigh.
            child.beta = (child.beta * s.f * s.wi.dot(bsdf.frame().z).abs()).safe_div(s.pdf);
            push(lanes, child, &s);
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

    /// Whether a ray stops at a primitive that may let rays pass: it does not at the holes of an alpha mask.
    #[inline]
    fn stops(&self, ray: &Ray, candidate: &Candidate<'_>, chance: Chance<'_>) -> bool {
        let scene = self.scene;
        let surface = &scene.surfaces[candidate.user as usize];
        let Some(alpha) = &surface.alpha else { return true };
        let hit = scene.world.interaction(ray, &candidate.hit);
        let a = scene.textures.float(alpha, &TextureContext::at(&hit));
        if a >= 1.0 {
            return true;
        }
        if a <= 0.0 {
            return false;
        }
        chance.of(&candidate.hit) < a
    }
}

/// Decides whether rays that leave a vertex stop at surfaces that are partly there: at each by a number of its own, which is the
/// same whenever the traversal asks.
#[derive(Copy, Clone)]
struct Chance<'a> {
    sampler: &'a PixelSample<'a>,
    bounce: u16,
}

impl Chance<'_> {
    /// The number, in `[0, 1)`, of a surface that is hit.
    fn of(self, hit: &Hit) -> f32 {
        if let Some(value) = self.sampler.held(Variable::Alpha) {
            return value.x;
        }
        let seed = self.sampler.hash(Dimension::alpha(self.bounce));
        let id = hit.primitive;
        let place = u64::from(hit.t.to_bits()) << 32 | u64::from(id.index);
        let bits = hash::combine(hash::combine(seed, place), id.geometry.index() as u64);
        hash::unit_f32(bits as u32)
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

/// What paths must carry to go on in any case.
const SAFE: f32 = 0.25;

/// Russian roulette (Arvo and Kirk 1990): ends paths that carry little, and strengthens the others in turn.
///
/// Most of the cost of a path is in its first vertices, and most of the noise of roulette comes from ending paths that carry much:
/// chances in proportion to what is carried, up to 1 at a quarter, were the best of those tried.
///
/// The chance with which a path that carries `carried` at most goes on: 1 of those that go on in any case, 0 of those that do not.
#[inline]
fn survival(path: &Path, carried: f32, sample: &Sample<'_>) -> f32 {
    if carried == 0.0 {
        return 0.0;
    }
    if path.bounce < 2 || carried >= SAFE || sample.sampler.held(Variable::Roulette).is_some() {
        return 1.0;
    }
    let survival = (carried / SAFE).max(0.05);
    if sample.sampler.get_1d(Dimension::roulette(path.bounce)) >= survival { 0.0 } else { survival }
}
