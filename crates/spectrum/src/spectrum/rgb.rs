//! Smooth spectra of RGB colours.

use tenfold_math::Vec3;

use super::DenselySampled;
use crate::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, SigmoidPolynomial};

/// Factors of an RGB colour of any brightness: a scale, and a colour whose largest component is ½, where sigmoids are
/// smoothest (pbrt 4th ed., section 4.6.6).
#[inline]
pub(crate) fn factor(rgb: Rgb) -> (f32, Rgb) {
    let scale = 2.0 * rgb.0.max_element().max(0.0);
    if scale > 0.0 { (scale, Rgb(rgb.0 / scale)) } else { (0.0, Rgb(Vec3::ZERO)) }
}

/// Reflectance of an RGB colour clamped to [0, 1].
#[derive(Copy, Clone, PartialEq, Debug)]
pub struct RgbAlbedo {
    /// The spectrum.
    pub sigmoid: SigmoidPolynomial,
}

impl RgbAlbedo {
    /// The spectrum of a constant colour, solved for exactly.
    pub fn new(cs: &RgbColorSpace, rgb: Rgb) -> Self {
        Self { sigmoid: cs.solve_sigmoid(rgb) }
    }

    /// Value at a wavelength in nm.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        self.sigmoid.eval(lambda)
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        self.sigmoid.sample(w)
    }

    /// Largest value over the rendered range.
    pub fn max_value(&self) -> f32 {
        self.sigmoid.max_value()
    }
}

/// A coefficient (an absorption, an index of refraction, …) of an RGB colour that may exceed 1: scale × sigmoid.
#[derive(Copy, Clone, PartialEq, Debug)]
pub struct RgbUnbounded {
    /// Factor of the sigmoid: twice the largest component.
    pub scale: f32,
    /// The spectrum of the colour over the scale.
    pub sigmoid: SigmoidPolynomial,
}

impl RgbUnbounded {
    /// The spectrum of a constant colour, solved for exactly. Negative components count as 0.
    pub fn new(cs: &RgbColorSpace, rgb: Rgb) -> Self {
        let (scale, rgb) = factor(rgb);
        Self { scale, sigmoid: cs.solve_sigmoid(rgb) }
    }

    /// Value at a wavelength in nm.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        self.scale * self.sigmoid.eval(lambda)
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        self.scale * self.sigmoid.sample(w)
    }

    /// Largest value over the rendered range.
    pub fn max_value(&self) -> f32 {
        self.scale * self.sigmoid.max_value()
    }
}

/// Emission of an RGB colour: scale × sigmoid × the illuminant of the colour space, so that white is
/// the colour of the illuminant.
#[derive(Clone, PartialEq, Debug)]
pub struct RgbIlluminant {
    /// Factor of the sigmoid: twice the largest component.
    pub scale: f32,
    /// The spectrum of the colour over the scale.
    pub sigmoid: SigmoidPolynomial,
    /// The illuminant.
    pub illuminant: DenselySampled,
}

impl RgbIlluminant {
    /// The spectrum of a constant colour, solved for exactly. Negative components count as 0.
    pub fn new(cs: &RgbColorSpace, rgb: Rgb) -> Self {
        let (scale, rgb) = factor(rgb);
        Self { scale, sigmoid: cs.solve_sigmoid(rgb), illuminant: cs.illuminant().clone() }
    }

    /// Value at a wavelength in nm.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        self.scale * self.sigmoid.eval(lambda) * self.illuminant.eval(lambda)
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        self.scale * self.sigmoid.sample(w) * self.illuminant.sample(w)
    }

    /// A bound on the values over the rendered range.
    pub fn max_value(&self) -> f32 {
        self.scale * self.sigmoid.max_value() * self.illuminant.max_value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_exact() {
        let cs = RgbColorSpace::srgb();
        for v in [0.0, 0.2, 0.5, 1.0] {
            let s = RgbAlbedo::new(cs, Rgb::new(v, v, v));
            assert!((s.eval(480.0) - v).abs() < 1e-7 && (s.eval(800.0) - v).abs() < 1e-7);
        }
        let black = RgbAlbedo::new(cs, Rgb::default()).sample(&SampledWavelengths::sample_visible(0.3));
        assert!(black.is_black());
        let u = RgbUnbounded::new(cs, Rgb::new(7.0, 7.0, 7.0));
        assert_eq!((u.eval(400.0), u.max_value()), (7.0, 7.0));
        assert_eq!(RgbUnbounded::new(cs, Rgb::default()).eval(500.0), 0.0);
        assert_eq!(RgbUnbounded::new(cs, Rgb::new(-1.0, -2.0, -1.0)).eval(500.0), 0.0);
        let i = RgbIlluminant::new(cs, Rgb::new(3.0, 3.0, 3.0));
        assert_eq!(i.eval(500.0), 3.0 * cs.illuminant().eval(500.0));
    }

    #[test]
    fn albedos_are_clamped() {
        let cs = RgbColorSpace::srgb();
        let over = RgbAlbedo::new(cs, Rgb::new(2.0, 0.5, -0.5));
        assert_eq!(over, RgbAlbedo::new(cs, Rgb::new(1.0, 0.5, 0.0)));
        assert!(over.max_value() <= 1.0);
    }
}
