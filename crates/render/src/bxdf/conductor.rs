use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::{N, SampledSpectrum};

use super::fresnel::{fresnel_conductor, fresnel_conductor_array};
use super::local::{reflect, reflect_local};
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

    /// Index of refraction, real and imaginary part.
    #[inline]
    pub(crate) fn index(&self) -> [SampledSpectrum; 2] {
        [self.eta, self.k]
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
        if self.is_smooth() {
            return Scattering::ZERO;
        }
        let (f, pdf) = rough(self.distribution, self.eta.to_array(), self.k.to_array(), wo, wi);
        Scattering { f: SampledSpectrum::new(f), pdf: SampledSpectrum::splat(pdf) }
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

/// The BRDF of a rough metal of index `eta + i·k` per lane, and the density of reflection about visible normals.
#[inline(always)]
pub(crate) fn rough(
    distribution: TrowbridgeReitz,
    eta: [f32; N],
    k: [f32; N],
    wo: Vec3,
    wi: Vec3,
) -> ([f32; N], f32) {
    let mirror = distribution.mirror(wo, wi);
    let exists = mirror.cos != 0.0;
    let fresnel = fresnel_conductor_array(mirror.cos.abs(), eta, k);
    (fresnel.map(|f| if exists { f * mirror.value } else { 0.0 }), if exists { mirror.pdf } else { 0.0 })
}
