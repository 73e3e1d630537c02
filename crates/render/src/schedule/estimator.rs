use super::RenderSettings;
use crate::{
    camera::{ShutterSample, TimeStrategy},
    filter::FilterSample,
    integrator::{PathTracer, Workspace},
    scene::Scene,
};
use tenfold_math::{Vec2, Vec3};
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
    pub fn sample(&self, sampler: &PixelSample<'_>, workspace: &mut Workspace) -> Vec3 {
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
        let radiance = self.tracer.radiance(ray, &wavelengths, sampler, workspace);
        scene.film.sensor.rgb(radiance, &wavelengths) * (filtered.weight * shutter.weight)
    }
}
