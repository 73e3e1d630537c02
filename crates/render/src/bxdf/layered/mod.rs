//! A coat over a slab over a base, by random walks.

mod guide;
mod walk;

use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::{N, SampledSpectrum};

use super::coat_table::attenuation;
use super::coated_diffuse::geometric_series;
use super::conductor::Conductor;
use super::dielectric::Dielectric;
use super::diffuse::Diffuse;
use super::interface::Interface;
use super::local::{reflect_local, refract_local};
use super::microfacet::TrowbridgeReitz;
use super::record::{BsdfSample, Lobe, Scattering};
use guide::{Choice, Guide};
use walk::{Walk, WalkRng};

/// What lies between a coat and its base: pbrt's parameters of layered materials.
#[derive(Copy, Clone, Debug)]
pub struct Slab {
    /// Optical thickness: the extinction is 1 per unit of it.
    pub thickness: f32,
    /// Single-scattering albedo of the medium, per lane. Where it is zero in all lanes crossings are only attenuated.
    pub albedo: SampledSpectrum,
    /// Mean cosine of the medium's scattering.
    pub g: f32,
    /// Crossings and scatterings after which a walk ends.
    pub max_depth: u32,
    /// Walks for each evaluation.
    pub samples: u32,
}

/// The opaque surface under a coat.
#[derive(Copy, Clone, Debug)]
pub enum LayeredBase {
    /// Lambertian.
    Diffuse(Diffuse),
    /// Metal, whose index is relative to the coat's.
    Conductor(Conductor),
}

impl LayeredBase {
    #[inline]
    fn is_smooth(&self) -> bool {
        match self {
            Self::Diffuse(_) => false,
            Self::Conductor(b) => b.is_smooth(),
        }
    }

    #[inline]
    fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        match self {
            Self::Diffuse(b) => b.scattering(wo, wi),
            Self::Conductor(b) => b.scattering(wo, wi),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        match self {
            Self::Diffuse(b) => b.sample(wo, u),
            Self::Conductor(b) => b.sample(wo, u),
        }
    }

    /// Albedo per lane at about the direction `wo`.
    #[inline]
    fn albedo(&self, wo: Vec3) -> SampledSpectrum {
        match self {
            Self::Diffuse(b) => b.reflectance(),
            Self::Conductor(b) => b.fresnel(wo.z.abs()),
        }
    }
}

/// An opaque base under a dielectric coat, with a slab between them that attenuates or scatters: pbrt-v4's
/// `LayeredBxDF` (Guo, Hašan and Zhao 2018), both sides coated.
///
/// Evaluation estimates the BSDF by walks between the boundaries that connect to `wi` through the
/// coat at each bounce. Their random numbers are a hash of both directions and a seed, so it is a function, whose
/// mean over seeds is the BSDF. Deltas (reflection by a smooth coat; with a smooth base, the reflections below it
/// too, which share its direction) are summed in closed form.
///
/// Directions are sampled from a mixture with a density of its own in closed form, not from the walk: the coat, the base, a cosine.
#[derive(Copy, Clone, Debug)]
pub struct Layered {
    eta: SampledSpectrum,
    distribution: TrowbridgeReitz,
    coat: Dielectric,
    slab: Slab,
    base: LayeredBase,
    seed: u64,
}

impl Layered {
    /// A coat of index `eta` per lane (over that of the surroundings) and microfacets `distribution` over `slab` over
    /// `base`. `seed` should differ between samples of a picture.
    #[inline]
    pub fn new(
        eta: SampledSpectrum,
        distribution: TrowbridgeReitz,
        slab: Slab,
        base: LayeredBase,
        seed: u64,
    ) -> Self {
        Self { eta, distribution, coat: Dielectric::new(eta, distribution), slab, base, seed }
    }

    #[inline]
    fn has_medium(&self) -> bool {
        !self.slab.albedo.is_black()
    }

    /// Whether all light leaves in deltas.
    #[inline]
    fn is_delta(&self) -> bool {
        self.coat.lobes().is_specular() && self.base.is_smooth() && !self.has_medium()
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        let coat = self.coat.lobes();
        let mut lobes = Lobe::REFLECTION;
        if coat.is_specular() && (coat.is_reflective() || self.base.is_smooth()) {
            lobes |= Lobe::SPECULAR;
        }
        if matches!(self.base, LayeredBase::Diffuse(_)) || self.has_medium() {
            lobes |= Lobe::DIFFUSE;
        } else if !self.is_delta() {
            lobes |= Lobe::GLOSSY;
        }
        lobes
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        if wi.z <= 0.0 || self.is_delta() {
            return Scattering::ZERO;
        }
        let pdf = Guide::new(self, wo).pdf(self, wo, wi);
        Scattering { f: self.estimate(wo, wi), pdf: SampledSpectrum::splat(pdf) }
    }

    #[inline]
    pub(crate) fn pdf(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        if wi.z <= 0.0 || self.is_delta() {
            return SampledSpectrum::ZERO;
        }
        SampledSpectrum::splat(Guide::new(self, wo).pdf(self, wo, wi))
    }

    /// The coat's reflection, and the mean of `slab.samples` walks; both directions above.
    fn estimate(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        let coat = self.coat.reflection(wo, wi);
        let samples = self.slab.samples.max(1);
        let mut below = SampledSpectrum::ZERO;
        if self.coat.is_dispersive() {
            // Directions inside differ, so each lane walks alone.
            for lane in 0..N {
                let mut rng = WalkRng::new(wo, wi, self.seed);
                let walk = Walk { layered: self, interface: self.interface(lane), wo, wi };
                let sum: f32 = (0..samples).map(|_| walk.run(&mut rng).lane(lane)).sum();
                below.set_lane(lane, sum);
            }
        } else {
            let mut rng = WalkRng::new(wo, wi, self.seed);
            let walk = Walk { layered: self, interface: self.interface(0), wo, wi };
            for _ in 0..samples {
                below += walk.run(&mut rng);
            }
        }
        // Radiance, unlike the walk's particles, scales on its way into the coat.
        coat.fresnel * coat.unit + below / (samples as f32 * self.eta * self.eta)
    }

    #[inline]
    fn interface(&self, lane: usize) -> Interface {
        Interface::new(self.eta.lane(lane), self.distribution)
    }

    /// Weight, over the cosine, of the delta at the mirror direction of `wo` above, per lane. Zero under a rough coat.
    fn delta(&self, wo: Vec3) -> SampledSpectrum {
        if !self.coat.lobes().is_specular() {
            return SampledSpectrum::ZERO;
        }
        let reflected = self.coat.fresnel(wo, wo.z);
        if !self.base.is_smooth() {
            return reflected;
        }
        // F + (1 - F)² Σ Bⁿ⁺¹ Fⁿ A²⁽ⁿ⁺¹⁾ with the base's reflectance B; a walk leaves at every second crossing.
        let below = SampledSpectrum::from_fn(|lane| {
            let Some(inside) = refract_local(wo, self.eta.lane(lane)) else { return 0.0 };
            let attenuation = attenuation(self.slab.thickness, inside);
            self.base.albedo(inside).lane(lane) * attenuation * attenuation
        });
        let sum = below * geometric_series(below * reflected, self.slab.max_depth / 2);
        let passed = 1.0 - reflected;
        reflected + passed * passed * sum
    }

    /// Probability of the delta of a smooth coat.
    pub(crate) fn delta_probability(&self, wo: Vec3) -> f32 {
        Guide::new(self, wo * 1f32.copysign(wo.z)).delta_probability()
    }

    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let sign = 1f32.copysign(wo.z);
        let wo = wo * sign;
        let guide = Guide::new(self, wo);
        let wi = match guide.choose(u_lobe) {
            Choice::Delta => {
                let f = guide.delta / wo.z;
                let pdf = SampledSpectrum::splat(guide.coat);
                let lobe = Lobe::REFLECTION | Lobe::SPECULAR;
                let wi = reflect_local(wo) * sign;
                return (guide.coat > 0.0).then_some(BsdfSample {
                    f,
                    wi,
                    pdf,
                    lobe,
                    eta: 1.0,
                    dispersive: false,
                });
            }
            Choice::Coat => super::local::reflect(wo, self.distribution.sample_visible(wo, u)),
            Choice::Base => guide.sample_base(u)?,
            Choice::Cosine => super::diffuse::cosine_direction(1.0, u)?,
        };
        if wi.z <= 0.0 {
            return None;
        }
        let pdf = guide.pdf(self, wo, wi);
        let lobe = Lobe::REFLECTION
            | if self.lobes().contains(Lobe::DIFFUSE) { Lobe::DIFFUSE } else { Lobe::GLOSSY };
        (pdf > 0.0).then(|| BsdfSample {
            f: self.estimate(wo, wi),
            wi: wi * sign,
            pdf: SampledSpectrum::splat(pdf),
            lobe,
            eta: 1.0,
            dispersive: false,
        })
    }
}
