use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::fresnel::{fresnel_dielectric, fresnel_dielectric_lanes};
use super::interface::{Interface, InterfaceDirection};
use super::local::{reflect_local, refract_local, same_hemisphere};
use super::microfacet::TrowbridgeReitz;
use super::record::{BsdfSample, Lobe, Scattering};

/// A boundary between dielectrics, smooth or of Trowbridge–Reitz microfacets (Walter et al. 2007), whose index may
/// differ from lane to lane.
///
/// The hero's index decides between reflection and transmission, and the direction of the latter. Radiance that is
/// transmitted carries `1/η²`, with η of the far side over that of `wo`, as pbrt's `TransportMode::Radiance`.
#[derive(Copy, Clone, Debug)]
pub struct Dielectric {
    eta: SampledSpectrum,
    distribution: TrowbridgeReitz,
    dispersive: bool,
    smooth: bool,
}

/// The parts of a reflection by microfacets.
pub(crate) struct MicrofacetReflection {
    /// Reflectance of the microfacet per lane.
    pub(crate) fresnel: SampledSpectrum,
    /// The BRDF of a perfect mirror's microfacets: `D G₂ / (4 cos θo cos θi)`.
    pub(crate) unit: f32,
    /// Density in solid angle of reflection about visible normals.
    pub(crate) visible_pdf: f32,
}

impl Dielectric {
    /// A boundary with index `eta` of what lies below the surface over that of what lies above, per lane.
    #[inline]
    pub fn new(eta: SampledSpectrum, distribution: TrowbridgeReitz) -> Self {
        let dispersive = eta.min_component() != eta.max_component();
        let invisible = eta == SampledSpectrum::ONE;
        Self { eta, distribution, dispersive, smooth: invisible || distribution.effectively_smooth() }
    }

    /// Index of the far side over that of the side of `wo`, per lane.
    #[inline]
    pub(crate) fn eta_from(&self, wo: Vec3) -> SampledSpectrum {
        if wo.z >= 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// Reflectance per lane of a smooth boundary seen at cosine `cos`, positive, from the side of `wo`.
    #[inline]
    pub(crate) fn fresnel(&self, wo: Vec3, cos: f32) -> SampledSpectrum {
        let eta = self.eta_from(wo);
        if self.dispersive {
            fresnel_dielectric_lanes(cos, eta)
        } else {
            SampledSpectrum::splat(fresnel_dielectric(cos, eta.lane(0)))
        }
    }

    /// Whether the index differs between lanes.
    #[inline]
    pub(crate) fn is_dispersive(&self) -> bool {
        self.dispersive
    }

    /// Whether the lanes' refracted lobes hardly overlap. Microfacets of roughness α turn a refracted direction by about
    /// α·(η − 1), dispersion by about the spread of η: the lobes part where the first is the smaller.
    #[inline]
    pub(crate) fn parts_wavelengths(&self) -> bool {
        if !self.dispersive {
            return false;
        }
        let (least, most) = (self.eta.min_component(), self.eta.max_component());
        self.smooth
            || self.distribution.alpha_x().max(self.distribution.alpha_y()) * (least - 1.0).abs()
                < most - least
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        let kind = if self.smooth { Lobe::SPECULAR } else { Lobe::GLOSSY };
        if self.eta == SampledSpectrum::ONE {
            Lobe::TRANSMISSION | kind
        } else {
            Lobe::REFLECTION | Lobe::TRANSMISSION | kind
        }
    }

    /// Reflection alone: the BRDF, and the density of sampling it by visible normals without any choice; with the
    /// reflectance of the microfacet. Zero where the boundary is smooth.
    #[inline]
    pub(crate) fn reflection(&self, wo: Vec3, wi: Vec3) -> MicrofacetReflection {
        let mirror = self.distribution.mirror(wo, wi);
        if self.smooth || mirror.cos <= 0.0 {
            return MicrofacetReflection { fresnel: SampledSpectrum::ZERO, unit: 0.0, visible_pdf: 0.0 };
        }
        let fresnel = self.fresnel(wo, mirror.cos);
        MicrofacetReflection { fresnel, unit: mirror.value, visible_pdf: mirror.pdf }
    }

    /// The boundary in one lane.
    #[inline]
    fn interface(&self, lane: usize) -> Interface {
        Interface::new(self.eta.lane(lane), self.distribution)
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        if self.smooth {
            return Scattering::ZERO;
        }
        if !self.dispersive {
            let Scattering { f, pdf } = self.interface(0).radiance(wo, wi);
            return Scattering { f: SampledSpectrum::splat(f), pdf: SampledSpectrum::splat(pdf) };
        }
        if same_hemisphere(wo, wi) {
            let r = self.reflection(wo, wi);
            return Scattering { f: r.fresnel * r.unit, pdf: r.fresnel * r.visible_pdf };
        }
        let mut all = Scattering::ZERO;
        for lane in 0..tenfold_spectrum::N {
            let Scattering { f, pdf } = self.interface(lane).radiance(wo, wi);
            all.f.set_lane(lane, f);
            all.pdf.set_lane(lane, pdf);
        }
        all
    }

    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, hero: usize) -> Option<BsdfSample> {
        if self.smooth {
            return self.sample_smooth(wo, u_lobe, hero);
        }
        let interface = self.interface(hero);
        let InterfaceDirection { wi, reflected, exists } = interface.sample(wo, u_lobe, u);
        if !exists {
            return None;
        }
        let Scattering { f, pdf } = self.scattering(wo, wi);
        let side = if reflected { Lobe::REFLECTION } else { Lobe::TRANSMISSION };
        (pdf.lane(hero) > 0.0).then_some(BsdfSample {
            f,
            wi,
            pdf,
            lobe: side | Lobe::GLOSSY,
            eta: if reflected { 1.0 } else { interface.eta_from(wo) },
            dispersive: self.dispersive && !reflected,
        })
    }

    #[inline]
    fn sample_smooth(&self, wo: Vec3, u_lobe: f32, hero: usize) -> Option<BsdfSample> {
        let reflectance = self.fresnel(wo, wo.z.abs());
        if u_lobe < reflectance.lane(hero) {
            return Some(BsdfSample {
                f: reflectance / wo.z.abs(),
                wi: reflect_local(wo),
                pdf: reflectance,
                lobe: Lobe::REFLECTION | Lobe::SPECULAR,
                eta: 1.0,
                dispersive: false,
            });
        }
        let etas = self.eta_from(wo);
        let eta = etas.lane(hero);
        let wi = refract_local(wo, eta)?;
        let mut pdf = 1.0 - reflectance;
        if self.dispersive {
            // Only lanes with the hero's very index are refracted along with it.
            pdf = SampledSpectrum::from_fn(|i| if etas.lane(i) == eta { pdf.lane(i) } else { 0.0 });
        }
        (pdf.lane(hero) > 0.0).then_some(BsdfSample {
            f: pdf / (eta * eta * wi.z.abs()),
            wi,
            pdf,
            lobe: Lobe::TRANSMISSION | Lobe::SPECULAR,
            eta,
            dispersive: self.dispersive,
        })
    }
}
