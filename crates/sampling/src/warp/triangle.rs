use tenfold_math::{Vec2, Vec3};

/// Uniform barycentric coordinates of a triangle, by the map of Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
/// The density per unit of area is one over the triangle's area.
#[inline(always)]
pub fn sample_uniform_triangle(u: Vec2) -> Vec3 {
    // Both, and no branch: for loops over slots.
    let half = 0.5 * u;
    let (b0, b1) = if u.x < u.y { (half.x, u.y - half.x) } else { (u.x - half.y, half.y) };
    // Not 1 − b0 − b1, which may round below zero.
    Vec3::new(b0, b1, (1.0 - (b0 + b1)).max(0.0))
}

/// The numbers that [`sample_uniform_triangle`] maps to the barycentric coordinates `b`.
#[inline]
pub fn invert_uniform_triangle(b: Vec3) -> Vec2 {
    if b.x > b.y { Vec2::new(b.x + b.y, 2.0 * b.y) } else { Vec2::new(2.0 * b.x, b.x + b.y) }
}
