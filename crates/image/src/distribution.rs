//! Piecewise-constant weights for sampling an image in proportion to its values.

use crate::image::Image;
use crate::wrap::WrapMode;
use tenfold_math::Vec2;

/// How an image is looked up between the centres of its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The pixel that covers the point.
    Nearest,
    /// Bilinear between four pixel centres, with what lies beyond the edges.
    Bilinear(WrapMode),
}

impl Image {
    /// Weights of the pixels for sampling the image, `width × height` of them, rows from the top: the mean over the
    /// pixel of the looked-up value (itself averaged over R, G and B, negative ones as zero), times `jacobian` at
    /// the pixel's centre in `domain` (its two corners; (0, 0) to (1, 1) for plain texture coordinates).
    ///
    /// For `Bilinear` the mean is exact: the integral of the interpolant over a pixel weighs the pixel with 3/4
    /// and either neighbour with 1/8 along each axis. Weights so made vanish only where the interpolant does.
    pub fn sampling_distribution(
        &self,
        interpolation: Interpolation,
        domain: (Vec2, Vec2),
        jacobian: impl Fn(Vec2) -> f32,
    ) -> Vec<f32> {
        let (width, height) = self.resolution();
        let size = Vec2::new(width as f32, height as f32);
        let mut weights = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let mean = match interpolation {
                    Interpolation::Nearest => self.grey(x as i32, y as i32, WrapMode::Clamp),
                    Interpolation::Bilinear(wrap) => self.bilinear_mean(x as i32, y as i32, wrap),
                };
                let center = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / size;
                weights.push(mean * jacobian(domain.0 + (domain.1 - domain.0) * center));
            }
        }
        weights
    }

    /// Mean of the colour's parts, not below zero.
    fn grey(&self, x: i32, y: i32, wrap: WrapMode) -> f32 {
        let rgb = self.rgb_wrapped(x, y, wrap);
        ((rgb.x + rgb.y + rgb.z) / 3.0).max(0.0)
    }

    fn bilinear_mean(&self, x: i32, y: i32, wrap: WrapMode) -> f32 {
        const WEIGHTS: [f32; 3] = [0.125, 0.75, 0.125];
        let mut sum = 0.0;
        for (dy, wy) in (-1..=1).zip(WEIGHTS) {
            for (dx, wx) in (-1..=1).zip(WEIGHTS) {
                sum += wx * wy * self.grey(x + dx, y + dy, wrap);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: (Vec2, Vec2) = (Vec2::ZERO, Vec2::ONE);

    #[test]
    fn nearest_weights_are_the_pixels_times_the_jacobian() {
        let image = Image::from_fn(2, 2, ["R", "G", "B"], |x, y| [x as f32, y as f32, 2.0]).unwrap();
        let weights = image.sampling_distribution(Interpolation::Nearest, UNIT, |p| p.y);
        let expected = [2.0 / 3.0 * 0.25, 0.25, 0.75, 4.0 / 3.0 * 0.75];
        assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-6), "{weights:?}");
    }

    #[test]
    fn bilinear_weights_are_the_integral_of_the_interpolant() {
        let image = Image::from_fn(5, 4, ["Y"], |x, y| [((x * 7 + y * 13) % 5) as f32]).unwrap();
        for wrap in [WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            let weights = image.sampling_distribution(Interpolation::Bilinear(wrap), UNIT, |_| 1.0);
            for y in 0..4_u32 {
                for x in 0..5_u32 {
                    // The midpoint rule with an even number of points is exact for a function linear on both halves.
                    let n = 8;
                    let mut sum = 0.0;
                    for j in 0..n {
                        for i in 0..n {
                            let u = (x as f32 + (i as f32 + 0.5) / n as f32) / 5.0;
                            let v = (y as f32 + (j as f32 + 0.5) / n as f32) / 4.0;
                            sum += image.bilerp(Vec2::new(u, v), 0, wrap);
                        }
                    }
                    let mean = sum / (n * n) as f32;
                    let weight = weights[(y * 5 + x) as usize];
                    assert!((weight - mean).abs() < 1e-5, "{wrap:?} ({x}, {y}): {weight} {mean}");
                }
            }
        }
    }

    #[test]
    fn the_domain_is_passed_to_the_jacobian() {
        let image = Image::from_fn(2, 1, ["Y"], |_, _| [1.0]).unwrap();
        let domain = (Vec2::new(-1.0, -2.0), Vec2::new(1.0, 2.0));
        assert_eq!(image.sampling_distribution(Interpolation::Nearest, domain, |p| p.x), [-0.5, 0.5]);
    }
}
