//! The wavelengths a path carries, and the density they were drawn with.

use crate::{
    LAMBDA_MAX, LAMBDA_MIN, N,
    spectrum::{SAMPLES, dense_index},
};
use tenfold_math::{Vec4, ops};

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

/// [`N`] wavelengths and their densities.
#[derive(Copy, Clone, PartialEq, Debug)]
pub struct SampledWavelengths {
    lambda: [f32; N],
    pdf: [f32; N],
    /// Where tables with a value for every nanometre have those of these wavelengths; one past the end beyond the rendered range.
    nearest: [u16; N],
}

impl SampledWavelengths {
    /// The wavelengths `lambda` in nm, drawn with the densities `pdf` per nm.
    #[inline]
    pub fn new(lambda: [f32; N], pdf: [f32; N]) -> Self {
        Self { lambda, pdf, nearest: lambda.map(|l| dense_index(l).unwrap_or(SAMPLES) as u16) }
    }

    /// Wavelengths in nm.
    #[inline]
    pub fn lambda(&self) -> [f32; N] {
        self.lambda
    }

    /// Density of each wavelength, per nm.
    #[inline]
    pub fn pdf(&self) -> [f32; N] {
        self.pdf
    }

    /// Where a table of [`SAMPLES`] values, and one for all wavelengths beyond, has those of the lanes.
    #[inline]
    pub(crate) fn nearest(&self) -> [usize; N] {
        self.nearest.map(usize::from)
    }

    /// Draws wavelengths with a density close to the visible response, from one number `u` in `[0, 1)`: the lanes use
    /// `u` rotated by `i / N`, so they stratify the spectrum. Density ∝ sech²(0.0072 (λ − 538)) on
    /// `[LAMBDA_MIN, LAMBDA_MAX]` (pbrt 4th ed., section 4.5.4; Radziszewski et al. 2009).
    #[inline]
    pub fn sample_visible(u: f32) -> Self {
        // The hyperbolic tangent of the scaled distance from the centre, which is uniformly distributed.
        let tanh = TANH_LOW - TANH_SPAN * rotations(u);
        Self::new(visible_from_tanh(tanh).to_array(), (DENSITY * (1.0 - tanh * tanh)).to_array())
    }

    /// Draws wavelengths uniformly on `[LAMBDA_MIN, LAMBDA_MAX]` from one number `u` in `[0, 1)`, the lanes at equal distances.
    #[inline]
    pub fn sample_uniform(u: f32) -> Self {
        let span = LAMBDA_MAX - LAMBDA_MIN;
        Self::new((LAMBDA_MIN + span * rotations(u)).to_array(), [1.0 / span; N])
    }

    /// All lanes at one wavelength `lambda` (nm), with density 1 nm⁻¹: what is measured is then the light of one nanometre
    /// around `lambda`.
    #[inline]
    pub fn fixed(lambda: f32) -> Self {
        Self::new([lambda; N], [1.0; N])
    }

    /// All lanes at one wavelength `lambda` (nm), with the density of [`Self::sample_visible`], for freezing the wavelength: the
    /// mean over wavelengths so drawn of what is measured is what is measured of all light. Beyond
    /// `[LAMBDA_MIN, LAMBDA_MAX]` it is black.
    #[inline]
    pub fn held(lambda: f32) -> Self {
        Self::new([lambda; N], [Self::visible_pdf(lambda); N])
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
}

/// `u + i / N` for every lane, wrapped into `[0, 1)`.
#[inline]
fn rotations(u: f32) -> Vec4 {
    let v = u + Vec4::new(0.0, 0.25, 0.5, 0.75);
    Vec4::select(v.cmpge(Vec4::ONE), v - 1.0, v)
}

/// Wavelengths with tanh(STEEPNESS (CENTRE − λ)) = `t`: artanh t is ½ ln((1 + t) / (1 − t)).
#[inline]
fn visible_from_tanh(t: Vec4) -> Vec4 {
    let artanh = ops::ln_lanes((1.0 + t) / (1.0 - t));
    // The clamp takes off the rounding at both ends, where the density would answer 0.
    (CENTRE - (0.5 / STEEPNESS) * artanh).max(Vec4::splat(LAMBDA_MIN)).min(Vec4::splat(LAMBDA_MAX))
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
                    assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&w.lambda()[lane]));
                    assert!(w.pdf[lane] > 0.0);
                }
            }
            let w = SampledWavelengths::sample_visible(u);
            for (pdf, lambda) in w.pdf.into_iter().zip(w.lambda()) {
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
            let draw = |u| Some(SampledWavelengths::sample_visible(u).lambda()[lane]);
            interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, visible, &options).check("visible");
            assert!(!interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, uniform, &options).passed);
            let draw = |u| Some(SampledWavelengths::sample_uniform(u).lambda()[lane]);
            interval_test(LAMBDA_MIN, LAMBDA_MAX, draw, uniform, &options).check("uniform");
        }
    }

    #[test]
    fn lanes_are_rotations() {
        let w = SampledWavelengths::sample_uniform(0.9);
        let want = [783.0, 430.5, 548.0, 665.5];
        for (got, want) in w.lambda().iter().zip(want) {
            assert!((got - want).abs() < 1e-3, "{:?}", w.lambda());
        }
        assert_eq!(SampledWavelengths::fixed(550.0).lambda(), [550.0; N]);
    }
}
