use std::f32::consts::FRAC_1_PI;

use tenfold_math::{ONE_MINUS_EPSILON, Vec2, Vec3};
use tenfold_sampling::warp;
use tenfold_spectrum::SampledSpectrum;

use super::local::same_hemisphere;
use super::record::{BsdfSample, Lobe};
use super::{BsdfValue, Bxdf, HORIZON};

/// How the direction of scattering is chosen.
///
/// All of them find all directions; what differs is the noise. Deltas are not a matter of choice: they keep the
/// probability that [`Bxdf::sample`] gives them, and the strategy spreads the rest over the hemispheres that the surface
/// scatters to, evenly over both where it reflects and transmits.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum ScatterStrategy {
    /// Uniformly in solid angle.
    Uniform,
    /// In proportion to the cosine to the shading normal.
    Cosine,
    /// By the scattering function.
    #[default]
    Bsdf,
}

impl ScatterStrategy {
    /// All of them, plain before refined.
    pub const ALL: [Self; 3] = [Self::Uniform, Self::Cosine, Self::Bsdf];

    /// The name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Cosine => "cosine",
            Self::Bsdf => "bsdf",
        }
    }
}

/// A density of directions that knows of a surface only to which sides it scatters: the same in all lanes.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Hemispheres {
    by_cosine: bool,
    /// Probability of the side of `wo`.
    reflect: f32,
    /// Probability that no delta is sampled instead.
    share: f32,
}

impl Hemispheres {
    /// What takes the place of the density of `bxdf` from `wo`; `None` where that density is to be kept, or is none.
    #[inline]
    pub(crate) fn new(strategy: ScatterStrategy, bxdf: &Bxdf<'_>, wo: Vec3) -> Option<Self> {
        match strategy {
            ScatterStrategy::Bsdf => None,
            ScatterStrategy::Uniform => Self::over(bxdf, wo, false),
            ScatterStrategy::Cosine => Self::over(bxdf, wo, true),
        }
    }

    #[cold]
    fn over(bxdf: &Bxdf<'_>, wo: Vec3, by_cosine: bool) -> Option<Self> {
        let lobes = bxdf.lobes();
        if !lobes.has_density() || wo.z.abs() < HORIZON {
            return None;
        }
        let reflect = match (lobes.is_reflective(), lobes.is_transmissive()) {
            (true, true) => 0.5,
            (_, transmits) => f32::from(u8::from(!transmits)),
        };
        Some(Self { by_cosine, reflect, share: 1.0 - bxdf.delta_probability(wo) })
    }

    /// Density of `wi` in solid angle.
    #[inline]
    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let side = if same_hemisphere(wo, wi) { self.reflect } else { 1.0 - self.reflect };
        let pdf = if self.by_cosine { FRAC_1_PI * wi.z.abs() } else { warp::uniform_hemisphere_pdf() };
        self.share * side * pdf
    }

    /// As [`Bxdf::eval_and_pdf`].
    #[cold]
    pub(crate) fn eval_and_pdf(&self, bxdf: &Bxdf<'_>, wo: Vec3, wi: Vec3) -> BsdfValue {
        if wi.z.abs() < HORIZON {
            return BsdfValue { f: SampledSpectrum::ZERO, pdf: SampledSpectrum::ZERO };
        }
        BsdfValue { f: bxdf.eval(wo, wi), pdf: SampledSpectrum::splat(self.pdf(wo, wi)) }
    }

    /// As [`Bxdf::sample`], whose deltas it leaves as they are.
    #[cold]
    pub(crate) fn sample(
        &self,
        bxdf: &Bxdf<'_>,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        hero: usize,
    ) -> Option<BsdfSample> {
        let delta = 1.0 - self.share;
        if u_lobe < delta {
            return bxdf.sample(wo, u_lobe, u, hero);
        }
        let u_side = ((u_lobe - delta) / self.share).min(ONE_MINUS_EPSILON);
        let reflected = u_side < self.reflect;
        let mut wi = if self.by_cosine {
            warp::sample_cosine_hemisphere(u)
        } else {
            warp::sample_uniform_hemisphere(u)
        };
        wi.z = wi.z.copysign(if reflected { wo.z } else { -wo.z });
        let BsdfValue { f, pdf } = self.eval_and_pdf(bxdf, wo, wi);
        let (side, eta) = if reflected {
            (Lobe::REFLECTION, 1.0)
        } else {
            (Lobe::TRANSMISSION, bxdf.transmitted_eta(wo, hero))
        };
        let kind = if bxdf.lobes().contains(Lobe::DIFFUSE) { Lobe::DIFFUSE } else { Lobe::GLOSSY };
        (pdf.lane(hero) > 0.0).then_some(BsdfSample { f, wi, pdf, lobe: side | kind, eta, dispersive: false })
    }
}
