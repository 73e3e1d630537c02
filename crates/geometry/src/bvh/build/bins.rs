//! The surface area heuristic over bins (Wald 2007).

use super::{
    hull::{Hull, middle},
    pair::Pair,
    reference::Reference,
};
use crate::bvh::{
    node::LANES,
    simd::{Portable, Simd, Vector},
    traverse::Level,
};
use std::mem::MaybeUninit;

/// Most bins along each axis.
const BINS: usize = 32;

/// What bins count: something in a box.
pub(super) trait Item: Copy {
    fn hull(&self) -> &Hull;
    /// How many references it stands for.
    fn count(&self) -> u32;
}

impl Item for Reference {
    #[inline(always)]
    fn hull(&self) -> &Hull {
        self.hull()
    }
    #[inline(always)]
    fn count(&self) -> u32 {
        1
    }
}

/// Equal slabs along each axis.
#[derive(Copy, Clone, Debug)]
struct Bins {
    origin: Hull,
    scale: Hull,
    count: usize,
}

impl Bins {
    /// For `n` items whose doubled middles are in `middles`.
    #[inline(always)]
    fn new(middles: &Hull, n: usize) -> Self {
        // Few items do not need many bins.
        let count = (4 + n / 4).min(BINS);
        let mut scale = [0.0; 8];
        for (axis, scale) in scale[..3].iter_mut().enumerate() {
            let d = -(middles.0[axis] + middles.0[axis + 4]);
            // An axis without extent gets scale 0: everything falls in bin 0.
            *scale = if d > 0.0 { count as f32 * 0.999_99 / d } else { 0.0 };
        }
        Self { origin: *middles, scale: Hull(scale), count }
    }

    /// In which bins on the three axes an item is whose doubled middle is given: the first three components, when truncated.
    #[inline(always)]
    fn place<V: Vector>(&self, middle: V) -> V {
        let x = middle.sub(self.origin.load()).mul(self.scale.load());
        // The first makes 0 of what is not a number.
        x.max(V::splat(0.0)).min(V::splat((self.count - 1) as f32))
    }
}

/// A plane between two bins.
#[derive(Copy, Clone, Debug)]
struct Split {
    bins: Bins,
    axis: usize,
    /// Bins below this go to the first half.
    bin: usize,
}

/// What bins hold.
struct Histogram {
    hulls: [[Hull; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl Histogram {
    #[inline(always)]
    fn of<V: Vector, T: Item>(items: &[T], bins: &Bins) -> Self {
        let mut histogram = Self { hulls: [[Hull::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] };
        for item in items {
            let hull: V = item.hull().load();
            let place = bins.place(middle(hull)).truncate();
            for (axis, bin) in place[..3].iter().enumerate() {
                let bin = *bin as usize % BINS;
                let bounds = &mut histogram.hulls[axis][bin];
                *bounds = Hull::store(bounds.load::<V>().min(hull));
                histogram.counts[axis][bin] += item.count();
            }
        }
        histogram
    }

    /// The cheapest plane; `None` where all middles coincide.
    #[inline(always)]
    fn best<V: Vector>(&self, bins: Bins) -> Option<(Split, [Hull; 2], f32)> {
        // The lowest of costs that are not negative is that of the lowest bits, behind which the axis and the bin fit: no branches, which could not be
        // foretold. Where a half holds nothing its cost is no number, and its bits are higher than all others.
        let mut best = u64::MAX;
        for axis in 0..3 {
            if bins.scale.0[axis] == 0.0 {
                continue;
            }
            let (hulls, counts) = (&self.hulls[axis], &self.counts[axis]);
            let mut high_cost = [0.0; BINS];
            let (mut high, mut n) = (V::splat(f32::INFINITY), 0);
            for i in (1..bins.count).rev() {
                high = high.min(hulls[i].load());
                n += counts[i];
                high_cost[i] = cost(Hull::store(high), n);
            }
            let (mut low, mut n) = (V::splat(f32::INFINITY), 0);
            for i in 1..bins.count {
                low = low.min(hulls[i - 1].load());
                n += counts[i - 1];
                // Nothing may be negative here, but zero.
                let cost = cost(Hull::store(low), n) + high_cost[i] + 0.0;
                best = best.min(u64::from(cost.to_bits()) << 32 | (axis << 8 | i) as u64);
            }
        }
        let cost = f32::from_bits((best >> 32) as u32);
        let split = Split { bins, axis: (best >> 8 & 3) as usize, bin: (best & 0xff) as usize };
        if !cost.is_finite() {
            return None;
        }
        let union = |hulls: &[Hull]| {
            Hull::store(hulls.iter().fold(V::splat(f32::INFINITY), |union, hull| union.min(hull.load())))
        };
        let (low, high) = self.hulls[split.axis][..bins.count].split_at(split.bin);
        Some((split, [union(low), union(high)], cost))
    }
}

/// What a half with `n` triangles costs: its area times the leaf blocks that they need.
#[inline(always)]
pub(super) fn cost(hull: Hull, n: u32) -> f32 {
    hull.half_area() * n.div_ceil(LANES as u32) as f32
}

/// What became of items that were sorted into halves.
pub(super) struct Halves {
    /// How many are in the first half.
    pub(super) low: usize,
    pub(super) bounds: [Hull; 2],
    /// Around the doubled middles.
    pub(super) middles: [Hull; 2],
    /// The sum of area times blocks.
    pub(super) cost: f32,
}

/// Sorts items by the cheapest plane to the front and the back of the pair's other side. `None`, and nothing is written, where there is no plane
/// since the doubled `middles` coincide.
pub(super) fn sort<T: Item>(level: Level, items: &mut Pair<'_, T>, middles: &Hull) -> Option<Halves> {
    let (from, to) = items.sides();
    match level {
        Level::Portable => sort_with::<Portable, T>(from, middles, to),
        // SAFETY: the token proves that the machine has AVX2.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => unsafe { sort_avx2(from, middles, to) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
fn sort_avx2<T: Item>(items: &[T], middles: &Hull, to: &mut [MaybeUninit<T>]) -> Option<Halves> {
    sort_with::<crate::bvh::simd::Avx2, T>(items, middles, to)
}

#[inline(always)]
fn sort_with<S: Simd, T: Item>(items: &[T], middles: &Hull, to: &mut [MaybeUninit<T>]) -> Option<Halves> {
    let bins = Bins::new(middles, items.len());
    let (split, bounds, cost) = Histogram::of::<S::F8, T>(items, &bins).best::<S::F8>(bins)?;
    let (low, middles) = partition::<S::F8, T>(items, &split, to);
    Some(Halves { low, bounds, middles, cost })
}

/// The maximum with the first is not in the way of any minimum; that with the second changes nothing.
static BARRIER: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

/// Writes the low items to the front and the others to the back. Every item is written to both places, and the one that it does not belong
/// to is written again: cheaper than branches that cannot be foretold.
#[inline(always)]
fn partition<V: Vector, T: Item>(
    items: &[T],
    split: &Split,
    to: &mut [MaybeUninit<T>],
) -> (usize, [Hull; 2]) {
    assert!(items.len() <= to.len());
    let plane = V::splat(split.bin as f32);
    let (mut i, mut j) = (0, to.len());
    let mut middles = [V::splat(f32::INFINITY); 2];
    for item in items {
        let middle = middle(item.hull().load::<V>());
        let is_low = split.bins.place(middle).lt(plane) >> split.axis & 1;
        to[i].write(*item);
        to[j - 1].write(*item);
        middles[0] = middles[0].min(middle.max(V::splat(BARRIER[is_low as usize])));
        middles[1] = middles[1].min(middle.max(V::splat(BARRIER[1 - is_low as usize])));
        i += is_low as usize;
        j -= 1 - is_low as usize;
    }
    (i, middles.map(Hull::store))
}

/// The hulls around items, and around their doubled middles.
pub(super) fn around<T: Item>(level: Level, items: &[T]) -> [Hull; 2] {
    match level {
        Level::Portable => around_with::<Portable, T>(items),
        // SAFETY: the token proves that the machine has AVX2.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) => unsafe { around_avx2(items) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
fn around_avx2<T: Item>(items: &[T]) -> [Hull; 2] {
    around_with::<crate::bvh::simd::Avx2, T>(items)
}

#[inline(always)]
fn around_with<S: Simd, T: Item>(items: &[T]) -> [Hull; 2] {
    let mut around = [S::F8::splat(f32::INFINITY); 2];
    for item in items {
        let hull: S::F8 = item.hull().load();
        around = [around[0].min(hull), around[1].min(middle(hull))];
    }
    around.map(Hull::store)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{build::Target, node::LeafPrimitive};
    use tenfold_math::Bounds3;
    use tenfold_testkit::Rng;

    #[test]
    fn all_levels_split_alike_and_well() {
        let mut rng = Rng::new(1);
        for n in 2..200 {
            let mut reference = |i| {
                let p = rng.vec3() - 0.5;
                let bounds = Bounds3::around([p, p + 0.1 * rng.vec3()]);
                Reference::new(bounds, Target::Triangle(LeafPrimitive::new(i, u32::MAX - i, i % 2 == 0)))
            };
            let references: Vec<Reference> = (0..n).map(&mut reference).collect();
            let split = |level: Level| {
                let mut items = references.clone();
                let mut room: Vec<Reference> = Vec::with_capacity(items.len());
                let [_, middles] = around(level, &items);
                // SAFETY: nothing but items.
                let home = unsafe { std::slice::from_raw_parts_mut(items.as_mut_ptr().cast(), items.len()) };
                // SAFETY: as many as there are.
                let mut pair = unsafe { Pair::new(home, n as usize) };
                pair.furnish(|_| room.spare_capacity_mut());
                let halves = sort(level, &mut pair, &middles).expect("a plane");
                // SAFETY: all were written.
                let pairs = unsafe { pair.swapped(halves.low, n as usize - halves.low, |_| 0.0) };
                let mut targets: Vec<String> = Vec::new();
                for (i, pair) in pairs.iter().enumerate() {
                    let items = pair.items();
                    assert!(!items.is_empty());
                    let [bounds, middles] = around(Level::Portable, items);
                    assert_eq!(halves.bounds[i].bounds(), bounds.bounds());
                    assert_eq!(halves.middles[i].bounds(), middles.bounds());
                    targets.extend(items.iter().map(|r| format!("{:?}", r.target())));
                }
                let mut sorted = targets.clone();
                sorted.sort();
                sorted.dedup();
                assert_eq!(sorted.len(), n as usize);
                targets
            };
            assert_eq!(split(Level::Portable), split(Level::detect()));
        }
    }
}
