//! Directions in the local frame of shading: unit vectors, z along the normal.

use tenfold_math::Vec3;

/// Whether both directions, neither in the surface, leave the same side of it. Compares signs, as a product underflows.
#[inline(always)]
pub(crate) fn same_hemisphere(a: Vec3, b: Vec3) -> bool {
    (a.z > 0.0) == (b.z > 0.0)
}

/// `a` or else `b`, without a branch.
#[inline(always)]
pub(crate) fn either(condition: bool, a: Vec3, b: Vec3) -> Vec3 {
    let of = |a: f32, b: f32| if condition { a } else { b };
    Vec3::new(of(a.x, b.x), of(a.y, b.y), of(a.z, b.z))
}

/// Mirror image of `wo` about the unit vector `n`; both point away from the surface.
#[inline(always)]
pub fn reflect(wo: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * wo.dot(n)) - wo
}

/// Mirror image of `wo` about the local normal.
#[inline(always)]
pub(crate) fn reflect_local(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

/// Snell's law: the direction, pointing away from the surface, into which light from `wo` goes through a boundary
/// with unit normal `n` on the side of `wo`. `eta` is the index of the far side over that of the side of `wo`.
/// `None` under total internal reflection.
#[inline(always)]
pub fn refract(wo: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let (direction, refracts) = refraction(wo, n, eta);
    refracts.then_some(direction)
}

/// [`refract`] without branches: the direction, and whether it is one.
#[inline(always)]
pub(crate) fn refraction(wo: Vec3, n: Vec3, eta: f32) -> (Vec3, bool) {
    let cos_i = wo.dot(n);
    let sin2_i = (1.0 - cos_i * cos_i).max(0.0);
    let sin2_t = sin2_i / (eta * eta);
    let cos_t = (1.0 - sin2_t).sqrt();
    (n * (cos_i / eta - cos_t) - wo / eta, (sin2_t < 1.0) & (cos_i >= 0.0))
}

/// [`refract`] through the local normal. Keeps the tangential components exact to rounding.
#[inline]
pub(crate) fn refract_local(wo: Vec3, eta: f32) -> Option<Vec3> {
    let (x, y) = (-wo.x / eta, -wo.y / eta);
    let cos2_t = 1.0 - (x * x + y * y);
    (cos2_t > 0.0).then(|| Vec3::new(x, y, -cos2_t.sqrt().copysign(wo.z)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refraction_follows_snell_and_reverses() {
        let n = Vec3::new(0.1, -0.2, 0.9).normalize();
        for wo in [Vec3::new(0.3, 0.2, 0.8), Vec3::new(-0.9, 0.1, 0.4), Vec3::Z] {
            let wo = wo.normalize();
            let wi = refract(wo, n, 1.5).unwrap();
            assert!((wi.length() - 1.0).abs() < 1e-6);
            let (sin_o, sin_i) = (wo.cross(n).length(), wi.cross(n).length());
            assert!((sin_o - 1.5 * sin_i).abs() < 1e-6);
            let back = refract(wi, -n, 1.0 / 1.5).unwrap();
            assert!((back - wo).length() < 1e-5);
            assert!((refract_local(wo, 1.5).unwrap() - refract(wo, Vec3::Z, 1.5).unwrap()).length() < 1e-6);
        }
        let below = Vec3::new(0.8, 0.0, -0.6);
        assert_eq!(refract(below, Vec3::NEG_Z, 1.0 / 1.5), None);
        assert_eq!(refract_local(below, 1.0 / 1.5), None);
    }

    #[test]
    fn reflection_is_an_involution() {
        let n = Vec3::new(0.1, -0.2, 0.9).normalize();
        let wo = Vec3::new(0.3, 0.2, 0.8).normalize();
        assert!((reflect(reflect(wo, n), n) - wo).length() < 1e-6);
        assert!((reflect(wo, Vec3::Z) - reflect_local(wo)).length() < 1e-7);
    }
}
