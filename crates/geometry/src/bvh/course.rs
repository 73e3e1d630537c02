//! What the tests of boxes and triangles want to know of rays.

use super::stream::Streams;
use crate::shape::{RayShear, fastest_axis, permuted};
use tenfold_math::{Ray, Rays, Vec3, Vec3s, WIDTH, higher, vectorized};

/// A ray on its way through a hierarchy.
pub(crate) trait Course {
    /// The ray.
    fn ray(&self) -> &Ray;

    /// The inverse of its direction, as [`inverse`] has it.
    fn inverse(&self) -> Vec3;

    /// The same ray for triangles.
    fn shear(&self) -> RayShear;
}

/// By itself: found out when it is asked for.
impl Course for Ray {
    #[inline(always)]
    fn ray(&self) -> &Ray {
        self
    }

    #[inline(always)]
    fn inverse(&self) -> Vec3 {
        inverse(self.direction)
    }

    #[inline(always)]
    fn shear(&self) -> RayShear {
        RayShear::new(self)
    }
}

/// The inverse of a direction for boxes: a ray along a slab gets a tiny slope instead of an infinite inverse, whose product with 0 would be NaN.
#[inline(always)]
fn inverse(d: Vec3) -> Vec3 {
    let tiny = 1e-18 * higher(d.x.abs(), higher(d.y.abs(), d.z.abs()));
    let inverse = |d: f32| 1.0 / if d.abs() < tiny { tiny.copysign(d) } else { d };
    Vec3::new(inverse(d.x), inverse(d.y), inverse(d.z))
}

/// How many vertices are turned toward the rays of all slots at once.
pub(crate) const MOST_VERTICES: usize = 16;

/// Room for what the tests of boxes and triangles want to know of the ray in each slot.
#[derive(Copy, Clone, Debug)]
pub struct RayCourses {
    pub(crate) inverse: Vec3s,
    pub(crate) shear: Vec3s,
    /// The axes along which they run fastest.
    pub(crate) axis: [u32; WIDTH],
    /// Their origins by axes permuted so that this one is the last.
    pub(crate) origin: Vec3s,
    /// Room for vertices in the spaces of these rays, so that it needs not be cleared for every wave: [`World`](crate::World)s of few primitives use it.
    pub(crate) vertices: [Vec3s; MOST_VERTICES],
    /// Room for what these rays come to, for the same reason.
    pub(crate) streams: Streams,
}

impl Default for RayCourses {
    fn default() -> Self {
        Self {
            inverse: Vec3s::ZERO,
            shear: Vec3s::ZERO,
            axis: [0; WIDTH],
            origin: Vec3s::ZERO,
            vertices: [Vec3s::ZERO; MOST_VERTICES],
            streams: Streams::EMPTY,
        }
    }
}

impl RayCourses {
    /// Prepares `rays`.
    #[inline]
    pub(crate) fn prepare(&mut self, rays: &Rays) {
        prepare(rays, self);
    }

    /// The course of the ray in a slot, which must be that which was prepared.
    #[inline(always)]
    pub(crate) fn of(&self, slot: usize, ray: Ray) -> Prepared {
        let shear = RayShear::known(ray.origin, self.axis[slot] as usize, self.shear.get(slot));
        Prepared { ray, inverse: self.inverse.get(slot), shear }
    }
}

/// A prepared ray.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Prepared {
    ray: Ray,
    inverse: Vec3,
    shear: RayShear,
}

impl Course for Prepared {
    #[inline(always)]
    fn ray(&self) -> &Ray {
        &self.ray
    }

    #[inline(always)]
    fn inverse(&self) -> Vec3 {
        self.inverse
    }

    #[inline(always)]
    fn shear(&self) -> RayShear {
        self.shear
    }
}

vectorized! {
    /// Prepares rays.
    fn prepare(rays: &Rays, out: &mut RayCourses) {
        for i in 0..WIDTH {
            let d = rays.direction.get(i);
            let axis = fastest_axis(d);
            out.inverse.set(i, inverse(d));
            out.shear.set(i, RayShear::along(d, axis));
            out.axis[i] = axis;
            out.origin.set(i, permuted(rays.origin.get(i), axis));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::Rng;

    #[test]
    fn prepared_rays_are_what_they_are_by_themselves() {
        let mut rng = Rng::new(8);
        let mut number = || 2.0 * rng.f32() - 1.0;
        for round in 0..200 {
            let mut rays = Rays::default();
            for slot in 0..WIDTH {
                let mut d = [number(), number(), number()];
                // Along planes and axes, too.
                (0..round % 3).for_each(|axis| d[(axis + slot) % 3] *= 0.0);
                rays.set(slot, Ray::new(Vec3::new(number(), number(), number()), d.into(), 0.5));
            }
            let mut courses = RayCourses::default();
            courses.prepare(&rays);
            for slot in 0..WIDTH {
                let ray = rays.get(slot);
                let prepared = courses.of(slot, ray);
                assert_eq!((*prepared.ray(), prepared.inverse()), (ray, Course::inverse(&ray)));
                assert_eq!(prepared.shear(), Course::shear(&ray));
            }
        }
    }
}
