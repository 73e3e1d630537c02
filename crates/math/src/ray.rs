use crate::{Vec3, next_by_sign};

/// A ray at an instant: `origin + t · direction`. The direction need not be of unit length.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub direction: Vec3,
    /// The instant, in the shutter units of the scene.
    pub time: f32,
}

impl Ray {
    /// A ray.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3, time: f32) -> Self {
        Self { origin, direction, time }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }
}

/// Where a ray toward `direction` must start so that it cannot meet again the surface it leaves: `p` moved off
/// the tangent plane of the geometric normal `n` by the bound `p_error` on the rounding error of `p`, and then
/// to the next float (pbrt book, 4th edition, §6.8.6).
#[inline]
pub fn offset_ray_origin(p: Vec3, p_error: Vec3, n: Vec3, direction: Vec3) -> Vec3 {
    let d = n.abs().dot(p_error);
    let offset = if direction.dot(n) < 0.0 { -d * n } else { d * n };
    let moved = p + offset;
    let away = |x, o| next_by_sign(x, o);
    Vec3::new(away(moved.x, offset.x), away(moved.y, offset.y), away(moved.z, offset.z))
}
