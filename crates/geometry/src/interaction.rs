use crate::{InstanceId, PrimitiveId, ReferencePoint, ShapeSample, SurfacePoint};
use tenfold_math::{Id, Ray, Transform, Vec2, Vec3, offset_ray_origin};

/// How far along a ray of [`ray_between`] an occluder counts: short of the far end by more than its rounding.
pub const SHADOW_T_MAX: f32 = 0.9999;

/// The frame that shading uses: bent by vertex normals, tangents and bump maps.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Shading {
    /// Unit normal.
    pub n: Vec3,
    /// Derivative of the position by texture u.
    pub dpdu: Vec3,
    /// Derivative of the position by texture v.
    pub dpdv: Vec3,
    /// Derivative of the normal by texture u.
    pub dndu: Vec3,
    /// Derivative of the normal by texture v.
    pub dndv: Vec3,
}

/// All that is known of the surface where a ray meets it, in world space.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// The point.
    pub p: Vec3,
    /// Bound on the absolute error of `p` in each coordinate (pbrt book, 4th edition, §6.8).
    pub p_error: Vec3,
    /// Unit geometric normal. Flipped by reversed orientation and by mirroring transforms; on the side of the
    /// vertex normals where a mesh has them.
    pub n: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// The hit's own parameters: see [`Hit::u`](crate::Hit::u) and [`Hit::v`](crate::Hit::v).
    pub param: Vec2,
    /// Derivative of the position by texture u.
    pub dpdu: Vec3,
    /// Derivative of the position by texture v.
    pub dpdv: Vec3,
    /// The frame for shading.
    pub shading: Shading,
    /// Unit direction to where the ray came from.
    pub wo: Vec3,
    /// The ray's time.
    pub time: f32,
    /// What was hit.
    pub primitive: PrimitiveId,
    /// Through which instance.
    pub instance: InstanceId,
    /// The face of the mesh's file that the primitive belongs to; 0 where the mesh does not say.
    pub face_index: u32,
}

impl SurfaceInteraction {
    /// A surface without a shading frame of its own. [`World::interaction`](crate::World::interaction) fills in what was hit.
    #[inline]
    pub(crate) fn new(
        p: Vec3,
        p_error: Vec3,
        n: Vec3,
        uv: Vec2,
        param: Vec2,
        [dpdu, dpdv, dndu, dndv]: [Vec3; 4],
        ray: &Ray,
    ) -> Self {
        Self {
            p,
            p_error,
            n,
            uv,
            param,
            dpdu,
            dpdv,
            shading: Shading { n, dpdu, dpdv, dndu, dndv },
            wo: toward_origin(ray),
            time: ray.time,
            primitive: PrimitiveId { geometry: Id::new(0), index: 0 },
            instance: InstanceId::NONE,
            face_index: 0,
        }
    }

    /// The same surface mapped by `t`; normals by the inverse transpose, the error bound widened.
    pub(crate) fn transformed(&self, t: &Transform) -> Self {
        let n = t.normal(self.n).normalize_or(self.n);
        let raw = t.normal(self.shading.n);
        let scale = raw.length().recip();
        let shading_n = if scale.is_finite() { raw * scale } else { n };
        // Derivatives of the unit normal, which pbrt leaves scaled like the unnormalised one.
        let derivative = |d: Vec3| {
            let d = t.normal(d) * scale;
            d - d.dot(shading_n) * shading_n
        };
        Self {
            p: t.point(self.p),
            p_error: t.point_error(self.p, self.p_error),
            n,
            dpdu: t.vector(self.dpdu),
            dpdv: t.vector(self.dpdv),
            shading: Shading {
                n: if shading_n.dot(n) < 0.0 { -shading_n } else { shading_n },
                dpdu: t.vector(self.shading.dpdu),
                dpdv: t.vector(self.shading.dpdv),
                dndu: derivative(self.shading.dndu),
                dndv: derivative(self.shading.dndv),
            },
            wo: t.vector(self.wo).normalize_or(self.wo),
            ..*self
        }
    }

    /// The point as lights see it.
    #[inline]
    pub fn reference(&self) -> ReferencePoint {
        let Self { p, p_error, n, time, .. } = *self;
        ReferencePoint { p, p_error, n, ns: self.shading.n, one_sided: false, time }
    }

    /// The point as [`Primitive::pdf_from_point`](crate::Primitive::pdf_from_point) wants it, where this surface is a
    /// light's.
    #[inline]
    pub fn surface_point(&self) -> SurfacePoint {
        SurfacePoint { p: self.p, n: self.n, param: self.param }
    }

    /// A ray that leaves the surface toward `direction` and cannot meet it again by rounding.
    #[inline]
    pub fn spawn_ray(&self, direction: Vec3) -> Ray {
        self.reference().spawn_ray(direction)
    }

    /// A ray to the free point `p`, which it reaches at `t = 1`.
    #[inline]
    pub fn spawn_ray_to_point(&self, p: Vec3) -> Ray {
        self.reference().spawn_ray_to_point(p)
    }

    /// A ray to a point sampled on a shape: nothing but true occluders lies before [`SHADOW_T_MAX`].
    #[inline]
    pub fn spawn_ray_to(&self, sample: &ShapeSample) -> Ray {
        self.reference().spawn_ray_to(sample)
    }
}

/// A ray from one surface point to another, each given with its error bound and geometric normal (zero for a free
/// point); both ends are moved off their surfaces, and `t = 1` is the far end.
#[inline]
pub fn ray_between(p0: Vec3, p0_error: Vec3, n0: Vec3, p1: Vec3, p1_error: Vec3, n1: Vec3, time: f32) -> Ray {
    let from = offset_ray_origin(p0, p0_error, n0, p1 - p0);
    let to = offset_ray_origin(p1, p1_error, n1, from - p1);
    Ray::new(from, to - from, time)
}

/// Unit direction to where a ray came from.
#[inline(always)]
pub(crate) fn toward_origin(ray: &Ray) -> Vec3 {
    let d = ray.direction;
    let squared = d.length_squared();
    // Most are of unit length already, up to rounding.
    let is_unit = (squared - 1.0).abs() <= 4.0 * f32::EPSILON;
    let scale = if is_unit { 1.0 } else { 1.0 / squared.sqrt() };
    let has_direction = scale > 0.0 && scale.is_finite();
    if has_direction { -(d * scale) } else { Vec3::Z }
}
