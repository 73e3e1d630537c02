//! What paths carry, by itself and side by side.

use super::{CombineStrategy, spectral::Lanes};
use crate::light::LightSamples;
use tenfold_math::{Floats, WIDTH, vectorized};
use tenfold_spectrum::{N, SampledSpectrum, Spectra};

/// What a path carries.
///
/// The path so far has been drawn with the density of its hero. By spectral multiple importance sampling (Wilkie et al.
/// 2014) it stands for all its lanes: `ratio` holds, per lane, the density with which that lane as hero
/// would have drawn it over the density with which the true hero has, so that the balance heuristic divides
/// `beta` by the mean of `ratio`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Weights {
    /// Product of f·|cos| over the hero's densities.
    pub(super) beta: SampledSpectrum,
    /// Per lane: density of the path over the hero's.
    pub(super) ratio: SampledSpectrum,
    /// Per lane, `ratio` with the density of the last direction left out: times a light's density it is that of the other strategy, where a
    /// light has been sampled at the last vertex.
    pub(super) light_ratio: SampledSpectrum,
    /// Product of the squared relative indices of refraction: what radiance lost by entering dense media and
    /// will win back on leaving (Walter et al. 2007).
    pub(super) eta_scale: f32,
}

impl Weights {
    /// At the camera.
    pub(super) const ONE: Self = Self {
        beta: SampledSpectrum::ONE,
        ratio: SampledSpectrum::ONE,
        light_ratio: SampledSpectrum::ZERO,
        eta_scale: 1.0,
    };

    /// Settles the spectral weights of a path that carries `lanes`, so that from here they may part.
    #[inline]
    pub(super) fn settle(&mut self, lanes: &Lanes) {
        self.beta /= lanes.mean(self.ratio);
        self.ratio = lanes.mask();
    }

    /// The part of a settled path that goes on with other `lanes`.
    #[inline]
    pub(super) fn with_lanes(&self, lanes: &Lanes) -> Self {
        Self { beta: self.beta * lanes.mask(), ratio: lanes.mask(), ..*self }
    }

    /// What a path with these `lanes` carries at most.
    #[inline]
    pub(super) fn carried(&self, lanes: &Lanes) -> f32 {
        self.beta.max_component() * self.eta_scale / lanes.mean(self.ratio)
    }

    /// Weighs in a scattered direction with the value `f`, the absolute cosine `cos` and the densities `pdf` per lane.
    #[inline]
    pub(super) fn advance(&mut self, f: SampledSpectrum, pdf: SampledSpectrum, hero_pdf: f32, cos: f32) {
        let (beta, ratio) = (self.beta.to_array(), self.ratio.to_array());
        let advanced = advanced(beta, ratio, f.to_array(), pdf.to_array(), hero_pdf, cos);
        [self.beta, self.ratio, self.light_ratio] = advanced.map(SampledSpectrum::new);
    }
}

/// The next `beta`, `ratio` and `light_ratio`.
#[inline(always)]
fn advanced(
    beta: [f32; N],
    ratio: [f32; N],
    f: [f32; N],
    pdf: [f32; N],
    hero_pdf: f32,
    cos: f32,
) -> [[f32; N]; 3] {
    let scale = cos / hero_pdf;
    let next = |i: usize| (beta[i] * f[i] * scale, ratio[i] * pdf[i] / hero_pdf, ratio[i] / hero_pdf);
    let next = [next(0), next(1), next(2), next(3)];
    [next.map(|n| n.0), next.map(|n| n.1), next.map(|n| n.2)]
}

/// [`Weights`] in each slot.
#[derive(Debug, Default)]
pub(super) struct WaveWeights {
    beta: Spectra,
    ratio: Spectra,
    light_ratio: Spectra,
    pub(super) eta_scale: Floats,
    /// How many lanes are carried.
    count: Floats,
}

impl WaveWeights {
    /// The weights in a slot.
    #[inline]
    pub(super) fn get(&self, slot: usize) -> Weights {
        Weights {
            beta: self.beta.get(slot),
            ratio: self.ratio.get(slot),
            light_ratio: self.light_ratio.get(slot),
            eta_scale: self.eta_scale[slot],
        }
    }

    /// Sets the weights in a slot, of a path that carries `lanes`.
    #[inline]
    pub(super) fn set(&mut self, slot: usize, weights: &Weights, lanes: &Lanes) {
        self.beta.set(slot, weights.beta);
        self.ratio.set(slot, weights.ratio);
        self.light_ratio.set(slot, weights.light_ratio);
        self.eta_scale[slot] = weights.eta_scale;
        self.count[slot] = lanes.count() as f32;
    }

    /// Strengthens a path that went on with a chance of `survival`.
    #[inline]
    pub(super) fn strengthen(&mut self, slot: usize, survival: f32) {
        self.beta.set(slot, self.beta.get(slot) / survival);
    }
}

/// Scattering in each slot: values, densities and cosines.
#[derive(Debug, Default)]
pub(super) struct Scattering {
    /// The BSDF in sr⁻¹, without the cosine.
    pub(super) f: Spectra,
    /// Densities per lane, in solid angle.
    pub(super) pdf: Spectra,
    /// The hero's density: 0 where nothing is scattered.
    pub(super) hero_pdf: Floats,
    /// |cos| to the shading normal.
    pub(super) cos: Floats,
}

impl Scattering {
    /// Sets value and density, the same in all lanes, of a slot if it is one of those looked at; for loops over slots.
    #[inline(always)]
    pub(super) fn set_if(&mut self, is_here: bool, slot: usize, f: [f32; N], pdf: f32, cos: f32) {
        let of = |new: f32, old: f32| if is_here { new } else { old };
        let (old_f, old_pdf) = (self.f.array(slot), self.pdf.array(slot));
        let f = [of(f[0], old_f[0]), of(f[1], old_f[1]), of(f[2], old_f[2]), of(f[3], old_f[3])];
        self.f.set_array(slot, f);
        self.pdf.set_array(slot, old_pdf.map(|old| of(pdf, old)));
        self.hero_pdf[slot] = of(pdf, self.hero_pdf[slot]);
        self.cos[slot] = of(cos, self.cos[slot]);
    }

    #[inline]
    pub(super) fn set(
        &mut self,
        slot: usize,
        f: SampledSpectrum,
        pdf: SampledSpectrum,
        hero: usize,
        cos: f32,
    ) {
        self.f.set(slot, f);
        self.pdf.set(slot, pdf);
        self.hero_pdf[slot] = pdf.lane(hero);
        self.cos[slot] = cos;
    }
}

#[inline(always)]
fn sum([a, b, c, d]: [f32; N]) -> f32 {
    (a + b) + (c + d)
}

#[inline(always)]
fn times(a: [f32; N], b: [f32; N]) -> [f32; N] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

/// The quotient; 0 where the divisor is 0.
#[inline(always)]
fn safe_div(a: f32, b: f32) -> f32 {
    if b == 0.0 { 0.0 } else { a / b }
}

vectorized! {
    /// What paths carry back of sampled `light` that is scattered toward them, weighed against scattered directions that meet it by themselves. Where
    /// lanes part (`parts`) each weighs its own densities, otherwise all weigh those of all.
    pub(super) fn weigh_sampled(
        combine: CombineStrategy,
        weights: &WaveWeights,
        scattering: &Scattering,
        light: &LightSamples,
        parts: &[bool; WIDTH],
        out: &mut Spectra,
    ) {
        let by_both = combine == CombineStrategy::Mis;
        let by_scattering = combine == CombineStrategy::BsdfOnly;
        for i in 0..WIDTH {
            let (beta, ratio, count) = (weights.beta.array(i), weights.ratio.array(i), weights.count[i]);
            let (f, scatter_pdf) = (scattering.f.array(i), scattering.pdf.array(i));
            let (radiance, cos) = (light.radiance.array(i), scattering.cos[i]);
            let (delta, parts) = (light.delta[i], parts[i]);
            let carried = times(times(beta, f), radiance);
            let sampled = ratio.map(|ratio| ratio * light.pdf[i]);
            let scattered = times(ratio, scatter_pdf);
            let (all_sampled, all_scattered) = (sum(sampled) / count, sum(scattered) / count);
            let weighed = |lane: usize| {
                let sampled = if parts { sampled[lane] } else { all_sampled };
                let scattered = if parts { scattered[lane] } else { all_scattered };
                let both = sampled + scattered * safe_div(scattered, sampled);
                let density = if by_both & !delta { both } else { sampled };
                let light = safe_div(carried[lane] * cos, density);
                if by_scattering & !delta { 0.0 } else { light }
            };
            out.set_array(i, [weighed(0), weighed(1), weighed(2), weighed(3)]);
        }
    }
}

vectorized! {
    /// Weighs scattered directions in; `carried` is what paths carry then, at most.
    pub(super) fn advance(
        weights: &mut WaveWeights,
        scattering: &Scattering,
        carried: &mut Floats,
    ) {
        for i in 0..WIDTH {
            let (f, pdf) = (scattering.f.array(i), scattering.pdf.array(i));
            let (hero_pdf, cos) = (scattering.hero_pdf[i], scattering.cos[i]);
            let [beta, ratio, light_ratio] =
                advanced(weights.beta.array(i), weights.ratio.array(i), f, pdf, hero_pdf, cos);
            let most = |a: f32, b: f32| if a > b { a } else { b };
            let greatest = most(most(beta[0], beta[1]), most(beta[2], beta[3]));
            carried[i] = greatest * weights.eta_scale[i] / (sum(ratio) / weights.count[i]);
            weights.beta.set_array(i, beta);
            weights.ratio.set_array(i, ratio);
            weights.light_ratio.set_array(i, light_ratio);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::Rng;

    fn spectrum(rng: &mut Rng) -> SampledSpectrum {
        // Black now and then.
        SampledSpectrum::from_fn(|_| if rng.below(8) == 0 { 0.0 } else { rng.f32() })
    }

    /// Paths of all, some and single lanes, and what they scatter.
    fn paths(rng: &mut Rng) -> ([(Weights, Lanes); WIDTH], WaveWeights, Scattering) {
        let (mut wave, mut scattering) = (WaveWeights::default(), Scattering::default());
        let paths = std::array::from_fn(|slot| {
            let lanes = [Lanes::ALL, Lanes::subset(0b0110, 0.7), Lanes::one(3)][slot % 3];
            let mask = lanes.mask();
            let weights = Weights {
                beta: spectrum(rng) * mask,
                ratio: (spectrum(rng) + SampledSpectrum::splat(0.1)) * mask,
                light_ratio: SampledSpectrum::ZERO,
                eta_scale: 0.5 + rng.f32(),
            };
            wave.set(slot, &weights, &lanes);
            let pdf = spectrum(rng) + SampledSpectrum::splat(0.05);
            scattering.set(slot, spectrum(rng), pdf, lanes.hero(), rng.f32());
            (weights, lanes)
        });
        (paths, wave, scattering)
    }

    #[test]
    fn slots_advance_as_paths_do_by_themselves() {
        let mut rng = Rng::new(11);
        for _ in 0..200 {
            let (paths, mut wave, scattering) = paths(&mut rng);
            let mut carried = [0.0; WIDTH];
            advance(&mut wave, &scattering, &mut carried);
            for (slot, (mut alone, lanes)) in paths.into_iter().enumerate() {
                let (f, pdf) = (scattering.f.get(slot), scattering.pdf.get(slot));
                alone.advance(f, pdf, pdf.lane(lanes.hero()), scattering.cos[slot]);
                let found = wave.get(slot);
                assert_eq!((found.beta, found.ratio), (alone.beta, alone.ratio));
                assert_eq!((found.light_ratio, found.eta_scale), (alone.light_ratio, alone.eta_scale));
                assert_eq!(carried[slot], alone.carried(&lanes));
            }
        }
    }

    /// Sampled light has the weight of the power heuristic against scattered directions, all of it alone, and none where the latter count alone;
    /// light that these do not find has all of it always.
    #[test]
    fn sampled_light_has_the_weight_of_its_strategy() {
        let mut rng = Rng::new(12);
        for _ in 0..200 {
            let (paths, wave, scattering) = paths(&mut rng);
            let mut light = LightSamples::default();
            (0..WIDTH).for_each(|slot| light.radiance.set(slot, spectrum(&mut rng)));
            light.pdf = std::array::from_fn(|_| 0.05 + rng.f32());
            light.delta = std::array::from_fn(|_| rng.below(4) == 0);
            let parts = std::array::from_fn(|_| rng.below(4) == 0);
            let weighed = |combine: CombineStrategy| {
                let mut out = Spectra::ZERO;
                weigh_sampled(combine, &wave, &scattering, &light, &parts, &mut out);
                out
            };
            let (both, sampled) = (weighed(CombineStrategy::Mis), weighed(CombineStrategy::LightOnly));
            let scattered = weighed(CombineStrategy::BsdfOnly);
            for (slot, (weights, lanes)) in paths.into_iter().enumerate() {
                if light.delta[slot] {
                    assert_eq!(both.get(slot), sampled.get(slot));
                    assert_eq!(scattered.get(slot), sampled.get(slot));
                    continue;
                }
                assert!(scattered.get(slot).is_black());
                let by_light = weights.ratio * light.pdf[slot];
                let by_scattering = weights.ratio * scattering.pdf.get(slot);
                let carried = weights.beta * scattering.f.get(slot) * light.radiance.get(slot);
                for lane in (0..N).filter(|&lane| lanes.carries(lane)) {
                    let of = |x: SampledSpectrum| if parts[slot] { x.lane(lane) } else { lanes.mean(x) };
                    let (a, b) = (of(by_light), of(by_scattering));
                    let alone = carried.lane(lane) * scattering.cos[slot] / a;
                    let near = |x: f32, y: f32| (x - y).abs() <= 1e-5 * y.abs();
                    assert!(near(sampled.get(slot).lane(lane), alone));
                    assert!(near(both.get(slot).lane(lane), alone * a * a / (a * a + b * b)));
                }
            }
        }
    }
}
