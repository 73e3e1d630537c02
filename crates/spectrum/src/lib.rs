//! Wavelengths, spectra, CIE data, colour spaces, RGB upsampling and named measured spectra.
//!
//! Light is carried as [`SampledSpectrum`]: values at the [`N`] wavelengths of a [`SampledWavelengths`],
//! one per SIMD lane. A [`Spectrum`] is a function of wavelength that can be sampled at them; an
//! [`Observer`] turns the carried values into CIE XYZ, and an [`RgbColorSpace`] XYZ into RGB and RGB
//! into smooth spectra.
//!
//! Units: wavelengths in nm, densities over wavelength in nm⁻¹. Semantics of the spectrum kinds are those of
//! pbrt-v4 (Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., chapter 4).

mod cie;
mod color;
mod colorspace;
mod data;
mod named;
mod sampled;
mod sigmoid;
mod spd;
mod spectra;
mod spectrum;
mod upsample;
mod wavelengths;

pub use cie::{CIE_Y_INTEGRAL, Observer, photometric, spectrum_to_xyz};
pub use color::{Chromaticity, Rgb, Xyz};
pub use colorspace::RgbColorSpace;
pub use named::{named, named_names};
pub use sampled::SampledSpectrum;
pub use sigmoid::SigmoidPolynomial;
pub use spd::{SpdError, parse_spd};
pub use spectra::{Spectra, SpectraToEvaluate};
pub use spectrum::{
    Blackbody, DenselySampled, PiecewiseError, PiecewiseLinear, RgbAlbedo, RgbIlluminant, RgbUnbounded,
    Spectrum,
};
pub use upsample::SigmoidTable;
pub use wavelengths::SampledWavelengths;

/// Number of wavelengths a path carries, one per SIMD lane.
pub const N: usize = 4;
/// Shortest wavelength rendered, in nm.
pub const LAMBDA_MIN: f32 = 360.0;
/// Longest wavelength rendered, in nm.
pub const LAMBDA_MAX: f32 = 830.0;
