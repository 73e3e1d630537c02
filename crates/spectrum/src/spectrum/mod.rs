//! Functions of wavelength.

mod blackbody;
mod dense;
mod piecewise;
mod rgb;

pub use blackbody::Blackbody;
pub use dense::DenselySampled;
pub(crate) use dense::{SAMPLES, dense_index};
pub use piecewise::{PiecewiseError, PiecewiseLinear};
pub(crate) use rgb::factor as rgb_factor;
pub use rgb::{RgbAlbedo, RgbIlluminant, RgbUnbounded};

use crate::{SampledSpectrum, SampledWavelengths};

/// A function of wavelength. Cheap to clone: bulk data is shared.
#[derive(Clone, PartialEq, Debug)]
pub enum Spectrum {
    /// The same value everywhere.
    Constant(f32),
    /// Values at every nanometre of the rendered range.
    Dense(DenselySampled),
    /// Linear between given points, 0 outside of them.
    PiecewiseLinear(PiecewiseLinear),
    /// Planck's law, normalised to a maximum of 1.
    Blackbody(Blackbody),
    /// Reflectance of an RGB colour, within [0, 1].
    RgbAlbedo(RgbAlbedo),
    /// Unbounded coefficient of an RGB colour.
    RgbUnbounded(RgbUnbounded),
    /// Emission of an RGB colour: the colour times the illuminant of its colour space.
    RgbIlluminant(RgbIlluminant),
}

impl Spectrum {
    /// Value at a wavelength in nm.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        match self {
            Self::Constant(c) => *c,
            Self::Dense(s) => s.eval(lambda),
            Self::PiecewiseLinear(s) => s.eval(lambda),
            Self::Blackbody(s) => s.eval(lambda),
            Self::RgbAlbedo(s) => s.eval(lambda),
            Self::RgbUnbounded(s) => s.eval(lambda),
            Self::RgbIlluminant(s) => s.eval(lambda),
        }
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(c) => SampledSpectrum::splat(*c),
            Self::Dense(s) => s.sample(w),
            Self::PiecewiseLinear(s) => s.sample(w),
            Self::Blackbody(s) => s.sample(w),
            Self::RgbAlbedo(s) => s.sample(w),
            Self::RgbUnbounded(s) => s.sample(w),
            Self::RgbIlluminant(s) => s.sample(w),
        }
    }

    /// A bound on the values over the rendered range, attained for all kinds but the RGB illuminant.
    pub fn max_value(&self) -> f32 {
        match self {
            Self::Constant(c) => *c,
            Self::Dense(s) => s.max_value(),
            Self::PiecewiseLinear(s) => s.max_value(),
            Self::Blackbody(s) => s.max_value(),
            Self::RgbAlbedo(s) => s.max_value(),
            Self::RgbUnbounded(s) => s.max_value(),
            Self::RgbIlluminant(s) => s.max_value(),
        }
    }

    /// Whether the kind of the spectrum makes it the same at all wavelengths. An index of refraction
    /// for which this is false disperses light.
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{N, Rgb, RgbColorSpace, named};

    /// `sample` agrees with `eval`, and `max_value` bounds both, for every kind.
    #[test]
    fn kinds_agree_with_themselves() {
        let cs = RgbColorSpace::srgb();
        let d65 = named("stdillum-D65").unwrap();
        let rgb = Rgb::new(0.7, 0.2, 0.4);
        let all = [
            Spectrum::Constant(0.4),
            Spectrum::Dense(DenselySampled::from_spectrum(&d65)),
            d65,
            Spectrum::PiecewiseLinear(
                PiecewiseLinear::new(vec![400.0, 500.0, 530.0], vec![1.0, 2.0, 0.5]).unwrap(),
            ),
            Spectrum::Blackbody(Blackbody::new(5000.0)),
            Spectrum::RgbAlbedo(RgbAlbedo::new(cs, rgb)),
            Spectrum::RgbUnbounded(RgbUnbounded::new(cs, Rgb(rgb.0 * 9.0))),
            Spectrum::RgbIlluminant(RgbIlluminant::new(cs, Rgb(rgb.0 * 9.0))),
        ];
        for s in &all {
            let mut largest = f32::MIN;
            for i in 0..4000 {
                let w = SampledWavelengths::sample_uniform(i as f32 / 4000.0);
                let v = s.sample(&w);
                for lane in 0..N {
                    assert_eq!(v[lane], s.eval(w.lambda()[lane]), "{s:?}");
                }
                largest = largest.max(v.max_component());
            }
            assert!(largest <= s.max_value() * 1.000_001, "{s:?}: {largest} > {}", s.max_value());
            if !matches!(s, Spectrum::RgbIlluminant(_)) {
                assert!(largest >= 0.99 * s.max_value(), "{s:?}: {largest} < {}", s.max_value());
            }
            assert_eq!(s.is_constant(), matches!(s, Spectrum::Constant(_)));
        }
    }
}
