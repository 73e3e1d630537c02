//! Spheres that are whole and round in the world: hit and sampled there.

use super::quadric::ObjectRay;
use crate::ReferencePoint;
use glam::DVec3;
use std::f32::consts::{PI, TAU};
use tenfold_math::{Frame, Ray, Vec2, Vec3, gamma, offset_ray_origin, spherical_direction, sqr};

/// A whole round sphere in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) centre: Vec3,
    pub(super) radius: f32,
}

impl Ball {
    /// A ray from the centre of the ball.
    #[inline]
    pub(super) fn ray(&self, ray: &Ray) -> ObjectRay {
        let o = ray.origin.as_dvec3() - self.centre.as_dvec3();
        ObjectRay { o, d: ray.direction.as_dvec3(), o_error: DVec3::ZERO }
    }

    /// The unit normal outward at a ray parameter.
    #[inline]
    pub(super) fn outward(&self, ray: &Ray, t: f32) -> Vec3 {
        let p = self.ray(ray).at(f64::from(t));
        (p * (1.0 / p.length())).as_vec3()
    }

    /// The point with the unit normal `outward`, and a bound on its error.
    #[inline]
    pub(super) fn point(&self, outward: Vec3) -> [Vec3; 2] {
        let p_error = gamma(4) * self.centre.abs() + Vec3::splat(gamma(12) * self.radius);
        [self.centre + self.radius * outward, p_error]
    }

    /// The cone of directions to the ball, where `reference` is outside.
    pub(super) fn seen_from(&self, reference: &ReferencePoint) -> Option<Cone> {
        let Self { centre, radius } = *self;
        let origin = offset_ray_origin(reference.p, reference.p_error, reference.n, centre - reference.p);
        if origin.distance_squared(centre) <= radius * radius {
            return None;
        }
        let sin2 = radius * radius / reference.p.distance_squared(centre);
        if !(sin2 < 1.0) {
            return None;
        }
        let one_minus_cos = if sin2 < SMALL_SIN2 {
            // 1 − √(1 − s) = s/2 + s²/8 + …
            sin2 * (0.5 + 0.125 * sin2)
        } else {
            1.0 - (1.0 - sin2).sqrt()
        };
        Some(Cone { sin2, one_minus_cos })
    }

    /// The unit normal outward where a uniform direction in the `cone` first meets the ball.
    pub(super) fn sample(&self, cone: &Cone, reference: &ReferencePoint, u: Vec2) -> Vec3 {
        let Cone { sin2, one_minus_cos } = *cone;
        // q = 1 − cos θ of the direction, uniform in the cone; sin²θ = q·(2 − q). The very middle of the square, which chance does
        // not hit, is sent to that of the cone, for who freezes points there.
        let q = if u == Vec2::splat(0.5) { 0.0 } else { u.x * one_minus_cos };
        let sin2_theta = q * (2.0 - q);
        // The angle at the centre between the nearest point and the sampled one
        // (pbrt book, 4th edition, eq. 6.14).
        let sin_max = sin2.sqrt();
        let cos_alpha = sin2_theta / sin_max + (1.0 - q) * (1.0 - sin2_theta / sin2).max(0.0).sqrt();
        let sin_alpha = (1.0 - sqr(cos_alpha)).max(0.0).sqrt();
        let w = spherical_direction(sin_alpha, cos_alpha.min(1.0), u.y * TAU);
        -Frame::from_z((self.centre - reference.p).normalize()).to_world(w)
    }
}

/// The directions from a point to a ball.
pub(super) struct Cone {
    /// sin² of the half angle.
    sin2: f32,
    one_minus_cos: f32,
}

/// Below this sin² of the half angle (1.5°), 1 − cos θ is taken from its series.
const SMALL_SIN2: f32 = 0.000_685_23;

impl Cone {
    /// Density per steradian of all directions within.
    pub(super) fn pdf(&self) -> f32 {
        1.0 / (2.0 * PI * self.one_minus_cos)
    }
}
