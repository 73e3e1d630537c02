//! The elliptically weighted average (Greene and Heckbert 1986, Heckbert 1989; pbrt book, 10.4.4).

use crate::pyramid::Texel;
use tenfold_math::Vec2;
use tenfold_math::ops;

/// A Gaussian of the squared radius, minus its value at radius one, in equal steps of the squared radius.
#[derive(Clone, Debug)]
pub(crate) struct EwaWeights(Box<[f32; EwaWeights::STEPS]>);

impl EwaWeights {
    const STEPS: usize = 128;

    pub(crate) fn new() -> Self {
        const FALLOFF: f64 = 2.0;
        let weight = |i: usize| {
            let r2 = i as f64 / (Self::STEPS - 1) as f64;
            (ops::exp(-FALLOFF * r2) - ops::exp(-FALLOFF)) as f32
        };
        Self(Box::new(std::array::from_fn(weight)))
    }

    fn get(&self, r2: f32) -> f32 {
        self.0[((r2 * Self::STEPS as f32) as usize).min(Self::STEPS - 1)]
    }
}

/// An ellipse on the texels of a level: the points with a·x² + b·x·y + c·y² < 1 about a centre.
pub(crate) struct Ewa {
    center: Vec2,
    a: f32,
    b: f32,
    c: f32,
    /// Half the sides of the bounding box.
    extent: Vec2,
}

impl Ewa {
    /// The ellipse with the half axes `major` and `minor` (in texture coordinates) about `st`, widened by one texel.
    pub(crate) fn new(st: Vec2, major: Vec2, minor: Vec2, resolution: (u32, u32)) -> Self {
        let size = Vec2::new(resolution.0 as f32, resolution.1 as f32);
        let (u, v) = (major * size, minor * size);
        let a = u.y * u.y + v.y * v.y + 1.0;
        let b = -2.0 * (u.x * u.y + v.x * v.y);
        let c = u.x * u.x + v.x * v.x + 1.0;
        let f = a * c - b * b * 0.25;
        // Scaled by f the extents in x and y are √c and √a.
        Self {
            center: st * size - Vec2::splat(0.5),
            a: a / f,
            b: b / f,
            c: c / f,
            extent: Vec2::new(c.sqrt(), a.sqrt()),
        }
    }

    /// Weighted mean of the texels inside of the ellipse. At least the nearest one is, since its radius is over one.
    pub(crate) fn filter<T: Texel>(&self, weights: &EwaWeights, texel: impl Fn(i32, i32) -> T) -> T {
        let (low, high) = ((self.center - self.extent).ceil(), (self.center + self.extent).floor());
        let mut sum = T::ZERO;
        let mut sum_of_weights = 0.0;
        for y in low.y as i32..=high.y as i32 {
            let dy = y as f32 - self.center.y;
            for x in low.x as i32..=high.x as i32 {
                let dx = x as f32 - self.center.x;
                let r2 = self.a * dx * dx + self.b * dx * dy + self.c * dy * dy;
                if r2 < 1.0 {
                    let weight = weights.get(r2);
                    sum = sum + texel(x, y) * weight;
                    sum_of_weights += weight;
                }
            }
        }
        if sum_of_weights > 0.0 {
            sum * (1.0 / sum_of_weights)
        } else {
            // Rounding of far coordinates lost the ellipse.
            texel(self.center.x.round() as i32, self.center.y.round() as i32)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_fall_from_the_centre_to_zero() {
        let weights = EwaWeights::new();
        assert!((weights.get(0.0) - (1.0 - ops::exp(-2.0_f32))).abs() < 1e-6);
        assert_eq!(weights.get(0.9999), 0.0);
        assert!(weights.0.windows(2).all(|w| w[0] > w[1]));
    }

    #[test]
    fn the_extent_bounds_the_ellipse() {
        let ewa = Ewa::new(Vec2::splat(0.5), Vec2::new(0.3, 0.2), Vec2::new(-0.02, 0.05), (64, 64));
        let (mut right, mut top) = (0.0_f32, 0.0_f32);
        for i in 0..10_000 {
            let (sin, cos) = ops::sin_cos(i as f32 / 10_000.0 * std::f32::consts::TAU);
            let r = (ewa.a * cos * cos + ewa.b * cos * sin + ewa.c * sin * sin).sqrt().recip();
            right = right.max(r * cos);
            top = top.max(r * sin);
        }
        assert!((right / ewa.extent.x - 1.0).abs() < 1e-3, "{right} {}", ewa.extent.x);
        assert!((top / ewa.extent.y - 1.0).abs() < 1e-3, "{top} {}", ewa.extent.y);
    }
}
