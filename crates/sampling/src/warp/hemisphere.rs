use super::{invert_uniform_disk_concentric, sample_uniform_disk_concentric, turn};
use std::f32::consts::{FRAC_1_PI, TAU};
use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3, sqr};

/// A direction around +z with density proportional to its cosine: the disk projected up (Malley 1988).
#[inline]
pub fn sample_cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = sample_uniform_disk_concentric(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Density per steradian; zero below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// The numbers that [`sample_cosine_hemisphere`] maps to the unit vector `d`.
#[inline]
pub fn invert_cosine_hemisphere(d: Vec3) -> Vec2 {
    invert_uniform_disk_concentric(d.truncate())
}

/// A uniform direction around +z (Archimedes: its z is uniform).
#[inline]
pub fn sample_uniform_hemisphere(u: Vec2) -> Vec3 {
    with_z(u.x, u.y)
}

/// Density per steradian on the hemisphere.
#[inline]
pub const fn uniform_hemisphere_pdf() -> f32 {
    0.5 * FRAC_1_PI
}

/// The numbers that [`sample_uniform_hemisphere`] maps to the unit vector `d`.
#[inline]
pub fn invert_uniform_hemisphere(d: Vec3) -> Vec2 {
    Vec2::new(d.z, turn(d.x, d.y))
}

/// A uniform direction.
#[inline]
pub fn sample_uniform_sphere(u: Vec2) -> Vec3 {
    with_z(1.0 - 2.0 * u.x, u.y)
}

/// Density per steradian on the sphere.
#[inline]
pub const fn uniform_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// The numbers that [`sample_uniform_sphere`] maps to the unit vector `d`.
#[inline]
pub fn invert_uniform_sphere(d: Vec3) -> Vec2 {
    Vec2::new(0.5 * (1.0 - d.z), turn(d.x, d.y))
}

#[inline]
fn with_z(z: f32, turns: f32) -> Vec3 {
    let r = (1.0 - sqr(z)).max(0.0).sqrt();
    let (s, c) = ops::sin_cos(TAU * turns);
    Vec3::new(r * c, r * s, z)
}
