//! Formats of 8-bit and 16-bit pixels that are only read: JPEG, TGA, BMP.

use super::check_size;
use crate::encoding::ColorEncoding;
use crate::error::ImageErrorKind;
use crate::format::Format;
use crate::image::Image;
use image::codecs::{bmp::BmpDecoder, jpeg::JpegDecoder, tga::TgaDecoder};
use image::{ColorType, ImageDecoder, ImageError};
use std::io::Cursor;

/// The fault of the codec library, as ours.
pub(super) fn image_error(format: Format, error: ImageError) -> ImageErrorKind {
    match error {
        ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            ImageErrorKind::malformed(format, "the file ends early")
        }
        ImageError::IoError(e) => ImageErrorKind::Io(e),
        ImageError::Unsupported(e) => ImageErrorKind::unsupported(format, e, "a common variant"),
        other => ImageErrorKind::malformed(format, other),
    }
}

pub(super) fn read(bytes: &[u8], format: Format, encoding: ColorEncoding) -> Result<Image, ImageErrorKind> {
    let fault = |e| image_error(format, e);
    let cursor = Cursor::new(bytes);
    match format {
        Format::Jpeg => decode(JpegDecoder::new(cursor).map_err(fault)?, bytes.len(), format, encoding),
        Format::Tga => decode(TgaDecoder::new(cursor).map_err(fault)?, bytes.len(), format, encoding),
        Format::Bmp => decode(BmpDecoder::new(cursor).map_err(fault)?, bytes.len(), format, encoding),
        Format::Exr | Format::Png | Format::Hdr | Format::Pfm => {
            Err(ImageErrorKind::unsupported(format, "not a plain raster", "JPEG, TGA or BMP"))
        }
    }
}

fn decode(
    decoder: impl ImageDecoder,
    file_bytes: usize,
    format: Format,
    encoding: ColorEncoding,
) -> Result<Image, ImageErrorKind> {
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    check_size(format, u64::from(width), u64::from(height), u64::from(color.bytes_per_pixel()), file_bytes)?;
    let channels: &[&str] = match color {
        ColorType::L8 => &["Y"],
        ColorType::La8 => &["Y", "A"],
        ColorType::Rgb8 => &["R", "G", "B"],
        ColorType::Rgba8 => &["R", "G", "B", "A"],
        other => {
            return Err(ImageErrorKind::unsupported(
                format,
                format_args!("pixels of kind {other:?}"),
                "8 bits a channel",
            ));
        }
    };
    let mut codes = vec![0; width as usize * height as usize * channels.len()];
    decoder.read_image(&mut codes).map_err(|e| image_error(format, e))?;
    Image::from_u8(width, height, channels.iter().copied(), codes, encoding)
}
