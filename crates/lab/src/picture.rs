use crate::page::base64;
use tenfold_image::{Format, Image, ImageError, WriteOptions};
use tenfold_math::Vec3;

/// A picture for a page: an 8-bit PNG file in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns of pixels.
    pub width: u32,
    /// Rows of pixels.
    pub height: u32,
    png: Vec<u8>,
}

impl Picture {
    /// A picture of linear sRGB values in [0, 1], row by row from the top, beyond which they are clamped.
    ///
    /// # Errors
    /// Where there are not `width` values a row, or none.
    pub fn from_linear_rgb(width: u32, pixels: &[Vec3]) -> Result<Self, ImageError> {
        let height = (pixels.len() / (width as usize).max(1)) as u32;
        let values = pixels.iter().flat_map(|p| p.to_array()).collect();
        let image = Image::from_f32(width, height, ["R", "G", "B"], values)?;
        let png = image.to_bytes(Format::Png, &WriteOptions::default());
        Ok(Self { width, height, png: png? })
    }

    /// A picture of numbers between 0, black, and 1, white, which the eye finds evenly spaced.
    ///
    /// # Errors
    /// As [`Picture::from_linear_rgb`].
    pub fn from_grey(width: u32, values: &[f32]) -> Result<Self, ImageError> {
        let linear = |v: &f32| Vec3::splat(tenfold_image::srgb_to_linear(v.clamp(0.0, 1.0)));
        Self::from_linear_rgb(width, &values.iter().map(linear).collect::<Vec<_>>())
    }

    /// The file.
    pub fn png(&self) -> &[u8] {
        &self.png
    }

    /// The file within an address.
    pub(crate) fn data_uri(&self) -> String {
        format!("data:image/png;base64,{}", base64(&self.png))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_its_values() {
        let picture = Picture::from_linear_rgb(2, &[Vec3::ZERO, Vec3::ONE, Vec3::X, Vec3::Y]).unwrap();
        assert_eq!((picture.width, picture.height), (2, 2));
        let image = Image::read_bytes(picture.png(), None, None).unwrap();
        assert_eq!((image.rgb(1, 0), image.rgb(0, 1)), (Vec3::ONE, Vec3::X));
        assert!(Picture::from_linear_rgb(3, &[Vec3::ZERO; 4]).is_err());
        assert!(Picture::from_linear_rgb(0, &[]).is_err());
        assert!(picture.data_uri().starts_with("data:image/png;base64,iVBORw0KGgo"));
    }
}
