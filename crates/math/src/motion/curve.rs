use super::{Key, Trs, swept};
use crate::{Bounds3, Transform, Vec3};
use glam::{Mat3, Quat};
use std::ops::{Add, Mul, Sub};

/// The smooth path through three or more keys: translation, rotation and stretch are continuous with their velocities.
///
/// Between two keys each is a cubic Bézier curve, that of the rotation in its cumulative form for unit quaternions (Kim, Kim and
/// Shin 1995, "A General Construction Scheme for Unit Quaternion Curves with Simple High Order Derivatives"). The velocity at
/// a key is that of the parabola through it and its two neighbours (Catmull and Rom's tangents for uneven times), at the ends
/// that of the parabola through the three keys there. So even speeds and turns, and even accelerations, stay what they are.
#[derive(Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) keys: Vec<Key>,
    /// From each key to the next.
    pieces: Vec<Piece>,
}

impl Curve {
    /// A path through three keys or more, in the order of their times, no two of which are the same.
    pub(super) fn new(keys: Vec<Key>) -> Self {
        let mut parts: Vec<Trs> = keys.iter().map(|key| Trs::decompose(&key.transform)).collect();
        for i in 1..parts.len() {
            parts[i] = parts[i].nearer_to(&parts[i - 1]);
        }
        let spans: Vec<f32> = keys.windows(2).map(|k| k[1].time - k[0].time).collect();
        let translations = tangents(&spans, |i| (parts[i + 1].translation - parts[i].translation) / spans[i]);
        let stretches = tangents(&spans, |i| (parts[i + 1].stretch - parts[i].stretch) * spans[i].recip());
        // Angular velocities in the body's own frame, which a turn at constant speed leaves the same.
        let turns = tangents(&spans, |i| log(parts[i].rotation.inverse() * parts[i + 1].rotation) / spans[i]);
        let piece = |i: usize| {
            let (a, b, third) = (&parts[i], &parts[i + 1], spans[i] / 3.0);
            let (first, last) = (turns[i] * third, turns[i + 1] * third);
            let between = exp(-first) * a.rotation.inverse() * b.rotation * exp(-last);
            Piece {
                translation: bezier(
                    [a.translation, b.translation],
                    [translations[i], translations[i + 1]],
                    third,
                ),
                stretch: bezier([a.stretch, b.stretch], [stretches[i], stretches[i + 1]], third),
                rotation: a.rotation,
                turns: [first, log(between), last],
            }
        };
        let pieces = (0..spans.len()).map(piece).collect();
        Self { keys, pieces }
    }

    pub(super) fn at(&self, time: f32) -> Transform {
        // The first key after `time`.
        let next = self.keys.partition_point(|key| key.time <= time);
        let Some(i) = next.checked_sub(1) else { return self.keys[0].transform };
        let key = &self.keys[i];
        if next == self.keys.len() || time == key.time {
            return key.transform;
        }
        let s = (time - key.time) / (self.keys[next].time - key.time);
        // A path through a singular map has no inverse at that instant: stay at the key before.
        Transform::from_affine(self.pieces[i].at(s).affine()).unwrap_or(key.transform)
    }

    /// A box around everything that `b` sweeps over while `time` goes from `from` to `to`.
    pub(super) fn bounds(&self, b: &Bounds3, from: f32, to: f32) -> Bounds3 {
        let [first, last] = [self.keys[0].time, self.keys[self.pieces.len()].time];
        let (from, to) = (from.clamp(first, last), to.clamp(first, last));
        let mut bounds = Bounds3::EMPTY;
        for (piece, keys) in self.pieces.iter().zip(self.keys.windows(2)) {
            let [start, end] = [keys[0].time, keys[1].time];
            if start <= to && from <= end {
                let param = |time: f32| ((time - start) / (end - start)).clamp(0.0, 1.0);
                bounds = bounds.union(piece.bounds(b, [param(from), param(to)]));
            }
        }
        bounds
    }
}

/// The path between two keys.
#[derive(Debug, PartialEq)]
struct Piece {
    /// Control points.
    translation: [Vec3; 4],
    /// Control points.
    stretch: [Mat3; 4],
    /// At the first key.
    rotation: Quat,
    /// Rotation vectors from each control point to the next.
    turns: [Vec3; 3],
}

impl Piece {
    /// The map at fraction `s` of the time between the keys.
    fn at(&self, s: f32) -> Trs {
        let r = 1.0 - s;
        let [b0, b1, b2, b3] = [r * r * r, 3.0 * s * r * r, 3.0 * s * s * r, s * s * s];
        let [t0, t1, t2, t3] = self.translation;
        let [m0, m1, m2, m3] = self.stretch;
        let [v1, v2, v3] = self.turns;
        Trs {
            translation: t0 * b0 + t1 * b1 + t2 * b2 + t3 * b3,
            rotation: self.rotation * exp(v1 * (b1 + b2 + b3)) * exp(v2 * (b2 + b3)) * exp(v3 * b3),
            stretch: m0 * b0 + m1 * b1 + m2 * b2 + m3 * b3,
        }
    }

    /// A box around what `b` sweeps over between two fractions.
    ///
    /// Derivatives of Bézier curves are Bézier curves of differences of control points, and lie in the hull of those. For the
    /// rotation `R`, with `w` the longest of its rotation vectors: the weights of these change by at most 3 in all, so `|R'| <= 3w`;
    /// the angular acceleration is at most `12w` from their second derivatives and `3w²` from turning each other, so
    /// `|R''| <= 9w² + 3w² + 12w`.
    fn bounds(&self, b: &Bounds3, range: [f32; 2]) -> Bounds3 {
        const STEPS: usize = 128;
        let longest = |v: &mut dyn Iterator<Item = Vec3>| v.map(Vec3::length).fold(0f32, f32::max);
        let w = longest(&mut self.turns.into_iter());
        let [t0, t1, t2, t3] = self.translation;
        let bend = longest(&mut [t0 - 2.0 * t1 + t2, t1 - 2.0 * t2 + t3].into_iter());
        let curvature = |i: usize| {
            let [p0, p1, p2, p3] = self.stretch.map(|m| m * b.corner(i));
            let size = longest(&mut [p0, p1, p2, p3].into_iter());
            let speed = 3.0 * longest(&mut [p1 - p0, p2 - p1, p3 - p2].into_iter());
            let change = 6.0 * longest(&mut [p0 - 2.0 * p1 + p2, p1 - 2.0 * p2 + p3].into_iter());
            12.0 * w * (1.0 + w) * size + 2.0 * 3.0 * w * speed + change
        };
        let curvature = 6.0 * bend + (0..8).map(curvature).fold(0f32, f32::max);
        swept(b, range, STEPS, curvature, |s| self.at(s))
    }
}

/// Velocities at the keys, from the mean velocities `slope` between them over times `spans`, of which there are two or more.
fn tangents<T>(spans: &[f32], slope: impl Fn(usize) -> T) -> Vec<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    let n = spans.len();
    let slopes: Vec<T> = (0..n).map(slope).collect();
    let inner = |i: usize| {
        let (before, after) = (spans[i - 1], spans[i]);
        (slopes[i - 1] * after + slopes[i] * before) * (before + after).recip()
    };
    // A parabola's mean velocity is the mean of those at the ends.
    let first = slopes[0] * 2.0 - inner(1);
    let last = slopes[n - 1] * 2.0 - inner(n - 1);
    std::iter::once(first).chain((1..n).map(inner)).chain([last]).collect()
}

/// Control points of the cubic between two points with these velocities, for a third of the time from one to the other.
fn bezier<T>([a, b]: [T; 2], [from, to]: [T; 2], third: f32) -> [T; 4]
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    [a, a + from * third, b - to * third, b]
}

/// The rotation of a rotation vector.
fn exp(v: Vec3) -> Quat {
    Quat::from_scaled_axis(v)
}

/// The rotation vector of a rotation, the shorter way round.
fn log(q: Quat) -> Vec3 {
    if q.w < 0.0 { -q } else { q }.to_scaled_axis()
}
