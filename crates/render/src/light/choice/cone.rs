//! Cones around cones of directions.

use std::f32::consts::PI;
use tenfold_geometry::NormalCone;
use tenfold_math::ops;
use tenfold_math::{Quat, angle_between};

/// A narrow cone around both: the smallest one that touches them from outside (Conty Estevez and Kulla 2018,
/// algorithm 1).
pub(super) fn union(a: NormalCone, b: NormalCone) -> NormalCone {
    // Planar meshes unite equal cones again and again.
    if a == b {
        return a;
    }
    let (wide, narrow) = if a.cos_theta <= b.cos_theta { (a, b) } else { (b, a) };
    // Most often the wide one holds the other, and no angle is needed to see it: between ≤ θw − θn.
    let sin = |c: NormalCone| (1.0 - c.cos_theta * c.cos_theta).max(0.0).sqrt();
    let rest = wide.cos_theta * narrow.cos_theta + sin(wide) * sin(narrow);
    if wide.cos_theta <= -1.0 || wide.axis.dot(narrow.axis) >= rest {
        return wide;
    }
    let theta = |c: NormalCone| ops::acos(c.cos_theta.clamp(-1.0, 1.0));
    let (theta_w, theta_n) = (theta(wide), theta(narrow));
    let between = angle_between(wide.axis, narrow.axis);
    let half = 0.5 * (theta_w + between + theta_n);
    if half >= PI {
        return NormalCone::EVERYWHERE;
    }
    // Turn the wide cone's axis toward the other until its far edge stays where it was.
    match wide.axis.cross(narrow.axis).try_normalize() {
        Some(pivot) => NormalCone {
            axis: (Quat::from_axis_angle(pivot, half - theta_w) * wide.axis).normalize(),
            cos_theta: ops::cos(half),
        },
        // Opposite axes leave the plane of the turn open.
        None => NormalCone::EVERYWHERE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::{Frame, Vec3, spherical_direction};

    #[test]
    fn the_union_holds_both_and_is_tight() {
        let cone = |axis, cos_theta| NormalCone { axis, cos_theta };
        let cones = [
            NormalCone::along(Vec3::Z),
            cone(Vec3::X, 0.9),
            cone(Vec3::new(0.6, 0.0, -0.8), 0.2),
            cone(Vec3::Y, -0.3),
            NormalCone::EVERYWHERE,
        ];
        for a in cones {
            for b in cones {
                let u = union(a, b);
                for c in [a, b] {
                    let frame = Frame::from_z(c.axis);
                    let sin = (1.0 - c.cos_theta * c.cos_theta).max(0.0).sqrt();
                    for i in 0..64 {
                        let rim = spherical_direction(sin, c.cos_theta, i as f32 / 32.0 * PI);
                        assert!(u.contains(frame.to_world(rim)), "{a:?} {b:?} {u:?}");
                    }
                }
                assert!(u.cos_theta <= a.cos_theta.min(b.cos_theta));
            }
        }
        let u = union(NormalCone::along(Vec3::Z), NormalCone::along(Vec3::X));
        assert!((u.cos_theta - 0.5f32.sqrt()).abs() < 1e-6);
    }
}
