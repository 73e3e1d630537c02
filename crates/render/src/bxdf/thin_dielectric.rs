use tenfold_math::Vec3;
use tenfold_spectrum::SampledSpectrum;

use super::fresnel::fresnel_dielectric_lanes;
use super::local::reflect_local;
use super::record::{BsdfSample, Lobe};

/// A pane too thin to shift a ray: both boundaries and all reflections between them in one (pbrt book, §9.5.3).
#[derive(Copy, Clone, Debug)]
pub struct ThinDielectric {
    eta: SampledSpectrum,
}

impl ThinDielectric {
    /// A pane of index `eta` over that of its surroundings, per lane.
    #[inline]
    pub fn new(eta: SampledSpectrum) -> Self {
        Self { eta }
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        Lobe::REFLECTION | Lobe::TRANSMISSION | Lobe::SPECULAR
    }

    /// Reflectance of the pane: R + T² R / (1 - R²) = 2 R / (1 + R).
    #[inline]
    pub(crate) fn reflectance(&self, cos: f32) -> SampledSpectrum {
        let r = fresnel_dielectric_lanes(cos.abs(), self.eta);
        2.0 * r / (1.0 + r)
    }

    /// Neither direction depends on the wavelength, so the choice follows the mean of the lanes.
    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32) -> Option<BsdfSample> {
        let r = self.reflectance(wo.z);
        let reflect = r.average();
        let cos = wo.z.abs();
        let (f, wi, probability, side) = if u_lobe < reflect {
            (r / cos, reflect_local(wo), reflect, Lobe::REFLECTION)
        } else {
            ((1.0 - r) / cos, -wo, 1.0 - reflect, Lobe::TRANSMISSION)
        };
        (probability > 0.0 && cos > 0.0).then_some(BsdfSample {
            f,
            wi,
            pdf: SampledSpectrum::splat(probability),
            lobe: side | Lobe::SPECULAR,
            eta: 1.0,
            dispersive: false,
        })
    }
}
