//! Scattering at surfaces, in the local frame and in the world.
//!
//! Directions point away from the surface; local z is the shading normal. Values are those of radiance transport and
//! leave out the cosine. Four wavelengths ride together; one of them, the *hero*, decides where a sample goes, and
//! densities are given per lane: each is that with which *this lane as the hero* would have chosen the direction.
//!
//! All members are small and `Copy`; a coat's tables are borrowed from its material.

mod bsdf;
mod coat_table;
mod coated_diffuse;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod fresnel;
mod gauss;
mod interface;
mod layered;
mod local;
mod microfacet;
mod phase;
mod record;
mod strategy;
#[cfg(test)]
mod tests;
mod thin_dielectric;
mod wide;

use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

pub use bsdf::{Bsdf, BsdfValue};
pub use coat_table::{CoatRoughness, CoatTable};
pub use coated_diffuse::CoatedDiffuse;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use fresnel::{fresnel_conductor, fresnel_dielectric, fresnel_dielectric_lanes};
pub use layered::{Layered, LayeredBase, Slab};
pub use local::{reflect, refract};
pub use microfacet::TrowbridgeReitz;
pub use record::{BsdfSample, Lobe};
pub use strategy::ScatterStrategy;
pub use thin_dielectric::ThinDielectric;

pub(crate) use conductor::rough as rough_conductor;
pub(crate) use interface::{Interface, InterfaceDirection};
pub(crate) use record::Scattering;
pub(crate) use wide::WideBxdf;

use strategy::Hemispheres;

/// Directions with a cosine below this lie in the surface: values over the cosine stay finite.
pub(crate) const HORIZON: f32 = 1e-30;

/// A scattering function in the local frame of shading.
#[derive(Copy, Clone, Debug)]
pub enum Bxdf<'a> {
    /// Lambertian reflection.
    Diffuse(Diffuse),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmission),
    /// Metal.
    Conductor(Conductor),
    /// Boundary of a transparent body.
    Dielectric(Dielectric),
    /// Pane.
    ThinDielectric(ThinDielectric),
    /// Lambertian reflector under a clear coat, without noise.
    CoatedDiffuse(CoatedDiffuse<'a>),
    /// Metal or Lambertian reflector under a coat, possibly filled with a medium, by random walks.
    Layered(Layered),
}

impl Bxdf<'_> {
    /// What it can do.
    #[inline]
    pub fn lobes(&self) -> Lobe {
        match self {
            Self::Diffuse(b) => b.lobes(),
            Self::DiffuseTransmission(b) => b.lobes(),
            Self::Conductor(b) => b.lobes(),
            Self::Dielectric(b) => b.lobes(),
            Self::ThinDielectric(b) => b.lobes(),
            Self::CoatedDiffuse(b) => b.lobes(),
            Self::Layered(b) => b.lobes(),
        }
    }

    /// Whether it transmits different wavelengths in different directions.
    #[inline]
    pub fn is_dispersive(&self) -> bool {
        matches!(self, Self::Dielectric(b) if b.is_dispersive())
    }

    /// Whether it sends the wavelengths so far apart that a direction sampled for one is of no use to the others.
    #[inline]
    pub fn parts_wavelengths(&self) -> bool {
        matches!(self, Self::Dielectric(b) if b.parts_wavelengths())
    }

    /// Probability with which [`Bxdf::sample`] samples a delta from `wo`, by numbers `u_lobe` below it, where it has a
    /// density beside it: the same in all lanes.
    fn delta_probability(&self, wo: Vec3) -> f32 {
        match self {
            Self::CoatedDiffuse(b) => b.delta_probability(wo),
            Self::Layered(b) => b.delta_probability(wo),
            Self::Diffuse(_)
            | Self::DiffuseTransmission(_)
            | Self::Conductor(_)
            | Self::Dielectric(_)
            | Self::ThinDielectric(_) => 0.0,
        }
    }

    /// Index of refraction in lane `hero` of the far side over that of the side of `wo`, as [`BsdfSample::eta`].
    fn transmitted_eta(&self, wo: Vec3, hero: usize) -> f32 {
        match self {
            Self::Dielectric(b) => b.eta_from(wo).lane(hero),
            _ => 1.0,
        }
    }

    /// Value and density together; both 0 of specular lobes, and at the horizon.
    #[inline]
    fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        if wo.z.abs() < HORIZON || wi.z.abs() < HORIZON {
            return Scattering::ZERO;
        }
        match self {
            Self::Diffuse(b) => b.scattering(wo, wi),
            Self::DiffuseTransmission(b) => b.scattering(wo, wi),
            Self::Conductor(b) => b.scattering(wo, wi),
            Self::Dielectric(b) => b.scattering(wo, wi),
            Self::ThinDielectric(_) => Scattering::ZERO,
            Self::CoatedDiffuse(b) => b.scattering(wo, wi),
            Self::Layered(b) => b.scattering(wo, wi),
        }
    }

    /// The BSDF per lane in sr⁻¹, without the cosine; 0 of specular lobes. A transmission includes the scaling of
    /// radiance by `1/η²`.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        self.scattering(wo, wi).f
    }

    /// Per lane, the density in solid angle with which this lane as the hero samples `wi` from `wo`; 0 of specular
    /// lobes.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        match self {
            Self::Layered(b) if wo.z.abs() >= HORIZON && wi.z.abs() >= HORIZON => b.pdf(wo, wi),
            _ => self.scattering(wo, wi).pdf,
        }
    }

    /// [`Bxdf::eval`] and [`Bxdf::pdf`] in one: the price of one of them.
    #[inline]
    pub fn eval_and_pdf(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        let Scattering { f, pdf } = self.scattering(wo, wi);
        BsdfValue { f, pdf }
    }

    /// Samples a direction from `wo`. `u_lobe` in `[0, 1)` chooses the lobe, `u` in the unit square the direction, and
    /// lane `hero` decides where they depend on the wavelength. `None` where `wo` lies in the surface or the chosen
    /// lobe has no such direction; the light of those samples is lost, as the density accounts for.
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, hero: usize) -> Option<BsdfSample> {
        if wo.z.abs() < HORIZON {
            return None;
        }
        let sample = match self {
            Self::Diffuse(b) => b.sample(wo, u),
            Self::DiffuseTransmission(b) => b.sample(wo, u_lobe, u),
            Self::Conductor(b) => b.sample(wo, u),
            Self::Dielectric(b) => b.sample(wo, u_lobe, u, hero),
            Self::ThinDielectric(b) => b.sample(wo, u_lobe),
            Self::CoatedDiffuse(b) => b.sample(wo, u_lobe, u),
            Self::Layered(b) => b.sample(wo, u_lobe, u),
        }?;
        (sample.wi.z.abs() >= HORIZON).then_some(sample)
    }
}
