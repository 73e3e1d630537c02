use std::{f32::consts::FRAC_1_PI, ops::Mul};

use tenfold_math::{Vec2, Vec3};
use tenfold_sampling::warp;
use tenfold_spectrum::SampledSpectrum;

use super::local::same_hemisphere;
use super::record::{BsdfSample, Lobe, Scattering};

/// Lambert's reflector: the same radiance in all directions of the side of incidence.
#[derive(Copy, Clone, Debug)]
pub struct Diffuse {
    reflectance: SampledSpectrum,
}

impl Diffuse {
    /// A reflector of the given albedo per lane, in `[0, 1]`.
    #[inline]
    pub fn new(reflectance: SampledSpectrum) -> Self {
        Self { reflectance }
    }

    /// Albedo per lane.
    #[inline]
    pub(crate) fn reflectance(&self) -> SampledSpectrum {
        self.reflectance
    }

    /// The BSDF of an albedo.
    #[inline]
    pub(crate) fn value<T: Mul<f32, Output = T>>(reflectance: T) -> T {
        reflectance * FRAC_1_PI
    }

    /// Density in solid angle of a direction on the side of incidence with this cosine to the normal.
    #[inline]
    pub(crate) fn density(cos: f32) -> f32 {
        FRAC_1_PI * cos.abs()
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        if self.reflectance.is_black() { Lobe::NONE } else { Lobe::REFLECTION | Lobe::DIFFUSE }
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        if !same_hemisphere(wo, wi) {
            return Scattering::ZERO;
        }
        Scattering { f: Self::value(self.reflectance), pdf: SampledSpectrum::splat(Self::density(wi.z)) }
    }

    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let wi = cosine_direction(wo.z, u)?;
        let Scattering { f, pdf } = self.scattering(wo, wi);
        let lobe = Lobe::REFLECTION | Lobe::DIFFUSE;
        Some(BsdfSample { f, wi, pdf, lobe, eta: 1.0, dispersive: false })
    }
}

/// A direction with density `|cos θ| / π` on the side of the sign of `side`; `None` at the very horizon.
#[inline]
pub(crate) fn cosine_direction(side: f32, u: Vec2) -> Option<Vec3> {
    let mut wi = warp::sample_cosine_hemisphere(u);
    wi.z = wi.z.copysign(side);
    (wi.z != 0.0).then_some(wi)
}
