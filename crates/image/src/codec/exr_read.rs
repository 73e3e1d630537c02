//! Reading OpenEXR files: any compression, scan lines or tiles, one part or several.

use super::check_size;
use crate::error::ImageErrorKind;
use crate::format::Format;
use crate::image::{Image, PixelData};
use crate::metadata::{Attribute, Metadata, Window};
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::ChunksReader;
use exr::error::Error;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Compression, SampleType, Text};
use exr::meta::header::Header;
use half::f16;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::io::Cursor;
use tenfold_math::Vec2;

pub(super) fn read(bytes: &[u8]) -> Result<Image, ImageErrorKind> {
    // Ahead of the library's own checks, which are less precise.
    for header in &MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?.headers {
        check_header(header, bytes.len())?;
    }
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(fault)?;
    // The largest in rank wins; of equals the first.
    let ranked = reader.headers().iter().enumerate().rev().max_by_key(|(_, h)| main_part_rank(&names(h)));
    let Some((part, header)) = ranked else {
        return Err(ImageErrorKind::malformed(Format::Exr, "the file has no parts"));
    };
    let header = header.clone();
    let mut pixels = Pixels::new(&header);
    let chunks = reader
        .filter_chunks(false, |_, tile, block| {
            block.layer == part && tile.level_index == exr::math::Vec2(0, 0)
        })
        .map_err(fault)?;
    let meta = chunks.meta_data().clone();
    let mut chunks = chunks.into_iter();
    loop {
        // Some at a time, to hold neither all packed nor all unpacked blocks in memory at once.
        let batch: Vec<Chunk> = chunks.by_ref().take(256).collect::<Result<_, _>>().map_err(fault)?;
        if batch.is_empty() {
            break;
        }
        batch.iter().try_for_each(|chunk| check_chunk(&header, chunk))?;
        let unpack = |chunk| UncompressedBlock::decompress_chunk(chunk, &meta, false);
        let blocks: Result<Vec<_>, Error> = batch.into_par_iter().map(unpack).collect();
        for block in blocks.map_err(fault)? {
            pixels.place(&header, &block)?;
        }
    }
    let (channels, data) = pixels.finish()?;
    let mut image = Image::new(header.layer_size.0 as u32, header.layer_size.1 as u32, channels, data)?;
    image.metadata = metadata(&header);
    Ok(image)
}

pub(super) fn fault(error: Error) -> ImageErrorKind {
    match error {
        Error::Io(e) => ImageErrorKind::Io(e),
        Error::NotSupported(what) => {
            ImageErrorKind::unsupported(Format::Exr, what, "flat scan lines or tiles")
        }
        Error::Invalid(what) => ImageErrorKind::malformed(Format::Exr, what),
        Error::Aborted => ImageErrorKind::malformed(Format::Exr, "reading was cancelled"),
    }
}

/// Refuses what the decoder cannot do or should not try.
fn check_header(header: &Header, file_bytes: usize) -> Result<(), ImageErrorKind> {
    if header.deep {
        return Err(ImageErrorKind::unsupported(Format::Exr, "deep pixels", "flat ones"));
    }
    let channels = &header.channels.list;
    if let Some(c) = channels.iter().find(|c| c.sampling != exr::math::Vec2(1, 1)) {
        return Err(ImageErrorKind::unsupported(
            Format::Exr,
            format_args!("the subsampled channel {}", c.name),
            "all channels at full resolution",
        ));
    }
    let bytes_per_pixel: usize = channels.iter().map(|c| c.sample_type.bytes_per_sample()).sum();
    let exr::math::Vec2(width, height) = header.layer_size;
    check_size(Format::Exr, width as u64, height as u64, bytes_per_pixel as u64, file_bytes)
}

/// Refuses DWA blocks that claim to unpack to far more than their pixels, which the library would take memory for.
fn check_chunk(header: &Header, chunk: &Chunk) -> Result<(), ImageErrorKind> {
    let packed = match (&chunk.compressed_block, header.compression) {
        (CompressedBlock::ScanLine(block), Compression::DWAA(_) | Compression::DWAB(_)) => {
            &block.compressed_pixels_le
        }
        (CompressedBlock::Tile(block), Compression::DWAA(_) | Compression::DWAB(_)) => {
            &block.compressed_pixels_le
        }
        _ => return Ok(()),
    };
    let tile = header.get_block_data_indices(&chunk.compressed_block).map_err(fault)?;
    let area = header.get_absolute_block_pixel_coordinates(tile).map_err(fault)?.size.area();
    let unpacked = area.saturating_mul(header.channels.bytes_per_pixel);
    if packed.len() == unpacked {
        // Not packed at all.
        return Ok(());
    }
    // The block begins with eleven 64-bit counts of bytes and values.
    let counts = packed.chunks_exact(8).take(11);
    let mut counts = counts.map(|b| u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]));
    let limit = (unpacked as u64).saturating_mul(4).saturating_add(65_536);
    if counts.any(|count| count > limit) {
        return Err(ImageErrorKind::malformed(Format::Exr, "a block claims more pixels than it has"));
    }
    Ok(())
}

fn names(header: &Header) -> Vec<String> {
    header.channels.list.iter().map(|c| c.name.to_string()).collect()
}

/// How much a part looks like the picture itself.
fn main_part_rank(names: &[String]) -> u32 {
    let has = |name: &str| names.iter().any(|n| n == name);
    if has("R") && has("G") && has("B") {
        3
    } else if has("Y") {
        2
    } else if color_prefix(names).is_some() {
        1
    } else {
        0
    }
}

/// The prefix, dot included, of the channels that hold the picture in a part whose channels all have one: that of the
/// only `….R`, or the one with a customary name.
fn color_prefix(names: &[String]) -> Option<&str> {
    const CUSTOMARY: [&str; 6] = ["rgba", "rgb", "combined", "composite", "beauty", "color"];
    let is_color = |prefix: &&str| ["G", "B"].iter().all(|c| names.contains(&format!("{prefix}{c}")));
    let ends = names.iter().filter(|n| n.ends_with(".R")).map(|n| &n[..n.len() - 1]);
    let prefixes: Vec<&str> = ends.filter(is_color).collect();
    let customary = |prefix: &&&str| {
        let last = prefix.trim_end_matches('.').rsplit('.').next().unwrap_or_default();
        CUSTOMARY.contains(&last.to_lowercase().as_str())
    };
    match prefixes.as_slice() {
        [only] => Some(only),
        several => several.iter().find(customary).copied(),
    }
}

/// The pixels of a part, filled block by block.
struct Pixels {
    names: Vec<String>,
    /// Where each channel of the file goes, and what it is there.
    places: Vec<(usize, SampleType)>,
    data: PixelData,
    resolution: (usize, usize),
    missing: usize,
}

impl Pixels {
    /// All zero, with the colour channels first. Halves stay halves where all channels are.
    fn new(header: &Header) -> Self {
        const ORDER: [&str; 5] = ["R", "G", "B", "Y", "A"];
        let originals = names(header);
        let prefix = if main_part_rank(&originals) >= 2 { None } else { color_prefix(&originals) };
        let rename = |name: &String| match prefix.and_then(|p| name.strip_prefix(p)) {
            Some(stem) if ORDER.contains(&stem) => stem.to_owned(),
            _ => name.clone(),
        };
        let rank = |name: &str| ORDER.iter().position(|&o| o == name).unwrap_or(ORDER.len());
        let mut order: Vec<(String, usize)> = originals.iter().map(rename).zip(0..).collect();
        order.sort_by(|(a, _), (b, _)| rank(a).cmp(&rank(b)).then_with(|| a.cmp(b)));
        let mut places: Vec<_> = header.channels.list.iter().map(|c| (0, c.sample_type)).collect();
        for (place, &(_, channel)) in order.iter().enumerate() {
            places[channel].0 = place;
        }
        let exr::math::Vec2(width, height) = header.layer_size;
        let count = width * height * places.len();
        let data = if places.iter().all(|(_, kind)| *kind == SampleType::F16) {
            PixelData::F16(vec![f16::ZERO; count])
        } else {
            PixelData::F32(vec![0.0; count])
        };
        let names = order.into_iter().map(|(name, _)| name).collect();
        Self { names, places, data, resolution: (width, height), missing: count }
    }

    fn place(&mut self, header: &Header, block: &UncompressedBlock) -> Result<(), ImageErrorKind> {
        let stride = self.places.len();
        for line in block.lines(&header.channels) {
            let exr::math::Vec2(x, y) = line.location.position;
            let count = line.location.sample_count;
            let (width, height) = self.resolution;
            let inside = x.checked_add(count).is_some_and(|end| end <= width) && y < height;
            if !inside || line.location.level != exr::math::Vec2(0, 0) {
                return Err(ImageErrorKind::malformed(Format::Exr, "a block lies outside of the image"));
            }
            let (place, kind) = self.places[line.location.channel];
            let start = (y * width + x) * stride + place;
            match &mut self.data {
                PixelData::F16(values) => {
                    let slots = values[start..].iter_mut().step_by(stride).take(count);
                    for (slot, b) in slots.zip(line.value.chunks_exact(2)) {
                        *slot = f16::from_ne_bytes([b[0], b[1]]);
                    }
                }
                PixelData::F32(values) => {
                    let slots = values[start..].iter_mut().step_by(stride).take(count);
                    let word = |b: &[u8]| [b[0], b[1], b[2], b[3]];
                    let samples = line.value.chunks_exact(kind.bytes_per_sample());
                    for (slot, b) in slots.zip(samples) {
                        *slot = match kind {
                            SampleType::F16 => f16::from_ne_bytes([b[0], b[1]]).to_f32(),
                            SampleType::F32 => f32::from_ne_bytes(word(b)),
                            SampleType::U32 => u32::from_ne_bytes(word(b)) as f32,
                        };
                    }
                }
                PixelData::U8(..) => {}
            }
            self.missing = self.missing.saturating_sub(count);
        }
        Ok(())
    }

    fn finish(self) -> Result<(Vec<String>, PixelData), ImageErrorKind> {
        if self.missing == 0 {
            return Ok((self.names, self.data));
        }
        let what = format_args!("{} of {} values are missing", self.missing, self.data.len());
        Err(ImageErrorKind::malformed(Format::Exr, what))
    }
}

fn metadata(header: &Header) -> Metadata {
    let origin = header.own_attributes.layer_position;
    let display = header.shared_attributes.display_window;
    let size = header.layer_size;
    let window = Window {
        x: display.position.0,
        y: display.position.1,
        width: display.size.0 as u32,
        height: display.size.1 as u32,
    };
    let whole = Window { x: origin.0, y: origin.1, width: size.0 as u32, height: size.1 as u32 };
    let chromaticities = header
        .shared_attributes
        .chromaticities
        .map(|c| [c.red, c.green, c.blue, c.white].map(|exr::math::Vec2(x, y)| Vec2::new(x, y)));
    Metadata {
        chromaticities,
        origin: (origin.0, origin.1),
        display_window: (window != whole).then_some(window),
        attributes: attributes(header),
    }
}

/// The attributes of kinds that we know, standard or custom.
fn attributes(header: &Header) -> BTreeMap<String, Attribute> {
    let mut found = BTreeMap::new();
    let custom = header.shared_attributes.other.iter().chain(&header.own_attributes.other);
    for (name, value) in custom {
        let value = match value {
            AttributeValue::Text(v) => Attribute::Text(v.to_string()),
            AttributeValue::F32(v) => Attribute::F32(*v),
            AttributeValue::F64(v) => Attribute::F32(*v as f32),
            AttributeValue::I32(v) => Attribute::I32(*v),
            AttributeValue::Matrix4x4(v) => Attribute::Matrix(*v),
            AttributeValue::TextVector(v) => Attribute::TextList(v.iter().map(Text::to_string).collect()),
            _ => continue,
        };
        found.insert(name.to_string(), value);
    }
    let a = &header.own_attributes;
    let texts = [
        ("owner", &a.owner),
        ("comments", &a.comments),
        ("capDate", &a.capture_date),
        ("software", &a.software_name),
        ("wrapmodes", &a.wrap_mode_name),
    ];
    for (name, value) in texts {
        if let Some(value) = value {
            found.insert(name.to_owned(), Attribute::Text(value.to_string()));
        }
    }
    let numbers = [
        ("whiteLuminance", a.white_luminance),
        ("expTime", a.exposure),
        ("aperture", a.aperture),
        ("isoSpeed", a.iso_speed),
        ("focus", a.focus),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            found.insert(name.to_owned(), Attribute::F32(value));
        }
    }
    let matrices = [("worldToCamera", a.world_to_camera), ("worldToNDC", a.world_to_normalized_device)];
    for (name, value) in matrices {
        if let Some(value) = value {
            found.insert(name.to_owned(), Attribute::Matrix(value));
        }
    }
    found
}
