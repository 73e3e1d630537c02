//! Spheres that are whole and round in the world: hit and sampled there.

use super::{
    ShapeHit,
    quadric::{Approach, ObjectRay},
};
use crate::{ReferencePoint, ReferencePoints, ShapeSamples};
use glam::DVec3;
use std::f32::consts::{PI, TAU};
use tenfold_math::{
    Floats, Frame, Ray, Slots, Vec2, Vec2s, Vec3, Vec3s, WIDTH, gamma, offset_ray_origin,
    spherical_direction, sqr, vectorized,
};

/// A whole round sphere in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Ball {
    pub(super) centre: Vec3,
    pub(super) radius: f32,
    /// Whether its normals point inward.
    pub(super) flip: bool,
}

impl Ball {
    /// Where a ray first hits the ball with `0 < t < t_max`, and whether it does. Without branches, for loops over slots: [`Sphere`](super::Sphere) does the
    /// same operations.
    #[inline(always)]
    pub(crate) fn hit(&self, ray: &Ray, t_max: f32) -> (ShapeHit, bool) {
        let ObjectRay { o, d, .. } = self.ray(ray);
        Approach::new(o, d, f64::from(self.radius)).roots(0.0).first(t_max)
    }

    /// A ray from the centre of the ball.
    #[inline(always)]
    pub(super) fn ray(&self, ray: &Ray) -> ObjectRay {
        let o = ray.origin.as_dvec3() - self.centre.as_dvec3();
        ObjectRay { o, d: ray.direction.as_dvec3(), o_error: DVec3::ZERO }
    }

    /// The unit normal outward at a ray parameter.
    #[inline(always)]
    pub(super) fn outward(&self, ray: &Ray, t: f32) -> Vec3 {
        let p = self.ray(ray).at(f64::from(t));
        (p * (1.0 / p.length_squared().sqrt())).as_vec3()
    }

    /// The unit normal `outward` or inward, as the ball has it.
    #[inline(always)]
    pub(super) fn normal(&self, outward: Vec3) -> Vec3 {
        if self.flip { -outward } else { outward }
    }

    /// The point with the unit normal `outward`, and a bound on its error.
    #[inline(always)]
    pub(super) fn point(&self, outward: Vec3) -> [Vec3; 2] {
        let p_error = gamma(4) * self.centre.abs() + Vec3::splat(gamma(12) * self.radius);
        [self.centre + self.radius * outward, p_error]
    }

    /// The cone of directions to the ball, where `reference` is outside.
    #[inline]
    pub(super) fn seen_from(&self, reference: &ReferencePoint) -> Option<Cone> {
        let cone = self.cone(reference);
        self.is_outside(reference, &cone).then_some(cone)
    }

    /// [`Ball::seen_from`] with a meaning only where `reference` is outside.
    #[inline(always)]
    fn cone(&self, reference: &ReferencePoint) -> Cone {
        let sin2 = self.radius * self.radius / reference.p.distance_squared(self.centre);
        // 1 − √(1 − s) = s/2 + s²/8 + …
        let (series, exact) = (sin2 * (0.5 + 0.125 * sin2), 1.0 - (1.0 - sin2).sqrt());
        Cone { sin2, one_minus_cos: if sin2 < SMALL_SIN2 { series } else { exact } }
    }

    /// Whether `reference`, and the origin of rays from there to the ball, are outside.
    #[inline(always)]
    fn is_outside(&self, reference: &ReferencePoint, cone: &Cone) -> bool {
        let Self { centre, radius, .. } = *self;
        let origin = offset_ray_origin(reference.p, reference.p_error, reference.n, centre - reference.p);
        (origin.distance_squared(centre) > radius * radius) & (cone.sin2 < 1.0)
    }

    /// The unit normal outward where a uniform direction in the `cone` first meets the ball.
    #[inline(always)]
    pub(super) fn sample(&self, cone: &Cone, reference: &ReferencePoint, u: Vec2) -> Vec3 {
        let Cone { sin2, one_minus_cos } = *cone;
        // q = 1 − cos θ of the direction, uniform in the cone; sin²θ = q·(2 − q). The very middle of the square, which chance does
        // not hit, is sent to that of the cone, for who freezes points there.
        let q = if (u.x == 0.5) & (u.y == 0.5) { 0.0 } else { u.x * one_minus_cos };
        let sin2_theta = q * (2.0 - q);
        // The angle at the centre between the nearest point and the sampled one
        // (pbrt book, 4th edition, eq. 6.14).
        let sin_max = sin2.sqrt();
        let cos_alpha = sin2_theta / sin_max + (1.0 - q) * (1.0 - sin2_theta / sin2).max(0.0).sqrt();
        let sin_alpha = (1.0 - sqr(cos_alpha)).max(0.0).sqrt();
        let w = spherical_direction(sin_alpha, cos_alpha.min(1.0), u.y * TAU);
        let to_centre = self.centre - reference.p;
        // Not `normalize`, whose root is a piece of assembly that does not become vector instructions.
        let z = to_centre * (1.0 / to_centre.length_squared().sqrt());
        -Frame::from_z(z).to_world(w)
    }
}

/// A [`Ball`] in each slot.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Balls {
    centre: Vec3s,
    radius: Floats,
    flip: [bool; WIDTH],
}

impl Balls {
    #[inline(always)]
    fn get(&self, slot: usize) -> Ball {
        Ball { centre: self.centre.get(slot), radius: self.radius[slot], flip: self.flip[slot] }
    }

    /// Sets the ball in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, ball: &Ball) {
        self.centre.set(slot, ball.centre);
        (self.radius[slot], self.flip[slot]) = (ball.radius, ball.flip);
    }

    /// [`Primitive::sample_from`](crate::Primitive::sample_from) for the ball and the point in each slot, and those of `slots` where the point is
    /// outside: the others have no meaning.
    pub fn samples_from(
        &self,
        slots: Slots,
        references: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
    ) -> Slots {
        let mut outside = [false; WIDTH];
        samples_from_outside(self, references, u, out, &mut outside);
        slots.keep(|slot| outside[slot])
    }
}

vectorized! {
    /// Points on the balls chosen for their view from all slots as if it were from outside, and where it is.
    fn samples_from_outside(
        balls: &Balls,
        references: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
        outside: &mut [bool; WIDTH],
    ) {
        for i in 0..WIDTH {
            let (ball, reference) = (balls.get(i), references.get(i));
            let cone = ball.cone(&reference);
            let outward = ball.sample(&cone, &reference, u.get(i));
            let [p, p_error] = ball.point(outward);
            outside[i] = ball.is_outside(&reference, &cone);
            out.p.set(i, p);
            out.p_error.set(i, p_error);
            out.n.set(i, ball.normal(outward));
            out.pdf[i] = cone.pdf();
        }
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
    #[inline(always)]
    pub(super) fn pdf(&self) -> f32 {
        1.0 / (2.0 * PI * self.one_minus_cos)
    }
}
