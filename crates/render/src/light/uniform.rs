//! The same radiance from every direction, infinitely far away.

use super::{Emission, LightSample, ShadowTarget};
use std::f32::consts::{FRAC_1_PI, TAU};
use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3, sqr};
use tenfold_spectrum::SampledWavelengths;

/// A uniform sky.
#[derive(Clone, Debug)]
pub struct UniformInfinite {
    /// Its radiance, in W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Emission,
}

const PDF: f32 = 0.25 * FRAC_1_PI;

impl UniformInfinite {
    #[inline]
    pub(super) fn sample(&self, u: Vec2, w: &SampledWavelengths) -> LightSample {
        let z = 1.0 - 2.0 * u.x;
        let r = (1.0 - sqr(z)).max(0.0).sqrt();
        let (sin, cos) = ops::sin_cos(TAU * u.y);
        LightSample {
            radiance: self.radiance.sample(w),
            wi: Vec3::new(r * cos, r * sin, z),
            target: ShadowTarget::Infinity,
            pdf: PDF,
            delta: false,
        }
    }

    #[inline]
    pub(super) fn pdf(&self) -> f32 {
        PDF
    }
}
