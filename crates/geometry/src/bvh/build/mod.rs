//! Building: the tree grows top-down, straight to eight children where it is large. Long triangles are cut, before that where they are few, meanwhile where they are many.

mod binary;
mod bins;
mod grid;
mod hull;
mod pair;
mod presplit;
mod range;
mod reference;
mod room;
mod source;
mod spatial;

pub(super) use hull::Hull;
pub(super) use pair::initialised;
pub(crate) use reference::{Reference, Target, padded};
pub(crate) use source::References;

use super::{
    Bvh,
    layout::{Sorted, lay_out},
    node::{LeafPrimitive, WIDTH},
    traverse::Level,
};
use pair::Pair;
use presplit::{Cuts, presplit};
use range::{Context, GRID, Items, Range};
use rayon::prelude::*;
use room::{Pool, Room};
use source::{Cut, Summary, collect};
use std::mem::MaybeUninit;
use tenfold_math::{Bounds3, Vec3};

/// Rays that would meet more boxes of primitives, on the average, hit something too soon to pass most.
const MOST_MET: f64 = 3.0;
/// Subtrees of at most this many references are built by one thread.
const ALONE: usize = 4096;
/// Nodes on the way from the root to any subtree of these, and halvings from there, at most.
const MOST_ABOVE: usize = 18;
const MOST_HALVINGS: usize = 36;
/// No path from the root is longer, in nodes: what the traversal's stack is made for.
pub(super) const MAX_DEPTH: usize = MOST_ABOVE + MOST_HALVINGS;

/// A tree over the sorted references before it is laid out.
pub(super) enum Tree {
    Node(Box<Inner>),
    /// A tree whose root is a node.
    Bulk(Bulk),
    /// A range of references.
    Leaf {
        /// Index of the first.
        first: usize,
        /// How many there are.
        len: usize,
    },
}

impl Tree {
    /// How much it holds; for what is more than a leaf.
    pub(super) fn counts(&self) -> Counts {
        match self {
            Self::Node(inner) => inner.counts,
            Self::Bulk(bulk) => bulk.counts,
            Self::Leaf { .. } => Counts::default(),
        }
    }
}

/// A node of the tree.
pub(super) struct Inner {
    pub(super) children: Vec<(Bounds3, Tree)>,
    pub(super) counts: Counts,
}

/// A tree as its nodes, depth first.
#[derive(Default)]
pub(super) struct Bulk {
    pub(super) nodes: Vec<[Option<Word>; WIDTH]>,
    pub(super) counts: Counts,
    /// Index of the first reference.
    pub(super) first: usize,
    /// How many there are.
    pub(super) len: usize,
}

/// A child of a node.
#[derive(Copy, Clone, Debug)]
pub(super) enum Word {
    /// A node, which follows.
    Node,
    /// A range of references.
    Leaf {
        /// Index of the first.
        first: u32,
        /// How many there are.
        len: u8,
    },
}

/// How much a tree holds.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) nodes: usize,
    /// Leaves with triangles.
    pub(super) blocks: usize,
    /// Leaves with a shape.
    pub(super) shapes: usize,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, b: Self) {
        self.nodes += b.nodes;
        self.blocks += b.blocks;
        self.shapes += b.shapes;
    }
}

/// A hierarchy over references, of which there must be at least one.
pub(super) fn build(
    source: &impl References,
    positions: &(impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync),
) -> Bvh {
    let summary = Summary::of(source);
    let mut bvh = match presplit(source, &summary, positions) {
        Cuts::Before(parts) if parts.is_empty() => grow(source, &summary, 0, positions),
        Cuts::Before(parts) => {
            let cut = Cut::new(source, parts);
            grow(&cut, &cut.summary(&summary), 0, positions)
        }
        Cuts::Meanwhile(extra) => grow(source, &summary, extra, positions),
    };
    // Of boxes a line through all meets as many, on the average, as their areas are larger than that of the box around all.
    bvh.is_sparse &= summary.all.areas <= MOST_MET * f64::from(summary.all.bounds.half_area());
    bvh
}

/// As [`build`]; splits of space may add `extra` references.
fn grow(
    source: &impl References,
    summary: &Summary,
    extra: usize,
    positions: &(impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync),
) -> Bvh {
    let (level, len, bounds) = (Level::detect(), source.len(), summary.all.bounds.bounds());
    let pool = Pool::default();
    let context = Context { level, source, positions, pool: &pool };
    if len > GRID
        && extra == 0
        && let Some((mut numbers, top)) = grid::sort(level, source, &summary.all.middles)
    {
        let tree = tree(Range::all(context, Items::Numbers(&mut numbers, top), summary), 0);
        drop(pool);
        // SAFETY: all are initialised.
        return unsafe { lay_out(&tree, bounds, Sorted::Numbers(&numbers, source), positions) };
    }
    let mut home = collect(source, extra);
    home.clear();
    let home = &mut home.spare_capacity_mut()[..len + extra];
    // SAFETY: as many were collected.
    let references = unsafe { Pair::new(home, len) };
    let tree = tree(Range::all(context, Items::References(references, None), summary), 0);
    drop(pool);
    // SAFETY: ranges leave what leaves name initialised.
    unsafe { lay_out(&tree, bounds, Sorted::References(home), positions) }
}

/// A tree whose root is a node.
fn tree(range: Range<'_>, depth: usize) -> Tree {
    if range.len() <= ALONE {
        return Tree::Bulk(binary::grow(range));
    }
    let grow = |mut range: Range<'_>| {
        let bounds = range.bounds();
        let mut counts = Counts::default();
        let tree = if range.fits_leaf() {
            Tree::Leaf { first: range.finish(&mut counts), len: range.len() }
        } else {
            let tree = tree(range, depth + 1);
            counts += tree.counts();
            tree
        };
        (counts, (bounds, tree))
    };
    let pool = range.pool();
    let mut rooms = [(); WIDTH - 1].map(|()| pool.room());
    let grown: Vec<_> = open(range, depth, &mut rooms).into_par_iter().map(grow).collect();
    let mut counts = Counts { nodes: 1, ..Counts::default() };
    grown.iter().for_each(|(below, _)| counts += *below);
    Tree::Node(Box::new(Inner { children: grown.into_iter().map(|(_, child)| child).collect(), counts }))
}

/// Splits until there are eight ranges or all fit leaves; they stay in order.
fn open<'a>(range: Range<'a>, depth: usize, rooms: &'a mut [Room<'_>]) -> Vec<Range<'a>> {
    // Deep down only halving keeps within the depth.
    let halve = depth + levels(range.len()) + 1 >= MOST_ABOVE;
    let mut ranges = Vec::with_capacity(WIDTH);
    ranges.push(range);
    for room in rooms {
        let Some(next) = next_to_split(&ranges, halve) else { break };
        let [low, high] = ranges.remove(next).split(halve, room);
        ranges.insert(next, high);
        ranges.insert(next, low);
    }
    ranges
}

/// The range to split next: that of largest box, or the one with most references; `None` where all fit leaves.
fn next_to_split(ranges: &[Range<'_>], by_count: bool) -> Option<usize> {
    let mut best: Option<(usize, f32)> = None;
    for (i, range) in ranges.iter().enumerate().filter(|(_, range)| !range.fits_leaf()) {
        let size = if by_count { range.len() as f32 } else { range.half_area() };
        if best.is_none_or(|(_, b)| size > b) {
            best = Some((i, size));
        }
    }
    best.map(|(i, _)| i)
}

/// How many levels of nodes `n` references need, with all nodes full.
fn levels(n: usize) -> usize {
    let mut levels = 0;
    let mut reach = 1;
    while reach < n {
        reach *= WIDTH;
        levels += 1;
    }
    levels
}
