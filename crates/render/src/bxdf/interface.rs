use tenfold_math::{Vec2, Vec3};

use super::fresnel::fresnel_dielectric;
use super::local::{either, reflect, reflect_local, refract, refract_local, refraction, same_hemisphere};
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

/// A direction sampled at a rough [`Interface`].
#[derive(Copy, Clone, Debug)]
pub(crate) struct InterfaceDirection {
    pub(crate) wi: Vec3,
    /// Whether it is one of reflection.
    pub(crate) reflected: bool,
    /// Whether there is one.
    pub(crate) exists: bool,
}

/// Microfacets of one normal: the one that reflects or refracts one direction to another (Walter et al. 2007, eq. 13 and 16), where there is one.
struct Facet {
    reflects: bool,
    transmits: bool,
    /// Cosine of the first direction to the normal.
    cos: f32,
    /// Reflectance; 0 where there is no such normal.
    fresnel: f32,
    /// The BRDF of perfect mirrors: `D G₂ / (4 cos θo cos θi)`.
    unit: f32,
    /// Density of the normal among those visible.
    visible_pdf: f32,
    /// Of a transmission, the Jacobian `dωm / dωi`.
    change: f32,
}

impl Facet {
    /// As [`Interface::reflection`].
    #[inline(always)]
    fn reflection(&self) -> Scattering<f32> {
        Scattering {
            f: if self.reflects { self.fresnel * self.unit } else { 0.0 },
            pdf: if self.reflects { self.visible_pdf / (4.0 * self.cos) } else { 0.0 },
        }
    }

    /// As [`Interface::transmission`].
    #[inline(always)]
    fn transmission(&self) -> Scattering<f32> {
        let projected = 4.0 * self.unit * self.cos;
        Scattering {
            f: if self.transmits { (1.0 - self.fresnel) * projected * self.change } else { 0.0 },
            pdf: if self.transmits { self.visible_pdf * self.change } else { 0.0 },
        }
    }
}

impl Interface {
    #[inline(always)]
    pub(crate) fn new(eta: f32, distribution: TrowbridgeReitz) -> Self {
        Self { eta, distribution }
    }

    /// Whether directions go through as deltas: smooth, or no boundary at all.
    #[inline(always)]
    pub(crate) fn is_smooth(&self) -> bool {
        self.eta == 1.0 || self.distribution.effectively_smooth()
    }

    /// Index of the far side over that of the side of `w`.
    #[inline(always)]
    pub(crate) fn eta_from(&self, w: Vec3) -> f32 {
        if w.z >= 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// Scattering from `wo` to `wi` by microfacets.
    #[inline(always)]
    fn facet(&self, wo: Vec3, wi: Vec3) -> Facet {
        let eta = self.eta_from(wo);
        let reflects = same_hemisphere(wo, wi);
        let half = wo + either(reflects, wi, wi * eta);
        let length2 = half.length_squared();
        let length = length2.sqrt();
        // On the side of `wo`.
        let m = either(reflects, half / length, half * (1f32.copysign(half.z * wo.z) / length));
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        // Back-facing microfacets transmit nothing.
        let is_facing = (cos_o > 0.0) & (reflects | (cos_i < 0.0));
        let exists = !self.is_smooth() & (length2 > 0.0) & is_facing;
        Facet {
            reflects: exists & reflects,
            transmits: exists & !reflects,
            cos: cos_o,
            fresnel: if exists { fresnel_dielectric(cos_o, eta) } else { 0.0 },
            unit: self.distribution.d_g2_over_4_cos_cos(m, wo, wi),
            visible_pdf: self.distribution.visible_pdf(wo, m),
            // |wo·m + η wi·m| is the length of the half vector, so eq. 17's Jacobian needs no difference.
            change: eta * eta / length2 * cos_i.abs(),
        }
    }

    /// Reflection: the BRDF, and the density of [`Interface::sample_reflection`]. 0 of a smooth interface.
    #[inline(always)]
    pub(crate) fn reflection(&self, wo: Vec3, wi: Vec3) -> Scattering<f32> {
        self.facet(wo, wi).reflection()
    }

    /// Transmission: the BTDF of particles (Walter et al. 2007, eq. 21 without `1/η²`), and the density of
    /// [`Interface::sample_transmission`]. 0 of a smooth interface.
    #[inline(always)]
    pub(crate) fn transmission(&self, wo: Vec3, wi: Vec3) -> Scattering<f32> {
        self.facet(wo, wi).transmission()
    }

    /// Scattering of radiance to both sides, and the density of [`Interface::sample`]. 0 of a smooth interface.
    #[inline(always)]
    pub(crate) fn radiance(&self, wo: Vec3, wi: Vec3) -> Scattering<f32> {
        let eta = self.eta_from(wo);
        let facet = self.facet(wo, wi);
        let (back, through) = (facet.reflection(), facet.transmission());
        Scattering {
            f: if facet.reflects { back.f } else { through.f / (eta * eta) },
            pdf: if facet.reflects { facet.fresnel * back.pdf } else { through.pdf * (1.0 - facet.fresnel) },
        }
    }

    /// Samples a direction about a visible normal of a rough interface; the reflectance decides whether of reflection or of transmission.
    #[inline(always)]
    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> InterfaceDirection {
        let eta = self.eta_from(wo);
        let m = self.distribution.sample_visible(wo, u);
        let reflected = u_lobe < fresnel_dielectric(wo.dot(m).abs(), eta);
        let (through, refracts) = refraction(wo, m, eta);
        let wi = either(reflected, reflect(wo, m), through);
        // Light reflected to below, or refracted to above, would have to meet the surface again.
        let leaves = (wi.z != 0.0) & (same_hemisphere(wo, wi) == reflected);
        InterfaceDirection { wi, reflected, exists: (reflected | refracts) & leaves }
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
