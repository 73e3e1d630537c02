use std::f32::consts::{FRAC_1_PI, PI};
use tenfold_math::ops;

use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::coat_table::{CoatFluxes, CoatTable};
use super::dielectric::Dielectric;
use super::diffuse::cosine_direction;
use super::local::reflect_local;
use super::microfacet::TrowbridgeReitz;
use super::record::{BsdfSample, Lobe, Scattering};

/// A Lambertian base of albedo `R` under a clear coat, smooth or rough, in closed form: pbrt-v4's `coateddiffuse`
/// without a medium, and without its random walk.
///
/// Write `t` for the coat's transmission of particles, `r` for its reflection from below, and `A` for the attenuation
/// of the slab. A walk from `wo` to `wi` that meets the base `n + 1` times has the value
///
/// `∫…∫ t(wo, ω₀) A · R/π · A r A · R/π · … · R/π · A t(wi, ωₙ)`
///
/// with a cosine for each inner direction. As `R/π` does not depend on directions the integrals part: the two
/// ends are the fluxes τ(wo) and τ(wi) of [`CoatTable`], and each of the `n` stretches between is `R·K`. With the
/// `1/η²` of radiance that enters the denser medium,
///
/// `f = r(wo, wi) + τ(wo) τ(wi) R / (π η²) · Σₙ (R K)ⁿ`.
///
/// pbrt's walk stops after `maxdepth` crossings of the slab. It meets the base at crossings 0, 2, 4, … (the others
/// end at the coat) and connects to the light from there, so `n` runs from 0 to `⌈maxdepth / 2⌉ - 1`. Both sides of the
/// surface are coated.
/// (Where the coat is rough, pbrt's own estimate is somewhat brighter than the mean of its walk: see the deviation
/// noted in `layered/walk.rs`.)
///
/// Directions are sampled from the coat's reflection or from the cosine, chosen by the albedos of the two
/// averaged over the lanes. So no density depends on the lane.
#[derive(Copy, Clone, Debug)]
pub struct CoatedDiffuse<'a> {
    table: &'a CoatTable,
    eta: SampledSpectrum,
    distribution: TrowbridgeReitz,
    coat: Dielectric,
    /// `R / (π η²) · Σₙ (R K)ⁿ`.
    base: SampledSpectrum,
    /// Albedo of what is not reflected at once, over τ(wo).
    base_albedo: SampledSpectrum,
}

impl<'a> CoatedDiffuse<'a> {
    /// A base of albedo `reflectance` under the coat with index `eta` per lane and microfacets `distribution`,
    /// which must lie within what `table` was made for; `max_depth` is pbrt's `maxdepth`.
    #[inline]
    pub fn new(
        table: &'a CoatTable,
        eta: SampledSpectrum,
        distribution: TrowbridgeReitz,
        reflectance: SampledSpectrum,
        max_depth: u32,
    ) -> Self {
        let totals = table.totals(eta, &distribution);
        let series = geometric_series(reflectance * totals.inner, max_depth.div_ceil(2));
        let base = reflectance * series / (PI * eta * eta);
        let coat = Dielectric::new(eta, distribution);
        let base_albedo = base * PI * totals.mean_transmitted;
        Self { table, eta, distribution, coat, base, base_albedo }
    }

    #[inline]
    pub(crate) fn lobes(&self) -> Lobe {
        let coat = self.coat.lobes();
        let mut lobes = Lobe::REFLECTION;
        if coat.is_reflective() {
            lobes |= if coat.is_specular() { Lobe::SPECULAR } else { Lobe::GLOSSY };
        }
        if !self.base.is_black() {
            lobes |= Lobe::DIFFUSE;
        }
        lobes
    }

    /// Probability of sampling the coat's reflection.
    #[inline]
    fn coat_probability(&self, fluxes: &CoatFluxes) -> f32 {
        let coat = fluxes.reflected.average();
        let base = (fluxes.transmitted * self.base_albedo).average();
        if coat > 0.0 { coat / (coat + base) } else { 0.0 }
    }

    /// Probability of the delta of a smooth coat.
    pub(crate) fn delta_probability(&self, wo: Vec3) -> f32 {
        if !self.coat.lobes().is_specular() {
            return 0.0;
        }
        let wo = wo * 1f32.copysign(wo.z);
        self.coat_probability(&self.table.fluxes(self.eta, &self.distribution, wo))
    }

    #[inline]
    pub(crate) fn scattering(&self, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        if wi.z <= 0.0 {
            return Scattering::ZERO;
        }
        let out = self.table.fluxes(self.eta, &self.distribution, wo);
        self.scattering_with(&out, wo, wi)
    }

    /// [`CoatedDiffuse::scattering`] above the surface, given the fluxes of `wo`.
    #[inline]
    fn scattering_with(&self, out: &CoatFluxes, wo: Vec3, wi: Vec3) -> Scattering<SampledSpectrum> {
        let into = self.table.fluxes(self.eta, &self.distribution, wi);
        let coat = self.coat.reflection(wo, wi);
        let probability = self.coat_probability(out);
        let pdf = probability * coat.visible_pdf + (1.0 - probability) * FRAC_1_PI * wi.z;
        Scattering {
            f: coat.fresnel * coat.unit + out.transmitted * into.transmitted * self.base,
            pdf: SampledSpectrum::splat(pdf),
        }
    }

    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let sign = 1f32.copysign(wo.z);
        let wo = wo * sign;
        let fluxes = self.table.fluxes(self.eta, &self.distribution, wo);
        let probability = self.coat_probability(&fluxes);
        let from_coat = u_lobe < probability;
        if from_coat && self.coat.lobes().is_specular() {
            return Some(BsdfSample {
                f: fluxes.reflected / wo.z,
                wi: reflect_local(wo) * sign,
                pdf: SampledSpectrum::splat(probability),
                lobe: Lobe::REFLECTION | Lobe::SPECULAR,
                eta: 1.0,
                dispersive: false,
            });
        }
        let wi = if from_coat {
            super::local::reflect(wo, self.distribution.sample_visible(wo, u))
        } else {
            cosine_direction(1.0, u)?
        };
        if wi.z <= 0.0 {
            return None;
        }
        let Scattering { f, pdf } = self.scattering_with(&fluxes, wo, wi);
        let kind = if from_coat { Lobe::GLOSSY } else { Lobe::DIFFUSE };
        (pdf.lane(0) > 0.0).then_some(BsdfSample {
            f,
            wi: wi * sign,
            pdf,
            lobe: Lobe::REFLECTION | kind,
            eta: 1.0,
            dispersive: false,
        })
    }
}

/// `Σ xⁿ` for `n` from 0 to `terms - 1`, per lane.
#[inline]
pub(crate) fn geometric_series(x: SampledSpectrum, terms: u32) -> SampledSpectrum {
    if terms <= 32 {
        let mut sum = SampledSpectrum::ZERO;
        for _ in 0..terms {
            sum = 1.0 + x * sum;
        }
        sum
    } else {
        let n = terms as f32;
        SampledSpectrum::from_fn(|i| {
            let x = x.lane(i);
            if x > 1.0 - 1e-6 { n } else { (1.0 - ops::powf(x, n)) / (1.0 - x) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_sums_its_terms() {
        let x = SampledSpectrum::new([0.0, 0.3, 0.6, 0.99]);
        for terms in [0, 1, 5, 32, 33, 500] {
            let got = geometric_series(x, terms);
            for i in 0..4 {
                let want: f64 = (0..terms).map(|n| f64::from(x[i]).powi(n as i32)).sum();
                assert!((f64::from(got[i]) - want).abs() <= 1e-4 * want, "{terms} {}: {got:?} {want}", x[i]);
            }
        }
    }
}
