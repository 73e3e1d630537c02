//! Texture pyramids: an image at all powers of two, for lookups of any footprint.

use crate::error::ImageErrorKind;
use crate::ewa::{Ewa, EwaWeights};
use crate::image::{Image, PixelData};
use crate::resample::for_rows;
use crate::wrap::WrapMode;
use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3};

/// How a texture is averaged over the footprint of a lookup (pbrt book, 10.4.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextureFilter {
    /// The nearest texel of the level whose texels are about as large as the footprint.
    Point,
    /// Bilinear on that level.
    Bilinear,
    /// Bilinear on the two nearest levels, interpolated.
    Trilinear,
    /// An elliptical Gaussian (Heckbert 1989), whose longer axis is at most `max_anisotropy` (at least one) times the
    /// shorter, which is widened where needed.
    Ewa {
        /// The largest ratio of the ellipse's axes; pbrt's default is 8.
        max_anisotropy: f32,
    },
}

/// An image and all its halvings down to one texel.
///
/// Level 0 is the finest. Its sides are powers of two: other images are enlarged to the next ones first, as in pbrt-v4.
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Image>,
    wrap: WrapMode,
    ewa_weights: EwaWeights,
}

/// A value that texels have: a colour or one channel.
pub(crate) trait Texel:
    Copy + std::ops::Add<Output = Self> + std::ops::Mul<f32, Output = Self>
{
    const ZERO: Self;
    /// Which channel, if the kind of value needs to be told.
    type Channel: Copy;
    fn texel(image: &Image, x: i32, y: i32, channel: Self::Channel, wrap: WrapMode) -> Self;
    fn bilerp(image: &Image, st: Vec2, channel: Self::Channel, wrap: WrapMode) -> Self;
}

impl Texel for f32 {
    const ZERO: f32 = 0.0;
    type Channel = usize;
    #[inline]
    fn texel(image: &Image, x: i32, y: i32, channel: usize, wrap: WrapMode) -> f32 {
        image.get_wrapped(x, y, channel, wrap)
    }
    #[inline]
    fn bilerp(image: &Image, st: Vec2, channel: usize, wrap: WrapMode) -> f32 {
        image.bilerp(st, channel, wrap)
    }
}

impl Texel for Vec3 {
    const ZERO: Vec3 = Vec3::ZERO;
    type Channel = ();
    #[inline]
    fn texel(image: &Image, x: i32, y: i32, (): (), wrap: WrapMode) -> Vec3 {
        image.rgb_wrapped(x, y, wrap)
    }
    #[inline]
    fn bilerp(image: &Image, st: Vec2, (): (), wrap: WrapMode) -> Vec3 {
        image.bilerp_rgb(st, wrap)
    }
}

impl Pyramid {
    /// Builds all levels of `image`, each stored in the format of the image. Every level is the box-filtered half of the
    /// unrounded level before.
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where a side exceeds 2³¹.
    pub fn build(image: Image, wrap: WrapMode) -> Result<Pyramid, ImageErrorKind> {
        let (width, height) = image.resolution();
        let (Some(w), Some(h)) = (width.checked_next_power_of_two(), height.checked_next_power_of_two())
        else {
            let channels = image.channels().len();
            return Err(ImageErrorKind::Size {
                width,
                height,
                channels,
                expected: 1 << 31,
                found: u64::from(u32::MAX),
            });
        };
        let like = image.data().clone_empty();
        let (base, mut exact) = if (w, h) == (width, height) {
            let exact = image.to_f32();
            (image, exact)
        } else {
            let exact = image.resize(w, h, wrap)?;
            (exact.stored_like(&like), exact)
        };
        let mut levels = vec![base];
        while exact.resolution() != (1, 1) {
            exact = exact.halved()?;
            levels.push(exact.stored_like(&like));
        }
        Ok(Pyramid { levels, wrap, ewa_weights: EwaWeights::new() })
    }

    /// The levels, the finest first; the last has one texel.
    pub fn levels(&self) -> &[Image] {
        &self.levels
    }

    /// What lies beyond the edges.
    pub fn wrap(&self) -> WrapMode {
        self.wrap
    }

    /// Memory taken by the texels, in bytes.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(Image::bytes).sum()
    }

    /// Colour at `st`, filtered over the parallelogram of the two differentials (how `st` changes from pixel to pixel in
    /// x and in y).
    #[inline]
    pub fn lookup_rgb(&self, st: Vec2, dst_dx: Vec2, dst_dy: Vec2, filter: TextureFilter) -> Vec3 {
        self.lookup_texel((), st, dst_dx, dst_dy, filter)
    }

    /// Channel `c` at `st`, filtered like [`Pyramid::lookup_rgb`]. Panics where there is no such channel.
    #[inline]
    pub fn lookup(&self, c: usize, st: Vec2, dst_dx: Vec2, dst_dy: Vec2, filter: TextureFilter) -> f32 {
        self.lookup_texel(c, st, dst_dx, dst_dy, filter)
    }

    fn lookup_texel<T: Texel>(
        &self,
        channel: T::Channel,
        st: Vec2,
        dst_dx: Vec2,
        dst_dy: Vec2,
        filter: TextureFilter,
    ) -> T {
        if let TextureFilter::Ewa { max_anisotropy } = filter {
            return self.lookup_ewa(channel, st, dst_dx, dst_dy, max_anisotropy);
        }
        let last = self.levels.len() - 1;
        let width = 2.0 * dst_dx.abs().max_element().max(dst_dy.abs().max_element());
        let level = last as f32 + ops::log2(width.max(1e-8));
        if level >= last as f32 {
            return self.coarsest(channel);
        }
        let finer = level.max(0.0) as usize;
        let image = &self.levels[finer];
        match filter {
            TextureFilter::Point => {
                // The texel whose centre is nearest.
                let (x, y) = image.pixel_at(st);
                T::texel(image, x, y, channel, self.wrap)
            }
            TextureFilter::Trilinear if level > 0.0 => {
                let (a, b) = (image, &self.levels[finer + 1]);
                let (a, b) = (T::bilerp(a, st, channel, self.wrap), T::bilerp(b, st, channel, self.wrap));
                let d = level - finer as f32;
                a * (1.0 - d) + b * d
            }
            TextureFilter::Bilinear | TextureFilter::Trilinear | TextureFilter::Ewa { .. } => {
                T::bilerp(image, st, channel, self.wrap)
            }
        }
    }

    fn lookup_ewa<T: Texel>(
        &self,
        channel: T::Channel,
        st: Vec2,
        dst_dx: Vec2,
        dst_dy: Vec2,
        max_anisotropy: f32,
    ) -> T {
        let ordered = dst_dx.length_squared() >= dst_dy.length_squared();
        let (major, mut minor) = if ordered { (dst_dx, dst_dy) } else { (dst_dy, dst_dx) };
        let (longer, mut shorter) = (major.length(), minor.length());
        if shorter * max_anisotropy < longer && shorter > 0.0 {
            let scale = longer / (shorter * max_anisotropy);
            minor *= scale;
            shorter *= scale;
        }
        if shorter == 0.0 {
            return T::bilerp(&self.levels[0], st, channel, self.wrap);
        }
        let last = self.levels.len() - 1;
        let level = (last as f32 + ops::log2(shorter)).max(0.0);
        // Not finite: lengths overflowed.
        if level >= last as f32 || !longer.is_finite() || !st.is_finite() {
            return self.coarsest(channel);
        }
        let finer = level as usize;
        let filtered = |level: usize| {
            let ewa = Ewa::new(st, major, minor, self.levels[level].resolution());
            ewa.filter(&self.ewa_weights, |x, y| T::texel(&self.levels[level], x, y, channel, self.wrap))
        };
        let d = level - finer as f32;
        filtered(finer) * (1.0 - d) + filtered(finer + 1) * d
    }

    /// The single texel of the last level.
    fn coarsest<T: Texel>(&self, channel: T::Channel) -> T {
        T::texel(&self.levels[self.levels.len() - 1], 0, 0, channel, self.wrap)
    }
}

impl PixelData {
    /// The same format without values.
    fn clone_empty(&self) -> PixelData {
        match self {
            PixelData::U8(_, table) => PixelData::U8(Vec::new(), table.clone()),
            PixelData::F16(_) => PixelData::F16(Vec::new()),
            PixelData::F32(_) => PixelData::F32(Vec::new()),
        }
    }
}

impl Image {
    fn stored_like(&self, like: &PixelData) -> Image {
        match like {
            PixelData::U8(_, table) => self.to_u8(table.encoding()),
            PixelData::F16(_) => self.to_f16(),
            PixelData::F32(_) => self.to_f32(),
        }
    }

    /// Half the sides, which are powers of two: means of four, or of two once a side is one.
    fn halved(&self) -> Result<Image, ImageErrorKind> {
        let (width, height) = self.resolution();
        let (w, h) = ((width / 2).max(1), (height / 2).max(1));
        let (dx, dy) = (u32::from(width > 1), u32::from(height > 1));
        let channels = self.channels().len();
        let mut values = vec![0.0; w as usize * h as usize * channels];
        for_rows(&mut values, w as usize * channels, |y, row| {
            for (x, texel) in row.chunks_exact_mut(channels).enumerate() {
                // Where a side is one already, 2x = 0 and both columns are the same.
                let (x, y) = (2 * x as u32, 2 * y as u32);
                for (c, value) in texel.iter_mut().enumerate() {
                    let top = self.get(x, y, c) + self.get(x + dx, y, c);
                    let bottom = self.get(x, y + dy, c) + self.get(x + dx, y + dy, c);
                    *value = 0.25 * (top + bottom);
                }
            }
        });
        Image::from_f32(w, h, self.channels().iter().cloned(), values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encoding::ColorEncoding;

    const FILTERS: [TextureFilter; 4] = [
        TextureFilter::Point,
        TextureFilter::Bilinear,
        TextureFilter::Trilinear,
        TextureFilter::Ewa { max_anisotropy: 8.0 },
    ];

    fn noise(width: u32, height: u32) -> Image {
        Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
            let v = |s: u32| ((x * 37 + y * 101 + s * 7) % 17) as f32 / 16.0;
            [v(0), v(1), v(2)]
        })
        .unwrap()
    }

    #[test]
    fn every_level_keeps_the_mean() {
        let pyramid = Pyramid::build(noise(16, 4), WrapMode::Repeat).unwrap();
        let sizes: Vec<_> = pyramid.levels().iter().map(Image::resolution).collect();
        assert_eq!(sizes, [(16, 4), (8, 2), (4, 1), (2, 1), (1, 1)]);
        for level in pyramid.levels() {
            for c in 0..3 {
                assert!((level.mean(c) - pyramid.levels()[0].mean(c)).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn levels_are_not_rounded_twice() {
        let image = noise(64, 64).to_u8(ColorEncoding::Srgb);
        let mean = image.mean(0);
        let pyramid = Pyramid::build(image.clone(), WrapMode::Repeat).unwrap();
        assert_eq!(pyramid.levels()[0], image);
        let top = &pyramid.levels()[6];
        // Equal but for the rounding of the last level: half a code, with the curve's slope at most 2.5 / 255.
        assert!((f64::from(top.get(0, 0, 0)) - mean).abs() < 0.5 * 2.5 / 255.0);
        assert_eq!(top.data().clone_empty(), image.data().clone_empty());
    }

    #[test]
    fn other_sizes_are_enlarged() {
        let pyramid = Pyramid::build(noise(5, 3), WrapMode::Clamp).unwrap();
        assert_eq!(pyramid.levels()[0].resolution(), (8, 4));
        assert_eq!(pyramid.levels().len(), 4);
    }

    #[test]
    fn a_constant_is_a_constant_through_every_filter() {
        let pyramid =
            Pyramid::build(Image::from_fn(8, 8, ["Y"], |_, _| [0.5]).unwrap(), WrapMode::Repeat).unwrap();
        for filter in FILTERS {
            for i in 0..200 {
                let t = i as f32 / 200.0;
                let (dx, dy) = (Vec2::new(t, 0.1 * t), Vec2::new(-0.03, 0.2 * t * t));
                let v = pyramid.lookup(0, Vec2::new(3.0 * t - 1.0, 1.0 - t), dx, dy, filter);
                assert!((v - 0.5).abs() < 1e-6, "{filter:?} {t}: {v}");
                let v = pyramid.lookup_rgb(Vec2::new(3.0 * t - 1.0, 1.0 - t), dx, dy, filter);
                assert!((v - Vec3::splat(0.5)).abs().max_element() < 1e-6);
            }
        }
    }

    #[test]
    fn no_footprint_looks_at_the_finest_level() {
        let image = noise(8, 8);
        let pyramid = Pyramid::build(image.clone(), WrapMode::Repeat).unwrap();
        for i in 0..50 {
            let st = Vec2::new(i as f32 * 0.618, i as f32 * 0.373);
            for filter in &FILTERS[1..] {
                let v = pyramid.lookup_rgb(st, Vec2::ZERO, Vec2::ZERO, *filter);
                assert_eq!(v, image.bilerp_rgb(st, WrapMode::Repeat));
            }
            let v = pyramid.lookup_rgb(st, Vec2::ZERO, Vec2::ZERO, TextureFilter::Point);
            assert_eq!(v, image.nearest_rgb(st, WrapMode::Repeat));
        }
    }

    #[test]
    fn a_footprint_of_the_whole_image_gives_its_mean() {
        let image = noise(8, 8);
        let mean = image.mean(1) as f32;
        let pyramid = Pyramid::build(image, WrapMode::Repeat).unwrap();
        for filter in FILTERS {
            let v = pyramid.lookup_rgb(Vec2::splat(0.3), Vec2::X, Vec2::Y, filter);
            assert!((v.y - mean).abs() < 1e-6, "{filter:?}");
        }
    }

    #[test]
    fn the_width_of_the_footprint_chooses_the_level() {
        let pyramid = Pyramid::build(noise(16, 16), WrapMode::Clamp).unwrap();
        let st = Vec2::new(0.4, 0.7);
        // Twice the differential spans one texel of level 2 (of four).
        let d = Vec2::new(0.125, 0.0);
        let v = pyramid.lookup_rgb(st, d, Vec2::ZERO, TextureFilter::Bilinear);
        assert_eq!(v, pyramid.levels()[2].bilerp_rgb(st, WrapMode::Clamp));
        let d = d * 2.0_f32.sqrt();
        let v = pyramid.lookup_rgb(st, Vec2::ZERO, d, TextureFilter::Trilinear);
        let [a, b] = [2, 3].map(|l: usize| pyramid.levels()[l].bilerp_rgb(st, WrapMode::Clamp));
        assert!((v - 0.5 * (a + b)).abs().max_element() < 1e-5);
    }

    #[test]
    fn an_ellipse_averages_along_its_longer_axis() {
        // Stripes along t vary with s alone: a footprint long in t keeps them, one long in s does not.
        let stripes = Image::from_fn(64, 64, ["Y"], |x, _| [(x % 2) as f32]).unwrap();
        let pyramid = Pyramid::build(stripes, WrapMode::Repeat).unwrap();
        let ewa = TextureFilter::Ewa { max_anisotropy: 16.0 };
        let st = Vec2::new(9.5 / 64.0, 0.5);
        let (short, long) = (0.25 / 64.0, 4.0 / 64.0);
        let along = pyramid.lookup(0, st, Vec2::new(0.0, long), Vec2::new(short, 0.0), ewa);
        let across = pyramid.lookup(0, st, Vec2::new(long, 0.0), Vec2::new(0.0, short), ewa);
        assert!(along > 0.7, "{along}");
        assert!((across - 0.5).abs() < 0.05, "{across}");
    }

    #[test]
    fn wild_footprints_do_not_panic() {
        let pyramid = Pyramid::build(noise(4, 16), WrapMode::Repeat).unwrap();
        let wild = [0.0, 1e-30, 1e-3, 1.0, 1e30, f32::MAX, f32::INFINITY, f32::NAN];
        for a in wild {
            for b in wild {
                for filter in FILTERS {
                    pyramid.lookup_rgb(Vec2::new(a, b), Vec2::new(b, a), Vec2::new(a, -a), filter);
                    pyramid.lookup(0, Vec2::splat(0.5), Vec2::new(b, a), Vec2::new(0.0, a), filter);
                    pyramid.lookup(0, Vec2::new(a, b), Vec2::new(0.01, 0.0), Vec2::new(0.0, 0.01), filter);
                }
            }
        }
    }
}
