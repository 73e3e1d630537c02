use crate::ops;
use crate::{Bounds3, Transform, Vec3};
use glam::{Affine3A, DQuat, Mat3, Quat};

/// An affine map taken apart: first `stretch`, then `rotation`, then `translation`
/// (Shoemake and Duff 1992, "Matrix Animation and Polar Decomposition").
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Trs {
    /// Translation.
    pub translation: Vec3,
    /// Rotation, a unit quaternion.
    pub rotation: Quat,
    /// The remaining stretch, symmetric for a map without reflection.
    pub stretch: Mat3,
}

impl Trs {
    /// Takes a map apart by polar decomposition; a reflection goes into the stretch.
    pub fn decompose(t: &Transform) -> Self {
        let m = t.affine().matrix3.as_dmat3();
        // Averaging a matrix with its inverse transpose converges to the orthogonal matrix nearest to it.
        let mut r = m;
        for _ in 0..100 {
            let next = (r + r.inverse().transpose()) * 0.5;
            let change = (next - r).to_cols_array().iter().fold(0f64, |a, x| a.max(x.abs()));
            r = next;
            if change < 1e-12 {
                break;
            }
        }
        if r.determinant() < 0.0 {
            r = -r;
        }
        let stretch = r.transpose() * m;
        Self {
            translation: t.affine().translation.into(),
            rotation: DQuat::from_mat3(&r).normalize().as_quat(),
            stretch: stretch.as_mat3(),
        }
    }

    fn affine(&self) -> Affine3A {
        Affine3A::from_mat3_translation(Mat3::from_quat(self.rotation) * self.stretch, self.translation)
    }
}

/// A transform that moves between two keys: translation and stretch linearly, rotation at constant
/// angular speed, each held before the first key and after the last, as pbrt does
/// (pbrt book, 3rd edition, §2.9.3).
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    start: Transform,
    end: Transform,
    start_time: f32,
    end_time: f32,
    /// The keys taken apart; `None` where the transform stands still.
    keys: Option<[Trs; 2]>,
}

impl Motion {
    /// A transform that stands still.
    pub fn still(t: Transform) -> Self {
        Self { start: t, end: t, start_time: 0.0, end_time: 1.0, keys: None }
    }

    /// A transform that goes from `start` at `start_time` to `end` at `end_time`.
    pub fn new(start: Transform, start_time: f32, end: Transform, end_time: f32) -> Self {
        let keys = (start.affine() != end.affine() && end_time > start_time).then(|| {
            let a = Trs::decompose(&start);
            let mut b = Trs::decompose(&end);
            // The two quaternions of one rotation: take the shorter way.
            if a.rotation.dot(b.rotation) < 0.0 {
                b.rotation = -b.rotation;
            }
            [a, b]
        });
        Self { start, end, start_time, end_time, keys }
    }

    /// Whether the transform changes in time.
    #[inline]
    pub fn is_moving(&self) -> bool {
        self.keys.is_some()
    }

    /// The transform at the first key.
    #[inline]
    pub fn start(&self) -> &Transform {
        &self.start
    }

    /// The transform at `time`.
    #[inline]
    pub fn at(&self, time: f32) -> Transform {
        let Some(keys) = &self.keys else { return self.start };
        if time <= self.start_time {
            return self.start;
        }
        if time >= self.end_time {
            return self.end;
        }
        let s = (time - self.start_time) / (self.end_time - self.start_time);
        // Keys whose path runs through a singular map have no inverse at that instant: stay at the start.
        Transform::from_affine(interpolate(keys, s).affine()).unwrap_or(self.start)
    }

    /// The motion `outer` after this one: exact at the keys, and everywhere where only one of the two moves.
    #[must_use]
    pub fn then(&self, outer: &Transform) -> Self {
        Self::new(*outer * self.start, self.start_time, *outer * self.end, self.end_time)
    }

    /// A box around everything that `b` sweeps over while `time` goes from `from` to `to`.
    ///
    /// The corners are followed in short steps; between two steps a path leaves its chord by at most
    /// `h² · max|p''| / 8`, and `|p''| <= ω²·|S·c| + 2·ω·|S'·c|` for a corner `c` under the stretch `S` and the
    /// angular speed `ω`: the box is grown by that bound, so it is tight and safe.
    pub fn bounds(&self, b: &Bounds3, from: f32, to: f32) -> Bounds3 {
        let Some(keys) = &self.keys else { return self.start.bounds(b) };
        if b.is_empty() {
            return Bounds3::EMPTY;
        }
        const STEPS: usize = 64;
        let [a, z] = keys;
        let angle = 2.0 * ops::acos(a.rotation.dot(z.rotation).abs().min(1.0));
        let param =
            |time: f32| ((time - self.start_time) / (self.end_time - self.start_time)).clamp(0.0, 1.0);
        let (s0, s1) = (param(from), param(to));
        let steps = if angle > 1e-6 { STEPS } else { 1 };
        let h = (s1 - s0) / steps as f32;
        let mut swept = Bounds3::EMPTY;
        for k in 0..=steps {
            let t = interpolate(keys, s0 + k as f32 * h).affine();
            swept = (0..8).fold(swept, |box_, i| box_.include(t.transform_point3(b.corner(i))));
        }
        let curvature = (0..8)
            .map(|i| {
                let c = b.corner(i);
                let stretched = (a.stretch * c).length().max((z.stretch * c).length());
                angle * angle * stretched + 2.0 * angle * ((z.stretch - a.stretch) * c).length()
            })
            .fold(0f32, f32::max);
        // A few ulps for the rounding of the interpolation itself.
        let size = swept.min.abs().max(swept.max.abs()).max_element();
        swept.expanded(h * h * curvature / 8.0 + 4e-6 * size)
    }
}

/// The map at fraction `s` of the way between two keys.
fn interpolate(keys: &[Trs; 2], s: f32) -> Trs {
    let [a, b] = keys;
    Trs {
        translation: a.translation * (1.0 - s) + b.translation * s,
        rotation: a.rotation.slerp(b.rotation, s),
        stretch: a.stretch * (1.0 - s) + b.stretch * s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decomposition_composes_again() {
        let t = Transform::translate(Vec3::new(1.0, 2.0, 3.0))
            * Transform::rotate(2.5, Vec3::new(0.2, -1.0, 0.4)).unwrap()
            * Transform::scale(Vec3::new(3.0, 0.2, -1.0)).unwrap();
        let again = Trs::decompose(&t).affine();
        assert!(again.abs_diff_eq(*t.affine(), 1e-5), "{again:?} {t:?}");
    }

    #[test]
    fn a_rotation_keeps_its_axis_and_speed() {
        let end = Transform::rotate(1.2, Vec3::Z).unwrap();
        let m = Motion::new(Transform::IDENTITY, 0.0, end, 2.0);
        let p = m.at(0.5).point(Vec3::X);
        let want = Vec3::new(ops::cos(0.3f32), ops::sin(0.3f32), 0.0);
        assert!((p - want).length() < 1e-6);
        assert_eq!(m.at(-1.0), m.at(0.0));
        assert_eq!(m.at(5.0).point(Vec3::X), end.point(Vec3::X));
    }

    #[test]
    fn bounds_hold_the_whole_sweep_and_little_more() {
        let start = Transform::translate(Vec3::new(0.0, 1.0, 0.0));
        let end = start
            * Transform::rotate(3.0, Vec3::new(0.3, 0.1, 1.0)).unwrap()
            * Transform::scale(Vec3::new(1.5, 0.7, 1.0)).unwrap();
        let m = Motion::new(start, 0.0, end, 1.0);
        let b = Bounds3::new(Vec3::new(-2.0, -0.5, -1.0), Vec3::new(1.0, 0.25, 3.0));
        let bound = m.bounds(&b, 0.0, 1.0);
        let mut swept = Bounds3::EMPTY;
        for k in 0..=5000 {
            swept = swept.union(m.at(k as f32 / 5000.0).bounds(&b));
        }
        assert_eq!(bound.union(swept), bound);
        assert!(bound.half_area() < 1.01 * swept.half_area());
    }
}
