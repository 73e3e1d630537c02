//! Where a cluster of lights is cut in two: the surface area orientation heuristic.

use super::bounds::LightBounds;
use super::tree::Entry;
use tenfold_math::Bounds3;

/// Candidates along an axis.
const BUCKETS: usize = 12;

/// Reorders `entries` (two at least) into two groups, neither empty, and returns the size of the first.
///
/// The cut is the one among the borders of [`BUCKETS`] slabs along each axis whose halves have the least sum of
/// intensity × size² × directions lit, with cuts across the longest edge preferred (Conty Estevez and Kulla 2018,
/// section 4.1, with the squared radius in place of the surface, which vanishes for lights in a line).
pub(super) fn split(entries: &mut [Entry]) -> usize {
    let centroids = Bounds3::around(entries.iter().map(|e| e.bounds.bounds.centroid()));
    let extent = centroids.diagonal();
    let whole = entries.iter().fold(Bounds3::EMPTY, |b, e| b.union(e.bounds.bounds)).diagonal();
    let bucket = |e: &Entry, axis: usize| {
        let t = (e.bounds.bounds.centroid()[axis] - centroids.min[axis]) / extent[axis];
        ((t * BUCKETS as f32) as usize).min(BUCKETS - 1)
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| extent[axis] > 0.0) {
        let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
        for e in &*entries {
            let slot = &mut buckets[bucket(e, axis)];
            *slot = unite(*slot, Some(e.bounds));
        }
        // costs[i] is of what lies up to bucket i.
        let mut below = [0.0; BUCKETS];
        let mut sum = None;
        for (cost, bucket) in below.iter_mut().zip(buckets) {
            sum = unite(sum, bucket);
            *cost = measure(sum);
        }
        let regular = whole.max_element() / whole[axis];
        let mut above = None;
        for i in (0..BUCKETS - 1).rev() {
            above = unite(above, buckets[i + 1]);
            let cost = regular * (below[i] + measure(above));
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    let middle = match best {
        // The extreme buckets hold the extreme lights: neither side is empty.
        Some((_, axis, last)) => partition(entries, |e| bucket(e, axis) <= last),
        None => 0,
    };
    if middle == 0 || middle == entries.len() { entries.len() / 2 } else { middle }
}

fn unite(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    }
}

fn measure(b: Option<LightBounds>) -> f32 {
    b.map_or(0.0, |b| b.intensity * b.radius * b.radius * b.orientation_measure())
}

/// Moves the entries that belong `first` to the front, by a scheme that depends on the order alone, and counts them.
fn partition(entries: &mut [Entry], first: impl Fn(&Entry) -> bool) -> usize {
    let mut count = 0;
    for i in 0..entries.len() {
        if first(&entries[i]) {
            entries.swap(i, count);
            count += 1;
        }
    }
    count
}
