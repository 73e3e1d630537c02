//! The bounding volume hierarchy: eight boxes a node, triangles in blocks, everything else one by one.
//!
//! [`Bvh`] knows nothing of worlds: it finds leaves along a ray in order and tests triangles; what lies in the other leaves is
//! the business of the [`Visitor`].

mod build;
mod node;
mod simd;
mod stack;
mod traverse;
mod triangles;

pub(crate) use node::LeafPrimitive;
pub(crate) use traverse::{Level, Visitor};

use build::{BuildPrimitive, Tree};
use node::{Child, Kind, Node, TriangleBlock};
use tenfold_math::{Bounds3, Vec3};

/// What goes into a hierarchy.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    /// Triangles, none of them degenerate, and their ids.
    pub(crate) triangles: Vec<([Vec3; 3], LeafPrimitive)>,
    /// Boxes of primitives of other kinds.
    pub(crate) shapes: Vec<(Bounds3, LeafPrimitive)>,
    /// Boxes of placements and their indices.
    pub(crate) placements: Vec<(Bounds3, u32)>,
}

/// A hierarchy, immutable once built.
#[derive(Debug)]
pub(crate) struct Bvh {
    /// The root first; none where there is nothing to hit.
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    shapes: Vec<LeafPrimitive>,
    bounds: Bounds3,
}

impl Bvh {
    /// Builds. The result does not depend on the number of threads. There must be less than 2³⁰ parts in total.
    pub(crate) fn build(parts: Parts) -> Self {
        let Parts { triangles, shapes, placements } = parts;
        let mut primitives = Vec::with_capacity(triangles.len() + shapes.len() + placements.len());
        let mut push = |bounds: Bounds3, kind, index: usize| {
            primitives.push(BuildPrimitive { bounds: padded(bounds), kind, index: index as u32 });
        };
        triangles.iter().enumerate().for_each(|(i, (p, _))| push(Bounds3::around(*p), Kind::Triangles, i));
        shapes.iter().enumerate().for_each(|(i, (b, _))| push(*b, Kind::Shape, i));
        placements.iter().for_each(|(b, i)| push(*b, Kind::Placement, *i as usize));
        let mut bvh = Self {
            nodes: Vec::new(),
            blocks: Vec::new(),
            shapes: shapes.iter().map(|(_, id)| *id).collect(),
            bounds: Bounds3::EMPTY,
        };
        if !primitives.is_empty() {
            let (bounds, tree) = build::build(&mut primitives);
            bvh.bounds = bounds;
            // The first node is the root, also of a single leaf.
            let tree = match tree {
                Tree::Node(_) => tree,
                Tree::Leaf(_) => Tree::Node(vec![(bounds, tree)]),
            };
            bvh.lay_out(&tree, &primitives, &triangles);
        }
        bvh
    }

    /// Appends a tree, nodes before their children and depth first.
    fn lay_out(
        &mut self,
        tree: &Tree,
        primitives: &[BuildPrimitive],
        triangles: &[([Vec3; 3], LeafPrimitive)],
    ) -> Child {
        match tree {
            Tree::Node(children) => {
                let at = self.nodes.len();
                self.nodes.push(Node::EMPTY);
                for (slot, (bounds, child)) in children.iter().enumerate() {
                    let child = self.lay_out(child, primitives, triangles);
                    self.nodes[at].set(slot, bounds, child);
                }
                Child::new(Kind::Node, at)
            }
            Tree::Leaf(range) => {
                let leaf = &primitives[range.clone()];
                if leaf[0].kind != Kind::Triangles {
                    return Child::new(leaf[0].kind, leaf[0].index as usize);
                }
                let at = self.blocks.len();
                let mut block = TriangleBlock::EMPTY;
                for (lane, primitive) in leaf.iter().enumerate() {
                    let (positions, id) = &triangles[primitive.index as usize];
                    block.set(lane, positions, *id);
                }
                self.blocks.push(block);
                Child::new(Kind::Triangles, at)
            }
        }
    }

    /// A box around everything.
    pub(crate) fn bounds(&self) -> Bounds3 {
        self.bounds
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

/// A box grown so that the rounding of the triangle test cannot reach out of it.
///
/// The test shears vertices to the ray's axis: along each axis that errs by at most 5u of the distance travelled, which
/// the slab test allows for, and by 4u of the distance from the vertex to the ray, here the size of the box and its
/// slant (u = 2⁻²⁴).
fn padded(b: Bounds3) -> Bounds3 {
    let size = b.diagonal().max_element();
    let by = size * 1e-6;
    let outward = |x: f32| x + by + x.abs() * f32::EPSILON;
    let inward = |x: f32| x - by - x.abs() * f32::EPSILON;
    Bounds3 {
        min: Vec3::new(inward(b.min.x), inward(b.min.y), inward(b.min.z)),
        max: Vec3::new(outward(b.max.x), outward(b.max.y), outward(b.max.z)),
    }
}
