//! Pixel buffers, EXR, PNG, HDR and PFM files, texture pyramids and error metrics.
//!
//! An [`Image`] is a rectangle of pixels in memory: rows from the top, channels interleaved, stored as 8-bit
//! codes, halves or floats and always *read* as linear floats. [`Image::read`] and [`Image::write`] move it from
//! and to files; [`Pyramid`] answers filtered texture lookups; [`metrics`] measures how far two images differ.
//!
//! Image coordinates: pixel (0, 0) is the top left one, `x` runs right and `y` down. Texture coordinates `st` span
//! [0, 1]² over the image with (0, 0) at the corner of the first stored pixel; a caller whose `t` runs up flips it.

mod atomic;
mod codec;
mod distribution;
mod dither;
mod encoding;
mod error;
mod ewa;
mod format;
mod image;
mod lookup;
mod metadata;
pub mod metrics;
mod pyramid;
mod resample;
mod transform;
mod wrap;

pub use atomic::write_atomic;
pub use codec::{ExrPixels, PngDepth, WriteOptions};
pub use distribution::Interpolation;
pub use dither::dither_offset;
pub use encoding::{ColorEncoding, DecodeTable, linear_to_srgb, srgb_to_linear};
pub use error::{ImageError, ImageErrorKind};
pub use format::{Format, UnknownFormat};
pub use image::{Image, PixelData};
pub use metadata::{Attribute, Chromaticities, Metadata, Window};
pub use pyramid::{Pyramid, TextureFilter};
pub use wrap::WrapMode;
