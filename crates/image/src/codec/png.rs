//! PNG files.

use super::{PngDepth, check_size};
use crate::dither::quantize;
use crate::encoding::ColorEncoding;
use crate::error::ImageErrorKind;
use crate::format::Format;
use crate::image::{Image, PixelData};
use crate::metadata::Chromaticities;
use png::{BitDepth, ColorType, DecodingError, EncodingError, ScaledFloat, Transformations};
use std::io::{Cursor, Write};

fn channels_of(color: ColorType) -> &'static [&'static str] {
    match color {
        ColorType::Grayscale => &["Y"],
        ColorType::GrayscaleAlpha => &["Y", "A"],
        // Palettes are expanded before this is asked.
        ColorType::Rgb | ColorType::Indexed => &["R", "G", "B"],
        ColorType::Rgba => &["R", "G", "B", "A"],
    }
}

fn fault(error: DecodingError) -> ImageErrorKind {
    match error {
        DecodingError::IoError(e) if e.kind() != std::io::ErrorKind::UnexpectedEof => ImageErrorKind::Io(e),
        DecodingError::IoError(_) => ImageErrorKind::malformed(Format::Png, "the file ends early"),
        other => ImageErrorKind::malformed(Format::Png, other),
    }
}

/// Reads 8 bits and fewer as codes of `encoding`; 16 bits become linear floats by it.
pub(super) fn read(bytes: &[u8], encoding: ColorEncoding) -> Result<Image, ImageErrorKind> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(fault)?;
    let (width, height) = header.size();
    check_size(Format::Png, u64::from(width), u64::from(height), 8, bytes.len())?;
    // The library's limit counts whole rows against a fixed allowance that wide images exceed.
    decoder.set_limits(png::Limits { bytes: 1 << 30 });
    let mut reader = decoder.read_info().map_err(fault)?;
    let size = reader.output_buffer_size();
    let size = size.ok_or_else(|| ImageErrorKind::malformed(Format::Png, "the size overflows"))?;
    let mut raw = vec![0; size];
    let info = reader.next_frame(&mut raw).map_err(fault)?;
    raw.truncate(info.buffer_size());
    let names = channels_of(info.color_type);
    let channels = names.iter().copied();
    match info.bit_depth {
        BitDepth::Sixteen => {
            let values = raw.chunks_exact(2).enumerate().map(|(i, b)| {
                let v = f32::from(u16::from_be_bytes([b[0], b[1]])) / 65535.0;
                if names[i % names.len()] == "A" { v } else { encoding.decode(v) }
            });
            Image::from_f32(width, height, channels, values.collect())
        }
        BitDepth::One | BitDepth::Two | BitDepth::Four | BitDepth::Eight => {
            Image::from_u8(width, height, channels, raw, encoding)
        }
    }
}

/// The channels to write, with the colour type they make.
fn layout(image: &Image) -> (ColorType, Vec<usize>) {
    let [r, g, b] = image.rgb_channels();
    match (image.is_color(), image.alpha_channel()) {
        (true, Some(a)) => (ColorType::Rgba, vec![r, g, b, a]),
        (true, None) => (ColorType::Rgb, vec![r, g, b]),
        (false, Some(a)) if a != r => (ColorType::GrayscaleAlpha, vec![r, a]),
        (false, _) => (ColorType::Grayscale, vec![r]),
    }
}

pub(super) fn write(image: &Image, depth: PngDepth, writer: &mut impl Write) -> Result<(), ImageErrorKind> {
    let (color, picked) = layout(image);
    let mut bytes = Vec::new();
    for y in 0..image.height() {
        for x in 0..image.width() {
            for (channel, &c) in (0..).zip(&picked) {
                match (depth, image.data()) {
                    (PngDepth::Eight, PixelData::U8(codes, table))
                        if table.encoding() == ColorEncoding::Srgb || image.alpha_channel() == Some(c) =>
                    {
                        bytes.push(codes[image.offset(x, y) + c]);
                    }
                    (PngDepth::Eight, _) => {
                        bytes.push(quantize(encoded(image, x, y, c), 255.0, x, y, channel) as u8);
                    }
                    (PngDepth::Sixteen, _) => {
                        let code = (encoded(image, x, y, c) * 65535.0).round() as u16;
                        bytes.extend(code.to_be_bytes());
                    }
                }
            }
        }
    }
    let mut encoder = png::Encoder::new(writer, image.width(), image.height());
    encoder.set_color(color);
    encoder.set_depth(match depth {
        PngDepth::Eight => BitDepth::Eight,
        PngDepth::Sixteen => BitDepth::Sixteen,
    });
    match image.metadata.chromaticities {
        None => encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric),
        Some(chromaticities) => {
            // The curve is still that of sRGB; 1/2.2 is the nearest that a gAMA chunk can say.
            encoder.set_source_gamma(ScaledFloat::new(1.0 / 2.2));
            encoder.set_source_chromaticities(source_chromaticities(chromaticities));
        }
    }
    let fault = |e| match e {
        EncodingError::IoError(e) => ImageErrorKind::Io(e),
        other => ImageErrorKind::unsupported(Format::Png, other, "an image that PNG can hold"),
    };
    let mut writer = encoder.write_header().map_err(fault)?;
    writer.write_image_data(&bytes).map_err(fault)?;
    writer.finish().map_err(fault)
}

/// The value as a fraction of the largest code.
fn encoded(image: &Image, x: u32, y: u32, c: usize) -> f32 {
    let encoding = if image.alpha_channel() == Some(c) { ColorEncoding::Linear } else { ColorEncoding::Srgb };
    encoding.encode(image.get(x, y, c))
}

fn source_chromaticities([r, g, b, w]: Chromaticities) -> png::SourceChromaticities {
    png::SourceChromaticities::new((w.x, w.y), (r.x, r.y), (g.x, g.y), (b.x, b.y))
}
