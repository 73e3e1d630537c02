//! Building: top-down, by the surface area heuristic over bins (Wald 2007), straight to eight children.

use super::node::{Kind, LANES, WIDTH};
use tenfold_math::{Bounds3, Vec3};

/// Bins along each axis.
const BINS: usize = 32;
/// Ranges with more primitives are split on several threads.
const PARALLEL: usize = 4096;
/// No path from the root is longer, in nodes: what the traversal's stack is made for.
pub(super) const MAX_DEPTH: usize = 18;

/// A primitive to be sorted into leaves.
#[derive(Copy, Clone, Debug)]
pub(super) struct BuildPrimitive {
    pub(super) bounds: Bounds3,
    pub(super) kind: Kind,
    pub(super) index: u32,
}

impl BuildPrimitive {
    /// Twice the middle of the box.
    fn middle(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

/// A tree of nodes and leaves before it is laid out.
pub(super) enum Tree {
    Node(Vec<(Bounds3, Tree)>),
    /// A range of the sorted primitives.
    Leaf(std::ops::Range<usize>),
}

/// Some primitives and what is around them.
struct Range<'a> {
    primitives: &'a mut [BuildPrimitive],
    /// Index of the first of them among all.
    first: usize,
    bounds: Bounds3,
    middles: Bounds3,
}

impl<'a> Range<'a> {
    fn new(primitives: &'a mut [BuildPrimitive], first: usize) -> Self {
        let around = |primitives: &[BuildPrimitive]| {
            primitives.iter().fold((Bounds3::EMPTY, Bounds3::EMPTY), |(b, m), p| {
                (b.union(p.bounds), m.include(p.middle()))
            })
        };
        let (bounds, middles) = if primitives.len() > PARALLEL {
            use rayon::prelude::*;
            // Minimum and maximum do not depend on the order.
            primitives
                .par_chunks(PARALLEL)
                .map(around)
                .reduce(|| (Bounds3::EMPTY, Bounds3::EMPTY), |a, b| (a.0.union(b.0), a.1.union(b.1)))
        } else {
            around(primitives)
        };
        Self { primitives, first, bounds, middles }
    }

    fn len(&self) -> usize {
        self.primitives.len()
    }

    /// Whether one leaf can hold all of it.
    fn fits_leaf(&self) -> bool {
        self.len() <= 1 || (self.len() <= LANES && self.primitives.iter().all(|p| p.kind == Kind::Triangles))
    }

    fn split_at(self, k: usize) -> [Range<'a>; 2] {
        let first = self.first;
        let (low, high) = self.primitives.split_at_mut(k);
        if low.len() + high.len() > PARALLEL {
            let (low, high) = rayon::join(|| Range::new(low, first), || Range::new(high, first + k));
            [low, high]
        } else {
            [Range::new(low, first), Range::new(high, first + k)]
        }
    }

    /// Splits by the heuristic; in the middle where that finds no plane.
    fn split(self, split: Option<Split>) -> [Range<'a>; 2] {
        let middle = match split {
            Some(split) => {
                let bins = Bins::new(&self.middles);
                partition(self.primitives, |p| bins.index(p, split.axis) < split.bin)
            }
            None => {
                let axis = self.middles.longest_axis();
                let k = self.len() / 2;
                let key = |p: &BuildPrimitive| p.middle()[axis];
                // Ties by index: the result must not depend on the algorithm's whims.
                self.primitives
                    .select_nth_unstable_by(k, |a, b| key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index)));
                k
            }
        };
        self.split_at(middle)
    }
}

/// Leaf blocks that `n` primitives need.
fn blocks(n: usize) -> f32 {
    n.div_ceil(LANES) as f32
}

/// Moves those for which `low` is true to the front and counts them.
fn partition(primitives: &mut [BuildPrimitive], low: impl Fn(&BuildPrimitive) -> bool) -> usize {
    let mut n = 0;
    for i in 0..primitives.len() {
        if low(&primitives[i]) {
            primitives.swap(n, i);
            n += 1;
        }
    }
    n
}

/// A plane between two bins.
#[derive(Copy, Clone, Debug)]
struct Split {
    axis: usize,
    /// Bins below this go to the first half.
    bin: usize,
    cost: f32,
}

/// Equal slabs along each axis.
#[derive(Copy, Clone)]
struct Bins {
    origin: Vec3,
    scale: Vec3,
}

impl Bins {
    fn new(middles: &Bounds3) -> Self {
        let size = middles.diagonal();
        // An axis without extent gets scale 0: everything falls in bin 0.
        let scale = |d: f32| if d > 0.0 { BINS as f32 * 0.999_99 / d } else { 0.0 };
        Self { origin: middles.min, scale: Vec3::new(scale(size.x), scale(size.y), scale(size.z)) }
    }

    #[inline]
    fn index(&self, p: &BuildPrimitive, axis: usize) -> usize {
        let x = (p.middle()[axis] - self.origin[axis]) * self.scale[axis];
        // The cast saturates, and makes 0 of NaN.
        (x as usize).min(BINS - 1)
    }
}

#[derive(Copy, Clone)]
struct Bin {
    bounds: Bounds3,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds3::EMPTY, count: 0 };

    fn union(self, b: Self) -> Self {
        Self { bounds: self.bounds.union(b.bounds), count: self.count + b.count }
    }
}

type Histogram = [[Bin; BINS]; 3];

fn histogram(primitives: &[BuildPrimitive], bins: &Bins) -> Histogram {
    let mut histogram = [[Bin::EMPTY; BINS]; 3];
    for p in primitives {
        for (axis, row) in histogram.iter_mut().enumerate() {
            let bin = &mut row[bins.index(p, axis)];
            bin.bounds = bin.bounds.union(p.bounds);
            bin.count += 1;
        }
    }
    histogram
}

/// The cheapest plane; `None` where all middles coincide.
fn best_split(range: &Range<'_>) -> Option<Split> {
    let bins = Bins::new(&range.middles);
    let histogram = if range.len() > PARALLEL {
        use rayon::prelude::*;
        range.primitives.par_chunks(PARALLEL).map(|chunk| histogram(chunk, &bins)).reduce(
            || [[Bin::EMPTY; BINS]; 3],
            |a, b| std::array::from_fn(|axis| std::array::from_fn(|i| a[axis][i].union(b[axis][i]))),
        )
    } else {
        histogram(range.primitives, &bins)
    };
    let mut best: Option<Split> = None;
    for (axis, row) in histogram.iter().enumerate() {
        let mut high_cost = [0f32; BINS];
        let mut high = Bin::EMPTY;
        for i in (1..BINS).rev() {
            high = high.union(row[i]);
            high_cost[i] = high.bounds.half_area() * blocks(high.count as usize);
        }
        let mut low = Bin::EMPTY;
        for i in 1..BINS {
            low = low.union(row[i - 1]);
            if low.count == 0 || low.count as usize == range.len() {
                continue;
            }
            let cost = low.bounds.half_area() * blocks(low.count as usize) + high_cost[i];
            if best.is_none_or(|b| cost < b.cost) {
                best = Some(Split { axis, bin: i, cost });
            }
        }
    }
    best
}

/// How many levels of nodes `n` primitives need, with all nodes full.
fn levels(n: usize) -> usize {
    let mut levels = 0;
    let mut reach = 1;
    while reach < n {
        reach *= WIDTH;
        levels += 1;
    }
    levels
}

/// Sorts `primitives` and builds a tree over them; there must be at least one.
pub(super) fn build(primitives: &mut [BuildPrimitive]) -> (Bounds3, Tree) {
    let range = Range::new(primitives, 0);
    (range.bounds, subtree(range, 0))
}

fn subtree(range: Range<'_>, depth: usize) -> Tree {
    if range.fits_leaf() {
        return Tree::Leaf(range.first..range.first + range.len());
    }
    // Deep down only halving keeps within the depth.
    let halve = depth + levels(range.len()) + 1 >= MAX_DEPTH;
    let mut children = vec![range];
    while children.len() < WIDTH {
        let Some(next) = next_to_split(&children, halve) else { break };
        let range = children.swap_remove(next);
        let split = if halve { None } else { best_split(&range) };
        children.extend(range.split(split));
    }
    let grow = |range: Range<'_>| (range.bounds, subtree(range, depth + 1));
    if children.iter().map(Range::len).sum::<usize>() > PARALLEL {
        use rayon::prelude::*;
        Tree::Node(children.into_par_iter().map(grow).collect())
    } else {
        Tree::Node(children.into_iter().map(grow).collect())
    }
}

/// The child to split next: that of largest box, or the one with most primitives; `None` where all fit leaves.
fn next_to_split(children: &[Range<'_>], by_count: bool) -> Option<usize> {
    let mut best: Option<(usize, f32)> = None;
    for (i, child) in children.iter().enumerate().filter(|(_, child)| !child.fits_leaf()) {
        let size = if by_count { child.len() as f32 } else { child.bounds.half_area() };
        if best.is_none_or(|(_, b)| size > b) {
            best = Some((i, size));
        }
    }
    best.map(|(i, _)| i)
}
