use crate::{Bounds3, Ray, Vec3, gamma};
use glam::{Affine3A, Mat4, Vec3A, Vec4};

/// An invertible affine map of space together with its inverse.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Transform {
    forward: Affine3A,
    inverse: Affine3A,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { forward: Affine3A::IDENTITY, inverse: Affine3A::IDENTITY };

    /// The map with this matrix, or `None` where it is not affine, not finite or has no inverse.
    pub fn from_mat4(m: Mat4) -> Option<Self> {
        (m.row(3) == Vec4::W).then(|| Affine3A::from_mat4(m)).and_then(Self::from_affine)
    }

    /// The map given, or `None` where it is not finite or has no inverse.
    pub fn from_affine(forward: Affine3A) -> Option<Self> {
        // The determinant in double precision: strong scaling must not underflow it.
        let determinant = forward.matrix3.as_dmat3().determinant();
        if !forward.is_finite() || determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let exact = glam::DAffine3 {
            matrix3: forward.matrix3.as_dmat3(),
            translation: Vec3::from(forward.translation).as_dvec3(),
        }
        .inverse();
        let inverse = Affine3A {
            matrix3: exact.matrix3.as_mat3().into(),
            translation: Vec3A::from(exact.translation.as_vec3()),
        };
        inverse.is_finite().then_some(Self { forward, inverse })
    }

    /// Moves by `by`.
    pub fn translate(by: Vec3) -> Self {
        Self { forward: Affine3A::from_translation(by), inverse: Affine3A::from_translation(-by) }
    }

    /// Scales along the axes, or `None` where a factor vanishes or is not finite.
    pub fn scale(by: Vec3) -> Option<Self> {
        Self::from_affine(Affine3A::from_scale(by))
    }

    /// Turns by `angle` radians around `axis` (any length), or `None` where the axis vanishes.
    pub fn rotate(angle: f32, axis: Vec3) -> Option<Self> {
        let axis = axis.try_normalize()?;
        let forward = Affine3A::from_axis_angle(axis, angle);
        Some(Self { forward, inverse: Affine3A::from_mat3(glam::Mat3::from(forward.matrix3).transpose()) })
    }

    /// World to camera for a camera at `eye` that looks at `look` along +z, with `up` near +y and x along
    /// `up × z` (pbrt's `LookAt`). `None` where the three do not span a frame.
    pub fn look_at(eye: Vec3, look: Vec3, up: Vec3) -> Option<Self> {
        let z = (look - eye).try_normalize()?;
        let x = up.try_normalize()?.cross(z).try_normalize()?;
        let y = z.cross(x);
        let camera_to_world = Affine3A::from_mat3_translation(glam::Mat3::from_cols(x, y, z), eye);
        Some(Self::from_affine(camera_to_world)?.inverse())
    }

    /// The inverse map.
    #[inline]
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self { forward: self.inverse, inverse: self.forward }
    }

    /// The matrix of the map.
    #[inline]
    pub fn affine(&self) -> &Affine3A {
        &self.forward
    }

    /// The matrix of the inverse map.
    #[inline]
    pub fn inverse_affine(&self) -> &Affine3A {
        &self.inverse
    }

    /// Maps a point.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.forward.transform_point3(p)
    }

    /// Maps a vector.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.forward.transform_vector3(v)
    }

    /// Maps a normal, by the inverse transpose; its length changes.
    #[inline]
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let m = &self.inverse.matrix3;
        let n = Vec3A::from(n);
        Vec3::new(m.x_axis.dot(n), m.y_axis.dot(n), m.z_axis.dot(n))
    }

    /// Maps a ray; the parameter `t` of a point on it stays the same.
    #[inline]
    pub fn ray(&self, r: &Ray) -> Ray {
        Ray::new(self.point(r.origin), self.vector(r.direction), r.time)
    }

    /// The box around the mapped box.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() {
            return Bounds3::EMPTY;
        }
        Bounds3::around((0..8).map(|i| self.point(b.corner(i))))
    }

    /// Bound on the absolute error of [`Transform::point`] at `p`, itself known within `p_error`
    /// (pbrt book, 4th edition, §6.8.4).
    #[inline]
    pub fn point_error(&self, p: Vec3, p_error: Vec3) -> Vec3 {
        let abs = |v: Vec3A| Vec3::from(v).abs();
        let m = &self.forward.matrix3;
        let (x, y, z) = (abs(m.x_axis), abs(m.y_axis), abs(m.z_axis));
        let rounding = x * p.x.abs() + y * p.y.abs() + z * p.z.abs() + abs(self.forward.translation);
        let inherited = x * p_error.x + y * p_error.y + z * p_error.z;
        rounding * gamma(3) + inherited * (1.0 + gamma(3))
    }

    /// Whether the map turns a right-handed basis into a left-handed one.
    pub fn swaps_handedness(&self) -> bool {
        self.forward.matrix3.determinant() < 0.0
    }
}

impl std::ops::Mul for Transform {
    type Output = Self;

    /// `(a * b).point(p) == a.point(b.point(p))`.
    fn mul(self, b: Self) -> Self {
        Self { forward: self.forward * b.forward, inverse: b.inverse * self.inverse }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Transform {
        Transform::translate(Vec3::new(1.0, -2.0, 0.5))
            * Transform::rotate(0.7, Vec3::new(1.0, 2.0, 3.0)).unwrap()
            * Transform::scale(Vec3::new(2.0, 0.5, -1.0)).unwrap()
    }

    #[test]
    fn inverse_undoes() {
        let t = sample();
        let p = Vec3::new(0.3, 4.0, -1.0);
        assert!((t.inverse().point(t.point(p)) - p).length() < 1e-5);
        assert!(t.swaps_handedness());
    }

    #[test]
    fn normals_stay_perpendicular() {
        let t = sample();
        let (n, v) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, -1.0, 3.0));
        assert!(t.normal(n).dot(t.vector(v)).abs() < 1e-5);
    }

    #[test]
    fn look_at_puts_the_target_on_the_z_axis() {
        let t = Transform::look_at(Vec3::new(0.0, 2.0, 6.0), Vec3::ZERO, Vec3::Y).unwrap();
        let p = t.point(Vec3::ZERO);
        assert!(p.x.abs() < 1e-6 && p.y.abs() < 1e-6 && (p.z - 40f32.sqrt()).abs() < 1e-5);
        // The frame is right-handed: seen from +z, the world's +x is camera space's -x.
        assert!(t.vector(Vec3::X).x < 0.0 && !t.swaps_handedness());
        assert_eq!(Transform::look_at(Vec3::ZERO, Vec3::ZERO, Vec3::Y), None);
        assert_eq!(Transform::look_at(Vec3::ZERO, Vec3::Y, Vec3::Y), None);
    }

    #[test]
    fn singular_and_projective_matrices_are_refused() {
        assert_eq!(Transform::scale(Vec3::new(1.0, 0.0, 1.0)), None);
        assert_eq!(Transform::scale(Vec3::new(1.0, f32::NAN, 1.0)), None);
        assert_eq!(Transform::from_mat4(Mat4::from_cols_array(&[1.0; 16])), None);
        assert!(Transform::scale(Vec3::splat(1e-15)).is_some());
    }
}
