use std::f32::consts::FRAC_1_PI;

use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::diffuse::cosine_direction;
use super::local::same_hemisphere;
use super::record::{BsdfSample, Lobe, Scattering};

/// A Lambertian reflector and transmitter, like paper or a leaf: the same radiance in all directions of each side.
#[derive(Copy, Clone, Debug)]
pub struct DiffuseTransmission {
    reflectance: SampledSpectrum,
    transmittance: SampledSpectrum,
    reflect: f32,
}

impl DiffuseTransmission {
    /// A sheet of the given albedos per lane; their sum should not exceed one.
    #[inline]
    pub fn new(reflectance: SampledSpectrum, transmittance: SampledSpectrum) -> Self {
        let (r, t) = (reflectance.average(), transmittance.average());
        let reflect = if r + t > 0.0 { r / (r + t) } else { 0.0 };
        Self { reflectance, transmittance, reflect }
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        let mut lobes = Lobe::NONE;
        if !self.reflectance.is_black() {
            lobes |= Lobe::REFLECTION | Lobe::DIFFUSE;
        }
        if !self.transmittance.is_black() {
            lobes |= Lobe::TRANSMISSION | Lobe::DIFFUSE;
        }
        lobes
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        let (albedo, probability) = if same_hemisphere(wo, wi) {
            (self.reflectance, self.reflect)
        } else {
            (self.transmittance, 1.0 - self.reflect)
        };
        if albedo.is_black() {
            return Scattering::ZERO;
        }
        let pdf = SampledSpectrum::splat(probability * FRAC_1_PI * wi.z.abs());
        Scattering { f: albedo * FRAC_1_PI, pdf }
    }

    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let reflected = u_lobe < self.reflect;
        let wi = cosine_direction(if reflected { wo.z } else { -wo.z }, u)?;
        let Scattering { f, pdf } = self.scattering(wo, wi);
        let side = if reflected { Lobe::REFLECTION } else { Lobe::TRANSMISSION };
        (pdf.lane(0) > 0.0).then_some(BsdfSample {
            f,
            wi,
            pdf,
            lobe: side | Lobe::DIFFUSE,
            eta: 1.0,
            dispersive: false,
        })
    }
}
