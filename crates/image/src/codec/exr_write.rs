//! Writing OpenEXR files: one part, scan lines, ZIP compression.

use super::ExrPixels;
use super::exr_read::fault;
use crate::error::ImageErrorKind;
use crate::image::{Image, PixelData};
use crate::metadata::{Attribute, Window};
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Layer};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, Compression, IntegerBounds, LineOrder, Text};
use exr::meta::header::{ImageAttributes, LayerAttributes};
use half::f16;
use std::io::{Cursor, Seek, Write};

pub(super) fn write(
    image: &Image,
    pixels: ExrPixels,
    writer: &mut (impl Write + Seek),
) -> Result<(), ImageErrorKind> {
    let channels: Result<Vec<_>, _> =
        image.channels().iter().enumerate().map(|(c, name)| channel(image, c, name, pixels)).collect();
    let (width, height) = image.resolution();
    let origin = image.metadata.origin;
    let display = image.metadata.display_window.unwrap_or(Window { x: origin.0, y: origin.1, width, height });
    let mut attributes = ImageAttributes::new(IntegerBounds::new(
        Vec2(display.x, display.y),
        Vec2(display.width as usize, display.height as usize),
    ));
    attributes.chromaticities = image.metadata.chromaticities.map(|c| {
        let [red, green, blue, white] = c.map(|v| Vec2(v.x, v.y));
        Chromaticities { red, green, blue, white }
    });
    let mut layer_attributes = LayerAttributes::default().with_position(Vec2(origin.0, origin.1));
    for (name, value) in &image.metadata.attributes {
        set_attribute(&mut layer_attributes, name, value)?;
    }
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = Vec2(width as usize, height as usize);
    let layer = Layer::new(size, layer_attributes, encoding, AnyChannels::sort(channels?.into()));
    let file = exr::image::Image::new(attributes, layer);
    let mut bytes = Cursor::new(Vec::new());
    file.write().to_buffered(&mut bytes).map_err(fault)?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    writer.write_all(&bytes)?;
    Ok(())
}

fn text(name: &str, content: &str) -> Result<Text, ImageErrorKind> {
    Text::new_or_none(content).ok_or_else(|| ImageErrorKind::Attribute {
        name: name.to_owned(),
        why: format!("`{content}` has characters beyond Latin-1"),
    })
}

/// A text that ends in a zero byte in the file, and so has neither none nor too many characters nor a zero.
fn identifier(name: &str) -> Result<Text, ImageErrorKind> {
    if name.is_empty() || name.len() > 255 || name.contains('\0') {
        return Err(ImageErrorKind::Attribute {
            name: name.to_owned(),
            why: "names have 1 to 255 characters".to_owned(),
        });
    }
    text(name, name)
}

fn channel(
    image: &Image,
    c: usize,
    name: &str,
    pixels: ExrPixels,
) -> Result<AnyChannel<FlatSamples>, ImageErrorKind> {
    let stride = image.channels().len();
    let half = match pixels {
        ExrPixels::Half => !name.contains('.'),
        ExrPixels::Float => false,
    };
    let count = image.width() as usize * image.height() as usize;
    let values = (0..count).map(|i| image.value(i * stride + c, c));
    let samples = match image.data() {
        PixelData::F16(v) if half => FlatSamples::F16(v.iter().skip(c).step_by(stride).copied().collect()),
        _ if half => FlatSamples::F16(values.map(finite_half).collect()),
        _ => FlatSamples::F32(values.collect()),
    };
    let mut channel = AnyChannel::new(identifier(name)?, samples);
    channel.quantize_linearly = name == "A";
    Ok(channel)
}

/// The nearest half; finite numbers beyond its range become the largest one, not infinite.
fn finite_half(v: f32) -> f16 {
    if v.is_finite() { f16::from_f32(v.clamp(-65504.0, 65504.0)) } else { f16::from_f32(v) }
}

/// Stores an attribute: standard ones in their place, others as custom ones.
fn set_attribute(
    attributes: &mut LayerAttributes,
    name: &str,
    value: &Attribute,
) -> Result<(), ImageErrorKind> {
    match (name, value) {
        ("owner", Attribute::Text(v)) => attributes.owner = Some(text(name, v)?),
        ("comments", Attribute::Text(v)) => attributes.comments = Some(text(name, v)?),
        ("capDate", Attribute::Text(v)) => attributes.capture_date = Some(text(name, v)?),
        ("software", Attribute::Text(v)) => attributes.software_name = Some(text(name, v)?),
        ("wrapmodes", Attribute::Text(v)) => attributes.wrap_mode_name = Some(text(name, v)?),
        ("whiteLuminance", Attribute::F32(v)) => attributes.white_luminance = Some(*v),
        ("expTime", Attribute::F32(v)) => attributes.exposure = Some(*v),
        ("aperture", Attribute::F32(v)) => attributes.aperture = Some(*v),
        ("isoSpeed", Attribute::F32(v)) => attributes.iso_speed = Some(*v),
        ("focus", Attribute::F32(v)) => attributes.focus = Some(*v),
        ("worldToCamera", Attribute::Matrix(v)) => attributes.world_to_camera = Some(*v),
        ("worldToNDC", Attribute::Matrix(v)) => attributes.world_to_normalized_device = Some(*v),
        (_, value) => {
            if exr::meta::header::standard_names::ALL.contains(&name.as_bytes()) {
                return Err(ImageErrorKind::Attribute {
                    name: name.to_owned(),
                    why: "the name is reserved by the format for another kind of value".to_owned(),
                });
            }
            let value = match value {
                Attribute::Text(v) => AttributeValue::Text(text(name, v)?),
                Attribute::F32(v) => AttributeValue::F32(*v),
                Attribute::I32(v) => AttributeValue::I32(*v),
                Attribute::Matrix(v) => AttributeValue::Matrix4x4(*v),
                Attribute::TextList(v) => {
                    let list: Result<Vec<Text>, _> = v.iter().map(|s| text(name, s)).collect();
                    AttributeValue::TextVector(list?)
                }
            };
            attributes.other.insert(identifier(name)?, value);
        }
    }
    Ok(())
}

/// Sorts the attributes of a single-part file by name. The library keeps custom ones in a hash map of random order, and
/// equal images are to make equal files. The header's length stays, so no offset changes.
fn sort_attributes(file: &mut [u8]) {
    const START: usize = 8; // after the magic number and the version
    let Some((attributes, end)) = split_attributes(file, START) else { return };
    let mut sorted = attributes;
    sorted.sort();
    let header = sorted.concat();
    file[START..end].copy_from_slice(&header);
}

/// The attributes from `start` on (name, zero, kind, zero, length, value) and where they end; `None` if they are not
/// laid out so.
fn split_attributes(file: &[u8], start: usize) -> Option<(Vec<Vec<u8>>, usize)> {
    let text_end = |from: usize| Some(from + file.get(from..)?.iter().position(|&b| b == 0)? + 1);
    let mut attributes = Vec::new();
    let mut at = start;
    while *file.get(at)? != 0 {
        let length_at = text_end(text_end(at)?)?;
        let length = file.get(length_at..length_at + 4)?;
        let length = i32::from_le_bytes([length[0], length[1], length[2], length[3]]);
        let end = (length_at + 4).checked_add(usize::try_from(length).ok()?)?;
        attributes.push(file.get(at..end)?.to_vec());
        at = end;
    }
    Some((attributes, at))
}
