//! The wavelengths a path carries, and the density they were drawn with.

use crate::{LAMBDA_MAX, LAMBDA_MIN, N};
use tenfold_math::ops;

/// Centre of the visible-importance density, nm.
const CENTRE: f32 = 538.0;
/// Its inverse width, nm⁻¹.
const STEEPNESS: f32 = 0.0072;
/// `tanh(STEEPNESS · (CENTRE − LAMBDA_MIN))`.
const TANH_LOW: f32 = 0.856_910_62;
/// `TANH_LOW + tanh(STEEPNESS · (LAMBDA_MAX − CENTRE))`: the integral of the density times `STEEPNESS`.
const TANH_SPAN: f32 = 1.827_501_97;
/// The density at the centre, nm⁻¹.
const DENSITY: f32 = STEEPNESS / TANH_SPAN;

/// [`N`] wavelengths and their densities. Lane 0 is the hero: the one that is kept when dispersion separates the
/// wavelengths of a path.
#[derive(Copy, Clone, PartialEq, Debug)]
pub struct SampledWavelengths {
    /// Wavelengths in nm.
    pub lambda: [f32; N],
    /// Density of each wavelength, per nm; 0 for a lane that no longer carries light.
    pub pdf: [f32; N],
}

impl SampledWavelengths {
    /// Draws wavelengths with a density close to the visible response, from one number `u` in `[0, 1)`: the lanes use
    /// `u` rotated by `i / N`, so they stratify the spectrum. Density ∝ sech²(0.0072 (λ − 538)) on
    /// `[LAMBDA_MIN, LAMBDA_MAX]` (pbrt 4th ed., section 4.5.4; Radziszewski et al. 2009).
    #[inline]
    pub fn sample_visible(u: f32) -> Self {
        // The hyperbolic tangent of the scaled distance from the centre, which is uniformly distributed.
        let tanh: [f32; N] = std::array::from_fn(|i| TANH_LOW - TANH_SPAN * rotate(u, i));
        Self { lambda: tanh.map(visible_from_tanh), pdf: tanh.map(|t| DENSITY * (1.0 - t * t)) }
    }

    /// Draws wavelengths uniformly on `[LAMBDA_MIN, LAMBDA_MAX]` from one number `u` in `[0, 1)`, the lanes at equal distances.
    #[inline]
    pub fn sample_uniform(u: f32) -> Self {
        let span = LAMBDA_MAX - LAMBDA_MIN;
        Self { lambda: std::array::from_fn(|i| LAMBDA_MIN + span * rotate(u, i)), pdf: [1.0 / span; N] }
    }

    /// All lanes at one wavelength `lambda` (nm), with density 1 nm⁻¹: what is measured is then the light of one nanometre
    /// around `lambda`.
    #[inline]
    pub fn fixed(lambda: f32) -> Self {
        Self { lambda: [lambda; N], pdf: [1.0; N] }
    }

    /// All lanes at one wavelength `lambda` (nm), with the density of [`Self::sample_visible`], for freezing the wavelength: the
    /// mean over wavelengths so drawn of what is measured is what is measured of all light. Beyond
    /// `[LAMBDA_MIN, LAMBDA_MAX]` it is black.
    #[inline]
    pub fn held(lambda: f32) -> Self {
        Self { lambda: [lambda; N], pdf: [Self::visible_pdf(lambda); N] }
    }

    /// The wavelength in nm on whose two sides [`Self::sample_visible`] draws equally many.
    pub fn visible_median() -> f32 {
        Self::sample_visible(0.5).lambda[0]
    }

    /// Density, per nm, with which [`Self::sample_visible`] draws a wavelength; 0 outside the rendered range.
    #[inline]
    pub fn visible_pdf(lambda: f32) -> f32 {
        if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
            return 0.0;
        }
        let c = ops::cosh(STEEPNESS * (lambda - CENTRE));
        DENSITY / (c * c)
    }

    /// Gives up all lanes but the hero, which then stands for all of them: its density becomes that of one
    /// wavelength out of [`N`] equally likely ones. Does nothing when called again. For dispersion
    /// (pbrt 4th ed., section 4.5.4).
    #[inline]
    pub fn terminate_secondary(&mut self) {
        if self.secondary_terminated() {
            return;
        }
        let hero = self.pdf[0] / N as f32;
        self.pdf = [0.0; N];
        self.pdf[0] = hero;
    }

    /// Whether only the hero carries light.
    #[inline]
    pub fn secondary_terminated(&self) -> bool {
        self.pdf[1..].iter().all(|&p| p == 0.0)
    }
}

/// `u + i / N`, wrapped into `[0, 1)`.
#[inline]
fn rotate(u: f32, i: usize) -> f32 {
    let v = u + i as f32 / N as f32;
    if v >= 1.0 { v - 1.0 } else { v }
}

/// Wavelength with tanh(STEEPNESS (CENTRE − λ)) = `t`: artanh t is ½ ln((1 + t) / (1 − t)).
#[inline]
fn visible_from_tanh(t: f32) -> f32 {
    // The clamp takes off the rounding at both ends, where the density would answer 0.
    (CENTRE - (0.5 / STEEPNESS) * ops::ln((1.0 + t) / (1.0 - t))).clamp(LAMBDA_MIN, LAMBDA_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::chi2::{Options, interval_test};
    use tenfold_testkit::quadrature;

    #[test]
    fn densities_integrate_to_one() {
        let pdf = |l: f64| f64::from(SampledWavelengths::visible_pdf(l as f32));
        let sum = quadrature::integrate(f64::from(LAMBDA_MIN), f64::from(LAMBDA_MAX), pdf);
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        assert_eq!(SampledWavelengths::visible_pdf(359.9), 0.0);
        assert_eq!(SampledWavelengths::visible_pdf(830.1), 0.0);
    }

    #[test]
    fn samples_carry_their_density_and_stay_in_range() {
        for i in 0..=1000 {
            let u = (i as f32 / 1000.0).min(1.0 - f32::EPSILON / 2.0);
            for w in [SampledWavelengths::sample_visible(u), SampledWavelengths::sample_uniform(u)] {
                for lane in 0..N {
                    assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&w.lambda[lane]));
                    assert!(w.pdf[lane] > 0.0);
                }
            }
            let w = SampledWavelengths::sample_visible(u);
            for (pdf, lambda) in w.pdf.into_iter().zip(w.lambda) {
                let want = SampledWavelengths::visible_pdf(lambda);
                assert!((pdf - want).abs() < 1e-5 * want, "{lambda}: {pdf} {want}");
            }
        }
    }

    #[test]
    fn samples_follow_their_density() {
        let visible = |l: f32| f64::from(SampledWavelengths::visible_pdf(l));
        let uniform = |_: f32| 1.0 / f64::from(LAMBDA_MAX - LAMBDA_MIN);
        let options = Options { theta_bins: 47, phi_bins: 2, tests: 2 * N, ..Options::default() };
        for lane in 0..N {
            let draw = |u| Some(SampledWavelengths::sample_visible(u).lambda[lane]);
            interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, visible, &options).check("visible");
            assert!(!interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, uniform, &options).passed);
            let draw = |u| Some(SampledWavelengths::sample_uniform(u).lambda[lane]);
            interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, uniform, &options).check("uniform");
        }
    }

    #[test]
    fn lanes_are_rotations() {
        let w = SampledWavelengths::sample_uniform(0.9);
        let want = [783.0, 430.5, 548.0, 665.5];
        for (got, want) in w.lambda.iter().zip(want) {
            assert!((got - want).abs() < 1e-3, "{:?}", w.lambda);
        }
        assert_eq!(SampledWavelengths::fixed(550.0).lambda, [550.0; N]);
    }

    #[test]
    fn the_hero_takes_over_once() {
        let mut w = SampledWavelengths::sample_visible(0.2);
        let before = w;
        w.terminate_secondary();
        assert!(w.secondary_terminated() && !before.secondary_terminated());
        assert_eq!(w.pdf, [before.pdf[0] / 4.0, 0.0, 0.0, 0.0]);
        let once = w;
        w.terminate_secondary();
        assert_eq!(w, once);
    }
}
