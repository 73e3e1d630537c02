//! Black bodies.

use crate::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};
use tenfold_math::ops;

/// Wien's displacement constant, nm·K (CODATA 2010, as pbrt-v4).
const WIEN: f32 = 2.897_772_1e6;
/// Second radiation constant h c / k, nm·K (CODATA 2010: h = 6.62606957e-34, k = 1.3806488e-23, as pbrt-v4).
const SECOND_RADIATION: f32 = 1.438_777e7;

/// Planck's law for the radiance of a black body, divided by its largest value over all wavelengths.
#[derive(Copy, Clone, PartialEq, Debug)]
pub struct Blackbody {
    temperature: f32,
    /// Wavelength of the largest value, nm.
    peak: f32,
}

impl Blackbody {
    /// Exponent h c / (λ k T) at the peak, the same for all temperatures.
    const PEAK_EXPONENT: f32 = SECOND_RADIATION / WIEN;

    /// Of a temperature in K. One of 0 or less does not radiate.
    pub fn new(temperature: f32) -> Self {
        Self { temperature, peak: WIEN / temperature }
    }

    /// Temperature in K.
    pub fn temperature(&self) -> f32 {
        self.temperature
    }

    /// Value at a wavelength in nm: with u = peak / λ and x the exponent at the peak, u⁵ (eˣ − 1) / (eˣᵘ − 1)
    /// (Planck's law over itself at the peak).
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        // Also where the temperature is NaN.
        if !(self.temperature > 0.0 && lambda > 0.0) {
            return 0.0;
        }
        let u = self.peak / lambda;
        let u2 = u * u;
        let v = u2 * u2 * u * ops::exp_m1(Self::PEAK_EXPONENT) / ops::exp_m1(Self::PEAK_EXPONENT * u);
        // Far below the peak the exponential overflows, and the quotient may be of two infinities.
        if v.is_finite() { v } else { 0.0 }
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum::new(w.lambda().map(|lambda| self.eval(lambda)))
    }

    /// Largest value over the rendered range.
    pub fn max_value(&self) -> f32 {
        self.eval(self.peak.clamp(LAMBDA_MIN, LAMBDA_MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Spectrum, spectrum_to_xyz};

    /// Planck's law in SI units, W·m⁻²·sr⁻¹·m⁻¹.
    fn planck(lambda_nm: f64, t: f64) -> f64 {
        let (c, h, k) = (299_792_458.0, 6.626_069_57e-34, 1.380_648_8e-23);
        let l = lambda_nm * 1e-9;
        2.0 * h * c * c / (l.powi(5) * (ops::exp(h * c / (l * k * t)) - 1.0))
    }

    #[test]
    fn is_plancks_law_over_its_peak() {
        for t in [800.0, 2856.0, 6500.0, 20_000.0] {
            let peak = planck(2.897_772_1e6 / t, t);
            for lambda in [360.0, 450.0, 555.5, 700.0, 830.0] {
                let want = planck(lambda, t) / peak;
                let got = f64::from(Blackbody::new(t as f32).eval(lambda as f32));
                assert!((got - want).abs() < 1e-5 * want + 1e-30, "{t} K, {lambda} nm: {got} {want}");
            }
        }
        assert_eq!(Blackbody::new(0.0).eval(500.0), 0.0);
        assert_eq!(Blackbody::new(-1.0).eval(500.0), 0.0);
        assert_eq!(Blackbody::new(1.0).eval(360.0), 0.0);
        assert_eq!(Blackbody::new(5000.0).temperature(), 5000.0);
    }

    /// Published: CIE illuminant A is the black body of 2855.54 K on the scale of these constants, at
    /// (0.44757, 0.40745) (CIE 015).
    #[test]
    fn chromaticity_at_illuminant_a() {
        let c = spectrum_to_xyz(&Spectrum::Blackbody(Blackbody::new(2856.0))).chromaticity();
        assert!((c.x - 0.447_57).abs() < 2e-4 && (c.y - 0.407_45).abs() < 2e-4, "{c}");
    }
}
