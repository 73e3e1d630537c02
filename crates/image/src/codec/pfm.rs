//! Portable float maps (Paul Debevec's format): a text header, then floats, rows from the bottom.

use super::check_size;
use crate::error::ImageErrorKind;
use crate::format::Format;
use crate::image::Image;
use std::io::Write;

/// Splits the next word off; it must be followed by one character of white space.
fn word<'a>(bytes: &mut &'a [u8]) -> Result<&'a str, ImageErrorKind> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace());
    let trimmed = &bytes[start.unwrap_or(bytes.len())..];
    // Longer words than any number has are not worth searching for the end.
    let end = trimmed.iter().take(64).position(|b| b.is_ascii_whitespace());
    let word = end.and_then(|end| std::str::from_utf8(&trimmed[..end]).ok());
    let word = word.ok_or_else(|| ImageErrorKind::malformed(Format::Pfm, "the header is incomplete"))?;
    *bytes = &trimmed[word.len() + 1..];
    Ok(word)
}

fn number<T: std::str::FromStr>(bytes: &mut &[u8], what: &str) -> Result<T, ImageErrorKind> {
    let word = word(bytes)?;
    word.parse().map_err(|_| ImageErrorKind::malformed(Format::Pfm, format_args!("`{word}` is not a {what}")))
}

pub(super) fn read(bytes: &[u8]) -> Result<Image, ImageErrorKind> {
    let mut rest = bytes;
    let channels: &[&str] = match word(&mut rest)? {
        "PF" => &["R", "G", "B"],
        "Pf" => &["Y"],
        other => {
            return Err(ImageErrorKind::malformed(
                Format::Pfm,
                format_args!("`{other}` is not `PF` or `Pf`"),
            ));
        }
    };
    let width: u32 = number(&mut rest, "width")?;
    let height: u32 = number(&mut rest, "height")?;
    let scale: f32 = number(&mut rest, "scale")?;
    if !scale.is_finite() || scale == 0.0 {
        return Err(ImageErrorKind::malformed(Format::Pfm, format_args!("the scale is {scale}")));
    }
    let bytes_per_pixel = channels.len() as u64 * 4;
    check_size(Format::Pfm, u64::from(width), u64::from(height), bytes_per_pixel, bytes.len())?;
    let count = width as usize * height as usize * channels.len();
    if rest.len() < count * 4 {
        return Err(ImageErrorKind::malformed(
            Format::Pfm,
            format_args!("the file ends after {} of {} bytes of pixels", rest.len(), count * 4),
        ));
    }
    // The sign of the scale tells the byte order, its size the unit.
    let decode = |b: [u8; 4]| {
        let value = if scale < 0.0 { f32::from_le_bytes(b) } else { f32::from_be_bytes(b) };
        value * scale.abs()
    };
    let values = rest[..count * 4].chunks_exact(4).map(|b| decode([b[0], b[1], b[2], b[3]])).collect();
    let mut image = Image::from_f32(width, height, channels.iter().copied(), values)?;
    image.flip_vertical();
    Ok(image)
}

pub(super) fn write(image: &Image, writer: &mut impl Write) -> Result<(), ImageErrorKind> {
    let (width, height) = image.resolution();
    let kind = if image.is_color() { "PF" } else { "Pf" };
    write!(writer, "{kind}\n{width} {height}\n-1\n")?;
    for y in (0..height).rev() {
        for x in 0..width {
            let rgb = image.rgb(x, y).to_array();
            for v in &rgb[..if image.is_color() { 3 } else { 1 }] {
                writer.write_all(&v.to_le_bytes())?;
            }
        }
    }
    Ok(())
}
