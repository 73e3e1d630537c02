//! Radiance RGBE files.

use super::{check_size, raster::image_error};
use crate::error::ImageErrorKind;
use crate::format::Format;
use crate::image::Image;
use image::codecs::hdr::{HdrDecoder, HdrEncoder};
use image::{ImageDecoder, Rgb};
use std::io::{Cursor, Write};

pub(super) fn read(bytes: &[u8]) -> Result<Image, ImageErrorKind> {
    let fault = |e| image_error(Format::Hdr, e);
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(bytes)).map_err(fault)?;
    let meta = decoder.metadata();
    check_size(Format::Hdr, u64::from(meta.width), u64::from(meta.height), 12, bytes.len())?;
    let mut raw = vec![0; meta.width as usize * meta.height as usize * 12];
    decoder.read_image(&mut raw).map_err(fault)?;
    let values = raw.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect();
    Image::from_f32(meta.width, meta.height, ["R", "G", "B"], values)
}

pub(super) fn write(image: &Image, writer: &mut impl Write) -> Result<(), ImageErrorKind> {
    let (width, height) = image.resolution();
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            // The shared exponent can hold neither infinity nor NaN nor negative numbers.
            let part = |v: f32| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1e38) };
            let c = image.rgb(x, y);
            pixels.push(Rgb([part(c.x), part(c.y), part(c.z)]));
        }
    }
    HdrEncoder::new(writer)
        .encode(&pixels, width as usize, height as usize)
        .map_err(|e| image_error(Format::Hdr, e))
}
