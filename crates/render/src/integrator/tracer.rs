use super::{
    Strategies,
    path::{Arrival, Path},
    spectral::{DispersionRule, Lanes},
};
use crate::{
    bxdf::{Bsdf, BsdfSample, Lobe},
    light::{LightSample, ShadowRay},
    material::Waves,
    scene::{Scene, Surface},
    texture::TextureContext,
};
use tenfold_geometry::{Candidate, Hit, ReferencePoint, SurfaceInteraction};
use tenfold_math::Ray;
use tenfold_sampling::{Dimension, PixelSample, Variable, hash};
use tenfold_spectrum::{N, SampledSpectrum, SampledWavelengths};

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

/// What tracing needs room for, to be used again for sample after sample.
#[derive(Debug, Default)]
pub struct Workspace {
    /// Paths that wait for their turn. Every split leaves each lane on one path only: there are never more than lanes.
    pending: Vec<Path>,
    /// Rays traced so far.
    pub rays: RayCounts,
}

/// One sample being traced.
struct Sample<'a> {
    wavelengths: &'a SampledWavelengths,
    sampler: &'a PixelSample<'a>,
    radiance: SampledSpectrum,
    workspace: &'a mut Workspace,
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

    /// An estimate of the spectral radiance that arrives along `ray`, against its direction, in the lanes of
    /// `wavelengths`, not yet divided by their densities.
    #[inline]
    pub fn radiance(
        &self,
        ray: Ray,
        wavelengths: &SampledWavelengths,
        sampler: &PixelSample<'_>,
        workspace: &mut Workspace,
    ) -> SampledSpectrum {
        let mut sample = Sample { wavelengths, sampler, radiance: SampledSpectrum::ZERO, workspace };
        self.follow(Path::from_camera(ray), &mut sample);
        while let Some(path) = sample.workspace.pending.pop() {
            self.follow(path, &mut sample);
        }
        sample.radiance
    }

    /// Follows a path to its end, leaving paths that split off pending.
    fn follow(&self, mut path: Path, sample: &mut Sample<'_>) {
        let scene = self.scene;
        let mut passes = 0;
        loop {
            sample.workspace.rays.path += 1;
            let chance = Chance { sampler: sample.sampler, bounce: path.bounce };
            let stops = |c: &Candidate<'_>| self.stops(&path.ray, c, chance);
            let Some(hit) = scene.world.intersect(&path.ray, f32::INFINITY, stops) else {
                self.add_escaped(&path, sample);
                return;
            };
            let surface = scene.world.interaction(&path.ray, &hit);
            self.add_emitted(&path, &surface, sample);
            let at_end = path.bounce >= scene.max_depth;
            let material = self.look(&surface).material;
            // A path that has met all the surfaces it may still passes those that are none.
            if at_end && !scene.materials.may_be_interface(material) {
                return;
            }
            // By reference, here and below: these records are large to move.
            let bsdf = self.bsdf(&path, &surface, passes, sample);
            let Some(bsdf) = &bsdf else {
                passes += 1;
                if passes > MOST_PASSES {
                    return;
                }
                if !scene.materials.is_interface(material) {
                    // Shadow rays stop at what is an interface by chance alone: no light sample could have come this way.
                    path.arrival = Arrival::Specular;
                }
                path.ray = surface.spawn_ray(path.ray.direction);
                continue;
            };
            if at_end {
                return;
            }
            if self.rule == DispersionRule::Terminate && path.lanes.count() > 1 && bsdf.is_dispersive() {
                terminate_secondary(&mut path);
            }
            let parts = path.lanes.count() > 1 && bsdf.parts_wavelengths();
            if parts {
                path.settle();
            }
            let mut from = surface.reference();
            if !bsdf.lobes().is_transmissive() {
                from = from.seen_from(surface.wo);
            }
            if bsdf.lobes().has_density() {
                self.add_direct(&path, &surface, &from, bsdf, parts, sample);
            }
            if parts {
                self.part(&path, &surface, &from, bsdf, sample);
                return;
            }
            let u_lobe = if bsdf.chooses_lobe() {
                sample.sampler.get_1d(Dimension::scatter_lobe(path.bounce))
            } else {
                0.0
            };
            let u = sample.sampler.get_2d(Dimension::scatter_direction(path.bounce));
            let scattered = bsdf.sample(surface.wo, u_lobe, u, path.lanes.hero());
            let Some(scattered) = &scattered else { return };
            if !advance(&mut path, &surface, &from, bsdf, scattered) || !survives(&mut path, sample) {
                return;
            }
        }
    }

    /// The scattering function where `path` has met `surface`, after passing `passes` interfaces; `None` for a further one.
    #[inline]
    fn bsdf(
        &self,
        path: &Path,
        surface: &SurfaceInteraction,
        passes: u32,
        sample: &Sample<'_>,
    ) -> Option<Bsdf<'a>> {
        let scene = self.scene;
        let at = if scene.needs_footprint {
            let seen =
                scene.camera.pixel_differentials(surface.p, surface.n, surface.time, self.footprint_scale);
            TextureContext::with_differentials(surface, seen.dpdx, seen.dpdy)
        } else {
            TextureContext::at(surface)
        };
        let u_mix = || {
            let dimension = Dimension::material_mix(path.bounce);
            if passes == 0 || sample.sampler.held(dimension.variable).is_some() {
                return sample.sampler.get_1d(dimension);
            }
            // Surfaces behind an interface are at the same vertex, and need numbers of their own.
            hash::unit_f32(hash::combine(sample.sampler.hash(dimension), passes.into()) as u32)
        };
        let material = self.look(surface).material;
        let indices = self.indices.as_ref().unwrap_or(sample.wavelengths);
        let waves = Waves { light: sample.wavelengths, indices };
        let mut bsdf = scene.materials.bsdf(material, &scene.textures, surface, &at, waves, u_mix);
        if let Some(bsdf) = &mut bsdf {
            bsdf.set_strategy(self.strategies.scatter);
            if sample.sampler.held(Variable::ScatterDirection).is_some() {
                bsdf.hold_direction();
            }
        }
        bsdf
    }

    /// What a surface that was hit looks like.
    #[inline]
    fn look(&self, surface: &SurfaceInteraction) -> &'a Surface {
        let geometry = self.scene.world.geometry(surface.primitive.geometry);
        &self.scene.surfaces[geometry.user as usize]
    }

    /// Light that arrives from beyond the scene.
    #[inline]
    fn add_escaped(&self, path: &Path, sample: &mut Sample<'_>) {
        let lights = &self.scene.lights;
        for &id in lights.infinite() {
            let emitted = lights.escaped(id, path.ray.direction, sample.wavelengths);
            if emitted.is_black() {
                continue;
            }
            let direction = path.ray.direction;
            let pdf = |from: &ReferencePoint| lights.pdf_escaped(self.strategies.light, from, id, direction);
            sample.radiance += path.carried(self.strategies.combine, emitted, pdf);
        }
    }

    /// Light that the surface itself emits toward the path.
    #[inline]
    fn add_emitted(&self, path: &Path, surface: &SurfaceInteraction, sample: &mut Sample<'_>) {
        let lights = &self.scene.lights;
        let Some(id) = self.look(surface).light(surface.primitive) else { return };
        let emitted = lights.emitted(id, surface, surface.wo, sample.wavelengths);
        if emitted.is_black() {
            return;
        }
        let direction = path.ray.direction;
        let pdf = |from: &ReferencePoint| lights.pdf_hit(self.strategies.light, from, id, surface, direction);
        sample.radiance += path.carried(self.strategies.combine, emitted, pdf);
    }

    /// Light from a point sampled on a light.
    #[inline]
    fn add_direct(
        &self,
        path: &Path,
        surface: &SurfaceInteraction,
        from: &ReferencePoint,
        bsdf: &Bsdf<'_>,
        parts: bool,
        sample: &mut Sample<'_>,
    ) {
        let Strategies { light: strategy, combine, .. } = self.strategies;
        let lights = &self.scene.lights;
        let u_choice = match lights.sampled(strategy) {
            0 => return,
            1 => 0.0,
            _ => sample.sampler.get_1d(Dimension::light_choice(path.bounce)),
        };
        let u = sample.sampler.get_2d(Dimension::light_point(path.bounce));
        let light = lights.sample(strategy, from, u_choice, u, sample.wavelengths);
        let Some(light) = &light else { return };
        let scattering = bsdf.eval_and_pdf(surface.wo, light.wi);
        let cos = light.wi.dot(bsdf.frame().z).abs();
        let contribution = path.beta * scattering.f * light.radiance * cos;
        if contribution.is_black() {
            return;
        }
        let Some(density) = path.density_of_sampled(combine, light, scattering.pdf, parts) else { return };
        sample.workspace.rays.shadow += 1;
        if self.is_shadowed(from, light, Chance { sampler: sample.sampler, bounce: path.bounce }) {
            return;
        }
        sample.radiance += contribution.safe_div(density);
    }

    /// Sends every lane of a settled path its own way. Lanes that are reflected stay together: reflection does not
    /// disperse.
    fn part(
        &self,
        path: &Path,
        surface: &SurfaceInteraction,
        from: &ReferencePoint,
        bsdf: &Bsdf<'_>,
        sample: &mut Sample<'_>,
    ) {
        // All lanes use the same random numbers: as dispersion tends to zero, so do their differences.
        let u_lobe = sample.sampler.get_1d(Dimension::scatter_lobe(path.bounce));
        let u = sample.sampler.get_2d(Dimension::scatter_direction(path.bounce));
        let mut reflected = 0u8;
        let mut reflection: Option<BsdfSample> = None;
        for lane in (0..N).filter(|&lane| path.lanes.carries(lane)) {
            let Some(s) = bsdf.sample(surface.wo, u_lobe, u, lane) else { continue };
            if s.lobe.contains(Lobe::REFLECTION) && s.lobe.is_specular() {
                reflected |= 1 << lane;
                // Per lane its own weight and probability, whichever lanes were reflected.
                let joint = reflection.get_or_insert(s);
                joint.f.set_lane(lane, s.f.lane(lane));
                joint.pdf.set_lane(lane, s.pdf.lane(lane));
                continue;
            }
            let mut child = path.with_lanes(Lanes::one(lane));
            if advance(&mut child, surface, from, bsdf, &s) && survives(&mut child, sample) {
                sample.workspace.pending.push(child);
            }
        }
        if let Some(s) = reflection {
            let u_hero = sample.sampler.get_1d(Dimension::hero(path.bounce));
            let mut child = path.with_lanes(Lanes::subset(reflected, u_hero));
            // Each lane was reflected by its own choice: its own probability divides it, and nothing is left to weigh.
            let probability = s.pdf;
            child.beta = (child.beta * s.f * s.wi.dot(bsdf.frame().z).abs()).safe_div(probability);
            leave(&mut child, surface, &s, Arrival::Specular);
            if survives(&mut child, sample) {
                sample.workspace.pending.push(child);
            }
        }
    }

    #[inline]
    fn is_shadowed(&self, from: &ReferencePoint, light: &LightSample, chance: Chance<'_>) -> bool {
        let ShadowRay { ray, t_max } = light.shadow_ray(from);
        self.scene.world.occluded(&ray, t_max, |c| {
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

/// Goes on with the hero alone, in place of all lanes.
fn terminate_secondary(path: &mut Path) {
    let count = path.lanes.count() as f32;
    *path = path.with_lanes(Lanes::one(path.lanes.hero()));
    path.beta *= count;
}

/// Weighs a scattered direction in and moves on; false where nothing is left to carry.
#[inline]
fn advance(
    path: &mut Path,
    surface: &SurfaceInteraction,
    from: &ReferencePoint,
    bsdf: &Bsdf<'_>,
    s: &BsdfSample,
) -> bool {
    let hero_pdf = s.pdf.lane(path.lanes.hero());
    path.beta = path.beta * s.f * (s.wi.dot(bsdf.frame().z).abs() / hero_pdf);
    if path.beta.is_black() {
        return false;
    }
    let arrival = if s.lobe.is_specular() {
        Arrival::Specular
    } else {
        Arrival::Scattered { from: *from, light_ratio: path.ratio / hero_pdf }
    };
    path.ratio = path.ratio * s.pdf / hero_pdf;
    leave(path, surface, s, arrival);
    true
}

/// Leaves `surface` in the direction of `s`.
#[inline]
fn leave(path: &mut Path, surface: &SurfaceInteraction, s: &BsdfSample, arrival: Arrival) {
    path.arrival = arrival;
    path.eta_scale *= s.eta * s.eta;
    path.ray = surface.spawn_ray(s.wi);
    path.bounce += 1;
}

/// What paths must carry to go on in any case.
const SAFE: f32 = 0.25;

/// Russian roulette (Arvo and Kirk 1990): ends paths that carry little, and strengthens the others in turn.
///
/// Most of the cost of a path is in its first vertices, and most of the noise of roulette comes from ending paths that carry much:
/// chances in proportion to what is carried, up to 1 at a quarter, were the best of those tried.
#[inline]
fn survives(path: &mut Path, sample: &Sample<'_>) -> bool {
    if path.bounce < 2 {
        return true;
    }
    let carried = path.beta.max_component() * path.eta_scale / path.lanes.mean(path.ratio);
    if carried >= SAFE || sample.sampler.held(Variable::Roulette).is_some() {
        return true;
    }
    let survival = (carried / SAFE).max(0.05);
    if sample.sampler.get_1d(Dimension::roulette(path.bounce)) >= survival {
        return false;
    }
    path.beta /= survival;
    true
}
