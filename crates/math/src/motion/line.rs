use super::{Key, Trs, swept};
use crate::{Bounds3, Transform, ops};
use glam::Mat3;

/// The path between two keys: translation and stretch go linearly, the rotation at constant angular speed, as in pbrt
/// (pbrt book, 3rd edition, §2.9.3).
#[derive(Debug, PartialEq)]
pub(super) struct Line {
    pub(super) keys: [Key; 2],
    /// The keys taken apart.
    parts: [Trs; 2],
    /// The transform at the start without its translation, where only that changes.
    fixed: Option<Transform>,
}

impl Line {
    pub(super) fn new(keys: [Key; 2]) -> Self {
        let a = Trs::decompose(&keys[0].transform);
        let b = Trs::decompose(&keys[1].transform).nearer_to(&a);
        let matrix = Mat3::from_quat(a.rotation) * a.stretch;
        let fixed = Transform::from_affine(glam::Affine3A::from_mat3(matrix));
        let only_moves = a.rotation == b.rotation && a.stretch == b.stretch;
        Self { keys, parts: [a, b], fixed: fixed.filter(|_| only_moves) }
    }

    #[inline]
    pub(super) fn at(&self, time: f32) -> Transform {
        let [start, end] = &self.keys;
        if time <= start.time {
            return start.transform;
        }
        if time >= end.time {
            return end.transform;
        }
        let s = (time - start.time) / (end.time - start.time);
        if let Some(fixed) = &self.fixed {
            let [a, b] = &self.parts;
            return Transform::translate(a.translation * (1.0 - s) + b.translation * s) * *fixed;
        }
        // Keys whose path runs through a singular map have no inverse at that instant: stay at the start.
        Transform::from_affine(self.interpolate(s).affine()).unwrap_or(start.transform)
    }

    /// The map at fraction `s` of the way.
    fn interpolate(&self, s: f32) -> Trs {
        let [a, b] = &self.parts;
        Trs {
            translation: a.translation * (1.0 - s) + b.translation * s,
            rotation: a.rotation.slerp(b.rotation, s),
            stretch: a.stretch * (1.0 - s) + b.stretch * s,
        }
    }

    /// A box around everything that `b` sweeps over while `time` goes from `from` to `to`.
    ///
    /// `|p''| <= ω²·|S·c| + 2·ω·|S'·c|` for a corner `c` under the stretch `S` and the angular speed `ω`.
    pub(super) fn bounds(&self, b: &Bounds3, from: f32, to: f32) -> Bounds3 {
        const STEPS: usize = 64;
        let [a, z] = &self.parts;
        let [start, end] = [self.keys[0].time, self.keys[1].time];
        let angle = 2.0 * ops::acos(a.rotation.dot(z.rotation).abs().min(1.0));
        let param = |time: f32| ((time - start) / (end - start)).clamp(0.0, 1.0);
        let (s0, s1) = (param(from), param(to));
        let steps = if angle > 1e-6 { STEPS } else { 1 };
        let curvature = (0..8)
            .map(|i| {
                let c = b.corner(i);
                let stretched = (a.stretch * c).length().max((z.stretch * c).length());
                angle * angle * stretched + 2.0 * angle * ((z.stretch - a.stretch) * c).length()
            })
            .fold(0f32, f32::max);
        swept(b, [s0, s1], steps, curvature, |s| self.interpolate(s))
    }

    /// Whether points go in straight lines at constant speeds all the time from `from` to `to`.
    pub(super) fn is_linear(&self, from: f32, to: f32) -> bool {
        self.fixed.is_some() && self.keys[0].time <= from && to <= self.keys[1].time
    }
}
