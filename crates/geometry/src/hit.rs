use crate::{Geometry, World};
use tenfold_math::{Id, Ray};

/// One primitive of a world: a geometry and the index of a triangle or patch in it (0 for a quadric).
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PrimitiveId {
    /// The geometry.
    pub geometry: Id<Geometry>,
    /// The triangle or patch of its mesh; 0 for a quadric.
    pub index: u32,
}

/// Which placement of a primitive was hit: [`InstanceId::NONE`] for what stands still in the world itself.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstanceId(pub(crate) u32);

impl InstanceId {
    /// Not an instance: the primitive's own space is the world.
    pub const NONE: Self = Self(u32::MAX);

    /// Whether the primitive was reached through an instance or moves by itself.
    #[inline]
    pub fn is_some(self) -> bool {
        self != Self::NONE
    }
}

/// Where a ray meets a primitive: all that is known until [`World::interaction`] is asked for more.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Hit {
    /// The ray's parameter, in units of its direction's length.
    pub t: f32,
    /// Triangles: the barycentric weight of the second vertex. Patches: the parameter u. Quadrics: 0.
    pub u: f32,
    /// Triangles: the barycentric weight of the third vertex. Patches: the parameter v. Quadrics: 0.
    pub v: f32,
    /// What was hit.
    pub primitive: PrimitiveId,
    /// Through which instance.
    pub instance: InstanceId,
}

/// A hit that a filter may refuse, for surfaces with holes ([`Geometry::masked`]).
#[derive(Copy, Clone, Debug)]
pub struct Candidate<'a> {
    /// The world that was hit.
    pub world: &'a World,
    /// The ray as it was given to the world.
    pub ray: &'a Ray,
    /// The hit in question.
    pub hit: Hit,
    /// [`Geometry::user`] of the geometry that was hit.
    pub user: u32,
}
