use super::{
    ShapeError, ShapeHit,
    quadric::{Placement, azimuth, check_finite},
};
use crate::{
    NormalCone, ReferencePoint, ShapeSample, SurfaceInteraction, SurfacePoint, sample::pdf_by_solid_angle,
};
use std::f32::consts::TAU;
use tenfold_math::ops;
use tenfold_math::{Bounds3, Ray, Transform, Vec2, Vec3, gamma, sqr};
use tenfold_sampling::warp::sample_uniform_disk_concentric;

/// What a [`Disk`] is made from; the default is the whole unit disk in the plane z = 0.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DiskParams {
    /// Its z.
    pub height: f32,
    /// The radius.
    pub radius: f32,
    /// The radius of the hole.
    pub inner_radius: f32,
    /// The azimuth swept, in radians.
    pub phi_max: f32,
}

impl Default for DiskParams {
    fn default() -> Self {
        Self { height: 0.0, radius: 1.0, inner_radius: 0.0, phi_max: TAU }
    }
}

/// A disk perpendicular to z in object space, or an annulus, or a sector.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Disk {
    placement: Placement,
    params: DiskParams,
    /// In the world.
    area: f32,
}

impl Disk {
    /// A disk.
    ///
    /// # Errors
    /// Where a parameter is not finite or the radius is not positive.
    pub fn new(
        to_world: Transform,
        reverse_orientation: bool,
        mut params: DiskParams,
    ) -> Result<Self, ShapeError> {
        let DiskParams { height, radius, inner_radius, phi_max } = params;
        check_finite(&[
            ("height", height),
            ("radius", radius),
            ("innerradius", inner_radius),
            ("phimax", phi_max),
        ])?;
        if radius <= 0.0 {
            return Err(ShapeError::Parameter { parameter: "radius", value: radius });
        }
        if inner_radius < 0.0 {
            return Err(ShapeError::Parameter { parameter: "innerradius", value: inner_radius });
        }
        params.phi_max = phi_max.clamp(0.0, TAU);
        let placement = Placement::new(to_world, reverse_orientation);
        let object_area = params.phi_max * 0.5 * (sqr(radius) - sqr(inner_radius)).max(0.0);
        Ok(Self { placement, params, area: object_area * placement.area_scale(Vec3::Z) })
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let DiskParams { height, radius: r, .. } = self.params;
        self.placement.to_world.bounds(&Bounds3::new(Vec3::new(-r, -r, height), Vec3::new(r, r, height)))
    }

    pub(super) fn normal_cone(&self) -> NormalCone {
        NormalCone::along(self.normal())
    }

    fn normal(&self) -> Vec3 {
        self.placement.normal(Vec3::Z)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        mut accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        let object = self.placement.ray(ray);
        let t = (f64::from(self.params.height) - object.o.z) / object.d.z;
        let hit = ShapeHit { t: t as f32, u: 0.0, v: 0.0 };
        // Also leaves out NaN and infinity, of rays in the plane and beside it.
        if !(t > object.o_error.z / object.d.z.abs() && hit.t < t_max && t.is_finite()) {
            return None;
        }
        let p = object.at(t);
        let r2 = p.x * p.x + p.y * p.y;
        let DiskParams { radius, inner_radius, phi_max, .. } = self.params;
        let square = |x: f32| f64::from(x) * f64::from(x);
        if r2 > square(radius) || r2 < square(inner_radius) {
            return None;
        }
        if phi_max < TAU && azimuth(p.as_vec3()) > phi_max {
            return None;
        }
        accept(hit).then_some(hit)
    }

    fn object_uv(&self, p: Vec3) -> Vec2 {
        let DiskParams { radius, inner_radius, phi_max, .. } = self.params;
        let r = p.truncate().length();
        Vec2::new(azimuth(p) / phi_max, (radius - r) / (radius - inner_radius))
    }

    pub(super) fn uv(&self, ray: &Ray, hit: &ShapeHit) -> Vec2 {
        self.object_uv(self.placement.ray(ray).at(f64::from(hit.t)).as_vec3())
    }

    pub(super) fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        let DiskParams { height, radius, inner_radius, phi_max } = self.params;
        let p = self.placement.ray(ray).at(f64::from(hit.t)).as_vec3();
        let p = Vec3::new(p.x, p.y, height);
        let r = p.truncate().length();
        let radial = if r > 0.0 { Vec3::new(p.x / r, p.y / r, 0.0) } else { Vec3::X };
        // At the centre ∂p/∂u vanishes: keep its direction, so that the frame stays one.
        let around = phi_max * r.max(1e-7 * radius) * Vec3::new(-radial.y, radial.x, 0.0);
        let derivatives = [around, radial * (inner_radius - radius), Vec3::ZERO, Vec3::ZERO];
        let n = if self.placement.flip { Vec3::NEG_Z } else { Vec3::Z };
        let uv = self.object_uv(p);
        self.placement.place(&SurfaceInteraction::new(p, Vec3::ZERO, n, uv, Vec2::ZERO, derivatives, ray))
    }

    pub(super) fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let DiskParams { height, radius, inner_radius, phi_max } = self.params;
        let xy = if inner_radius == 0.0 && phi_max == TAU {
            radius * sample_uniform_disk_concentric(u)
        } else {
            let r2 = sqr(inner_radius) + u.x * (sqr(radius) - sqr(inner_radius));
            let (sin, cos) = ops::sin_cos(u.y * phi_max);
            r2.max(0.0).sqrt() * Vec2::new(cos, sin)
        };
        let p = xy.extend(height);
        let pdf = 1.0 / self.area;
        pdf.is_finite().then(|| ShapeSample {
            p: self.placement.to_world.point(p),
            p_error: self.placement.to_world.point_error(p, gamma(4) * Vec3::new(p.x.abs(), p.y.abs(), 0.0)),
            n: self.normal(),
            uv: self.object_uv(p),
            param: Vec2::ZERO,
            pdf,
        })
    }

    pub(super) fn pdf_area(&self, _: &SurfacePoint) -> f32 {
        1.0 / self.area
    }

    pub(super) fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        self.sample_area(u)?.by_solid_angle(reference)
    }

    pub(super) fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        pdf_by_solid_angle(self.pdf_area(point), point.p - reference.p, point.n)
    }
}
