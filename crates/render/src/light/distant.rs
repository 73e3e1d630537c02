//! Parallel light from infinitely far away.

use super::{Emission, LightSample, ShadowTarget};
use tenfold_math::Vec3;
use tenfold_spectrum::SampledWavelengths;

/// A directional light.
#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit direction to the light.
    pub direction: Vec3,
    /// The irradiance on a surface turned toward it, in W·m⁻²·nm⁻¹.
    pub irradiance: Emission,
}

impl DistantLight {
    #[inline]
    pub(super) fn sample(&self, w: &SampledWavelengths) -> LightSample {
        LightSample {
            radiance: self.irradiance.sample(w),
            wi: self.direction,
            target: ShadowTarget::Infinity,
            pdf: 1.0,
            delta: true,
        }
    }
}
