//! The equal-area octahedral map of the sphere (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere
//! using SIMD"), in the orientation of pbrt-v4's image lights.

use crate::ops;
use crate::{Vec2, Vec3};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_4};

/// Maps `[0, 1]²` to the unit sphere; equal areas go to equal solid angles.
pub fn equal_area_square_to_sphere(p: Vec2) -> Vec3 {
    let (u, v) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
    let (up, vp) = (u.abs(), v.abs());
    // Signed distance to the diagonal: the upper hemisphere fills |u| + |v| < 1.
    let signed_distance = 1.0 - (up + vp);
    let r = 1.0 - signed_distance.abs();
    let phi = FRAC_PI_4 * if r == 0.0 { 1.0 } else { (vp - up) / r + 1.0 };
    let z = (1.0 - r * r).copysign(signed_distance);
    let sin_theta = r * (2.0 - r * r).max(0.0).sqrt();
    Vec3::new((ops::cos(phi) * sin_theta).copysign(u), (ops::sin(phi) * sin_theta).copysign(v), z)
}

/// The inverse of [`equal_area_square_to_sphere`] for a unit vector `d`.
pub fn equal_area_sphere_to_square(d: Vec3) -> Vec2 {
    let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
    let r = (1.0 - z).max(0.0).sqrt();
    // Azimuth within the octant as a fraction of a quarter turn.
    let phi = if x == 0.0 && y == 0.0 { 0.0 } else { ops::atan2(y, x) * FRAC_2_PI };
    let (mut u, mut v) = (r - phi * r, phi * r);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    Vec2::new((u.copysign(d.x) + 1.0) * 0.5, (v.copysign(d.y) + 1.0) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_inverse_and_keep_area() {
        let n = 64;
        let (mut mean, mut upper) = (Vec3::ZERO, 0);
        for i in 0..n * n {
            let p = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            let d = equal_area_square_to_sphere(p);
            assert!((d.length() - 1.0).abs() < 1e-5);
            assert!((equal_area_sphere_to_square(d) - p).length() < 1e-4, "{p}");
            mean += d;
            // A cap of height 0.5 holds a quarter of the sphere.
            upper += (d.z > 0.5) as i32;
        }
        assert!(mean.length() / ((n * n) as f32) < 1e-4);
        assert!((upper as f32 / (n * n) as f32 - 0.25).abs() < 0.01);
    }
}
