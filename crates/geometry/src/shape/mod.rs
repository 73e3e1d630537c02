//! Shapes: what a ray can hit and a light can shine from.

mod ball;
mod bilinear_patch;
mod cylinder;
mod disk;
mod facet;
mod quadric;
mod rectangle;
mod sphere;
mod triangle;

pub use ball::{Ball, Balls};
pub use bilinear_patch::BilinearPatch;
pub(crate) use bilinear_patch::Parallelogram;
pub use cylinder::{Cylinder, CylinderParams};
pub use disk::{Disk, DiskParams};
pub use facet::{Facet, Facets};
pub use quadric::ShapeError;
pub use rectangle::Rectangle;
pub use sphere::{Sphere, SphereParams};
pub use triangle::Triangle;
pub(crate) use triangle::{FlatTriangle, RayShear, ShearedTriangle, fastest_axis, permuted, sheared_vertex};

use crate::{
    BilinearMesh, NormalCone, ReferencePoint, ShapeSample, SurfaceInteraction, SurfacePoint, TriangleMesh,
    sample::pdf_by_solid_angle,
};
use std::sync::Arc;
use tenfold_math::{Bounds3, Ray, Vec2, Vec3};

/// A shape as scenes name them: one quadric, or a whole mesh.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere or a part of one.
    Sphere(Sphere),
    /// A disk, an annulus or a sector of one.
    Disk(Disk),
    /// The side of a cylinder or a part of it.
    Cylinder(Cylinder),
    /// Triangles.
    Triangles(Arc<TriangleMesh>),
    /// Bilinear patches.
    Patches(Arc<BilinearMesh>),
}

impl Shape {
    /// How many primitives it has: 1 for a quadric.
    #[inline]
    pub fn len(&self) -> usize {
        match self {
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => 1,
            Self::Triangles(mesh) => mesh.len(),
            Self::Patches(mesh) => mesh.len(),
        }
    }

    /// Whether it has no primitive.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Its primitive with the given index below [`Shape::len`].
    #[inline]
    pub fn primitive(&self, index: usize) -> Primitive<'_> {
        match self {
            Self::Sphere(s) => Primitive::Sphere(s),
            Self::Disk(s) => Primitive::Disk(s),
            Self::Cylinder(s) => Primitive::Cylinder(s),
            Self::Triangles(mesh) => Primitive::Triangle(Triangle::new(mesh, index)),
            Self::Patches(mesh) => Primitive::Patch(BilinearPatch::new(mesh, index)),
        }
    }

    /// Begins to load the primitive with the given index, of a mesh whose vertices are [`separated`](crate::Mesh::separated).
    #[inline]
    pub fn prefetch(&self, index: usize) {
        match self {
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => {}
            Self::Triangles(mesh) => mesh.prefetch(index),
            Self::Patches(mesh) => mesh.prefetch(index),
        }
    }
}

/// Where a ray meets a single primitive.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ShapeHit {
    /// The ray's parameter.
    pub t: f32,
    /// See [`Hit::u`](crate::Hit::u).
    pub u: f32,
    /// See [`Hit::v`](crate::Hit::v).
    pub v: f32,
}

/// One primitive of a [`Shape`].
#[derive(Copy, Clone, Debug)]
pub enum Primitive<'a> {
    /// A sphere or a part of one.
    Sphere(&'a Sphere),
    /// A disk, an annulus or a sector of one.
    Disk(&'a Disk),
    /// The side of a cylinder or a part of it.
    Cylinder(&'a Cylinder),
    /// A triangle of a mesh.
    Triangle(Triangle<'a>),
    /// A patch of a mesh.
    Patch(BilinearPatch<'a>),
}

/// Calls the same function on the member, whichever it is.
macro_rules! dispatch {
    ($self:expr, $s:ident => $call:expr) => {
        match $self {
            Primitive::Sphere($s) => $call,
            Primitive::Disk($s) => $call,
            Primitive::Cylinder($s) => $call,
            Primitive::Triangle($s) => $call,
            Primitive::Patch($s) => $call,
        }
    };
}

impl<'a> Primitive<'a> {
    /// A box around the primitive.
    pub fn bounds(&self) -> Bounds3 {
        dispatch!(self, s => s.bounds())
    }

    /// A cone around its geometric normals.
    pub fn normal_cone(&self) -> NormalCone {
        dispatch!(self, s => s.normal_cone())
    }

    /// Its surface area in the world.
    pub fn area(&self) -> f32 {
        dispatch!(self, s => s.area())
    }

    /// The first hit with `0 < t < t_max` that `accept` does not refuse.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32, accept: impl FnMut(ShapeHit) -> bool) -> Option<ShapeHit> {
        dispatch!(self, s => s.intersect(ray, t_max, accept))
    }

    /// The surface at a hit of `ray`, in the space of the shape's world.
    #[inline(always)]
    pub fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        dispatch!(self, s => s.interaction(ray, hit))
    }

    /// Texture coordinates at a hit of `ray`.
    pub fn uv(&self, ray: &Ray, hit: &ShapeHit) -> Vec2 {
        dispatch!(self, s => s.uv(ray, hit))
    }

    /// A point on the surface; its density is by area.
    pub fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        dispatch!(self, s => s.sample_area(u))
    }

    /// Density by area of [`Primitive::sample_area`] at a point of the surface.
    pub fn pdf_area(&self, point: &SurfacePoint) -> f32 {
        dispatch!(self, s => s.pdf_area(point))
    }

    /// [`Primitive::sample_area`] with its density by solid angle at `reference`; `None` also where the point cannot be
    /// seen from there, being edge-on or at the same place.
    pub fn sample_area_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        self.sample_area(u)?.by_solid_angle(reference)
    }

    /// Density by solid angle of [`Primitive::sample_area_from`] for the direction to a known point of the surface.
    pub fn pdf_area_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        pdf_by_solid_angle(self.pdf_area(point), point.p - reference.p, point.n)
    }

    /// A point on the surface chosen for its view from `reference`; its density is by solid angle there. The point
    /// may be hidden by other parts of the primitive.
    pub fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        dispatch!(self, s => s.sample_from(reference, u))
    }

    /// The primitive as a rectangle, where it is one: whose views [`Rectangle::sample_from`] samples as [`Primitive::sample_from`], faster.
    pub fn rectangle(&self) -> Option<Rectangle> {
        match self {
            Self::Patch(patch) => patch.rectangle(),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) | Self::Triangle(_) => None,
        }
    }

    /// The primitive as a whole round sphere, where it is one: [`Balls::samples_from`] samples many as [`Primitive::sample_from`], faster.
    #[inline]
    pub fn ball(&self) -> Option<&'a Ball> {
        match self {
            Self::Sphere(sphere) => sphere.ball(),
            Self::Disk(_) | Self::Cylinder(_) | Self::Triangle(_) | Self::Patch(_) => None,
        }
    }

    /// The primitive as a triangle that has its vertices to itself and no normals of theirs, where it is one: [`Facets::samples_from`] samples many that are far as [`Primitive::sample_from`], faster.
    #[inline]
    pub fn facet(&self) -> Option<Facet<'a>> {
        match self {
            Self::Triangle(triangle) => Facet::of(triangle),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) | Self::Patch(_) => None,
        }
    }

    /// Density by solid angle of [`Primitive::sample_from`] for the direction to a known point of the surface. Where
    /// both sides of a closed shape lie in one direction, each point has its own.
    pub fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        dispatch!(self, s => s.pdf_from_point(reference, point))
    }

    /// Density by solid angle of [`Primitive::sample_from`] for the first point of the surface in the unit direction
    /// `wi`; 0 where there is none.
    pub fn pdf_from(&self, reference: &ReferencePoint, wi: Vec3) -> f32 {
        let ray = reference.spawn_ray(wi);
        match self.intersect(&ray, f32::INFINITY, |_| true) {
            Some(hit) => self.pdf_from_point(reference, &self.interaction(&ray, &hit).surface_point()),
            None => 0.0,
        }
    }
}

/// The unit vector across two others, `None` where that vanishes; in double precision, where products of tiny edges do not.
#[inline(always)]
fn unit_cross(a: Vec3, b: Vec3) -> Option<Vec3> {
    let across = a.as_dvec3().cross(b.as_dvec3());
    let squared = across.length_squared();
    (squared > 0.0).then(|| (across * (1.0 / squared.sqrt())).as_vec3())
}
