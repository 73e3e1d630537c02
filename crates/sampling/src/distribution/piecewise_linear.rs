use super::{locate, sanitize};
use crate::warp::{invert_linear, linear_pdf, sample_linear};
use tenfold_math::{find_interval, lerp};

/// A density in proportion to a function given at points and linear between them, zero outside. The cumulative function is
/// quadratic from point to point, and inverted in closed form.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear1D {
    points: Vec<[f32; 2]>,
    cdf: Vec<f32>,
}

impl PiecewiseLinear1D {
    /// The function through `points`, pairs of place and value; values that are negative, infinite or NaN count as zero. Places do
    /// not fall; where two are the same the function jumps. `None` where there is nothing to sample: places that fall or are not
    /// finite, or a function without area.
    pub fn new(points: &[[f32; 2]]) -> Option<Self> {
        let points: Vec<_> = points.iter().map(|&[x, f]| [x, sanitize(f)]).collect();
        if !points.iter().all(|p| p[0].is_finite()) || !points.windows(2).all(|p| p[0][0] <= p[1][0]) {
            return None;
        }
        let area = |p: &[[f32; 2]]| {
            (f64::from(p[1][0]) - f64::from(p[0][0])) * 0.5 * (f64::from(p[0][1]) + f64::from(p[1][1]))
        };
        let total: f64 = points.windows(2).map(area).sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let mut sum = 0.0;
        let sums = points.windows(2).map(|p| {
            sum += area(p);
            (sum / total) as f32
        });
        let cdf = std::iter::once(0.0).chain(sums).collect();
        Some(Self { points, cdf })
    }

    /// The smallest range outside of which the function vanishes.
    pub fn support(&self) -> [f32; 2] {
        let areas = || self.cdf.windows(2).map(|c| c[1] > c[0]);
        let first = areas().position(|some| some).unwrap_or(0);
        let last = self.points.len() - 1 - areas().rev().position(|some| some).unwrap_or(0);
        [self.points[first][0], self.points[last][0]]
    }

    /// A place, from a uniform number.
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let (piece, offset) = locate(&self.cdf, u);
        let [[x0, f0], [x1, f1]] = [self.points[piece], self.points[piece + 1]];
        lerp(sample_linear(offset, f0, f1), x0, x1)
    }

    /// Density at `x`; zero outside.
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        self.locate(x).map_or(0.0, |(piece, offset)| {
            let [[x0, f0], [x1, f1]] = [self.points[piece], self.points[piece + 1]];
            (self.cdf[piece + 1] - self.cdf[piece]) * linear_pdf(offset, f0, f1) / (x1 - x0)
        })
    }

    /// The number that [`Self::sample`] maps to `x`; `None` outside.
    #[inline]
    pub fn invert(&self, x: f32) -> Option<f32> {
        self.locate(x).map(|(piece, offset)| {
            let inner = invert_linear(offset, self.points[piece][1], self.points[piece + 1][1]);
            lerp(inner, self.cdf[piece], self.cdf[piece + 1])
        })
    }

    /// The piece that holds `x`, and the place in it.
    #[inline]
    fn locate(&self, x: f32) -> Option<(usize, f32)> {
        let (first, last) = (self.points[0][0], self.points[self.points.len() - 1][0]);
        if !(first..=last).contains(&x) {
            return None;
        }
        let piece = find_interval(self.points.len(), |i| self.points[i][0] <= x);
        let (x0, x1) = (self.points[piece][0], self.points[piece + 1][0]);
        (x1 > x0).then(|| (piece, (x - x0) / (x1 - x0)))
    }
}
