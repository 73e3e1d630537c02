use super::RenderSettings;
use crate::{
    camera::TimeStrategy,
    filter::FilterSamples,
    integrator::{PathTracer, Sample, Workspace},
    scene::Scene,
};
use arrayvec::ArrayVec;
use tenfold_math::{Floats, Vec2, Vec2s, Vec3, Vec3s, WIDTH};
use tenfold_sampling::{Dimension, PixelSample, SampleGroup, Variable};
use tenfold_spectrum::SampledWavelengths;

/// The estimator of a pixel's integral: one sample of all its variables, from the film to the light.
#[derive(Clone, Debug)]
pub struct PixelEstimator<'a> {
    scene: &'a Scene,
    tracer: PathTracer<'a>,
    /// The wavelengths of all samples, where they are not drawn.
    wavelengths: Option<SampledWavelengths>,
    /// How the time is drawn, where it matters.
    time: Option<TimeStrategy>,
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
            time: (scene.is_moving() || settings.time != TimeStrategy::Shutter)
                .then(|| settings.time.clone()),
        }
    }

    /// The linear RGB of one sample, which may not be finite, with the weights of filter and shutter in.
    pub fn sample(&self, sampler: &PixelSample<'_>, workspace: &mut Workspace<'a>) -> Vec3 {
        self.samples(&SampleGroup::from(*sampler), workspace).get(0)
    }

    /// What [`PixelEstimator::sample`] is of each of `group`.
    pub fn samples(&self, group: &SampleGroup<'_>, workspace: &mut Workspace<'a>) -> Vec3s {
        let scene = self.scene;
        let FilterSamples { offset, mut weight } = self.filter(group);
        let (time, time_weight) = self.times(group);
        (0..WIDTH).for_each(|i| weight[i] *= time_weight[i]);
        let centre = group.pixel().as_vec2() + Vec2::splat(0.5);
        let film = Vec2s { x: offset.x.map(|x| centre.x + x), y: offset.y.map(|y| centre.y + y) };
        let rays = scene.camera.rays(group.slots(), &film, &self.lens(group), &time);
        let wavelengths = self.wavelengths(group);
        let mut samples = ArrayVec::<Sample<'_>, WIDTH>::new();
        for (sampler, wavelengths) in group.iter().zip(&wavelengths) {
            samples.push(Sample::new(sampler, *wavelengths));
        }
        self.tracer.trace(group, &rays, &mut samples, workspace);
        let mut xyz = Vec3s::ZERO;
        for (slot, sample) in samples.iter().enumerate() {
            xyz.set(slot, scene.film.sensor.xyz(sample.radiance, &sample.wavelengths));
        }
        scene.film.sensor.weighted_rgb(&xyz, &weight)
    }

    /// Where in the pixel.
    #[inline]
    fn filter(&self, group: &SampleGroup<'_>) -> FilterSamples {
        let slots = group.slots();
        match group.held(Variable::Pixel) {
            None => self.scene.filter.samples(slots, &group.get_2d(slots, Dimension::PIXEL)),
            Some(place) => {
                let offset = place - Vec2::splat(0.5);
                let offset = Vec2s { x: [offset.x; WIDTH], y: [offset.y; WIDTH] };
                FilterSamples { offset, weight: [1.0; WIDTH] }
            }
        }
    }

    /// When, and the weights of that.
    #[inline]
    fn times(&self, group: &SampleGroup<'_>) -> (Floats, Floats) {
        let (slots, shutter) = (group.slots(), &self.scene.camera.shutter);
        let at = |fraction| ([shutter.instant(fraction); WIDTH], [1.0; WIDTH]);
        match (&self.time, group.held(Variable::Time)) {
            (_, Some(fraction)) => at(fraction.x),
            (Some(time), None) => time.samples(slots, shutter, &group.get_1d(slots, Dimension::TIME)),
            (None, None) => at(0.0),
        }
    }

    /// Numbers for the place on the lens.
    #[inline]
    fn lens(&self, group: &SampleGroup<'_>) -> Vec2s {
        if !self.scene.camera.has_lens() {
            return Vec2s::ZERO;
        }
        group.get_2d(group.slots(), Dimension::LENS)
    }

    #[inline]
    fn wavelengths(&self, group: &SampleGroup<'_>) -> [SampledWavelengths; WIDTH] {
        match self.wavelengths {
            None => SampledWavelengths::samples_visible(&group.get_1d(group.slots(), Dimension::WAVELENGTH)),
            Some(wavelengths) => [wavelengths; WIDTH],
        }
    }
}
