//! The surface area heuristic over bins (Wald 2007).

use super::reference::{Box4, Reference};
use crate::bvh::node::LANES;
use glam::Vec4;
use rayon::prelude::*;

/// Most bins along each axis.
const BINS: usize = 32;
/// Larger ranges are counted on several threads.
const PARALLEL: usize = 1 << 14;

/// A plane between two bins.
#[derive(Copy, Clone, Debug)]
pub(super) struct Split {
    bins: Bins,
    axis: usize,
    /// Bins below this go to the first half.
    bin: usize,
}

impl Split {
    /// Whether a reference goes to the first half.
    #[inline(always)]
    pub(super) fn is_low(&self, reference: &Reference) -> bool {
        self.bins.index(reference.middle(), self.axis) < self.bin
    }
}

/// Equal slabs along each axis.
#[derive(Copy, Clone, Debug)]
struct Bins {
    origin: Vec4,
    scale: Vec4,
    count: usize,
}

impl Bins {
    /// For `n` references with their doubled middles in `middles`.
    fn new(middles: &Box4, n: usize) -> Self {
        // Few references do not need many bins.
        let count = (4 + n / 4).min(BINS);
        // An axis without extent gets scale 0: everything falls in bin 0.
        let scale = |d: f32| if d > 0.0 { count as f32 * 0.999_99 / d } else { 0.0 };
        let d = middles.high - middles.low;
        Self { origin: middles.low, scale: Vec4::new(scale(d.x), scale(d.y), scale(d.z), 0.0), count }
    }

    #[inline(always)]
    fn index(&self, middle: Vec4, axis: usize) -> usize {
        // The cast saturates, and makes 0 of NaN.
        let x = (middle.to_array()[axis] - self.origin.to_array()[axis]) * self.scale.to_array()[axis];
        (x as i32).clamp(0, self.count as i32 - 1) as usize
    }
}

#[derive(Copy, Clone)]
struct Bin {
    bounds: Box4,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Box4::EMPTY, count: 0 };

    #[inline(always)]
    fn union(self, b: Self) -> Self {
        Self { bounds: self.bounds.union(b.bounds), count: self.count + b.count }
    }
}

type Histogram = [[Bin; BINS]; 3];

fn histogram(references: &[Reference], bins: &Bins) -> Histogram {
    let mut histogram = [[Bin::EMPTY; BINS]; 3];
    for reference in references {
        for (axis, row) in histogram.iter_mut().enumerate() {
            let bin = &mut row[bins.index(reference.middle(), axis) % BINS];
            bin.bounds = bin.bounds.union(reference.bounds());
            bin.count += 1;
        }
    }
    histogram
}

/// Leaf blocks that `n` triangles need.
fn blocks(n: u32) -> f32 {
    n.div_ceil(LANES as u32) as f32
}

/// The cheapest plane; `None` where all middles coincide.
pub(super) fn best_split(references: &[Reference], middles: &Box4) -> Option<Split> {
    let bins = Bins::new(middles, references.len());
    let histogram = if references.len() > PARALLEL {
        // Minimum, maximum and sums of integers do not depend on the order.
        references.par_chunks(PARALLEL).map(|chunk| histogram(chunk, &bins)).reduce_with(|mut a, b| {
            a.iter_mut().flatten().zip(b.iter().flatten()).for_each(|(a, b)| *a = a.union(*b));
            a
        })?
    } else {
        histogram(references, &bins)
    };
    let mut best: Option<(Split, f32)> = None;
    for (axis, row) in histogram.iter().enumerate() {
        let row = &row[..bins.count];
        let mut high_cost = [0f32; BINS];
        let mut high = Bin::EMPTY;
        for i in (1..bins.count).rev() {
            high = high.union(row[i]);
            high_cost[i] = high.bounds.half_area() * blocks(high.count);
        }
        let mut low = Bin::EMPTY;
        for i in 1..bins.count {
            low = low.union(row[i - 1]);
            if low.count == 0 || low.count as usize == references.len() {
                continue;
            }
            let cost = low.bounds.half_area() * blocks(low.count) + high_cost[i];
            if best.is_none_or(|(_, b)| cost < b) {
                best = Some((Split { bins, axis, bin: i }, cost));
            }
        }
    }
    best.map(|(split, _)| split)
}
