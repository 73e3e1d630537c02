use super::{
    ShapeError, ShapeHit,
    quadric::{ObjectRay, Placement, azimuth, check_finite, integrate, roots},
};
use crate::{
    NormalCone, ReferencePoint, ShapeSample, SurfaceInteraction, SurfacePoint, sample::pdf_by_solid_angle,
};
use glam::DVec3;
use std::f32::consts::TAU;
use tenfold_math::ops;
use tenfold_math::{Bounds3, Ray, Transform, Vec2, Vec3, gamma};

/// What a [`Cylinder`] is made from; the default has radius 1 and goes from z = −1 to 1.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CylinderParams {
    /// The radius.
    pub radius: f32,
    /// One end.
    pub z_min: f32,
    /// The other end.
    pub z_max: f32,
    /// The azimuth swept, in radians.
    pub phi_max: f32,
}

impl Default for CylinderParams {
    fn default() -> Self {
        Self { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: TAU }
    }
}

/// The side of a cylinder around z in object space, or a part of it up to an azimuth; open at both ends.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Cylinder {
    placement: Placement,
    params: CylinderParams,
    /// In the world.
    area: f32,
}

impl Cylinder {
    /// A cylinder; `z_min` and `z_max` may be given in either order.
    ///
    /// # Errors
    /// Where a parameter is not finite or the radius is not positive.
    pub fn new(
        to_world: Transform,
        reverse_orientation: bool,
        params: CylinderParams,
    ) -> Result<Self, ShapeError> {
        let CylinderParams { radius, z_min, z_max, phi_max } = params;
        check_finite(&[("radius", radius), ("zmin", z_min), ("zmax", z_max), ("phimax", phi_max)])?;
        if radius <= 0.0 {
            return Err(ShapeError::Parameter { parameter: "radius", value: radius });
        }
        let params = CylinderParams {
            radius,
            z_min: z_min.min(z_max),
            z_max: z_min.max(z_max),
            phi_max: phi_max.clamp(0.0, TAU),
        };
        let mut cylinder =
            Self { placement: Placement::new(to_world, reverse_orientation), params, area: 0.0 };
        cylinder.area = cylinder.world_area();
        Ok(cylinder)
    }

    /// Area in object space.
    fn object_area(&self) -> f32 {
        let CylinderParams { radius, z_min, z_max, phi_max } = self.params;
        (z_max - z_min) * radius * phi_max
    }

    fn world_area(&self) -> f32 {
        let scale = match self.placement.similarity {
            Some(s) => f64::from(s * s),
            // The scale depends on the azimuth alone.
            None => integrate(64, |u| {
                let (sin, cos) = ops::sin_cos(u as f32 * self.params.phi_max);
                f64::from(self.placement.area_scale(Vec3::new(cos, sin, 0.0)))
            }),
        };
        (f64::from(self.object_area()) * scale) as f32
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let CylinderParams { radius: r, z_min, z_max, .. } = self.params;
        self.placement.to_world.bounds(&Bounds3::new(Vec3::new(-r, -r, z_min), Vec3::new(r, r, z_max)))
    }

    pub(super) fn normal_cone(&self) -> NormalCone {
        NormalCone::EVERYWHERE
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    /// Object-space point and azimuth at a ray parameter.
    fn surface(&self, ray: &ObjectRay, t: f64) -> (Vec3, f32) {
        let p = ray.at(t);
        let scale = f64::from(self.params.radius) / ops::hypot(p.x, p.y);
        let p = DVec3::new(p.x * scale, p.y * scale, p.z).as_vec3();
        (p, azimuth(p))
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        let object = self.placement.ray(ray);
        let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
        let CylinderParams { radius, z_min, z_max, phi_max } = self.params;
        let (o, d) = (flat(object.o), flat(object.d));
        let roots = roots(o, d, o.abs().dot(object.o_error), f64::from(radius))?;
        let is_cut_away = |t| {
            let z = object.at(t).z as f32;
            z < z_min || z > z_max || (phi_max < TAU && self.surface(&object, t).1 > phi_max)
        };
        roots.first_hit(t_max, is_cut_away, accept)
    }

    fn object_uv(&self, p: Vec3, phi: f32) -> Vec2 {
        let CylinderParams { z_min, z_max, phi_max, .. } = self.params;
        Vec2::new(phi / phi_max, (p.z - z_min) / (z_max - z_min))
    }

    pub(super) fn uv(&self, ray: &Ray, hit: &ShapeHit) -> Vec2 {
        let (p, phi) = self.surface(&self.placement.ray(ray), f64::from(hit.t));
        self.object_uv(p, phi)
    }

    pub(super) fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        let CylinderParams { radius, z_min, z_max, phi_max } = self.params;
        let (p, phi) = self.surface(&self.placement.ray(ray), f64::from(hit.t));
        let dpdu = Vec3::new(-phi_max * p.y, phi_max * p.x, 0.0);
        let dpdv = Vec3::new(0.0, 0.0, z_max - z_min);
        // ∂p/∂u × ∂p/∂v points outward for a positive range of z.
        let outward = Vec3::new(p.x, p.y, 0.0) / radius;
        self.placement.place(&SurfaceInteraction::new(
            p,
            gamma(3) * Vec3::new(p.x.abs(), p.y.abs(), 0.0),
            if self.placement.flip { -outward } else { outward },
            self.object_uv(p, phi),
            Vec2::ZERO,
            [dpdu, dpdv, dpdu / radius, Vec3::ZERO],
            ray,
        ))
    }

    pub(super) fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let CylinderParams { radius, z_min, z_max, phi_max } = self.params;
        let phi = u.y * phi_max;
        let (sin, cos) = ops::sin_cos(phi);
        let p = Vec3::new(radius * cos, radius * sin, z_min + u.x * (z_max - z_min));
        let outward = Vec3::new(cos, sin, 0.0);
        let pdf = 1.0 / (self.object_area() * self.placement.area_scale(outward));
        pdf.is_finite().then(|| ShapeSample {
            p: self.placement.to_world.point(p),
            p_error: self.placement.to_world.point_error(p, Vec3::new(1.0, 1.0, 0.0) * (gamma(4) * radius)),
            n: self.placement.normal(outward),
            uv: self.object_uv(p, phi),
            param: Vec2::ZERO,
            pdf,
        })
    }

    pub(super) fn pdf_area(&self, point: &SurfacePoint) -> f32 {
        if self.placement.similarity.is_some() {
            return 1.0 / self.area;
        }
        let p = self.placement.to_world.inverse().point(point.p);
        let outward = Vec3::new(p.x, p.y, 0.0).normalize_or(Vec3::X);
        1.0 / (self.object_area() * self.placement.area_scale(outward))
    }

    pub(super) fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        self.sample_area(u)?.by_solid_angle(reference)
    }

    pub(super) fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        pdf_by_solid_angle(self.pdf_area(point), point.p - reference.p, point.n)
    }
}
