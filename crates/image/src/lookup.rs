//! Unfiltered and bilinear lookups at texture coordinates.

use crate::image::{Image, PixelData};
use crate::wrap::WrapMode;
use half::f16;
use tenfold_math::{Vec2, Vec3};

/// The four pixels around a point and their weights.
struct Footprint {
    x: [i32; 2],
    y: [i32; 2],
    /// Weights of the second column and row.
    d: Vec2,
}

impl Footprint {
    fn new(st: Vec2, resolution: (u32, u32)) -> Self {
        let p = st * Vec2::new(resolution.0 as f32, resolution.1 as f32) - Vec2::splat(0.5);
        let (x, y) = (floor(p.x), floor(p.y));
        let d = p - Vec2::new(x as f32, y as f32);
        Self { x: [x, x.wrapping_add(1)], y: [y, y.wrapping_add(1)], d }
    }

    /// Index of the first of the four pixels where all lie inside of the image, counted in pixels.
    #[inline]
    fn inside(&self, (width, height): (u32, u32)) -> Option<usize> {
        let (x, y) = (u32::try_from(self.x[0]).ok()?, u32::try_from(self.y[0]).ok()?);
        (x + 1 < width && y + 1 < height).then_some(y as usize * width as usize + x as usize)
    }

    /// Weights of the pixels (0, 0), (1, 0), (0, 1), (1, 1).
    fn weights(&self) -> [f32; 4] {
        let Vec2 { x: dx, y: dy } = self.d;
        [(1.0 - dx) * (1.0 - dy), dx * (1.0 - dy), (1.0 - dx) * dy, dx * dy]
    }
}

/// The largest integer not above `v`; far numbers saturate and NaN is zero, as `as` has it. (Without SSE 4.1, `f32::floor`
/// is a function call.)
#[inline]
fn floor(v: f32) -> i32 {
    let truncated = v as i32;
    if truncated as f32 > v { truncated.saturating_sub(1) } else { truncated }
}

/// Weighted sum of the colours of four pixels, of which the first is at index `o`, the second `right` further, and the
/// others `down` further than these.
#[inline]
fn blend<T: Copy>(
    v: &[T],
    o: usize,
    (right, down): (usize, usize),
    rgb: [usize; 3],
    w: [f32; 4],
    decode: impl Fn(T) -> f32,
) -> Vec3 {
    let color = |o: usize| Vec3::from_array(rgb.map(|c| decode(v[o + c])));
    w[0] * color(o) + w[1] * color(o + right) + w[2] * color(o + down) + w[3] * color(o + down + right)
}

impl Image {
    /// Linear value of channel `c` at (x, y), which may lie outside of the image.
    #[inline]
    pub fn get_wrapped(&self, x: i32, y: i32, c: usize, wrap: WrapMode) -> f32 {
        wrap.remap(x, y, self.resolution()).map_or(0.0, |(x, y)| self.get(x, y, c))
    }

    /// Linear colour at (x, y), which may lie outside of the image.
    #[inline]
    pub fn rgb_wrapped(&self, x: i32, y: i32, wrap: WrapMode) -> Vec3 {
        wrap.remap(x, y, self.resolution()).map_or(Vec3::ZERO, |(x, y)| self.rgb(x, y))
    }

    /// Coordinates of the pixel that covers `st`, unwrapped.
    ///
    /// (pbrt-v4 truncates toward zero, which differs for negative `st` alone.)
    #[inline]
    pub fn pixel_at(&self, st: Vec2) -> (i32, i32) {
        let p = st * Vec2::new(self.width() as f32, self.height() as f32);
        (floor(p.x), floor(p.y))
    }

    /// Channel `c` of the pixel that covers `st`.
    #[inline]
    pub fn nearest(&self, st: Vec2, c: usize, wrap: WrapMode) -> f32 {
        let (x, y) = self.pixel_at(st);
        self.get_wrapped(x, y, c, wrap)
    }

    /// Colour of the pixel that covers `st`.
    #[inline]
    pub fn nearest_rgb(&self, st: Vec2, wrap: WrapMode) -> Vec3 {
        let (x, y) = self.pixel_at(st);
        self.rgb_wrapped(x, y, wrap)
    }

    /// Channel `c` at `st`, bilinearly interpolated between the centres of four pixels.
    #[inline]
    pub fn bilerp(&self, st: Vec2, c: usize, wrap: WrapMode) -> f32 {
        let f = Footprint::new(st, self.resolution());
        let [w0, w1, w2, w3] = f.weights();
        w0 * self.get_wrapped(f.x[0], f.y[0], c, wrap)
            + w1 * self.get_wrapped(f.x[1], f.y[0], c, wrap)
            + w2 * self.get_wrapped(f.x[0], f.y[1], c, wrap)
            + w3 * self.get_wrapped(f.x[1], f.y[1], c, wrap)
    }

    /// Colour at `st`, bilinearly interpolated between the centres of four pixels.
    #[inline]
    pub fn bilerp_rgb(&self, st: Vec2, wrap: WrapMode) -> Vec3 {
        let f = Footprint::new(st, self.resolution());
        let w @ [w0, w1, w2, w3] = f.weights();
        if let Some(pixel) = f.inside(self.resolution()) {
            // Almost always: no wrapping, and the format is looked at once.
            let channels = self.channels().len();
            let (o, steps) = (pixel * channels, (channels, self.width() as usize * channels));
            let rgb = self.rgb_channels();
            return match self.data() {
                PixelData::U8(v, table) => blend(v, o, steps, rgb, w, |code| table.decode(code)),
                PixelData::F16(v) => blend(v, o, steps, rgb, w, f16::to_f32),
                PixelData::F32(v) => blend(v, o, steps, rgb, w, |v| v),
            };
        }
        w0 * self.rgb_wrapped(f.x[0], f.y[0], wrap)
            + w1 * self.rgb_wrapped(f.x[1], f.y[0], wrap)
            + w2 * self.rgb_wrapped(f.x[0], f.y[1], wrap)
            + w3 * self.rgb_wrapped(f.x[1], f.y[1], wrap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Image {
        Image::from_fn(4, 2, ["R", "G", "B"], |x, y| [x as f32, y as f32, (x * y) as f32]).unwrap()
    }

    #[test]
    fn lookups_at_pixel_centres_are_exact() {
        let image = ramp();
        for y in 0..2 {
            for x in 0..4 {
                let st = Vec2::new((x as f32 + 0.5) / 4.0, (y as f32 + 0.5) / 2.0);
                for wrap in [WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere] {
                    assert_eq!(image.bilerp_rgb(st, wrap), image.rgb(x, y));
                    assert_eq!(image.nearest_rgb(st, wrap), image.rgb(x, y));
                    assert_eq!(image.bilerp(st, 2, wrap), image.get(x, y, 2));
                    assert_eq!(image.nearest(st, 2, wrap), image.get(x, y, 2));
                }
            }
        }
    }

    #[test]
    fn every_format_gives_the_same_colours() {
        let floats = Image::from_fn(5, 4, ["A", "B", "G", "R"], |x, y| {
            [x, y, x * y, x + y].map(|v| ((v % 4) as f32 / 4.0 * 255.0).round() / 255.0)
        })
        .unwrap();
        let (halves, codes) = (floats.to_f16(), floats.to_u8(crate::ColorEncoding::Linear));
        for i in 0..100 {
            let st = Vec2::new(i as f32 * 0.618, i as f32 * 0.317).fract();
            let c = floats.bilerp_rgb(st, WrapMode::Repeat);
            assert_eq!(c.to_array(), [3, 2, 1].map(|c| floats.bilerp(st, c, WrapMode::Repeat)));
            assert!((c - halves.bilerp_rgb(st, WrapMode::Repeat)).abs().max_element() < 5e-4);
            assert!((c - codes.bilerp_rgb(st, WrapMode::Repeat)).abs().max_element() < 1e-6);
        }
    }

    #[test]
    fn bilinear_lookups_interpolate_and_wrap() {
        let image = ramp();
        let at = |s, wrap| image.bilerp(Vec2::new(s, 0.25), 0, wrap);
        assert_eq!(at(0.5, WrapMode::Clamp), 1.5);
        assert_eq!(at(0.0, WrapMode::Clamp), 0.0);
        assert_eq!(at(0.0, WrapMode::Repeat), 1.5);
        assert_eq!(at(1.0, WrapMode::Black), 1.5);
        assert_eq!(at(1.0, WrapMode::Clamp), 3.0);
        // Beyond the right edge lies the same edge, upside down.
        assert_eq!(image.bilerp(Vec2::new(1.0, 0.25), 1, WrapMode::OctahedralSphere), 0.5);
    }

    #[test]
    fn nearest_lookups_take_the_covering_pixel() {
        let image = ramp();
        assert_eq!(image.nearest(Vec2::new(0.2499, 0.0), 0, WrapMode::Clamp), 0.0);
        assert_eq!(image.nearest(Vec2::new(0.25, 0.0), 0, WrapMode::Clamp), 1.0);
        assert_eq!(image.nearest(Vec2::new(-0.01, 0.0), 0, WrapMode::Repeat), 3.0);
    }

    #[test]
    fn wild_coordinates_do_not_panic() {
        let image = ramp();
        for v in [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, 1e10, -1e10] {
            for wrap in [WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere] {
                image.bilerp_rgb(Vec2::new(v, v), wrap);
                image.nearest_rgb(Vec2::new(v, v), wrap);
            }
        }
    }
}
