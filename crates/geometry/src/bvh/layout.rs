//! Laying a tree out: nodes before their children, depth first, each kind of leaf in an array of its own.

use super::{
    Bvh,
    build::{Counts, Hull, Inner, Reference, References, Target, Tree, Word, initialised},
    node::{Child, Kind, LeafPrimitive, Node, TriangleBlock, WIDTH},
    with_capacity,
};
use rayon::prelude::*;
use std::{
    mem::MaybeUninit,
    sync::atomic::{AtomicUsize, Ordering},
};
use tenfold_math::{Bounds3, Vec3};

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

impl Room<'_> {
    fn assert_full(&self) {
        let left = self.nodes.len() + self.blocks.len() + self.shapes.len();
        assert!(left == 0, "more room than was counted");
    }
}

/// What leaves name ranges of.
pub(super) enum Sorted<'a> {
    /// References; there may be gaps between those that leaves name.
    References(&'a [MaybeUninit<Reference>]),
    /// Numbers of references, which are made anew.
    Numbers(&'a [u32], &'a dyn References),
}

/// References that leaves name, side by side.
enum Leaves<'a> {
    /// All, as the builder has left them.
    Kept(&'a [MaybeUninit<Reference>]),
    /// Some, which were made anew, behind the index of the first.
    Made(usize, Vec<Reference>),
}

impl Leaves<'_> {
    fn leaf(&self, first: usize, len: usize) -> &[Reference] {
        match self {
            // SAFETY: leaves name initialised references.
            Self::Kept(all) => unsafe { initialised(&all[first..first + len]) },
            Self::Made(before, made) => &made[first - before..][..len],
        }
    }
}

/// What is laid out.
struct Source<'a, P> {
    sorted: Sorted<'a>,
    positions: &'a P,
    /// How many leaves are sparse.
    sparse: AtomicUsize,
}

/// What is in sparse leaves has boxes with at most this share of the area of the leaf's box. On surfaces it is more than half of it, in clouds of small things
/// a few hundredths.
const SPARSE: f32 = 0.25;

/// The hierarchy of a tree over what was sorted. `positions` gives the corners of triangles.
///
/// # Safety
/// The references that leaves name must be initialised.
pub(super) unsafe fn lay_out(
    tree: &Tree,
    bounds: Bounds3,
    sorted: Sorted<'_>,
    positions: &(impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync),
) -> Bvh {
    let counts = tree.counts();
    let mut bvh = Bvh {
        nodes: with_capacity(counts.nodes),
        blocks: with_capacity(counts.blocks),
        shapes: Vec::with_capacity(counts.shapes),
        bounds,
        is_sparse: false,
    };
    let room = Room {
        nodes: &mut bvh.nodes.spare_capacity_mut()[..counts.nodes],
        blocks: &mut bvh.blocks.spare_capacity_mut()[..counts.blocks],
        shapes: &mut bvh.shapes.spare_capacity_mut()[..counts.shapes],
        first: Counts::default(),
    };
    let source = Source { sorted, positions, sparse: AtomicUsize::new(0) };
    source.tree(tree, room);
    bvh.is_sparse = 2 * source.sparse.into_inner() > counts.blocks + counts.shapes;
    // SAFETY: every subtree writes all elements of its room, whose sizes are those that its nodes and leaves were counted to; `Room::take`
    // panics where there is less, and `Room::assert_full` where there is more.
    unsafe {
        bvh.nodes.set_len(counts.nodes);
        bvh.blocks.set_len(counts.blocks);
        bvh.shapes.set_len(counts.shapes);
    }
    bvh
}

impl<P: Fn(LeafPrimitive) -> [Vec3; 3] + Sync> Source<'_, P> {
    /// A tree whose root is a node.
    fn tree(&self, tree: &Tree, mut room: Room<'_>) {
        match tree {
            Tree::Node(inner) => self.node(inner, room),
            Tree::Bulk(bulk) => {
                self.bulk(&mut bulk.nodes.iter(), &self.references(bulk.first, bulk.len), &mut room);
                room.assert_full();
            }
            Tree::Leaf { .. } => {}
        }
    }

    fn node(&self, inner: &Inner, mut room: Room<'_>) {
        let own = room.take(Counts { nodes: 1, ..Counts::default() });
        let mut node = Node::EMPTY;
        let mut below = Vec::new();
        for (slot, (bounds, tree)) in inner.children.iter().enumerate() {
            let child = match tree {
                Tree::Leaf { first, len } => {
                    self.leaf(self.references(*first, *len).leaf(*first, *len), &mut room)
                }
                _ => {
                    let room = room.take(tree.counts());
                    let child = Child::new(Kind::Node, room.first.nodes);
                    below.push((tree, room));
                    child
                }
            };
            node.set(slot, bounds, child);
        }
        own.nodes[0].write(node);
        room.assert_full();
        below.into_par_iter().for_each(|(tree, room)| self.tree(tree, room));
    }

    /// The next node and all below it. Returns the box around it.
    fn bulk(
        &self,
        nodes: &mut std::slice::Iter<'_, [Option<Word>; WIDTH]>,
        references: &Leaves<'_>,
        room: &mut Room<'_>,
    ) -> Bounds3 {
        let own = room.take(Counts { nodes: 1, ..Counts::default() });
        let mut node = Node::EMPTY;
        let mut all = Hull::EMPTY;
        let words = nodes.next().expect("as many nodes as words for them");
        // The leaves of a node lie side by side.
        for (slot, word) in words.iter().enumerate() {
            if let Some(Word::Leaf { first, len }) = word {
                let leaf = references.leaf(*first as usize, usize::from(*len));
                let hull = leaf.iter().fold(Hull::EMPTY, |hull, r| hull.union(r.hull()));
                node.set(slot, &hull.bounds(), self.leaf(leaf, room));
                let filled: f32 = leaf.iter().map(|r| r.hull().half_area()).sum();
                if filled < SPARSE * hull.half_area() {
                    self.sparse.fetch_add(1, Ordering::Relaxed);
                }
                all = all.union(&hull);
            }
        }
        for (slot, word) in words.iter().enumerate() {
            if let Some(Word::Node) = word {
                let index = room.first.nodes;
                let bounds = self.bulk(nodes, references, room);
                node.set(slot, &bounds, Child::new(Kind::Node, index));
                all = all.union(&Hull::new(bounds));
            }
        }
        own.nodes[0].write(node);
        all.bounds()
    }

    /// Those that leaves in this range name.
    fn references(&self, first: usize, len: usize) -> Leaves<'_> {
        match self.sorted {
            Sorted::References(references) => Leaves::Kept(references),
            Sorted::Numbers(numbers, source) => {
                let mut made = Vec::with_capacity(len);
                source.choose(&numbers[first..first + len], &mut made);
                Leaves::Made(first, made)
            }
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
