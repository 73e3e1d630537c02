//! An image infinitely far away on all sides.

use super::{LightSample, RadianceImage, ShadowTarget};
use std::f32::consts::FRAC_1_PI;
use tenfold_image::{Image, Interpolation};
use tenfold_math::{Mat3, Vec2, Vec3, equal_area_sphere_to_square, equal_area_square_to_sphere};
use tenfold_sampling::distribution::PiecewiseConstant2D;
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
    pub(super) fn sample(&self, u: Vec2, w: &SampledWavelengths) -> Option<LightSample> {
        let s = self.distribution.sample(u);
        let radiance = self.scale * self.image.pixel(s.cell, w);
        (s.pdf > 0.0 && !radiance.is_black()).then(|| LightSample {
            radiance,
            wi: self.world_from_light * equal_area_square_to_sphere(s.point),
            target: ShadowTarget::Infinity,
            pdf: s.pdf * (0.25 * FRAC_1_PI),
            delta: false,
        })
    }

    /// Density per steradian of the unit `direction`.
    #[inline]
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        self.distribution.pdf(self.square(direction)) * (0.25 * FRAC_1_PI)
    }
}
