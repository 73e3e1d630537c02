//! Shapes, meshes, subdivision surfaces and the bounding volume hierarchy.
//!
//! A [`World`] is built once from [`Geometry`]s (a [`Shape`] each, a quadric or a whole mesh) and
//! [`Instance`]s, and is immutable from then on. Rays ask it for the closest [`Hit`] ([`World::intersect`]) or whether
//! anything is in the way ([`World::occluded`]); only for the hit that matters is the full [`SurfaceInteraction`] computed
//! ([`World::interaction`]). Lights sample the surface of a single [`Primitive`] of a shape, by area or by solid angle.
//!
//! Parametrisations and orientations are those of pbrt-v4.

// A negated comparison also catches NaN: that is why it is written so.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod bvh;
mod cone;
mod hit;
mod interaction;
mod mesh;
mod plain;
mod sample;
mod shape;
mod subdivision;
mod world;

pub use bvh::RayCourses;
pub use cone::NormalCone;
pub use hit::{Candidate, Hit, InstanceId, PrimitiveId};
pub use interaction::{SHADOW_T_MAX, Shading, SurfaceInteraction, ray_between};
pub use mesh::{BilinearMesh, Mesh, MeshError, MeshParts, TriangleMesh};
pub use plain::PlainSurfaces;
pub use sample::{ReferencePoint, ReferencePoints, ShapeSample, ShapeSamples, SurfacePoint};
pub use shape::{
    Ball, Balls, BilinearPatch, Cylinder, CylinderParams, Disk, DiskParams, Facet, Facets, Primitive,
    Rectangle, Shape, ShapeError, ShapeHit, Sphere, SphereParams, Triangle,
};
pub use subdivision::{SubdivisionError, loop_subdivide};
pub use world::{Geometry, Group, Instance, World, WorldDesc, WorldError, WorldStats};
