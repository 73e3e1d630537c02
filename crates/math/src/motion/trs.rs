use crate::{Transform, Vec3};
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

    /// The same with, of the two quaternions of its rotation, the one that is nearer to that of `before`.
    #[must_use]
    pub(super) fn nearer_to(self, before: &Self) -> Self {
        if before.rotation.dot(self.rotation) < 0.0 {
            Self { rotation: -self.rotation, ..self }
        } else {
            self
        }
    }

    pub(super) fn affine(&self) -> Affine3A {
        Affine3A::from_mat3_translation(Mat3::from_quat(self.rotation) * self.stretch, self.translation)
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
}
