use tenfold_math::{Vec2, Vec3};

use super::fresnel::fresnel_dielectric;
use super::local::{reflect, reflect_local, refract, refract_local, same_hemisphere};
use super::microfacet::TrowbridgeReitz;
use super::record::Scattering;

/// A boundary between two dielectrics at one wavelength, smooth or of microfacets (Walter et al. 2007), with
/// reflection and transmission apart.
///
/// Transmission `t` here is that of particles, which conserves flux: `t(a, b) = η² t(b, a)` with η of the side of
/// `b` over that of `a`. Radiance seen from `a` is transmitted by `t(a, b) / η² = t(b, a)`.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Interface {
    /// Index below the surface over that above it.
    eta: f32,
    distribution: TrowbridgeReitz,
}

/// A direction sampled at an [`Interface`].
#[derive(Copy, Clone, Debug)]
pub(crate) struct InterfaceSample {
    pub(crate) wi: Vec3,
    /// `f |cos θi| / pdf` of the sampled part (reflection or transmission) in the transport of particles.
    pub(crate) weight: f32,
    /// Density in solid angle; 1 of a smooth interface.
    pub(crate) pdf: f32,
}

/// The half vector of a transmission.
struct Halfway {
    m: Vec3,
    /// Jacobian `dωm / dωi` over `|wi·m|`.
    jacobian: f32,
}

impl Interface {
    #[inline]
    pub(crate) fn new(eta: f32, distribution: TrowbridgeReitz) -> Self {
        Self { eta, distribution }
    }

    /// Whether directions go through as deltas: smooth, or no boundary at all.
    #[inline]
    pub(crate) fn is_smooth(&self) -> bool {
        self.eta == 1.0 || self.distribution.effectively_smooth()
    }

    /// Index of the far side over that of the side of `w`.
    #[inline]
    pub(crate) fn eta_from(&self, w: Vec3) -> f32 {
        if w.z >= 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// Reflectance of a microfacet with normal `m` (on any side) for `wo`.
    #[inline]
    pub(crate) fn fresnel(&self, wo: Vec3, m: Vec3) -> f32 {
        fresnel_dielectric(wo.dot(m).abs(), self.eta_from(wo))
    }

    /// Microfacet normal of a reflection, on the side of `wo`.
    #[inline]
    pub(crate) fn reflecting_normal(wo: Vec3, wi: Vec3) -> Option<Vec3> {
        let half = wo + wi;
        let length = half.length();
        (same_hemisphere(wo, wi) && length > 0.0).then(|| half / length)
    }

    /// Microfacet normal, on the side of `wo`, of a transmission; `None` where none refracts `wo` to `wi`
    /// (Walter et al. 2007, eq. 16).
    #[inline]
    fn refracting_normal(&self, wo: Vec3, wi: Vec3) -> Option<Halfway> {
        if same_hemisphere(wo, wi) {
            return None;
        }
        let eta = self.eta_from(wo);
        let half = wo + wi * eta;
        let length2 = half.length_squared();
        if length2 == 0.0 {
            return None;
        }
        let m = half * (1f32.copysign(half.z * wo.z) / length2.sqrt());
        // Back-facing microfacets transmit nothing.
        if wo.dot(m) <= 0.0 || wi.dot(m) >= 0.0 {
            return None;
        }
        // |wo·m + η wi·m| is the length of the half vector, so eq. 17's Jacobian needs no difference.
        Some(Halfway { m, jacobian: eta * eta / length2 })
    }

    /// Reflection: the BRDF, and the density of [`Interface::sample_reflection`]. 0 of a smooth interface.
    #[inline]
    pub(crate) fn reflection(&self, wo: Vec3, wi: Vec3) -> Scattering<f32> {
        if self.is_smooth() {
            return Scattering { f: 0.0, pdf: 0.0 };
        }
        let Some(m) = Self::reflecting_normal(wo, wi) else { return Scattering { f: 0.0, pdf: 0.0 } };
        let cos = wo.dot(m);
        if cos <= 0.0 {
            return Scattering { f: 0.0, pdf: 0.0 };
        }
        Scattering {
            f: self.fresnel(wo, m) * self.distribution.d_g2_over_4_cos_cos(m, wo, wi),
            pdf: self.distribution.visible_pdf(wo, m) / (4.0 * cos),
        }
    }

    /// Transmission: the BTDF of particles (Walter et al. 2007, eq. 21 without `1/η²`), and the density of
    /// [`Interface::sample_transmission`]; the Fresnel reflectance beside them. 0 of a smooth interface.
    #[inline]
    pub(crate) fn transmission(&self, wo: Vec3, wi: Vec3) -> Scattering<f32> {
        self.transmission_and_fresnel(wo, wi).0
    }

    /// [`Interface::transmission`], and the reflectance of the microfacet it goes through.
    #[inline]
    pub(crate) fn transmission_and_fresnel(&self, wo: Vec3, wi: Vec3) -> (Scattering<f32>, f32) {
        let zero = (Scattering { f: 0.0, pdf: 0.0 }, 1.0);
        if self.is_smooth() {
            return zero;
        }
        let Some(Halfway { m, jacobian }) = self.refracting_normal(wo, wi) else { return zero };
        let fresnel = self.fresnel(wo, m);
        let change = jacobian * wi.dot(m).abs();
        let projected = 4.0 * self.distribution.d_g2_over_4_cos_cos(m, wo, wi) * wo.dot(m);
        let scattering = Scattering {
            f: (1.0 - fresnel) * projected * change,
            pdf: self.distribution.visible_pdf(wo, m) * change,
        };
        (scattering, fresnel)
    }

    /// Samples a reflection.
    #[inline]
    pub(crate) fn sample_reflection(&self, wo: Vec3, u: Vec2) -> Option<InterfaceSample> {
        if self.is_smooth() {
            let weight = fresnel_dielectric(wo.z.abs(), self.eta_from(wo));
            return Some(InterfaceSample { wi: reflect_local(wo), weight, pdf: 1.0 });
        }
        let wi = reflect(wo, self.distribution.sample_visible(wo, u));
        weigh(wi, self.reflection(wo, wi))
    }

    /// Samples a transmission.
    #[inline]
    pub(crate) fn sample_transmission(&self, wo: Vec3, u: Vec2) -> Option<InterfaceSample> {
        let eta = self.eta_from(wo);
        if self.is_smooth() {
            let weight = 1.0 - fresnel_dielectric(wo.z.abs(), eta);
            return Some(InterfaceSample { wi: refract_local(wo, eta)?, weight, pdf: 1.0 });
        }
        let wi = refract(wo, self.distribution.sample_visible(wo, u), eta)?;
        weigh(wi, self.transmission(wo, wi))
    }
}

#[inline]
fn weigh(wi: Vec3, Scattering { f, pdf }: Scattering<f32>) -> Option<InterfaceSample> {
    (pdf > 0.0).then(|| InterfaceSample { wi, weight: f * wi.z.abs() / pdf, pdf })
}
