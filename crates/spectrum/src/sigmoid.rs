//! Smooth spectra with values in [0, 1]: a sigmoid of a quadratic polynomial.

use tenfold_math::Vec4;

use crate::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};

/// Middle of the rendered range, nm.
const MIDDLE: f32 = 0.5 * (LAMBDA_MIN + LAMBDA_MAX);
/// Half its width, nm.
const HALF: f32 = 0.5 * (LAMBDA_MAX - LAMBDA_MIN);

/// `s(c₀ + c₁ t + c₂ t²)` with `s(x) = ½ + x / (2 √(1 + x²))` (Jakob and Hanika 2019, eqs. 1 and 3) and
/// `t = (λ − 595 nm) / 235 nm`, which runs over [−1, 1]: coefficients of moderate size, for the sake of `f32`.
#[derive(Copy, Clone, PartialEq, Debug, Default)]
pub struct SigmoidPolynomial {
    /// Coefficients of 1, t and t².
    pub c: [f32; 3],
}

impl SigmoidPolynomial {
    /// The constant spectrum of value `v` in [0, 1], by the inverse of the sigmoid: exactly 0 and 1 at the ends.
    #[inline]
    pub fn constant(v: f32) -> Self {
        // 0 / 0 cannot occur: where the root is 0, the numerator is ±½, and the coefficient infinite with intent.
        Self { c: [(v - 0.5) / (v * (1.0 - v)).sqrt(), 0.0, 0.0] }
    }

    /// Value at a wavelength in nm.
    #[inline(always)]
    pub fn eval(&self, lambda: f32) -> f32 {
        let t = (lambda - MIDDLE) * (1.0 / HALF);
        let x = (self.c[2] * t + self.c[1]) * t + self.c[0];
        // As `sigmoid`.
        let a = x.abs();
        let q = (1.0 + a * a).sqrt();
        let tail = 0.5 / (q * (q + a));
        if x < 0.0 { tail } else { 1.0 - tail }
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        let t = (Vec4::from_array(w.lambda()) - MIDDLE) * (1.0 / HALF);
        SampledSpectrum(sigmoid((self.c[2] * t + self.c[1]) * t + self.c[0]))
    }

    /// Largest value on the rendered range.
    pub fn max_value(&self) -> f32 {
        let ends = self.eval(LAMBDA_MIN).max(self.eval(LAMBDA_MAX));
        let [_, c1, c2] = self.c;
        let vertex = -c1 / (2.0 * c2);
        if c2 < 0.0 && vertex.abs() < 1.0 { ends.max(self.eval(MIDDLE + HALF * vertex)) } else { ends }
    }
}

/// ½ + x / (2 √(1 + x²)), rewritten so that small values keep their relative precision and ±∞ give 1 and 0.
#[inline]
fn sigmoid(x: Vec4) -> Vec4 {
    let a = x.abs();
    let q = (Vec4::ONE + a * a).sqrt();
    let tail = 0.5 / (q * (q + a));
    Vec4::select(x.cmplt(Vec4::ZERO), tail, 1.0 - tail)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sigmoid_agrees_with_its_definition() {
        for i in -400..=400 {
            let x = f64::from(i) * 0.1;
            let want = 0.5 + x / (2.0 * (1.0 + x * x).sqrt());
            let got = f64::from(sigmoid(Vec4::splat(x as f32)).y);
            assert!((got - want).abs() <= 2e-6 * want, "{x}: {got} {want}");
        }
    }

    #[test]
    fn constants_come_back() {
        for v in [0.0, 1e-6, 0.01, 0.18, 0.5, 0.9, 1.0f32] {
            let s = SigmoidPolynomial::constant(v);
            for lambda in [360.0, 512.3, 830.0] {
                assert!((s.eval(lambda) - v).abs() <= 1e-6 * v, "{v}: {}", s.eval(lambda));
            }
            assert!((s.max_value() - v).abs() <= 1e-6 * v);
        }
    }

    #[test]
    fn lanes_agree_with_single_wavelengths_and_the_maximum_bounds_them() {
        let w = SampledWavelengths::sample_uniform(0.13);
        for c in [[0.3, -2.0, 4.0], [1.0, 0.5, -7.0], [-1.0, 3.0, -1.0]] {
            let s = SigmoidPolynomial { c };
            let lanes = s.sample(&w);
            for i in 0..crate::N {
                assert_eq!(lanes[i], s.eval(w.lambda()[i]));
            }
            let max = (0..=4700).map(|i| s.eval(360.0 + i as f32 * 0.1)).fold(0.0, f32::max);
            assert!((s.max_value() - max).abs() < 1e-5);
        }
    }
}
