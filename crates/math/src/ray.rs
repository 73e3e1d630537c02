use crate::Vec3;

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
/// to the next float or the one after it (pbrt book, 4th edition, §6.8.6).
#[inline]
pub fn offset_ray_origin(p: Vec3, p_error: Vec3, n: Vec3, direction: Vec3) -> Vec3 {
    let d = n.abs().dot(p_error);
    let offset = if direction.dot(n) < 0.0 { -d * n } else { d * n };
    let moved = p + offset;
    // At least the distance to the next float, away from the surface, or nowhere along the axes on which it lies.
    let away = (moved.abs() * f32::EPSILON).copysign(offset);
    moved + Vec3::select(offset.cmpeq(Vec3::ZERO), Vec3::ZERO, away)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vec3;

    #[test]
    fn origins_move_by_a_float_at_least_and_stay_in_their_planes() {
        for p in [vec3(1.0, -1.0, 0.1), vec3(0.0, 3e30, -0.5), vec3(-7.0, 1e-30, 0.999_999_94)] {
            for n in [vec3(0.6, 0.0, -0.8), vec3(0.0, 1.0, 0.0), vec3(-0.48, 0.6, 0.64)] {
                for direction in [n, -n] {
                    // Too small an error to change anything by itself.
                    let origin = offset_ray_origin(p, 1e-9 * p.abs(), n, direction);
                    for axis in 0..3 {
                        let (from, to, along) = (p[axis], origin[axis], direction[axis]);
                        let moved = if along > 0.0 { to > from } else { to < from };
                        assert!(if along == 0.0 { to == from } else { moved }, "{p} {n}: {origin}");
                        assert!((to - from).abs() <= 3e-7 * from.abs() + 3e-9 * p.length());
                    }
                }
            }
        }
    }
}
