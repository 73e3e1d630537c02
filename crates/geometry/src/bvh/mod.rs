//! The bounding volume hierarchy: eight boxes a node, triangles in blocks, everything else one by one.
//!
//! [`Bvh`] knows nothing of worlds: it finds leaves along a ray in order and tests triangles; what lies in the other leaves is
//! the business of the [`Visitor`].

mod build;
mod course;
mod interleaved;
mod layout;
mod memory;
mod node;
mod simd;
mod stack;
mod stream;
mod traverse;
mod triangles;

pub(crate) use build::{Reference, References, Target, padded};
pub use course::RayCourses;
pub(crate) use course::{Course, MOST_VERTICES};
pub(crate) use memory::with_capacity;
pub(crate) use node::LeafPrimitive;
pub(crate) use traverse::{LONGER, Level, Visitor};

use node::{Node, TriangleBlock};
use tenfold_math::{Bounds3, Vec3};

/// A hierarchy, immutable once built.
#[derive(Debug)]
pub(crate) struct Bvh {
    /// The root first; none where there is nothing to hit.
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    shapes: Vec<LeafPrimitive>,
    bounds: Bounds3,
    is_sparse: bool,
}

impl Bvh {
    /// A hierarchy over `references`; `positions` gives the corners of the triangles among them. The result does not depend on the number of threads.
    /// There must be less than 2³⁰ references.
    pub(crate) fn build(
        references: &impl References,
        positions: impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync,
    ) -> Self {
        if references.len() == 0 {
            return Self {
                nodes: Vec::new(),
                blocks: Vec::new(),
                shapes: Vec::new(),
                bounds: Bounds3::EMPTY,
                is_sparse: false,
            };
        }
        build::build(references, &positions)
    }

    /// A box around everything.
    pub(crate) fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Whether most rays pass most of the leaves that they come to.
    pub(crate) fn is_sparse(&self) -> bool {
        self.is_sparse
    }

    /// How many nodes there are.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Memory in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..]) + size_of_val(&self.shapes[..])
    }
}
