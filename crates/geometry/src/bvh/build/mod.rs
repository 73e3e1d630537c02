//! Building: long triangles are cut first, then the tree grows top-down, straight to eight children.

mod bins;
mod presplit;
mod reference;

pub(crate) use presplit::presplit;
pub(crate) use reference::{Reference, Target, padded};

use super::node::{LANES, WIDTH};
use bins::{Split, best_split};
use rayon::prelude::*;
use reference::Box4;
use tenfold_math::Bounds3;

/// Ranges with more references are split on several threads.
const PARALLEL: usize = 4096;
/// No path from the root is longer, in nodes: what the traversal's stack is made for.
pub(super) const MAX_DEPTH: usize = 18;

/// A tree of nodes and leaves before it is laid out.
pub(super) enum Tree {
    Node(Box<Inner>),
    /// A range of the sorted references.
    Leaf {
        /// Index of the first.
        first: u32,
        /// How many there are.
        len: u32,
    },
}

/// A node of the tree.
pub(super) struct Inner {
    pub(super) children: Vec<(Bounds3, Tree)>,
    pub(super) counts: Counts,
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

/// Some references and what is around them.
struct Range<'a> {
    references: &'a mut [Reference],
    /// Index of the first of them among all.
    first: usize,
    bounds: Box4,
    middles: Box4,
}

impl<'a> Range<'a> {
    fn new(references: &'a mut [Reference], first: usize) -> Self {
        let around = |references: &[Reference]| {
            references.iter().fold((Box4::EMPTY, Box4::EMPTY), |(bounds, middles), r| {
                (bounds.union(r.bounds()), middles.include(r.middle()))
            })
        };
        let (bounds, middles) = if references.len() > PARALLEL {
            // Minimum and maximum do not depend on the order.
            references
                .par_chunks(PARALLEL)
                .map(around)
                .reduce(|| (Box4::EMPTY, Box4::EMPTY), |a, b| (a.0.union(b.0), a.1.union(b.1)))
        } else {
            around(references)
        };
        Self { references, first, bounds, middles }
    }

    fn len(&self) -> usize {
        self.references.len()
    }

    /// Whether one leaf can hold all of it.
    fn fits_leaf(&self) -> bool {
        self.len() <= 1 || (self.len() <= LANES && self.references.iter().all(Reference::is_triangle))
    }

    /// Splits by the heuristic; in the middle where that finds no plane, or where it must (`halve`).
    fn split(self, halve: bool) -> [Range<'a>; 2] {
        let split = if halve { None } else { best_split(self.references, &self.middles) };
        let Self { references, first, middles, .. } = self;
        match split {
            Some(split) => {
                let ([low_bounds, low_middles], [high_bounds, high_middles], k) =
                    partition(references, &split);
                let (low, high) = references.split_at_mut(k);
                [
                    Range { references: low, first, bounds: low_bounds, middles: low_middles },
                    Range { references: high, first: first + k, bounds: high_bounds, middles: high_middles },
                ]
            }
            None => {
                let axis = middles.bounds().longest_axis();
                let k = references.len() / 2;
                // A total order: the result must not depend on the algorithm's whims.
                references.select_nth_unstable_by(k, |a, b| a.cmp_along(b, axis));
                let (low, high) = references.split_at_mut(k);
                [Range::new(low, first), Range::new(high, first + k)]
            }
        }
    }
}

/// Moves the low ones to the front; returns bounds of boxes and of middles of both halves, and how many are low.
fn partition(references: &mut [Reference], split: &Split) -> ([Box4; 2], [Box4; 2], usize) {
    let (mut low, mut high) = ([Box4::EMPTY; 2], [Box4::EMPTY; 2]);
    let add = |to: &mut [Box4; 2], r: &Reference| {
        *to = [to[0].union(r.bounds()), to[1].include(r.middle())];
    };
    let (mut i, mut j) = (0, references.len());
    loop {
        while i < j && split.is_low(&references[i]) {
            add(&mut low, &references[i]);
            i += 1;
        }
        while i < j && !split.is_low(&references[j - 1]) {
            add(&mut high, &references[j - 1]);
            j -= 1;
        }
        if i >= j {
            return (low, high, i);
        }
        references.swap(i, j - 1);
    }
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

/// Sorts the references and builds a tree over them, whose root is a node; there must be at least one reference.
pub(super) fn build(references: &mut [Reference]) -> (Bounds3, Box<Inner>) {
    let range = Range::new(references, 0);
    (range.bounds.bounds(), node(range, 0))
}

fn node(range: Range<'_>, depth: usize) -> Box<Inner> {
    // Deep down only halving keeps within the depth.
    let halve = depth + levels(range.len()) + 1 >= MAX_DEPTH;
    let parallel = range.len() > PARALLEL;
    let mut ranges = Vec::with_capacity(WIDTH);
    ranges.push(range);
    while ranges.len() < WIDTH {
        let Some(next) = next_to_split(&ranges, halve) else { break };
        let range = ranges.swap_remove(next);
        ranges.extend(range.split(halve));
    }
    let grow = |range: Range<'_>| {
        let bounds = range.bounds.bounds();
        if !range.fits_leaf() {
            let inner = node(range, depth + 1);
            return (bounds, inner.counts, Tree::Node(inner));
        }
        let mut counts = Counts::default();
        match range.references[0].target() {
            Target::Triangle(_) => counts.blocks = 1,
            Target::Shape(_) => counts.shapes = 1,
            Target::Placement(_) => {}
        }
        (bounds, counts, Tree::Leaf { first: range.first as u32, len: range.len() as u32 })
    };
    let grown: Vec<_> = match parallel {
        true => ranges.into_par_iter().map(grow).collect(),
        false => ranges.into_iter().map(grow).collect(),
    };
    let mut counts = Counts { nodes: 1, ..Counts::default() };
    grown.iter().for_each(|(_, below, _)| counts += *below);
    let children = grown.into_iter().map(|(bounds, _, tree)| (bounds, tree)).collect();
    Box::new(Inner { children, counts })
}

/// The range to split next: that of largest box, or the one with most references; `None` where all fit leaves.
fn next_to_split(ranges: &[Range<'_>], by_count: bool) -> Option<usize> {
    let mut best: Option<(usize, f32)> = None;
    for (i, range) in ranges.iter().enumerate().filter(|(_, range)| !range.fits_leaf()) {
        let size = if by_count { range.len() as f32 } else { range.bounds.half_area() };
        if best.is_none_or(|(_, b)| size > b) {
            best = Some((i, size));
        }
    }
    best.map(|(i, _)| i)
}
