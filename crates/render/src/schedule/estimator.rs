use super::RenderSettings;
use crate::{
    camera::{ShutterSample, TimeStrategy},
    filter::FilterSample,
    integrator::{PathTracer, Sample, Workspace},
    scene::Scene,
};
use arrayvec::ArrayVec;
use tenfold_math::{Vec2, Vec3, WIDTH};
use tenfold_sampling::{Dimension, PixelSample, Variable};
use tenfold_spectrum::SampledWavelengths;

/// The estimator of a pixel's integral: one sample of all its variables, from the film to the light.
#[derive(Clone, Debug)]
pub struct PixelEstimator<'a> {
    scene: &'a Scene,
    tracer: PathTracer<'a>,
    /// The wavelengths of all samples, where they are not drawn.
    wavelengths: Option<SampledWavelengths>,
    /// How the time is drawn.
    time: TimeStrategy,
}

impl<'a> PixelEstimator<'a> {
    /// An estimator of the pixels of `scene`, under those of `settings` that concern a sample.
    pub fn new(scene: &'a Scene, settings: &RenderSettings) -> Self {
        // Textures are narrowed by the number of samples: it must not change on the way of a picture.
        let spp = if settings.noise.is_some() { u32::MAX } else { settings.spp };
        let strategies = settings.strategies.held(&settings.sampling);
        let tracer = PathTracer::new(scene, settings.dispersion, strategies, spp);
        Self {
            scene,
            tracer: tracer.with_indices_at(settings.index_wavelength),
            wavelengths: settings.wavelength.map(SampledWavelengths::held),
            time: settings.time.clone(),
        }
    }

    /// The linear RGB of one sample, which may not be finite, with the weights of filter and shutter in.
    pub fn sample(&self, sampler: &PixelSample<'_>, workspace: &mut Workspace<'a>) -> Vec3 {
        let mut rgb = Vec3::ZERO;
        self.samples(std::slice::from_ref(sampler), workspace, |_, value| rgb = value);
        rgb
    }

    /// Calls `take` with each of `samplers`, at most [`WIDTH`], and what [`PixelEstimator::sample`] is of it.
    pub fn samples(
        &self,
        samplers: &[PixelSample<'_>],
        workspace: &mut Workspace<'a>,
        mut take: impl FnMut(&PixelSample<'_>, Vec3),
    ) {
        let mut weights = [0.0; WIDTH];
        let mut samples = ArrayVec::<Sample<'_>, WIDTH>::new();
        for (sampler, weight) in samplers.iter().zip(&mut weights) {
            let (sample, w) = self.start(sampler);
            *weight = w;
            samples.push(sample);
        }
        self.tracer.trace(&mut samples, workspace);
        for (sample, weight) in samples.iter().zip(weights) {
            take(sample.sampler, self.scene.film.sensor.rgb(sample.radiance, &sample.wavelengths) * weight);
        }
    }

    /// What is decided before light is traced, and its weight.
    #[inline]
    fn start<'s>(&self, sampler: &'s PixelSample<'s>) -> (Sample<'s>, f32) {
        let scene = self.scene;
        let filtered = match sampler.held(Variable::Pixel) {
            None => scene.filter.sample(sampler.get_2d(Dimension::PIXEL)),
            Some(place) => FilterSample { offset: place - Vec2::splat(0.5), weight: 1.0 },
        };
        let position = sampler.pixel().as_vec2() + Vec2::splat(0.5) + filtered.offset;
        let wavelengths = self
            .wavelengths
            .unwrap_or_else(|| SampledWavelengths::sample_visible(sampler.get_1d(Dimension::WAVELENGTH)));
        let u_lens = if scene.camera.has_lens() { sampler.get_2d(Dimension::LENS) } else { Vec2::ZERO };
        let shutter = match sampler.held(Variable::Time) {
            None => self.time.sample(&scene.camera.shutter, sampler.get_1d(Dimension::TIME)),
            Some(fraction) => ShutterSample { time: scene.camera.shutter.instant(fraction.x), weight: 1.0 },
        };
        let ray = scene.camera.ray(position, u_lens, shutter.time);
        (Sample::new(sampler, ray, wavelengths), filtered.weight * shutter.weight)
    }
}
