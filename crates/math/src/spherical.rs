use crate::ops;
use crate::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// The unit vector at polar angle θ (given as sine and cosine) and azimuth `phi`, in radians, of at most 10⁵, around z.
#[inline]
pub fn spherical_direction(sin_theta: f32, cos_theta: f32, phi: f32) -> Vec3 {
    let (s, c) = ops::sin_cos_of_moderate(phi);
    Vec3::new(sin_theta * c, sin_theta * s, cos_theta)
}

/// Polar angle in `[0, π]` and azimuth in `[0, 2π)` of a unit vector, around z.
#[inline]
pub fn direction_to_spherical(d: Vec3) -> Vec2 {
    let phi = ops::atan2(d.y, d.x);
    Vec2::new(ops::acos(d.z.clamp(-1.0, 1.0)), if phi < 0.0 { phi + TAU } else { phi })
}

/// The angle between two unit vectors, precise also near 0 and π (Kahan).
#[inline]
pub fn angle_between(a: Vec3, b: Vec3) -> f32 {
    if a.dot(b) < 0.0 {
        PI - 2.0 * ops::asin((0.5 * (a + b).length()).min(1.0))
    } else {
        2.0 * ops::asin((0.5 * (b - a).length()).min(1.0))
    }
}

/// Solid angle in steradians of the spherical triangle with unit vertices (Van Oosterom and Strackee 1983).
#[inline]
pub fn spherical_triangle_area(a: Vec3, b: Vec3, c: Vec3) -> f32 {
    (2.0 * ops::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + a.dot(c) + b.dot(c))).abs()
}

/// Solid angle in steradians of the convex spherical quadrilateral `a b c d`, as two triangles.
#[inline]
pub fn spherical_quad_area(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f32 {
    spherical_triangle_area(a, b, c) + spherical_triangle_area(a, c, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_octant_is_an_eighth_of_the_sphere() {
        assert!((spherical_triangle_area(Vec3::X, Vec3::Y, Vec3::Z) - PI / 2.0).abs() < 1e-6);
    }

    #[test]
    fn small_angles_keep_their_digits() {
        let b = Vec3::new(1e-5, 0.0, 1.0).normalize();
        assert!((angle_between(Vec3::Z, b) / 1e-5 - 1.0).abs() < 1e-5);
        assert!((angle_between(Vec3::Z, Vec3::NEG_Z) - PI).abs() < 1e-6);
    }
}
