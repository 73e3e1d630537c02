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
    distribution: PiecewiseConstant2D,
    scale: f32,
}

impl ImageInfinite {
    /// The square `image`, of colours in `space`, times `scale` is the radiance, in W·m⁻²·sr⁻¹·nm⁻¹.
    /// `world_from_light` is orthonormal.
    pub fn new(world_from_light: Mat3, image: &Image, space: &RgbColorSpace, scale: f32) -> Self {
        let weights = image.sampling_distribution(Interpolation::Nearest, (Vec2::ZERO, Vec2::ONE), |_| 1.0);
        Self {
            world_from_light,
            image: RadianceImage::new(image, space),
            distribution: PiecewiseConstant2D::new(&weights, image.width() as usize),
            scale,
        }
    }

    pub(super) fn visible_mean(&self) -> f32 {
        self.scale * self.image.visible_mean()
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
        let (wi, color, pdf) = match strategy {
            LightStrategy::AsPoint => return None,
            LightStrategy::ByTexture | LightStrategy::Complementary => {
                let s = self.distribution.sample(u);
                let wi = self.world_from_light * equal_area_square_to_sphere(s.point);
                (wi, self.image.pixel(s.cell, w), s.pdf)
            }
            LightStrategy::UniformArea | LightStrategy::SolidAngle => {
                let wi = warp::sample_uniform_sphere(u);
                (wi, self.image.nearest(self.square(wi), w), 1.0)
            }
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
        let on_square = match strategy {
            LightStrategy::AsPoint => 0.0,
            LightStrategy::ByTexture | LightStrategy::Complementary => {
                self.distribution.pdf(self.square(direction))
            }
            LightStrategy::UniformArea | LightStrategy::SolidAngle => 1.0,
        };
        on_square * warp::uniform_sphere_pdf()
    }
}
