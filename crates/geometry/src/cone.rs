use tenfold_math::Vec3;

/// A cone of directions: all within the angle θ of an axis. Bounds the normals of a surface.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NormalCone {
    /// The unit axis.
    pub axis: Vec3,
    /// Cosine of the half angle θ; −1 holds every direction.
    pub cos_theta: f32,
}

impl NormalCone {
    /// Every direction.
    pub const EVERYWHERE: Self = Self { axis: Vec3::Z, cos_theta: -1.0 };

    /// One direction alone.
    pub fn along(axis: Vec3) -> Self {
        Self { axis, cos_theta: 1.0 }
    }

    /// Whether the unit vector `d` lies in the cone, up to rounding.
    pub fn contains(&self, d: Vec3) -> bool {
        self.axis.dot(d) >= self.cos_theta - 1e-5
    }
}
