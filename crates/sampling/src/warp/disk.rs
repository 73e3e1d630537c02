use super::turn;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, TAU};
use tenfold_math::Vec2;
use tenfold_math::ops;

/// A uniform point of the unit disk, by the concentric map (Shirley and Chiu 1997): squares around the centre go to
/// circles, which keeps neighbours together and their distances within a factor of about 1.4.
#[inline(always)]
pub fn sample_uniform_disk_concentric(u: Vec2) -> Vec2 {
    let p = 2.0 * u - Vec2::ONE;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    // Selected, not branched: which way is as good as random.
    let is_wide = p.x.abs() > p.y.abs();
    let (r, across) = if is_wide { (p.x, p.y) } else { (p.y, p.x) };
    let (s, c) = ops::sin_cos_of_small(FRAC_PI_4 * (across / r));
    r * if is_wide { Vec2::new(c, s) } else { Vec2::new(s, c) }
}

/// The numbers that [`sample_uniform_disk_concentric`] maps to `p`.
#[inline]
pub fn invert_uniform_disk_concentric(p: Vec2) -> Vec2 {
    let r = p.length();
    let q = if p.x.abs() > p.y.abs() {
        // r keeps the sign of x; the angle from the x axis is that of the point mirrored to the right.
        Vec2::new(r.copysign(p.x), r * ops::atan(p.y / p.x.abs()) / FRAC_PI_4)
    } else if p.y != 0.0 {
        Vec2::new(r * ops::atan(p.x / p.y.abs()) / FRAC_PI_4, r.copysign(p.y))
    } else {
        Vec2::ZERO
    };
    0.5 * (q + Vec2::ONE)
}

/// A uniform point of the unit disk in polar coordinates: the radius is `√u.x`, the angle `2π·u.y`.
#[inline]
pub fn sample_uniform_disk_polar(u: Vec2) -> Vec2 {
    let (s, c) = ops::sin_cos(TAU * u.y);
    u.x.sqrt() * Vec2::new(c, s)
}

/// The numbers that [`sample_uniform_disk_polar`] maps to `p`.
#[inline]
pub fn invert_uniform_disk_polar(p: Vec2) -> Vec2 {
    Vec2::new(p.length_squared(), turn(p.x, p.y))
}

/// Density per unit of area on the unit disk.
#[inline]
pub const fn uniform_disk_pdf() -> f32 {
    FRAC_1_PI
}
