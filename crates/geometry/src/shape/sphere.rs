use super::{
    ShapeError, ShapeHit,
    ball::Ball,
    quadric::{ObjectRay, Placement, azimuth, check_finite, integrate, roots},
};
use crate::{
    NormalCone, ReferencePoint, ShapeSample, SurfaceInteraction, SurfacePoint,
    plain::{PlainHits, PlainSurface, PlainSurfaces},
    sample::pdf_by_solid_angle,
};
use glam::Mat3;
use std::f32::consts::TAU;
use tenfold_math::ops;
use tenfold_math::{Bounds3, Ray, Rays, Slots, Transform, Vec2, Vec3, WIDTH, gamma, vectorized};

/// What a [`Sphere`] is made from; the default is the whole unit sphere.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SphereParams {
    /// The radius.
    pub radius: f32,
    /// The part below this z is cut off.
    pub z_min: f32,
    /// The part above this z is cut off.
    pub z_max: f32,
    /// The azimuth swept, in radians.
    pub phi_max: f32,
}

impl SphereParams {
    /// A whole sphere.
    pub fn whole(radius: f32) -> Self {
        Self { radius, z_min: -radius, z_max: radius, phi_max: TAU }
    }
}

impl Default for SphereParams {
    fn default() -> Self {
        Self::whole(1.0)
    }
}

/// A sphere around the origin of object space, or a part of it between two heights and up to an azimuth.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Sphere {
    placement: Placement,
    radius: f32,
    z_min: f32,
    z_max: f32,
    theta_z_min: f32,
    theta_z_max: f32,
    phi_max: f32,
    /// In the world.
    area: f32,
    /// The sphere in the world, where it is whole and still round.
    round: Option<Ball>,
}

impl Sphere {
    /// A sphere; `z_min` and `z_max` may be given in either order and are cut to the sphere.
    ///
    /// # Errors
    /// Where a parameter is not finite or the radius is not positive.
    pub fn new(
        to_world: Transform,
        reverse_orientation: bool,
        params: SphereParams,
    ) -> Result<Self, ShapeError> {
        let SphereParams { radius, z_min, z_max, phi_max } = params;
        check_finite(&[("radius", radius), ("zmin", z_min), ("zmax", z_max), ("phimax", phi_max)])?;
        if radius <= 0.0 {
            return Err(ShapeError::Parameter { parameter: "radius", value: radius });
        }
        let (z_min, z_max) =
            (z_min.min(z_max).clamp(-radius, radius), z_min.max(z_max).clamp(-radius, radius));
        let phi_max = phi_max.clamp(0.0, TAU);
        let placement = Placement::new(to_world, reverse_orientation);
        let whole = z_min == -radius && z_max == radius && phi_max == TAU;
        let round = placement.similarity.filter(|_| whole).map(|scale| Ball {
            centre: to_world.point(Vec3::ZERO),
            radius: scale * radius,
            flip: placement.flip,
        });
        let mut sphere = Self {
            placement,
            radius,
            z_min,
            z_max,
            theta_z_min: ops::acos((z_min / radius).clamp(-1.0, 1.0)),
            theta_z_max: ops::acos((z_max / radius).clamp(-1.0, 1.0)),
            phi_max,
            area: 0.0,
            round,
        };
        sphere.area = sphere.world_area();
        Ok(sphere)
    }

    /// Area in object space.
    fn object_area(&self) -> f32 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    fn world_area(&self) -> f32 {
        let scale = match self.placement.similarity {
            Some(s) => f64::from(s * s),
            None => integrate(32, |v| {
                integrate(32, |u| {
                    let p = self.object_point(Vec2::new(u as f32, v as f32));
                    f64::from(self.placement.area_scale(p / self.radius))
                })
            }),
        };
        (f64::from(self.object_area()) * scale) as f32
    }

    /// A point of object space from two numbers in [0, 1], uniformly by area.
    fn object_point(&self, u: Vec2) -> Vec3 {
        let z = self.z_min + u.x * (self.z_max - self.z_min);
        let r = (self.radius - z) * (self.radius + z);
        let (sin, cos) = ops::sin_cos(u.y * self.phi_max);
        let r = r.max(0.0).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }

    /// The sphere as a ball, where it is one.
    #[inline]
    pub(crate) fn ball(&self) -> Option<&Ball> {
        self.round.as_ref()
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        let r = self.radius;
        let b = self
            .placement
            .to_world
            .bounds(&Bounds3::new(Vec3::new(-r, -r, self.z_min), Vec3::new(r, r, self.z_max)));
        if let Some(Ball { centre: c, radius: r, .. }) = self.round {
            // The box of a turned box is larger than that of the ball.
            let ball = Bounds3::new(c - r, c + r).expanded(1e-5 * (r + c.abs().max_element()));
            return Bounds3 { min: b.min.max(ball.min), max: b.max.min(ball.max) };
        }
        b
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
        let r = f64::from(self.radius);
        self.off_pole((p * (r / p.length())).as_vec3())
    }

    /// [`Self::surface`] where the ball has the unit normal `outward` in the world.
    fn surface_of_ball(&self, ball: &Ball, outward: Vec3) -> (Vec3, f32) {
        self.off_pole(self.placement.to_world.inverse_affine().transform_vector3(ball.radius * outward))
    }

    /// An object-space point off the pole, which has no azimuth, and its azimuth.
    #[inline]
    fn off_pole(&self, p: Vec3) -> (Vec3, f32) {
        let p = self.beside_pole(p);
        (p, azimuth(p))
    }

    /// An object-space point, moved off the pole where it is there.
    #[inline(always)]
    fn beside_pole(&self, p: Vec3) -> Vec3 {
        let is_pole = (p.x == 0.0) & (p.y == 0.0);
        Vec3::new(if is_pole { 1e-5 * self.radius } else { p.x }, p.y, p.z)
    }

    fn is_cut_away(&self, p: Vec3, phi: f32) -> bool {
        (self.z_min > -self.radius && p.z < self.z_min)
            || (self.z_max < self.radius && p.z > self.z_max)
            || phi > self.phi_max
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        if let Some(ball) = &self.round {
            let ObjectRay { o, d, .. } = ball.ray(ray);
            return roots(o, d, 0.0, f64::from(ball.radius))?.first_hit(t_max, |_| false, accept);
        }
        let object = self.placement.ray(ray);
        let half_shift = object.o.abs().dot(object.o_error);
        let roots = roots(object.o, object.d, half_shift, f64::from(self.radius))?;
        let whole = self.phi_max == TAU && self.z_min == -self.radius && self.z_max == self.radius;
        let is_cut_away = |t| {
            !whole && {
                let (p, phi) = self.surface(&object, t);
                self.is_cut_away(p, phi)
            }
        };
        roots.first_hit(t_max, is_cut_away, accept)
    }

    fn object_uv(&self, p: Vec3, phi: f32) -> Vec2 {
        let theta = ops::acos((p.z / self.radius).clamp(-1.0, 1.0));
        Vec2::new(phi / self.phi_max, (theta - self.theta_z_min) / (self.theta_z_max - self.theta_z_min))
    }

    pub(crate) fn uv(&self, ray: &Ray, hit: &ShapeHit) -> Vec2 {
        let (p, phi) = match &self.round {
            Some(ball) => self.surface_of_ball(ball, ball.outward(ray, hit.t)),
            None => self.surface(&self.placement.ray(ray), f64::from(hit.t)),
        };
        self.object_uv(p, phi)
    }

    /// Derivatives by the parameters of an object-space point.
    #[inline]
    fn derivatives(&self, p: Vec3) -> [Vec3; 2] {
        let (phi_max, theta_range) = (self.phi_max, self.theta_z_max - self.theta_z_min);
        let z_radius = (p.x * p.x + p.y * p.y).sqrt();
        let (cos_phi, sin_phi) = (p.x / z_radius, p.y / z_radius);
        [eastward(phi_max, p), theta_range * Vec3::new(p.z * cos_phi, p.z * sin_phi, -z_radius)]
    }

    pub(super) fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        if let Some(ball) = &self.round {
            let outward = ball.outward(ray, hit.t);
            let (object, phi) = self.surface_of_ball(ball, outward);
            let [dpdu, dpdv] = self.derivatives(object).map(|d| self.placement.to_world.vector(d));
            let [p, p_error] = ball.point(outward);
            // The unit normal moves as the point does.
            let [dndu, dndv] = [dpdu, dpdv].map(|d| d / ball.radius);
            let (n, uv) = (ball.normal(outward), self.object_uv(object, phi));
            return SurfaceInteraction::new(p, p_error, n, uv, Vec2::ZERO, [dpdu, dpdv, dndu, dndv], ray);
        }
        let (p, phi) = self.surface(&self.placement.ray(ray), f64::from(hit.t));
        let [dpdu, dpdv] = self.derivatives(p);
        let [dndu, dndv] = [dpdu, dpdv].map(|d| d / self.radius);
        let outward = p / self.radius;
        let n = if self.placement.flip { -outward } else { outward };
        let (uv, derivatives) = (self.object_uv(p, phi), [dpdu, dpdv, dndu, dndv]);
        self.placement.place(&SurfaceInteraction::new(
            p,
            gamma(5) * p.abs(),
            n,
            uv,
            Vec2::ZERO,
            derivatives,
            ray,
        ))
    }

    /// [`Sphere::interaction`] at hits of a sphere that is a ball, in `slots`, without texture coordinates.
    pub(crate) fn plain_surfaces(&self, slots: Slots, rays: &Rays, at: &PlainHits, out: &mut PlainSurfaces) {
        let (Some(ball), to_world) = (&self.round, &self.placement.to_world) else { return };
        let (to_object, to_world) = (to_world.inverse_affine().matrix3, to_world.affine().matrix3);
        plain_surfaces(self, ball, &to_object.into(), &to_world.into(), rays, at, &slots.flags(), out);
    }

    pub(super) fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let p = self.object_point(Vec2::new(1.0 - u.x, u.y));
        let scale = self.placement.area_scale(p / self.radius);
        let phi = u.y * self.phi_max;
        let pdf = 1.0 / (self.object_area() * scale);
        pdf.is_finite().then(|| ShapeSample {
            p: self.placement.to_world.point(p),
            // Height and azimuth are exact here; the radius comes from a difference, a product and a root.
            p_error: self.placement.to_world.point_error(p, Vec3::splat(gamma(8) * self.radius)),
            n: self.placement.normal(p),
            uv: self.object_uv(p, phi),
            param: Vec2::ZERO,
            pdf,
        })
    }

    pub(super) fn pdf_area(&self, point: &SurfacePoint) -> f32 {
        if self.placement.similarity.is_some() {
            return 1.0 / self.area;
        }
        let p = self.placement.to_world.inverse().point(point.p).normalize_or(Vec3::Z);
        1.0 / (self.object_area() * self.placement.area_scale(p))
    }

    pub(super) fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        let Some((ball, cone)) = self.round.and_then(|ball| Some((ball, ball.seen_from(reference)?))) else {
            return self.sample_area(u)?.by_solid_angle(reference);
        };
        let outward = ball.sample(&cone, reference, u);
        let [p, p_error] = ball.point(outward);
        let (object, phi) = self.surface_of_ball(&ball, outward);
        Some(ShapeSample {
            p,
            p_error,
            n: ball.normal(outward),
            uv: self.object_uv(object, phi),
            param: Vec2::ZERO,
            pdf: cone.pdf(),
        })
    }

    pub(super) fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        match self.round.and_then(|ball| ball.seen_from(reference)) {
            Some(cone) => cone.pdf(),
            None => pdf_by_solid_angle(self.pdf_area(point), point.p - reference.p, point.n),
        }
    }
}

/// The derivative by u of an object-space point, where the azimuth is u times `phi_max`.
#[inline(always)]
fn eastward(phi_max: f32, p: Vec3) -> Vec3 {
    Vec3::new(-phi_max * p.y, phi_max * p.x, 0.0)
}

vectorized! {
    /// Surfaces of a sphere that is `ball`, in the slots that are `found`, without texture coordinates.
    fn plain_surfaces(
        sphere: &Sphere,
        ball: &Ball,
        to_object: &Mat3,
        to_world: &Mat3,
        rays: &Rays,
        at: &PlainHits,
        found: &[bool; WIDTH],
        out: &mut PlainSurfaces,
    ) {
        for i in 0..WIDTH {
            let outward = ball.outward(&rays.get(i), at.t[i]);
            let object = sphere.beside_pole(*to_object * (ball.radius * outward));
            let [p, p_error] = ball.point(outward);
            let surface = PlainSurface {
                p,
                p_error,
                n: ball.normal(outward),
                uv: Vec2::ZERO,
                dpdu: *to_world * eastward(sphere.phi_max, object),
            };
            out.set_if(found[i], i, surface);
        }
    }
}
