//! An image infinitely far away on all sides.

use super::far::FarIrradiance;
use super::{LightSample, LightStrategy, RadianceImage, ShadowTarget};
use tenfold_image::{Image, Interpolation};
use tenfold_math::{DVec3, Mat3, Vec2, Vec3, equal_area_sphere_to_square, equal_area_square_to_sphere};
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
    /// The share of the light that is above the mean, if there is any to speak of, and the mean of its directions in the world.
    uneven: Option<(f32, Vec3)>,
    scale: f32,
}

/// Skies are even where less of their light than this is above the mean: rounding, perhaps.
const LEAST_UNEVEN: f32 = 0.01;
/// Directions are taken to be the same within squares, up to so many along an edge of the image.
const SQUARES: usize = 256;

/// The mean of the directions of the pixels of an image, in its own frame, weighted.
fn mean_direction(weights: &[f32], width: usize) -> Vec3 {
    let along = width.min(SQUARES);
    let square = |i: usize| i * along / width;
    let mut squares = vec![0f64; along * along];
    for (i, &weight) in weights.iter().enumerate() {
        squares[square(i / width) * along + square(i % width)] += f64::from(weight);
    }
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (i, weight) in squares.into_iter().enumerate() {
        let at = (Vec2::new((i % along) as f32, (i / along) as f32) + 0.5) / along as f32;
        sum += weight * equal_area_square_to_sphere(at).as_dvec3();
        total += weight;
    }
    (sum / total).as_vec3()
}

impl ImageInfinite {
    /// The square `image`, of colours in `space`, times `scale` is the radiance, in W·m⁻²·sr⁻¹·nm⁻¹.
    /// `world_from_light` is orthonormal.
    pub fn new(world_from_light: Mat3, image: &Image, space: &RgbColorSpace, scale: f32) -> Self {
        let weights = image.sampling_distribution(Interpolation::Nearest, (Vec2::ZERO, Vec2::ONE), |_| 1.0);
        let width = image.width() as usize;
        let sum = |w: &[f32]| w.iter().map(|&w| f64::from(w)).sum::<f64>();
        let mean = (sum(&weights) / weights.len() as f64) as f32;
        let excess: Vec<f32> = weights.iter().map(|w| (w - mean).max(0.0)).collect();
        let share = (sum(&excess) / sum(&weights)) as f32;
        let distribution = |w: &[f32]| PiecewiseConstant2D::new(w, width);
        Self {
            world_from_light,
            image: RadianceImage::new(image, space),
            brightness: distribution(&weights),
            excess: distribution(&excess),
            uneven: (share >= LEAST_UNEVEN)
                .then(|| (share, world_from_light * mean_direction(&excess, width))),
            scale,
        }
    }

    fn visible_mean(&self) -> f32 {
        self.scale * self.image.visible_mean()
    }

    /// What it lights surfaces with.
    pub(super) fn irradiance(&self) -> FarIrradiance {
        FarIrradiance::around(self.visible_mean(), Vec3::ZERO)
    }

    /// The same by light above the mean of all directions alone, if there is any to speak of.
    pub(super) fn uneven_irradiance(&self) -> Option<FarIrradiance> {
        let (share, toward) = self.uneven?;
        Some(FarIrradiance::around(share * self.visible_mean(), toward))
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
