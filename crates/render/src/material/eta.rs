use tenfold_math::Vec4;
use tenfold_spectrum::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths, Spectrum};

/// The index of refraction inside a dielectric, over that outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Eta(Spectrum);

impl Eta {
    /// An index per wavelength. Zero, which a tabulated spectrum has beyond its ends, stands for 1 (as in pbrt-v4).
    pub fn new(eta: Spectrum) -> Self {
        match eta {
            Spectrum::Constant(0.0) => Self(Spectrum::Constant(1.0)),
            eta => Self(eta),
        }
    }

    /// The index, where it is the same at all wavelengths: then nothing is dispersed.
    pub fn constant(&self) -> Option<f32> {
        match self.0 {
            Spectrum::Constant(eta) => Some(eta),
            _ => None,
        }
    }

    /// The least and the largest index at the wavelengths rendered.
    pub fn range(&self) -> [f32; 2] {
        let steps = (LAMBDA_MAX - LAMBDA_MIN) as u32;
        (0..=steps).fold([f32::INFINITY, f32::NEG_INFINITY], |[min, max], i| {
            let eta = self.sample(&SampledWavelengths::fixed(LAMBDA_MIN + i as f32))[0];
            [min.min(eta), max.max(eta)]
        })
    }

    /// The index at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        match &self.0 {
            Spectrum::Constant(eta) => SampledSpectrum::splat(*eta),
            spectrum => {
                let eta = spectrum.sample(w).0;
                SampledSpectrum(Vec4::select(eta.cmpeq(Vec4::ZERO), Vec4::ONE, eta))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_spectrum::{PiecewiseLinear, named};

    #[test]
    fn glasses_disperse_and_numbers_do_not() {
        let w = SampledWavelengths::sample_visible(0.2);
        assert_eq!(Eta::new(Spectrum::Constant(1.5)).sample(&w), SampledSpectrum::splat(1.5));
        assert_eq!(Eta::new(Spectrum::Constant(1.5)).constant(), Some(1.5));
        let glass = Eta::new(named("glass-BK7").unwrap());
        assert_eq!(glass.constant(), None);
        let eta = glass.sample(&w);
        assert!(eta.min_component() > 1.5 && eta.max_component() < 1.54 && eta[0] != eta[1]);
    }

    #[test]
    fn nothing_is_one() {
        assert_eq!(Eta::new(Spectrum::Constant(0.0)).constant(), Some(1.0));
        let narrow = PiecewiseLinear::new(vec![500.0, 510.0], vec![1.4, 1.4]).unwrap();
        let eta = Eta::new(Spectrum::PiecewiseLinear(narrow)).sample(&SampledWavelengths::fixed(600.0));
        assert_eq!(eta, SampledSpectrum::ONE);
    }
}
