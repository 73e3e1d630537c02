//! Laying a tree out: nodes before their children, depth first, each kind of leaf in an array of its own.

use super::{
    Bvh,
    build::{Counts, Inner, Reference, Target, Tree},
    node::{Child, Kind, LeafPrimitive, Node, TriangleBlock},
    with_capacity,
};
use rayon::prelude::*;
use std::mem::MaybeUninit;
use tenfold_math::{Bounds3, Vec3};

/// Subtrees with more nodes are laid out on several threads.
const PARALLEL: usize = 512;

/// Where a subtree goes: parts of the arrays, and the indices where they begin.
struct Room<'a> {
    nodes: &'a mut [MaybeUninit<Node>],
    blocks: &'a mut [MaybeUninit<TriangleBlock>],
    shapes: &'a mut [MaybeUninit<LeafPrimitive>],
    first: Counts,
}

impl<'a> Room<'a> {
    /// Takes the first elements away.
    fn take(&mut self, counts: Counts) -> Room<'a> {
        fn take<'a, T>(from: &mut &'a mut [T], n: usize) -> &'a mut [T] {
            from.split_off_mut(..n).expect("as much room as was counted")
        }
        let first = self.first;
        self.first += counts;
        Room {
            nodes: take(&mut self.nodes, counts.nodes),
            blocks: take(&mut self.blocks, counts.blocks),
            shapes: take(&mut self.shapes, counts.shapes),
            first,
        }
    }
}

/// What is laid out.
struct Source<'a, P> {
    references: &'a [Reference],
    positions: &'a P,
}

/// The hierarchy of a tree over sorted references. `positions` gives the corners of triangles.
pub(super) fn lay_out(
    root: &Inner,
    bounds: Bounds3,
    references: &[Reference],
    positions: &(impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync),
) -> Bvh {
    let counts = root.counts;
    let mut bvh = Bvh {
        nodes: with_capacity(counts.nodes),
        blocks: with_capacity(counts.blocks),
        shapes: Vec::with_capacity(counts.shapes),
        bounds,
    };
    let mut room = Room {
        nodes: &mut bvh.nodes.spare_capacity_mut()[..counts.nodes],
        blocks: &mut bvh.blocks.spare_capacity_mut()[..counts.blocks],
        shapes: &mut bvh.shapes.spare_capacity_mut()[..counts.shapes],
        first: Counts::default(),
    };
    Source { references, positions }.node(root, room.take(counts));
    // SAFETY: every subtree writes all elements of its room, whose sizes are those that its nodes and leaves were counted to; `Room::take`
    // panics where there is less, and `Source::node` where there is more.
    unsafe {
        bvh.nodes.set_len(counts.nodes);
        bvh.blocks.set_len(counts.blocks);
        bvh.shapes.set_len(counts.shapes);
    }
    bvh
}

impl<P: Fn(LeafPrimitive) -> [Vec3; 3] + Sync> Source<'_, P> {
    fn node(&self, inner: &Inner, mut room: Room<'_>) {
        let own = room.take(Counts { nodes: 1, ..Counts::default() });
        let mut node = Node::EMPTY;
        let mut below = Vec::new();
        for (slot, (bounds, tree)) in inner.children.iter().enumerate() {
            let child = match tree {
                Tree::Node(inner) => {
                    let room = room.take(inner.counts);
                    let child = Child::new(Kind::Node, room.first.nodes);
                    below.push((inner, room));
                    child
                }
                Tree::Leaf { first, len } => {
                    let first = *first as usize;
                    self.leaf(&self.references[first..first + *len as usize], &mut room)
                }
            };
            node.set(slot, bounds, child);
        }
        own.nodes[0].write(node);
        assert!(
            room.nodes.is_empty() && room.blocks.is_empty() && room.shapes.is_empty(),
            "more room than was counted"
        );
        match inner.counts.nodes > PARALLEL {
            true => below.into_par_iter().for_each(|(inner, room)| self.node(inner, room)),
            false => below.into_iter().for_each(|(inner, room)| self.node(inner, room)),
        }
    }

    fn leaf(&self, leaf: &[Reference], room: &mut Room<'_>) -> Child {
        match leaf[0].target() {
            Target::Placement(index) => Child::new(Kind::Placement, index as usize),
            Target::Shape(id) => {
                let room = room.take(Counts { shapes: 1, ..Counts::default() });
                room.shapes[0].write(id);
                Child::new(Kind::Shape, room.first.shapes)
            }
            Target::Triangle(_) => {
                let room = room.take(Counts { blocks: 1, ..Counts::default() });
                let mut block = TriangleBlock::EMPTY;
                for (lane, reference) in leaf.iter().enumerate() {
                    // Several parts of a triangle need no more than one lane.
                    let first = leaf.iter().position(|r| r.target() == reference.target());
                    if let (Target::Triangle(id), true) = (reference.target(), first == Some(lane)) {
                        block.set(lane, &(self.positions)(id), id);
                    }
                }
                room.blocks[0].write(block);
                Child::new(Kind::Triangles, room.first.blocks)
            }
        }
    }
}
