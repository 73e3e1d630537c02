//! The wavelengths a path carries, and the density they were drawn with.

use crate::{LAMBDA_MAX, LAMBDA_MIN, N, spectrum::dense_index};
use tenfold_math::{Floats, WIDTH, ops, vectorized};

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
        Self { lambda, pdf, nearest: lambda.map(|l| dense_index(l) as u16) }
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
        let [mut lambda, mut pdf] = [[0.0; N]; 2];
        for i in 0..N {
            (lambda[i], pdf[i]) = visible(rotation(u, i));
        }
        Self::new(lambda, pdf)
    }

    /// [`Self::sample_visible`] of the number in each slot.
    #[inline]
    pub fn samples_visible(u: &Floats) -> [Self; WIDTH] {
        let mut lanes = Lanes::default();
        draw_visible(u, &mut lanes);
        std::array::from_fn(|i| Self {
            lambda: lanes.lambda[i],
            pdf: lanes.pdf[i],
            nearest: lanes.nearest[i],
        })
    }

    /// Draws wavelengths uniformly on `[LAMBDA_MIN, LAMBDA_MAX]` from one number `u` in `[0, 1)`, the lanes at equal distances.
    #[inline]
    pub fn sample_uniform(u: f32) -> Self {
        let span = LAMBDA_MAX - LAMBDA_MIN;
        Self::new(std::array::from_fn(|i| LAMBDA_MIN + span * rotation(u, i)), [1.0 / span; N])
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

/// What [`SampledWavelengths`] holds, for the wavelengths in each slot.
#[derive(Default)]
#[repr(align(64))]
struct Lanes {
    lambda: [[f32; N]; WIDTH],
    pdf: [[f32; N]; WIDTH],
    nearest: [[u16; N]; WIDTH],
}

vectorized! {
    /// Draws wavelengths from the number in each slot.
    fn draw_visible(u: &Floats, out: &mut Lanes) {
        let u = u.map(|u| [u; N]);
        // One loop over all lanes of all slots.
        let u = u.as_flattened();
        let Lanes { lambda, pdf, nearest } = out;
        let (lambda, pdf, nearest) = (lambda.as_flattened_mut(), pdf.as_flattened_mut(), nearest.as_flattened_mut());
        for i in 0..N * WIDTH {
            (lambda[i], pdf[i]) = visible(rotation(u[i], i));
            nearest[i] = dense_index(lambda[i]) as u16;
        }
    }
}

/// `u` rotated for the lane `i`, of those of all slots: `u + i / N` modulo 1.
#[inline(always)]
fn rotation(u: f32, i: usize) -> f32 {
    let v = u + (i % N) as u16 as f32 * (1.0 / N as f32);
    if v >= 1.0 { v - 1.0 } else { v }
}

/// The wavelength that `u` draws by [`SampledWavelengths::sample_visible`], and its density.
#[inline(always)]
fn visible(u: f32) -> (f32, f32) {
    // The hyperbolic tangent of the scaled distance from the centre, which is uniformly distributed.
    let tanh = TANH_LOW - TANH_SPAN * u;
    // artanh t is ½ ln((1 + t) / (1 - t)).
    let artanh = ops::ln_of_normal((1.0 + tanh) / (1.0 - tanh));
    let lambda = CENTRE - (0.5 / STEEPNESS) * artanh;
    // The clamp takes off the rounding at both ends, where the density would answer 0.
    (lambda.clamp(LAMBDA_MIN, LAMBDA_MAX), DENSITY * (1.0 - tanh * tanh))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::ONE_MINUS_EPSILON;
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
    fn slots_draw_what_each_number_draws_alone() {
        for step in 0..2000 {
            let u: Floats =
                std::array::from_fn(|i| ((step * WIDTH + i) as f32 / 32_000.0).min(ONE_MINUS_EPSILON));
            assert_eq!(SampledWavelengths::samples_visible(&u), u.map(SampledWavelengths::sample_visible));
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
