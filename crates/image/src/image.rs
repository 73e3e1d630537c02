//! The pixel buffer.

use crate::encoding::{ColorEncoding, DecodeTable};
use crate::error::ImageErrorKind;
use crate::metadata::Metadata;
use half::f16;
use tenfold_math::Vec3;

/// A rectangle of pixels: rows from the top, pixels from the left, channels interleaved.
///
/// Width, height and the number of channels are at least one, and the names of the channels differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    channels: Vec<String>,
    data: PixelData,
    /// Channels that stand for red, green and blue; the same one three times in a grey image.
    rgb: [usize; 3],
    /// Channel of the opacity, which is never encoded.
    alpha: Option<usize>,
    /// What the file said besides the pixels.
    pub metadata: Metadata,
}

/// The stored values of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum PixelData {
    /// 8-bit codes and what they stand for. A channel named `A` is linear whatever the table says.
    U8(Vec<u8>, DecodeTable),
    /// Linear half floats.
    F16(Vec<f16>),
    /// Linear floats.
    F32(Vec<f32>),
}

impl PixelData {
    pub(crate) fn len(&self) -> usize {
        match self {
            PixelData::U8(v, _) => v.len(),
            PixelData::F16(v) => v.len(),
            PixelData::F32(v) => v.len(),
        }
    }
}

impl Image {
    /// An image of `width` × `height` pixels with the given channels (such as `["R", "G", "B"]`), from its values.
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where the number of values is not width × height × channels or is zero;
    /// [`ImageErrorKind::Channels`] where a name comes twice.
    pub fn new<S: Into<String>>(
        width: u32,
        height: u32,
        channels: impl IntoIterator<Item = S>,
        data: PixelData,
    ) -> Result<Self, ImageErrorKind> {
        let channels: Vec<String> = channels.into_iter().map(Into::into).collect();
        let expected =
            u64::from(width).saturating_mul(u64::from(height)).saturating_mul(channels.len() as u64);
        let found = data.len() as u64;
        if expected != found || found == 0 {
            return Err(ImageErrorKind::Size { width, height, channels: channels.len(), expected, found });
        }
        if channels.iter().enumerate().any(|(i, name)| channels[..i].contains(name)) {
            return Err(ImageErrorKind::Channels {
                found: channels,
                expected: "each of them once".to_owned(),
            });
        }
        let position = |name: &str| channels.iter().position(|c| c == name);
        let rgb = match (position("R"), position("G"), position("B")) {
            (Some(r), Some(g), Some(b)) => [r, g, b],
            _ => [position("Y").unwrap_or(0); 3],
        };
        let alpha = position("A");
        Ok(Self { width, height, channels, data, rgb, alpha, metadata: Metadata::default() })
    }

    /// An image of linear floats; see [`Image::new`].
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn from_f32<S: Into<String>>(
        width: u32,
        height: u32,
        channels: impl IntoIterator<Item = S>,
        values: Vec<f32>,
    ) -> Result<Self, ImageErrorKind> {
        Self::new(width, height, channels, PixelData::F32(values))
    }

    /// An image of 8-bit codes; see [`Image::new`].
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn from_u8<S: Into<String>>(
        width: u32,
        height: u32,
        channels: impl IntoIterator<Item = S>,
        codes: Vec<u8>,
        encoding: ColorEncoding,
    ) -> Result<Self, ImageErrorKind> {
        Self::new(width, height, channels, PixelData::U8(codes, DecodeTable::new(encoding)))
    }

    /// A single-channel (`Y`) or three-channel (`R`, `G`, `B`) float image from a function of the pixel (x, y).
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where a side is zero.
    pub fn from_fn<const N: usize>(
        width: u32,
        height: u32,
        channels: [&str; N],
        mut pixel: impl FnMut(u32, u32) -> [f32; N],
    ) -> Result<Self, ImageErrorKind> {
        let mut values = Vec::with_capacity(width as usize * height as usize * N);
        for y in 0..height {
            for x in 0..width {
                values.extend(pixel(x, y));
            }
        }
        Self::from_f32(width, height, channels, values)
    }

    /// Columns.
    #[inline]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[inline]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Columns and rows.
    #[inline]
    pub fn resolution(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Names of the channels, in the order they are stored.
    pub fn channels(&self) -> &[String] {
        &self.channels
    }

    /// Index of the channel called `name`.
    pub fn channel_index(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|c| c == name)
    }

    /// Whether red, green and blue are channels of their own.
    pub fn is_color(&self) -> bool {
        self.rgb[0] != self.rgb[1]
    }

    /// Channels that stand for red, green and blue: those of these names, or else three times `Y`, or else three
    /// times the first.
    pub fn rgb_channels(&self) -> [usize; 3] {
        self.rgb
    }

    /// Index of the opacity channel, `A`.
    pub fn alpha_channel(&self) -> Option<usize> {
        self.alpha
    }

    /// The stored values.
    pub fn data(&self) -> &PixelData {
        &self.data
    }

    /// The values where they are stored as linear floats.
    pub fn as_f32(&self) -> Option<&[f32]> {
        match &self.data {
            PixelData::F32(values) => Some(values),
            _ => None,
        }
    }

    pub(crate) fn data_mut(&mut self) -> &mut PixelData {
        &mut self.data
    }

    /// This image with other values, as many as it has.
    pub(crate) fn with_data(&self, data: PixelData) -> Image {
        debug_assert_eq!(data.len(), self.data.len());
        Image { channels: self.channels.clone(), metadata: self.metadata.clone(), data, ..*self }
    }

    /// Memory taken by the stored values, in bytes.
    pub fn bytes(&self) -> usize {
        match &self.data {
            PixelData::U8(v, _) => v.len(),
            PixelData::F16(v) => v.len() * 2,
            PixelData::F32(v) => v.len() * 4,
        }
    }

    /// Index of the first stored value of pixel (x, y).
    #[inline]
    pub(crate) fn offset(&self, x: u32, y: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.channels.len()
    }

    /// Linear value of channel `c` at pixel (x, y). Panics outside of the image.
    #[inline]
    pub fn get(&self, x: u32, y: u32, c: usize) -> f32 {
        assert!(x < self.width && c < self.channels.len(), "pixel ({x}, {y}), channel {c}");
        self.value(self.offset(x, y) + c, c)
    }

    /// Linear value stored at `index`, which belongs to channel `c`.
    #[inline]
    pub(crate) fn value(&self, index: usize, c: usize) -> f32 {
        match &self.data {
            PixelData::U8(v, _) if self.alpha == Some(c) => f32::from(v[index]) / 255.0,
            PixelData::U8(v, table) => table.decode(v[index]),
            PixelData::F16(v) => v[index].to_f32(),
            PixelData::F32(v) => v[index],
        }
    }

    /// Linear colour of pixel (x, y); grey images have three equal parts. Panics outside of the image.
    #[inline]
    pub fn rgb(&self, x: u32, y: u32) -> Vec3 {
        assert!(x < self.width, "pixel ({x}, {y})");
        let [r, g, b] = self.rgb;
        let o = self.offset(x, y);
        match &self.data {
            PixelData::U8(v, table) => {
                Vec3::new(table.decode(v[o + r]), table.decode(v[o + g]), table.decode(v[o + b]))
            }
            PixelData::F16(v) => Vec3::new(v[o + r].to_f32(), v[o + g].to_f32(), v[o + b].to_f32()),
            PixelData::F32(v) => Vec3::new(v[o + r], v[o + g], v[o + b]),
        }
    }

    /// Stores the linear value `v`, rounded to the image's format, in channel `c` of pixel (x, y). Panics outside
    /// of the image.
    pub fn set(&mut self, x: u32, y: u32, c: usize, v: f32) {
        assert!(x < self.width && c < self.channels.len(), "pixel ({x}, {y}), channel {c}");
        let index = self.offset(x, y) + c;
        let alpha = self.alpha == Some(c);
        match &mut self.data {
            PixelData::U8(codes, table) => {
                let encoding = if alpha { ColorEncoding::Linear } else { table.encoding() };
                codes[index] = encoding.encode_u8(v);
            }
            PixelData::F16(values) => values[index] = f16::from_f32(v),
            PixelData::F32(values) => values[index] = v,
        }
    }

    /// Mean of channel `c` over all pixels, summed in double precision. Panics where there is no such channel.
    pub fn mean(&self, c: usize) -> f64 {
        assert!(c < self.channels.len(), "channel {c}");
        let pixels = self.width as usize * self.height as usize;
        let sum: f64 = (0..pixels).map(|i| f64::from(self.value(i * self.channels.len() + c, c))).sum();
        sum / pixels as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_sizes_and_repeated_channels_are_refused() {
        assert!(matches!(
            Image::from_f32(2, 2, ["Y"], vec![0.0; 3]),
            Err(ImageErrorKind::Size { expected: 4, found: 3, .. })
        ));
        assert!(matches!(Image::from_f32(0, 2, ["Y"], vec![]), Err(ImageErrorKind::Size { .. })));
        assert!(matches!(
            Image::from_f32(1, 1, ["Y", "Y"], vec![0.0; 2]),
            Err(ImageErrorKind::Channels { .. })
        ));
    }

    #[test]
    fn opacity_is_never_encoded() {
        let image = Image::from_u8(1, 1, ["R", "G", "B", "A"], vec![128; 4], ColorEncoding::Srgb).unwrap();
        assert_eq!(image.get(0, 0, 0), crate::srgb_to_linear(128.0 / 255.0));
        assert_eq!(image.get(0, 0, 3), 128.0 / 255.0);
    }

    #[test]
    fn colour_is_found_by_name() {
        let image = Image::from_f32(1, 1, ["A", "B", "G", "R"], vec![0.1, 0.2, 0.3, 0.4]).unwrap();
        assert_eq!(image.rgb(0, 0), Vec3::new(0.4, 0.3, 0.2));
        let image = Image::from_f32(1, 1, ["A", "Y"], vec![0.1, 0.2]).unwrap();
        assert_eq!(image.rgb(0, 0), Vec3::splat(0.2));
        assert!(!image.is_color());
    }

    #[test]
    fn values_are_rounded_to_the_format() {
        let mut image = Image::from_u8(2, 1, ["Y"], vec![0; 2], ColorEncoding::Srgb).unwrap();
        image.set(1, 0, 0, 0.5);
        assert_eq!(image.data(), &PixelData::U8(vec![0, 188], DecodeTable::new(ColorEncoding::Srgb)));
        assert!((image.mean(0) - f64::from(image.get(1, 0, 0)) / 2.0).abs() < 1e-9);
    }
}
