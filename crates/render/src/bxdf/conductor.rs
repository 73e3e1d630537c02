use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::fresnel::fresnel_conductor;
use super::local::{reflect, reflect_local, same_hemisphere};
use super::microfacet::TrowbridgeReitz;
use super::record::{BsdfSample, Lobe, Scattering};

/// Reflection by a metal of complex index, smooth or of Trowbridge–Reitz microfacets, single scattering
/// (Torrance and Sparrow 1967; pbrt book, §9.6).
#[derive(Copy, Clone, Debug)]
pub struct Conductor {
    eta: SampledSpectrum,
    k: SampledSpectrum,
    distribution: TrowbridgeReitz,
}

impl Conductor {
    /// A metal of index `eta + i·k`, both over the index of the medium in front of it.
    #[inline]
    pub fn new(eta: SampledSpectrum, k: SampledSpectrum, distribution: TrowbridgeReitz) -> Self {
        Self { eta, k, distribution }
    }

    #[inline]
    pub(crate) fn distribution(&self) -> TrowbridgeReitz {
        self.distribution
    }

    #[inline]
    pub(crate) fn is_smooth(&self) -> bool {
        self.distribution.effectively_smooth()
    }

    /// Reflectance at the cosine `cos_i` to a microfacet.
    #[inline]
    pub(crate) fn fresnel(&self, cos_i: f32) -> SampledSpectrum {
        fresnel_conductor(cos_i, self.eta, self.k)
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        Lobe::REFLECTION | if self.is_smooth() { Lobe::SPECULAR } else { Lobe::GLOSSY }
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        if self.is_smooth() || !same_hemisphere(wo, wi) {
            return Scattering::ZERO;
        }
        let half = wo + wi;
        let length = half.length();
        if length == 0.0 {
            return Scattering::ZERO;
        }
        let m = half / length;
        let cos = wo.dot(m).abs();
        if cos == 0.0 {
            return Scattering::ZERO;
        }
        Scattering {
            f: self.fresnel(cos) * self.distribution.d_g2_over_4_cos_cos(m, wo, wi),
            pdf: SampledSpectrum::splat(self.distribution.visible_pdf(wo, m) / (4.0 * cos)),
        }
    }

    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        if self.is_smooth() {
            let f = self.fresnel(wo.z.abs()) / wo.z.abs();
            let lobe = Lobe::REFLECTION | Lobe::SPECULAR;
            let pdf = SampledSpectrum::ONE;
            return Some(BsdfSample { f, wi: reflect_local(wo), pdf, lobe, eta: 1.0, dispersive: false });
        }
        let wi = reflect(wo, self.distribution.sample_visible(wo, u));
        let Scattering { f, pdf } = self.scattering(wo, wi);
        let lobe = Lobe::REFLECTION | Lobe::GLOSSY;
        (pdf.lane(0) > 0.0).then_some(BsdfSample { f, wi, pdf, lobe, eta: 1.0, dispersive: false })
    }
}
