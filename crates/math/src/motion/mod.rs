//! Transforms that move: the path through keys.

mod curve;
mod line;
mod trs;

use crate::{Bounds3, Transform, Vec3};
use curve::Curve;
use line::Line;
use std::sync::Arc;
pub use trs::Trs;

/// A transform at a time.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Key {
    /// The time, on the clock of the shutter.
    pub time: f32,
    /// The transform.
    pub transform: Transform,
}

/// A transform that may move through keys, held before the first and after the last. Between two keys translation and stretch go
/// linearly and the rotation at constant angular speed, as in pbrt; through three or more all go smoothly.
///
/// ```
/// use tenfold_math::{Key, Motion, Transform, Vec3};
/// // A throw: the parabola through three keys.
/// let key = |time, x, y| Key { time, transform: Transform::translate(Vec3::new(x, y, 0.0)) };
/// let ball = Motion::through(&[key(0.0, 0.0, 0.0), key(0.5, 1.0, 1.0), key(1.0, 2.0, 0.0)]);
/// let at = ball.at(0.25).point(Vec3::ZERO);
/// assert!((at - Vec3::new(0.5, 0.75, 0.0)).length() < 1e-6);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Motion(Path);

#[derive(Clone, Debug, PartialEq)]
enum Path {
    Still(Transform),
    // What moves is shared: most shapes of a scene stand still, and carry no more than a transform.
    Line(Arc<Line>),
    Curve(Arc<Curve>),
}

impl Default for Motion {
    fn default() -> Self {
        Self::still(Transform::IDENTITY)
    }
}

impl Motion {
    /// A transform that stands still.
    pub fn still(t: Transform) -> Self {
        Self(Path::Still(t))
    }

    /// A transform that goes from `start` at `start_time` to `end` at `end_time`.
    pub fn new(start: Transform, start_time: f32, end: Transform, end_time: f32) -> Self {
        Self::through(&[Key { time: start_time, transform: start }, Key { time: end_time, transform: end }])
    }

    /// The path through `keys`. Where their transforms are all the same, or their times do not increase, it stands still at the
    /// first; without keys it is the identity.
    pub fn through(keys: &[Key]) -> Self {
        let Some(first) = keys.first() else { return Self::default() };
        let same = keys.iter().all(|key| key.transform.affine() == first.transform.affine());
        let increasing = keys.windows(2).all(|pair| pair[0].time < pair[1].time);
        if same || !increasing {
            return Self::still(first.transform);
        }
        Self(match keys {
            [a, b] => Path::Line(Arc::new(Line::new([*a, *b]))),
            _ => Path::Curve(Arc::new(Curve::new(keys.to_vec()))),
        })
    }

    /// Whether the transform changes in time.
    #[inline]
    pub fn is_moving(&self) -> bool {
        !matches!(self.0, Path::Still(_))
    }

    /// The keys, two or more; none where the transform stands still.
    pub fn keys(&self) -> &[Key] {
        match &self.0 {
            Path::Still(_) => &[],
            Path::Line(line) => &line.keys,
            Path::Curve(curve) => &curve.keys,
        }
    }

    /// The transform at the first key.
    #[inline]
    pub fn start(&self) -> &Transform {
        match &self.0 {
            Path::Still(t) => t,
            Path::Line(line) => &line.keys[0].transform,
            Path::Curve(curve) => &curve.keys[0].transform,
        }
    }

    /// The transform at `time`.
    #[inline]
    pub fn at(&self, time: f32) -> Transform {
        match &self.0 {
            Path::Still(t) => *t,
            Path::Line(line) => line.at(time),
            Path::Curve(curve) => curve.at(time),
        }
    }

    /// A box around everything that `b` sweeps over while `time` goes from `from` to `to`; tight and safe.
    pub fn bounds(&self, b: &Bounds3, from: f32, to: f32) -> Bounds3 {
        if b.is_empty() {
            return Bounds3::EMPTY;
        }
        match &self.0 {
            Path::Still(t) => t.bounds(b),
            Path::Line(line) => line.bounds(b, from, to),
            Path::Curve(curve) => curve.bounds(b, from, to),
        }
    }

    /// Two boxes such that the box that goes linearly from the first, at time `from`, to the second, at time `to`, holds `b` all the time.
    pub fn linear_bounds(&self, b: &Bounds3, from: f32, to: f32) -> [Bounds3; 2] {
        // More follow the way closer, but each is made with care.
        const STEPS: usize = 8;
        let linear = match &self.0 {
            Path::Still(_) => true,
            Path::Line(line) => line.is_linear(from, to),
            Path::Curve(_) => false,
        };
        let ends = [self.bounds(b, from, from), self.bounds(b, to, to)];
        if linear || b.is_empty() || from >= to {
            return ends;
        }
        // Both ends move outward by as much as the box over any short time reaches out.
        let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
        for k in 0..STEPS {
            let s = [k, k + 1].map(|k| k as f32 / STEPS as f32);
            let short = self.bounds(b, from + (to - from) * s[0], from + (to - from) * s[1]);
            for s in s {
                low = low.max(ends[0].min.lerp(ends[1].min, s) - short.min);
                high = high.max(short.max - ends[0].max.lerp(ends[1].max, s));
            }
        }
        ends.map(|end| Bounds3 { min: end.min - low, max: end.max + high })
    }
}

/// A box around what `b` sweeps over while the parameter of the path `at` goes over a range.
///
/// The corners are followed in short steps `h`; between two steps a path leaves its chord by at most `h² · max|p''| / 8`, with
/// `curvature` a bound on `|p''|` for all corners: the box is grown by that.
fn swept(b: &Bounds3, [s0, s1]: [f32; 2], steps: usize, curvature: f32, at: impl Fn(f32) -> Trs) -> Bounds3 {
    let h = (s1 - s0) / steps as f32;
    let mut swept = Bounds3::EMPTY;
    for k in 0..=steps {
        let t = at(s0 + k as f32 * h).affine();
        swept = (0..8).fold(swept, |box_, i| box_.include(t.transform_point3(b.corner(i))));
    }
    // A few ulps for the rounding of the interpolation itself.
    let size = swept.min.abs().max(swept.max.abs()).max_element();
    swept.expanded(h * h * curvature / 8.0 + 4e-6 * size)
}
