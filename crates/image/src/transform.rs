//! Images made of images: parts, mirrors, other formats.

use crate::encoding::{ColorEncoding, DecodeTable, EncodeTable};
use crate::error::ImageErrorKind;
use crate::image::{Image, PixelData};
use half::f16;
use rayon::prelude::*;

/// The values at `indices`, in their order.
fn gather<T: Copy>(values: &[T], indices: impl Iterator<Item = usize>) -> Vec<T> {
    indices.map(|i| values[i]).collect()
}

impl Image {
    /// The image whose stored values are those of `self` at `indices`.
    fn gathered(
        &self,
        width: u32,
        height: u32,
        channels: &[String],
        indices: impl Iterator<Item = usize>,
    ) -> Result<Image, ImageErrorKind> {
        let data = match self.data() {
            PixelData::U8(v, table) => PixelData::U8(gather(v, indices), table.clone()),
            PixelData::F16(v) => PixelData::F16(gather(v, indices)),
            PixelData::F32(v) => PixelData::F32(gather(v, indices)),
        };
        let mut image = Image::new(width, height, channels, data)?;
        image.metadata = self.metadata.clone();
        Ok(image)
    }

    /// The channels of these names, in this order.
    ///
    /// # Errors
    /// [`ImageErrorKind::Channels`] where one is missing or named twice.
    pub fn select(&self, names: &[&str]) -> Result<Image, ImageErrorKind> {
        let picked: Option<Vec<usize>> = names.iter().map(|name| self.channel_index(name)).collect();
        let Some(picked) = picked else {
            return Err(ImageErrorKind::Channels {
                found: self.channels().to_vec(),
                expected: names.join(", "),
            });
        };
        let (stride, pixels) = (self.channels().len(), self.width() as usize * self.height() as usize);
        let names: Vec<String> = names.iter().map(|&n| n.to_owned()).collect();
        let indices = (0..pixels).flat_map(|i| picked.iter().map(move |c| i * stride + c));
        self.gathered(self.width(), self.height(), &names, indices)
    }

    /// The channels that a texture looks at: `R`, `G`, `B` and, where it is not one everywhere, `A`; or the single
    /// channel of a grey image (`Y`, or the only one), without its opacity.
    ///
    /// # Errors
    /// [`ImageErrorKind::Channels`] where the image has neither.
    pub fn into_texture(self) -> Result<Image, ImageErrorKind> {
        let names = if self.is_color() {
            let pixels = self.width() as usize * self.height() as usize;
            let stride = self.channels().len();
            match self.alpha_channel() {
                Some(a) if (0..pixels).any(|i| self.value(i * stride + a, a) != 1.0) => {
                    vec!["R", "G", "B", "A"]
                }
                _ => vec!["R", "G", "B"],
            }
        } else if self.channel_index("Y").is_some() {
            vec!["Y"]
        } else if self.channels().len() == 1 {
            return Ok(self);
        } else {
            return Err(ImageErrorKind::Channels {
                found: self.channels().to_vec(),
                expected: "R, G and B, or Y, or a single one".to_owned(),
            });
        };
        if self.channels() == names { Ok(self) } else { self.select(&names) }
    }

    /// The part of `width` × `height` pixels whose top left corner is (x, y). The metadata keep the place of the
    /// part in the whole.
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where the part is empty or reaches beyond the image.
    pub fn crop(&self, x: u32, y: u32, width: u32, height: u32) -> Result<Image, ImageErrorKind> {
        let inside =
            |start: u32, length: u32, whole: u32| start.checked_add(length).is_some_and(|e| e <= whole);
        if !inside(x, width, self.width()) || !inside(y, height, self.height()) {
            return Err(ImageErrorKind::Size {
                width: self.width(),
                height: self.height(),
                channels: self.channels().len(),
                expected: u64::from(self.width()) * u64::from(self.height()),
                found: (u64::from(x) + u64::from(width)) * (u64::from(y) + u64::from(height)),
            });
        }
        let row = width as usize * self.channels().len();
        let indices = (y..y + height).flat_map(|y| {
            let start = self.offset(x, y);
            start..start + row
        });
        let mut part = self.gathered(width, height, self.channels(), indices)?;
        let origin = self.metadata.origin;
        part.metadata.display_window.get_or_insert(crate::Window {
            x: origin.0,
            y: origin.1,
            width: self.width(),
            height: self.height(),
        });
        part.metadata.origin = (origin.0.saturating_add_unsigned(x), origin.1.saturating_add_unsigned(y));
        Ok(part)
    }

    /// The image upside down.
    pub fn flip_vertical(&mut self) {
        fn flip<T>(values: &mut [T], row: usize) {
            let rows = values.len() / row;
            for y in 0..rows / 2 {
                let (top, bottom) = values.split_at_mut((rows - 1 - y) * row);
                top[y * row..(y + 1) * row].swap_with_slice(&mut bottom[..row]);
            }
        }
        let row = self.width() as usize * self.channels().len();
        match self.data_mut() {
            PixelData::U8(v, _) => flip(v, row),
            PixelData::F16(v) => flip(v, row),
            PixelData::F32(v) => flip(v, row),
        }
    }

    /// The image with left and right exchanged.
    pub fn flip_horizontal(&mut self) {
        fn flip<T>(values: &mut [T], row: usize, pixel: usize) {
            for row in values.chunks_exact_mut(row) {
                row.reverse();
                // Reversing also turned the channels of each pixel around.
                row.chunks_exact_mut(pixel).for_each(<[T]>::reverse);
            }
        }
        let pixel = self.channels().len();
        let row = self.width() as usize * pixel;
        match self.data_mut() {
            PixelData::U8(v, _) => flip(v, row, pixel),
            PixelData::F16(v) => flip(v, row, pixel),
            PixelData::F32(v) => flip(v, row, pixel),
        }
    }

    /// The image with linear float values.
    pub fn to_f32(&self) -> Image {
        self.with_data(PixelData::F32(self.mapped(|v, _| v)))
    }

    /// The image with half float values.
    pub fn to_f16(&self) -> Image {
        self.with_data(PixelData::F16(self.mapped(|v, _| f16::from_f32(v))))
    }

    /// The image with 8-bit codes, each the nearest to its value. Opacity is encoded linearly.
    pub fn to_u8(&self, encoding: ColorEncoding) -> Image {
        /// As many values as it takes to make up for the table.
        const MANY: usize = 1 << 16;
        let alpha = self.alpha_channel();
        let many = self.width() as usize * self.height() as usize * self.channels().len() >= MANY;
        let table = many.then(|| EncodeTable::new(encoding));
        let codes = self.mapped(|v, channel| match &table {
            _ if alpha == Some(channel) => ColorEncoding::Linear.encode_u8(v),
            Some(table) => table.encode(v),
            None => encoding.encode_u8(v),
        });
        self.with_data(PixelData::U8(codes, DecodeTable::new(encoding)))
    }

    /// What `map` makes of every value and the number of its channel, computed by all threads.
    fn mapped<T: Send>(&self, map: impl Fn(f32, usize) -> T + Send + Sync) -> Vec<T> {
        let channels = self.channels().len();
        let count = self.width() as usize * self.height() as usize * channels;
        let value = |i: usize| map(self.value(i, i % channels), i % channels);
        (0..count).into_par_iter().with_min_len(1 << 14).map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered() -> Image {
        Image::from_fn(3, 2, ["R", "G"], |x, y| [(y * 3 + x) as f32, -((y * 3 + x) as f32)]).unwrap()
    }

    #[test]
    fn channels_are_selected_in_order() {
        let image = numbered().select(&["G", "R"]).unwrap();
        assert_eq!(image.channels(), ["G", "R"]);
        assert_eq!((image.get(1, 1, 0), image.get(1, 1, 1)), (-4.0, 4.0));
        let e = numbered().select(&["R", "B"]).unwrap_err();
        assert_eq!(e.to_string(), "the image has the channels R, G (expected R, B)");
    }

    #[test]
    fn crops_keep_their_place() {
        let part = numbered().crop(1, 1, 2, 1).unwrap();
        assert_eq!(part.as_f32().unwrap(), [4.0, -4.0, 5.0, -5.0]);
        assert_eq!(part.metadata.origin, (1, 1));
        assert_eq!(part.metadata.display_window, Some(crate::Window { x: 0, y: 0, width: 3, height: 2 }));
        assert!(numbered().crop(1, 1, 3, 1).is_err());
        assert!(numbered().crop(u32::MAX, 0, 2, 1).is_err());
        assert!(numbered().crop(0, 0, 0, 1).is_err());
    }

    #[test]
    fn flips() {
        let mut image = numbered();
        image.flip_vertical();
        assert_eq!((image.get(0, 0, 0), image.get(2, 1, 1)), (3.0, -2.0));
        image.flip_horizontal();
        assert_eq!((image.get(0, 0, 0), image.get(0, 0, 1), image.get(2, 1, 1)), (5.0, -5.0, 0.0));
    }

    #[test]
    fn textures_drop_opacity_of_one() {
        let rgba = |a: f32| Image::from_f32(1, 1, ["R", "G", "B", "A"], vec![0.1, 0.2, 0.3, a]).unwrap();
        assert_eq!(rgba(1.0).into_texture().unwrap().channels(), ["R", "G", "B"]);
        assert_eq!(rgba(0.5).into_texture().unwrap().channels(), ["R", "G", "B", "A"]);
        let grey = Image::from_f32(1, 1, ["Y", "A"], vec![0.1, 0.2]).unwrap();
        assert_eq!(grey.into_texture().unwrap().channels(), ["Y"]);
        assert!(numbered().into_texture().is_err());
    }

    #[test]
    fn formats_convert() {
        let image = Image::from_f32(1, 1, ["Y", "A"], vec![0.5, 0.5]).unwrap();
        assert_eq!(image.to_f16().get(0, 0, 0), 0.5);
        let codes = image.to_u8(ColorEncoding::Srgb);
        assert_eq!(codes.data(), &PixelData::U8(vec![188, 128], DecodeTable::new(ColorEncoding::Srgb)));
        assert!((codes.to_f32().get(0, 0, 1) - 128.0 / 255.0).abs() < 1e-7);
    }
}
