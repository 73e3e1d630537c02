//! Values at the wavelengths of many paths, side by side.

use crate::{N, SampledSpectrum, SampledWavelengths, SigmoidPolynomial, Spectrum};
use tenfold_math::{Floats, Vec3, Vec3s, WIDTH, vectorized};

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

/// A spectrum in each slot, to be evaluated at the wavelengths of that slot.
#[derive(Copy, Clone, Debug, Default)]
pub struct SpectraToEvaluate {
    /// Coefficients of those that are sigmoids.
    sigmoids: Vec3s,
    is_sigmoid: [bool; WIDTH],
    /// Values of the others.
    values: Spectra,
}

impl SpectraToEvaluate {
    /// Sets the spectrum in a slot, whose wavelengths are `w`.
    #[inline]
    pub fn set(&mut self, slot: usize, spectrum: &Spectrum, w: &SampledWavelengths) {
        if let Spectrum::RgbAlbedo(albedo) = spectrum {
            self.sigmoids.set(slot, Vec3::from_array(albedo.sigmoid.c));
            self.is_sigmoid[slot] = true;
        } else {
            self.set_values(slot, spectrum.sample(w));
        }
    }

    /// Sets the spectrum in a slot by its values.
    #[inline]
    pub fn set_values(&mut self, slot: usize, values: SampledSpectrum) {
        self.values.set(slot, values);
        self.is_sigmoid[slot] = false;
    }

    /// The values of all at the wavelengths `lambda` in nm, which those of [`SpectraToEvaluate::set`] are.
    pub fn evaluate(&self, lambda: &Spectra, out: &mut Spectra) {
        if self.is_sigmoid == [false; WIDTH] {
            *out = self.values;
        } else {
            evaluate(self, lambda, out);
        }
    }
}

vectorized! {
    /// The values of spectra at the wavelengths `lambda`.
    fn evaluate(spectra: &SpectraToEvaluate, lambda: &Spectra, out: &mut Spectra) {
        for lane in 0..N {
            for i in 0..WIDTH {
                let sigmoid = SigmoidPolynomial { c: spectra.sigmoids.get(i).to_array() };
                let value = sigmoid.eval(lambda.0[lane][i]);
                out.0[lane][i] = if spectra.is_sigmoid[i] { value } else { spectra.values.0[lane][i] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rgb, RgbAlbedo, RgbColorSpace, named};

    #[test]
    fn slots_evaluate_what_each_spectrum_has_alone() {
        let srgb = RgbColorSpace::srgb();
        let colors = [0.0f32, 0.3, 0.9, 1.0].map(|v| Rgb(Vec3::new(v, 1.0 - v, v * v)));
        let white = Spectrum::RgbAlbedo(RgbAlbedo::new(srgb, Rgb(Vec3::ONE)));
        let others = [Spectrum::Constant(0.4), named("metal-Cu-k").unwrap(), white];
        let albedos = colors.map(|rgb| Spectrum::RgbAlbedo(RgbAlbedo::new(srgb, rgb)));
        let all: Vec<_> = albedos.into_iter().chain(others).collect();
        let (mut together, mut lambda, mut values) =
            (SpectraToEvaluate::default(), Spectra::ZERO, Spectra::ZERO);
        for round in 0..200 {
            let w: [_; WIDTH] = std::array::from_fn(|slot| {
                SampledWavelengths::sample_visible((round * WIDTH + slot) as f32 / 3200.0)
            });
            let chosen = |slot: usize| &all[(round + slot * slot) % all.len()];
            for slot in 0..WIDTH {
                lambda.set_array(slot, w[slot].lambda());
                together.set(slot, chosen(slot), &w[slot]);
            }
            together.evaluate(&lambda, &mut values);
            (0..WIDTH).for_each(|slot| assert_eq!(values.get(slot), chosen(slot).sample(&w[slot])));
        }
    }

    #[test]
    fn what_is_set_is_there_again() {
        let mut spectra = Spectra::default();
        let spectrum = SampledSpectrum::from_fn(|lane| lane as f32 + 1.0);
        spectra.set(3, spectrum);
        assert_eq!((spectra.get(3), spectra.get(4)), (spectrum, SampledSpectrum::ZERO));
        assert_eq!(spectra.array(3), spectrum.to_array());
    }
}
