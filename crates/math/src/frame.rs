use crate::Vec3;

/// A right-handed orthonormal basis; local directions have z along [`Frame::z`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Frame {
    /// Any frame around the unit vector `z` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline]
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// The frame around the unit vector `z` whose `x` is nearest to `tangent`; any frame around `z` where
    /// `tangent` is parallel to it or vanishes.
    #[inline]
    pub fn from_z_and_tangent(z: Vec3, tangent: Vec3) -> Self {
        let x = tangent - z * z.dot(tangent);
        let length_squared = x.length_squared();
        if length_squared > 1e-12 * tangent.length_squared() && length_squared.is_finite() {
            let x = x / length_squared.sqrt();
            Self { x, y: z.cross(x), z }
        } else {
            Self::from_z(z)
        }
    }

    /// World to local.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local to world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for z in [Vec3::Z, Vec3::NEG_Z, Vec3::new(0.36, -0.48, -0.8), Vec3::new(1e-4, 0.0, -1.0).normalize()]
        {
            for f in [
                Frame::from_z(z),
                Frame::from_z_and_tangent(z, Vec3::new(0.3, 2.0, 0.1)),
                Frame::from_z_and_tangent(z, z),
            ] {
                assert!((f.x.cross(f.y) - f.z).length() < 1e-6);
                assert!((f.to_world(f.to_local(Vec3::ONE)) - Vec3::ONE).length() < 1e-6);
            }
        }
    }
}
