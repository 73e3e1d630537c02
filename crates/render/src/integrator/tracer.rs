use super::{Strategies, path::Waiting, spectral::DispersionRule, wave::Wave, weights::Scattering};
use crate::{light::LightSamples, scene::Scene};
use tenfold_geometry::{PlainSurfaces, RayCourses};
use tenfold_math::Rays;
use tenfold_sampling::{PixelSample, SampleGroup};
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths, Spectra, SpectraToEvaluate};

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
    pub(super) scene: &'a Scene,
    pub(super) rule: DispersionRule,
    pub(super) strategies: Strategies,
    pub(super) footprint_scale: f32,
    /// Where indices of refraction are looked up, if not at the wavelengths of the path.
    pub(super) indices: Option<SampledWavelengths>,
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
    pub(super) wave: Wave<'a>,
    pub(super) courses: RayCourses,
    pub(super) surfaces: PlainSurfaces,
    pub(super) albedos: SpectraToEvaluate,
    pub(super) lights: LightSamples,
    pub(super) scattering: Scattering,
    pub(super) arriving: Spectra,
    /// Paths that wait for their turn. Every split leaves each lane on one path only: a sample has never more than lanes.
    pub(super) pending: Vec<Waiting>,
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

    /// Estimates the radiance of `samples`, those of `group`, with their `rays` from the camera in the first slots, by paths that take each step
    /// together. The estimate of each is the same, whichever others are with it.
    pub fn trace(
        &self,
        group: &SampleGroup<'_>,
        rays: &Rays,
        samples: &mut [Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) {
        let mut live = workspace.wave.start(samples, rays);
        loop {
            while !live.is_empty() {
                let vertices = self.go_on(live, samples, workspace);
                self.add_direct(&vertices, group, samples, workspace);
                live = self.scatter(&vertices, group, samples, workspace);
            }
            if workspace.pending.is_empty() {
                return;
            }
            live = workspace.wave.resume(&mut workspace.pending);
        }
    }
}
