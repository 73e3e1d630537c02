use super::turn;
use std::f32::consts::TAU;
use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3};

// All three take the versine 1 − cos θ of the half angle, which keeps its digits where the cone is narrow: for a sphere of
// radius r seen from the distance d it is s / (1 + √(1 − s)) with s = (r / d)².

/// A uniform direction in the cone around +z whose half angle has the `versine` 1 − cos θ.
#[inline]
pub fn sample_uniform_cone(u: Vec2, versine: f32) -> Vec3 {
    let v = u.x * versine;
    let sin_theta = (v * (2.0 - v)).max(0.0).sqrt();
    let (s, c) = ops::sin_cos(TAU * u.y);
    Vec3::new(sin_theta * c, sin_theta * s, 1.0 - v)
}

/// Density per steradian in the cone whose half angle has the `versine` 1 − cos θ.
#[inline]
pub fn uniform_cone_pdf(versine: f32) -> f32 {
    1.0 / (TAU * versine)
}

/// The numbers that [`sample_uniform_cone`] maps to the unit vector `d`.
#[inline]
pub fn invert_uniform_cone(d: Vec3, versine: f32) -> Vec2 {
    // 1 − cos θ = sin² θ / (1 + cos θ), without cancellation in the upper half.
    let v = if d.z > 0.0 { d.truncate().length_squared() / (1.0 + d.z) } else { 1.0 - d.z };
    Vec2::new(v / versine, turn(d.x, d.y))
}
