//! Values at the wavelengths of many paths, side by side.

use crate::{N, SampledSpectrum};
use tenfold_math::{Floats, WIDTH};

/// A [`SampledSpectrum`] in each slot, wavelength by wavelength.
#[derive(Copy, Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Spectra([Floats; N]);

impl Spectra {
    /// Zero everywhere.
    pub const ZERO: Self = Self([[0.0; WIDTH]; N]);

    /// The spectrum in a slot.
    #[inline(always)]
    pub fn get(&self, slot: usize) -> SampledSpectrum {
        SampledSpectrum::new(self.array(slot))
    }

    /// Sets the spectrum in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, spectrum: SampledSpectrum) {
        self.set_array(slot, spectrum.to_array());
    }

    /// The spectrum in a slot, for arithmetic that is to become that of vectors over slots.
    #[inline(always)]
    pub fn array(&self, slot: usize) -> [f32; N] {
        [self.0[0][slot], self.0[1][slot], self.0[2][slot], self.0[3][slot]]
    }

    /// Sets the spectrum in a slot.
    #[inline(always)]
    pub fn set_array(&mut self, slot: usize, [a, b, c, d]: [f32; N]) {
        (self.0[0][slot], self.0[1][slot], self.0[2][slot], self.0[3][slot]) = (a, b, c, d);
    }
}

impl Default for Spectra {
    fn default() -> Self {
        Self::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_set_is_there_again() {
        let mut spectra = Spectra::default();
        let spectrum = SampledSpectrum::from_fn(|lane| lane as f32 + 1.0);
        spectra.set(3, spectrum);
        assert_eq!((spectra.get(3), spectra.get(4)), (spectrum, SampledSpectrum::ZERO));
        assert_eq!(spectra.array(3), spectrum.to_array());
    }
}
