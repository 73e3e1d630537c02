//! Spectra tabulated at every nanometre.

use std::sync::Arc;

use super::Spectrum;
use crate::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};

/// Whole nanometres of the rendered range.
pub(crate) const SAMPLES: usize = (LAMBDA_MAX - LAMBDA_MIN) as usize + 1;

/// Index of the nanometre nearest to `lambda`; [`SAMPLES`] for all beyond the rendered range.
#[inline(always)]
pub(crate) fn dense_index(lambda: f32) -> usize {
    let i = lambda + (0.5 - LAMBDA_MIN);
    let i = if i >= 0.0 && i < SAMPLES as f32 { i } else { SAMPLES as f32 };
    // SAFETY: it is between 0 and `SAMPLES`. Vectors have no instruction for conversions that saturate.
    unsafe { i.to_int_unchecked::<i32>() as usize }
}

/// Values at every whole nanometre of the rendered range, looked up by rounding the wavelength as
/// pbrt-v4 does; 0 outside.
#[derive(Clone, PartialEq, Debug)]
pub struct DenselySampled {
    /// The values, and a 0 for all wavelengths outside.
    values: Arc<[f32; SAMPLES + 1]>,
}

impl DenselySampled {
    /// Tabulates a function of the wavelength in nm.
    pub fn from_fn(mut f: impl FnMut(f32) -> f32) -> Self {
        let value = |i| if i < SAMPLES { f(LAMBDA_MIN + i as f32) } else { 0.0 };
        Self { values: Arc::new(std::array::from_fn(value)) }
    }

    /// Tabulates a spectrum.
    pub fn from_spectrum(s: &Spectrum) -> Self {
        Self::from_fn(|lambda| s.eval(lambda))
    }

    /// A copy with all values times `factor`.
    pub fn scaled(&self, factor: f32) -> Self {
        Self { values: Arc::new(self.values.map(|v| v * factor)) }
    }

    /// Value at the nanometre nearest to `lambda`.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        self.values[dense_index(lambda)]
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum::new(w.nearest().map(|i| self.values[i]))
    }

    /// Largest value.
    pub fn max_value(&self) -> f32 {
        self.values[..SAMPLES].iter().copied().fold(f32::MIN, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_round_to_the_nearest_nanometre() {
        let s = DenselySampled::from_fn(|l| l);
        for (lambda, want) in
            [(360.0, 360.0), (359.6, 360.0), (500.49, 500.0), (500.5, 501.0), (830.0, 830.0), (830.4, 830.0)]
        {
            assert_eq!(s.eval(lambda), want, "{lambda}");
        }
        for outside in [0.0, 359.4, 830.6, 1e9, -5.0, f32::NAN, f32::INFINITY] {
            assert_eq!(s.eval(outside), 0.0, "{outside}");
        }
        assert_eq!(s.max_value(), 830.0);
        assert_eq!(s.scaled(2.0).eval(400.0), 800.0);
    }
}
