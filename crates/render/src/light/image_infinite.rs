//! An image infinitely far away on all sides.

use super::{LightSample, LightStrategy, RadianceImage, ShadowTarget};
use tenfold_image::{Image, Interpolation};
use tenfold_math::{Mat3, Vec2, Vec3, equal_area_sphere_to_square, equal_area_square_to_sphere};
use tenfold_sampling::{distribution::PiecewiseConstant2D, warp};
use tenfold_spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// An environment map in the equal-area octahedral projection (Clarberg 2008; pbrt book, 4th edition, section
/// 12.5.2), each pixel of constant radiance, sampled by its brightness.
#[derive(Clone, Debug)]
pub struct ImageInfinite {
    /// A rotation, perhaps with a reflection.
    world_from_light: Mat3,
    image: RadianceImage,
    /// In proportion to brightness.
    brightness: PiecewiseConstant2D,
    /// In proportion to what brightness has above its mean.
    excess: PiecewiseConstant2D,
    /// The share of the light that is above the mean.
    uneven: f32,
    scale: f32,
}

impl ImageInfinite {
    /// The square `image`, of colours in `space`, times `scale` is the radiance, in W·m⁻²·sr⁻¹·nm⁻¹.
    /// `world_from_light` is orthonormal.
    pub fn new(world_from_light: Mat3, image: &Image, space: &RgbColorSpace, scale: f32) -> Self {
        let weights = image.sampling_distribution(Interpolation::Nearest, (Vec2::ZERO, Vec2::ONE), |_| 1.0);
        let mean = |w: &[f32]| (w.iter().map(|&w| f64::from(w)).sum::<f64>() / w.len() as f64) as f32;
        let whole = mean(&weights);
        let excess: Vec<f32> = weights.iter().map(|w| (w - whole).max(0.0)).collect();
        let distribution = |w: &[f32]| PiecewiseConstant2D::new(w, image.width() as usize);
        Self {
            world_from_light,
            image: RadianceImage::new(image, space),
            brightness: distribution(&weights),
            excess: distribution(&excess),
            uneven: if whole > 0.0 { mean(&excess) / whole } else { 0.0 },
            scale,
        }
    }

    pub(super) fn visible_mean(&self) -> f32 {
        self.scale * self.image.visible_mean()
    }

    /// The share of the light that is above the mean of all directions.
    pub(super) fn uneven(&self) -> f32 {
        self.uneven
    }

    /// How `strategy` distributes points on the square, if not evenly. What is left to scattered directions is what they find
    /// as well: all light up to the mean (Karlík et al. 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance
    /// Sampling").
    #[inline]
    fn distribution(&self, strategy: LightStrategy) -> Option<&PiecewiseConstant2D> {
        match strategy {
            LightStrategy::ByTexture => Some(&self.brightness),
            LightStrategy::Complementary => Some(&self.excess),
            LightStrategy::UniformArea | LightStrategy::SolidAngle | LightStrategy::AsPoint => None,
        }
    }

    #[inline]
    fn square(&self, direction: Vec3) -> Vec2 {
        equal_area_sphere_to_square(self.world_from_light.transpose() * direction)
    }

    /// Radiance from the unit `direction`.
    #[inline]
    pub(super) fn radiance(&self, direction: Vec3, w: &SampledWavelengths) -> SampledSpectrum {
        self.scale * self.image.nearest(self.square(direction), w)
    }

    #[inline]
    pub(super) fn sample(
        &self,
        strategy: LightStrategy,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> Option<LightSample> {
        if strategy == LightStrategy::AsPoint {
            return None;
        }
        let (wi, color, pdf) = if let Some(distribution) = self.distribution(strategy) {
            let s = distribution.sample(u);
            let wi = self.world_from_light * equal_area_square_to_sphere(s.point);
            (wi, self.image.pixel(s.cell, w), s.pdf)
        } else {
            let wi = warp::sample_uniform_sphere(u);
            (wi, self.image.nearest(self.square(wi), w), 1.0)
        };
        let radiance = self.scale * color;
        (pdf > 0.0 && !radiance.is_black()).then(|| LightSample {
            radiance,
            wi,
            target: ShadowTarget::Infinity,
            pdf: pdf * warp::uniform_sphere_pdf(),
            delta: false,
        })
    }

    /// Density per steradian of the unit `direction`.
    #[inline]
    pub(super) fn pdf(&self, strategy: LightStrategy, direction: Vec3) -> f32 {
        if strategy == LightStrategy::AsPoint {
            return 0.0;
        }
        let on_square = self.distribution(strategy).map_or(1.0, |d| d.pdf(self.square(direction)));
        on_square * warp::uniform_sphere_pdf()
    }
}
