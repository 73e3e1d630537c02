//! Images from and to files.

mod exr_read;
mod exr_write;
mod hdr;
mod pfm;
mod png;
mod raster;

use crate::atomic::write_atomic;
use crate::encoding::ColorEncoding;
use crate::error::{ImageError, ImageErrorKind};
use crate::format::Format;
use crate::image::Image;
use std::io::{Seek, Write};
use std::panic::catch_unwind;
use std::path::Path;

/// How the pixels of an EXR file are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ExrPixels {
    /// All channels as 32-bit floats.
    #[default]
    Float,
    /// Channels as 16-bit halves, but those with a dot in their name (`samples.Y`) as 32-bit floats: counts and
    /// statistics want more than eleven bits.
    Half,
}

/// Bits of a channel in a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PngDepth {
    /// Eight bits, dithered unless the image has 8-bit codes already.
    #[default]
    Eight,
    /// Sixteen bits, rounded.
    Sixteen,
}

/// Choices of [`Image::write`]; each format looks at its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// For EXR.
    pub exr_pixels: ExrPixels,
    /// For PNG.
    pub png_depth: PngDepth,
}

impl Image {
    /// Reads the image at `path`, in the format that its content tells, or else its suffix. Integers are taken as sRGB,
    /// in PNG, JPEG, TGA and BMP files alike.
    ///
    /// Channels are `R`, `G`, `B`, `A` or `Y`, `A`, as far as the file has them; an EXR file's others follow in
    /// alphabetical order. Of an EXR file with several parts, the one with plain colour channels counts.
    ///
    /// # Errors
    /// [`ImageError`] with the path, whatever the file holds.
    pub fn read(path: impl AsRef<Path>) -> Result<Image, ImageError> {
        Self::read_with_encoding(path, None)
    }

    /// [`Image::read`] with an encoding for files that store integers, whatever they say.
    ///
    /// # Errors
    /// As [`Image::read`].
    pub fn read_with_encoding(
        path: impl AsRef<Path>,
        encoding: Option<ColorEncoding>,
    ) -> Result<Image, ImageError> {
        let path = path.as_ref();
        let read = || {
            let bytes = std::fs::read(path)?;
            let format = match Format::from_magic(&bytes) {
                Some(format) => format,
                None => Format::from_path(path)?,
            };
            decode(&bytes, format, encoding)
        };
        read().map_err(|kind| kind.at(path))
    }

    /// Reads an image from the content of a file. `hint` decides where the content does not tell its format.
    ///
    /// # Errors
    /// [`ImageError`] without a path, whatever the bytes.
    pub fn read_bytes(
        bytes: &[u8],
        hint: Option<Format>,
        encoding: Option<ColorEncoding>,
    ) -> Result<Image, ImageError> {
        let Some(format) = Format::from_magic(bytes).or(hint) else {
            let unknown = crate::UnknownFormat { suffix: String::new(), nearest: None };
            return Err(ImageErrorKind::from(unknown).into());
        };
        Ok(decode(bytes, format, encoding)?)
    }

    /// Writes the image to `path`, in the format that the suffix tells, by [`write_atomic`].
    ///
    /// PNG takes `R`, `G`, `B` (`A`) or a grey channel and encodes it as sRGB; HDR and PFM take the colour; EXR takes
    /// every channel and the metadata.
    ///
    /// # Errors
    /// [`ImageError`] with the path: an unknown or read-only format, a channel that the format cannot hold, or a fault
    /// of the file system. A file that was there before is then left as it was.
    pub fn write(&self, path: impl AsRef<Path>, options: &WriteOptions) -> Result<(), ImageError> {
        let path = path.as_ref();
        let write = || {
            let format = Format::from_path(path)?;
            check_writable(format)?;
            write_atomic(path, |writer| self.encode(format, options, writer))
        };
        write().map_err(|kind| kind.at(path))
    }

    /// The content of a file of `format` with this image.
    ///
    /// # Errors
    /// As [`Image::write`], without a path.
    pub fn to_bytes(&self, format: Format, options: &WriteOptions) -> Result<Vec<u8>, ImageError> {
        check_writable(format)?;
        let mut bytes = std::io::Cursor::new(Vec::new());
        self.encode(format, options, &mut bytes)?;
        Ok(bytes.into_inner())
    }

    fn encode(
        &self,
        format: Format,
        options: &WriteOptions,
        writer: &mut (impl Write + Seek),
    ) -> Result<(), ImageErrorKind> {
        match format {
            Format::Exr => exr_write::write(self, options.exr_pixels, writer),
            Format::Png => png::write(self, options.png_depth, writer),
            Format::Hdr => hdr::write(self, writer),
            Format::Pfm => pfm::write(self, writer),
            Format::Jpeg | Format::Tga | Format::Bmp => check_writable(format),
        }
    }
}

fn check_writable(format: Format) -> Result<(), ImageErrorKind> {
    if format.is_writable() {
        return Ok(());
    }
    Err(ImageErrorKind::unsupported(format, "files of this format are only read", ".exr, .png, .hdr or .pfm"))
}

fn decode(bytes: &[u8], format: Format, encoding: Option<ColorEncoding>) -> Result<Image, ImageErrorKind> {
    let encoding = encoding.unwrap_or(ColorEncoding::Srgb);
    // The EXR library panics on some damaged files; what a file holds is no fault of the program. Nothing outlives
    // the call that the panic could leave half done.
    catch_unwind(|| decode_as(bytes, format, encoding))
        .unwrap_or_else(|_| Err(ImageErrorKind::malformed(format, "the decoder failed on its content")))
}

fn decode_as(bytes: &[u8], format: Format, encoding: ColorEncoding) -> Result<Image, ImageErrorKind> {
    match format {
        Format::Exr => exr_read::read(bytes),
        Format::Png => png::read(bytes, encoding),
        Format::Hdr => hdr::read(bytes),
        Format::Pfm => pfm::read(bytes),
        Format::Jpeg | Format::Tga | Format::Bmp => raster::read(bytes, format, encoding),
    }
}

/// Refuses sizes that a file of `file_bytes` bytes cannot honestly claim, before memory is taken for them. No
/// compression in use packs pixels more than 65,536 times.
fn check_size(
    format: Format,
    width: u64,
    height: u64,
    bytes_per_pixel: u64,
    file_bytes: usize,
) -> Result<(), ImageErrorKind> {
    const RATIO: u64 = 1 << 16;
    let file_bytes = file_bytes as u64;
    let limit = file_bytes.saturating_mul(RATIO);
    let wanted = width.saturating_mul(height).saturating_mul(bytes_per_pixel);
    if wanted == 0 {
        return Err(ImageErrorKind::malformed(format, "the image has no pixels"));
    }
    if wanted > limit || width > u64::from(u32::MAX) || height > u64::from(u32::MAX) {
        return Err(ImageErrorKind::TooLarge { format, width, height, file_bytes, limit });
    }
    Ok(())
}
