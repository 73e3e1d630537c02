use crate::ray_between;
use tenfold_math::{Floats, Ray, Vec2, Vec3, Vec3s, WIDTH, offset_ray_origin};

/// A point from which a shape is seen: where a light is sampled.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ReferencePoint {
    /// The point.
    pub p: Vec3,
    /// Bound on its absolute error.
    pub p_error: Vec3,
    /// Its geometric normal; zero where the point lies on no surface.
    pub n: Vec3,
    /// Its shading normal; zero where the point lies on no surface.
    pub ns: Vec3,
    /// Whether only light that arrives on the side of `ns` matters. Sampling favours directions near `ns`, or near ±`ns`.
    pub one_sided: bool,
    /// The time of the path.
    pub time: f32,
}

impl ReferencePoint {
    /// A point on no surface (in a medium, or of a camera).
    pub fn free(p: Vec3, time: f32) -> Self {
        Self { p, p_error: Vec3::ZERO, n: Vec3::ZERO, ns: Vec3::ZERO, one_sided: false, time }
    }

    /// The same point where only light that arrives on the side of `w` matters, which an opaque surface shows there.
    #[inline]
    #[must_use]
    pub fn seen_from(self, w: Vec3) -> Self {
        Self { ns: if self.ns.dot(w) < 0.0 { -self.ns } else { self.ns }, one_sided: true, ..self }
    }

    /// Weight by the cosine of light from the unit direction `w`: 0 where it does not matter.
    #[inline]
    pub fn cosine(&self, w: Vec3) -> f32 {
        let cos = self.ns.dot(w);
        if self.one_sided { cos.max(0.0) } else { cos.abs() }
    }

    /// A ray that leaves toward `direction` and cannot meet the surface of the point again by rounding.
    #[inline]
    pub fn spawn_ray(&self, direction: Vec3) -> Ray {
        Ray::new(offset_ray_origin(self.p, self.p_error, self.n, direction), direction, self.time)
    }

    /// A ray to the free point `p`, which it reaches at `t = 1`.
    #[inline]
    pub fn spawn_ray_to_point(&self, p: Vec3) -> Ray {
        let origin = offset_ray_origin(self.p, self.p_error, self.n, p - self.p);
        Ray::new(origin, p - origin, self.time)
    }

    /// A ray to a point sampled on a shape: nothing but true occluders lies before
    /// [`SHADOW_T_MAX`](crate::SHADOW_T_MAX).
    #[inline]
    pub fn spawn_ray_to(&self, sample: &ShapeSample) -> Ray {
        ray_between(self.p, self.p_error, self.n, sample.p, sample.p_error, sample.n, self.time)
    }
}

/// A [`ReferencePoint`] in each slot.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ReferencePoints {
    /// The points.
    pub p: Vec3s,
    /// See [`ReferencePoint::p_error`].
    pub p_error: Vec3s,
    /// See [`ReferencePoint::n`].
    pub n: Vec3s,
    /// See [`ReferencePoint::ns`].
    pub ns: Vec3s,
    /// See [`ReferencePoint::one_sided`].
    pub one_sided: [bool; WIDTH],
    /// The times of the paths.
    pub time: Floats,
}

impl ReferencePoints {
    /// The point in a slot.
    #[inline(always)]
    pub fn get(&self, slot: usize) -> ReferencePoint {
        ReferencePoint {
            p: self.p.get(slot),
            p_error: self.p_error.get(slot),
            n: self.n.get(slot),
            ns: self.ns.get(slot),
            one_sided: self.one_sided[slot],
            time: self.time[slot],
        }
    }

    /// Sets the point in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, point: ReferencePoint) {
        self.p.set(slot, point.p);
        self.p_error.set(slot, point.p_error);
        self.n.set(slot, point.n);
        self.ns.set(slot, point.ns);
        self.one_sided[slot] = point.one_sided;
        self.time[slot] = point.time;
    }
}

/// A point sampled on a shape.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ShapeSample {
    /// The point, in the world.
    pub p: Vec3,
    /// Bound on its absolute error.
    pub p_error: Vec3,
    /// Unit geometric normal, as [`SurfaceInteraction::n`](crate::SurfaceInteraction::n).
    pub n: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// The shape's own parameters there, as [`SurfaceInteraction::param`](crate::SurfaceInteraction::param).
    pub param: Vec2,
    /// The density, in the measure that the sampling function names: area or solid angle.
    pub pdf: f32,
}

impl ShapeSample {
    /// The point as [`Primitive::pdf_area`](crate::Primitive::pdf_area) wants it.
    #[inline]
    pub fn surface_point(&self) -> SurfacePoint {
        SurfacePoint { p: self.p, n: self.n, param: self.param }
    }

    /// The sample with its area density turned into one of solid angle seen from `reference`; `None` where the point
    /// cannot be seen from there (edge-on, or at the same place).
    pub(crate) fn by_solid_angle(mut self, reference: &ReferencePoint) -> Option<Self> {
        let to_light = self.p - reference.p;
        self.pdf = area_to_solid_angle(self.pdf, to_light, self.n);
        (self.pdf.is_finite() && self.pdf > 0.0).then_some(self)
    }
}

/// What a shadow ray needs of a [`ShapeSample`], in each slot.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ShapeSamples {
    /// The points.
    pub p: Vec3s,
    /// See [`ShapeSample::p_error`].
    pub p_error: Vec3s,
    /// See [`ShapeSample::n`].
    pub n: Vec3s,
    /// The densities: not positive where there is no sample.
    pub pdf: Floats,
}

impl ShapeSamples {
    /// Sets the sample in a slot.
    #[inline]
    pub fn set(&mut self, slot: usize, sample: &ShapeSample) {
        self.p.set(slot, sample.p);
        self.p_error.set(slot, sample.p_error);
        self.n.set(slot, sample.n);
        self.pdf[slot] = sample.pdf;
    }
}

/// A point on a shape, as far as densities depend on it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in the world.
    pub p: Vec3,
    /// Unit geometric normal.
    pub n: Vec3,
    /// The shape's own parameters there, as [`SurfaceInteraction::param`](crate::SurfaceInteraction::param).
    pub param: Vec2,
}

/// An area density turned into one of solid angle, where `to_light` leads to a surface with unit normal `n`;
/// infinite or NaN where the surface is seen edge-on or touched.
#[inline(always)]
pub(crate) fn area_to_solid_angle(pdf: f32, to_light: Vec3, n: Vec3) -> f32 {
    let distance_squared = to_light.length_squared();
    // |cos| = |n·d| / |d|, so distance² / |cos| = distance³ / |n·d|.
    pdf * distance_squared * distance_squared.sqrt() / n.dot(to_light).abs()
}

/// [`area_to_solid_angle`] for a known pair of points: 0 where that has no finite value.
#[inline(always)]
pub(crate) fn pdf_by_solid_angle(pdf_area: f32, to_light: Vec3, n: Vec3) -> f32 {
    let pdf = area_to_solid_angle(pdf_area, to_light, n);
    if pdf.is_finite() { pdf } else { 0.0 }
}

/// Weights of the corners of the unit square where the directions to them have these cosines to the shading normal: never zero, so
/// that every direction stays possible (pbrt book, 4th edition, §6.5.4).
#[inline(always)]
pub(crate) fn corner_weights(reference: &ReferencePoint, cosines: [f32; 4]) -> [f32; 4] {
    let least = 0.01;
    // Compared so that NaN counts as little.
    let weight = |cos: f32| if cos > least { cos } else { least };
    cosines.map(|cos| weight(if reference.one_sided { cos } else { cos.abs() }))
}
