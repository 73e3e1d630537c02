use tenfold_spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// What a colour stands for: the same RGB triple becomes different spectra.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum SpectrumRole {
    /// A fraction of light, in [0, 1].
    Albedo,
    /// A coefficient without upper bound, as an index of refraction.
    Unbounded,
    /// Emission: white is the illuminant of the colour space.
    Illuminant,
}

impl SpectrumRole {
    /// The spectrum that a texel's colour stands for, at the wavelengths of a path; negative components count
    /// as 0, and those of an albedo above 1 as 1.
    #[inline]
    pub fn sample(self, space: &RgbColorSpace, rgb: Rgb, w: &SampledWavelengths) -> SampledSpectrum {
        let rgb = Rgb(rgb.0.max(tenfold_math::Vec3::ZERO));
        match self {
            Self::Albedo => space.sample_albedo(rgb, w),
            Self::Unbounded => space.sample_unbounded(rgb, w),
            Self::Illuminant => space.sample_illuminant(rgb, w),
        }
    }
}
