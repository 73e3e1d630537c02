//! Splits of space: triangles on both sides of the plane are cut, so that the halves do not overlap (Stich, Friedrich and Dietrich 2009).

use super::{
    MaybeUninit,
    bins::cost,
    hull::Hull,
    reference::{Reference, Target, padded},
};
use crate::bvh::node::LeafPrimitive;
use tenfold_math::{Bounds3, Vec3};

/// Slabs along each axis: twice as many gain 2 % of the cost, and take half as long again.
const SLABS: usize = 8;

/// More references fill slabs on several threads.
const PARALLEL: usize = 1 << 13;

/// Gives the corners of triangles.
pub(super) type Positions<'a> = dyn Fn(LeafPrimitive) -> [Vec3; 3] + Sync + 'a;

/// A plane that cuts.
#[derive(Copy, Clone, Debug)]
pub(super) struct Plane {
    axis: usize,
    place: f32,
    /// As that of [`Halves`](super::bins::Halves).
    pub(super) cost: f32,
}

fn corners(reference: &Reference, positions: &Positions<'_>) -> Option<[Vec3; 3]> {
    match reference.target() {
        Target::Triangle(id) => Some(positions(id)),
        _ => None,
    }
}

/// The parts of a box on both sides of a plane, as far as the triangle reaches into them.
#[inline(always)]
fn cut(corners: &[Vec3; 3], hull: &Hull, axis: usize, place: f32) -> [Option<Hull>; 2] {
    let mut sides = [Bounds3::EMPTY; 2];
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % 3];
        if a[axis] <= place {
            sides[0] = sides[0].include(a);
        }
        if a[axis] >= place {
            sides[1] = sides[1].include(a);
        }
        if (a[axis] < place) != (b[axis] < place) && a[axis] != place && b[axis] != place {
            // What the rounding errs by is far below what boxes are padded by.
            let s = (place - a[axis]) / (b[axis] - a[axis]);
            let mut p = a + s * (b - a);
            p[axis] = place;
            sides = [sides[0].include(p), sides[1].include(p)];
        }
    }
    let size = Bounds3::around(*corners).diagonal().max_element();
    let hull = hull.bounds();
    let [low, high] = sides;
    [within(&hull, padded(low, size)), within(&hull, padded(high, size))]
}

/// What of a box is in another.
#[inline(always)]
fn within(hull: &Bounds3, side: Bounds3) -> Option<Hull> {
    let side = Bounds3 { min: side.min.max(hull.min), max: side.max.min(hull.max) };
    (!side.is_empty()).then(|| Hull::new(side))
}

/// A slab of space across an axis: what reaches into it, cut to fit, and how many references begin and end there.
#[derive(Copy, Clone)]
struct Slab {
    hull: Hull,
    begin: u32,
    end: u32,
}

/// Equal slabs across the axes of a box.
struct Slabs {
    min: Vec3,
    max: Vec3,
    scale: [f32; 3],
}

type Filled = [[Slab; SLABS]; 3];

impl Slabs {
    fn new(bounds: &Hull) -> Self {
        let Bounds3 { min, max } = bounds.bounds();
        let scale = (max - min).to_array().map(|d| if d > 0.0 { SLABS as f32 / d } else { 0.0 });
        Self { min, max, scale }
    }

    fn slab(&self, x: f32, axis: usize) -> usize {
        (((x - self.min[axis]) * self.scale[axis]) as usize).min(SLABS - 1)
    }

    /// Where the lower plane of a slab is.
    fn place(&self, slab: usize, axis: usize) -> f32 {
        self.min[axis] + (self.max[axis] - self.min[axis]) * (slab as f32 / SLABS as f32)
    }

    /// What reaches into the slabs.
    fn fill(&self, references: &[Reference], positions: &Positions<'_>) -> Filled {
        if references.len() > PARALLEL {
            let halves = references.split_at(references.len() / 2);
            let (mut all, more) =
                rayon::join(|| self.fill(halves.0, positions), || self.fill(halves.1, positions));
            // Minimum, maximum and sums of integers do not depend on the order.
            all.iter_mut().flatten().zip(more.iter().flatten()).for_each(|(a, b)| {
                let (begin, end) = (a.begin + b.begin, a.end + b.end);
                *a = Slab { hull: a.hull.union(&b.hull), begin, end };
            });
            return all;
        }
        let mut slabs = [[Slab { hull: Hull::EMPTY, begin: 0, end: 0 }; SLABS]; 3];
        for reference in references {
            let b = reference.hull().bounds();
            let reach = [0, 1, 2].map(|axis| [self.slab(b.min[axis], axis), self.slab(b.max[axis], axis)]);
            let spans = reach.iter().any(|[first, last]| first < last);
            let corners = if spans { corners(reference, positions) } else { None };
            for (axis, ([first, last], slabs)) in reach.into_iter().zip(&mut slabs).enumerate() {
                let (Some(corners), true) = (&corners, first < last) else {
                    // What cannot be cut belongs to one side.
                    let only = &mut slabs[self.slab(0.5 * (b.min[axis] + b.max[axis]), axis)];
                    *only = Slab {
                        hull: only.hull.union(reference.hull()),
                        begin: only.begin + 1,
                        end: only.end + 1,
                    };
                    continue;
                };
                let mut within: Option<[usize; 2]> = None;
                let mut rest = Some(*reference.hull());
                for (i, slab) in slabs.iter_mut().enumerate().take(last + 1).skip(first) {
                    let Some(hull) = rest.take() else { break };
                    let part;
                    [part, rest] = match i < last {
                        true => cut(corners, &hull, axis, self.place(i + 1, axis)),
                        false => [Some(hull), None],
                    };
                    if let Some(part) = part {
                        slab.hull = slab.hull.union(&part);
                        within = Some([within.map_or(i, |[first, _]| first), i]);
                    }
                }
                let [first, last] = within.unwrap_or([first, last]);
                slabs[first].begin += 1;
                slabs[last].end += 1;
            }
        }
        slabs
    }
}

/// The cheapest plane across `bounds`.
pub(super) fn find(references: &[Reference], bounds: &Hull, positions: &Positions<'_>) -> Option<Plane> {
    let slabs = Slabs::new(bounds);
    let filled = slabs.fill(references, positions);
    let mut best: Option<Plane> = None;
    for (axis, filled) in filled.iter().enumerate() {
        let all = references.len() as u32;
        let mut high_cost = [f32::INFINITY; SLABS];
        let (mut high, mut n) = (Hull::EMPTY, 0);
        for i in (1..SLABS).rev() {
            (high, n) = (high.union(&filled[i].hull), n + filled[i].end);
            if 0 < n && n < all {
                high_cost[i] = cost(high, n);
            }
        }
        let (mut low, mut n) = (Hull::EMPTY, 0);
        for i in 1..SLABS {
            (low, n) = (low.union(&filled[i - 1].hull), n + filled[i - 1].begin);
            // A half with nothing in it costs infinitely much, and so does one with everything.
            if n == 0 || n == all || high_cost[i] == f32::INFINITY {
                continue;
            }
            let cost = cost(low, n) + high_cost[i];
            if best.is_none_or(|best| cost < best.cost) {
                best = Some(Plane { axis, place: slabs.place(i, axis), cost });
            }
        }
    }
    best
}

/// Writes what is below the plane to the front of `to`, and what is above to the back: of triangles on both sides parts to both, as long as there is
/// room. Returns how many are in front and back.
pub(super) fn sort(
    references: &[Reference],
    plane: &Plane,
    positions: &Positions<'_>,
    to: &mut [MaybeUninit<Reference>],
) -> [usize; 2] {
    let (mut i, mut j) = (0, to.len());
    let mut slack = to.len() - references.len();
    let Plane { axis, place, .. } = *plane;
    for reference in references {
        let r = reference.hull().bounds();
        let mut parts = [None, None];
        if r.max[axis] <= place {
            parts[0] = Some(*reference);
        } else if r.min[axis] >= place {
            parts[1] = Some(*reference);
        } else {
            if let (Some(corners), 1..) = (corners(reference, positions), slack) {
                parts = cut(&corners, reference.hull(), axis, place)
                    .map(|part| part.map(|hull| reference.with_bounds(hull.bounds())));
            }
            if parts.iter().all(Option::is_none) {
                parts[usize::from(r.min[axis] + r.max[axis] > 2.0 * place)] = Some(*reference);
            }
            slack -= usize::from(parts.iter().all(Option::is_some));
        }
        let [low, high] = parts;
        if let Some(low) = low {
            to[i].write(low);
            i += 1;
        }
        if let Some(high) = high {
            j -= 1;
            to[j].write(high);
        }
    }
    [i, to.len() - j]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::Rng;

    #[test]
    fn parts_cover_triangles_and_hardly_overlap() {
        let mut rng = Rng::new(1);
        let triangles: Vec<[Vec3; 3]> = (0..500)
            .map(|_| {
                let p = rng.vec3();
                [p, p + 0.3 * (rng.vec3() - 0.5), p + 0.3 * (rng.vec3() - 0.5)]
            })
            .collect();
        let positions = |id: LeafPrimitive| triangles[id.index as usize];
        let whole = |i: usize| {
            let target = Target::Triangle(LeafPrimitive::new(0, i as u32, false));
            Reference::new(padded(Bounds3::around(triangles[i]), 0.3), target)
        };
        let references: Vec<Reference> = (0..triangles.len()).map(whole).collect();
        let all = references.iter().fold(Hull::EMPTY, |all, r| all.union(r.hull()));
        let plane = find(&references, &all, &positions).expect("a plane");
        let mut to = vec![MaybeUninit::uninit(); 2 * references.len()];
        let [low, high] = sort(&references, &plane, &positions, &mut to);
        assert!(low + high > references.len() && low < references.len() && high < references.len());
        let n = to.len();
        // SAFETY: so many were written.
        let part = |i: usize| unsafe { to[i].assume_init() };
        let (low, high): (Vec<_>, Vec<_>) = ((0..low).map(part).collect(), (n - high..n).map(part).collect());
        let axis = plane.axis;
        assert!(low.iter().all(|r| r.hull().bounds().max[axis] < plane.place + 1e-5));
        assert!(high.iter().all(|r| r.hull().bounds().min[axis] > plane.place - 1e-5));
        // The cost that was foretold is that of the halves.
        let around = |half: &[Reference]| {
            cost(half.iter().fold(Hull::EMPTY, |all, r| all.union(r.hull())), half.len() as u32)
        };
        let want = around(&low) + around(&high);
        assert!((plane.cost - want).abs() < 1e-3 * want, "{} {want}", plane.cost);
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            let own = |r: &&Reference| r.target() == references[i].target();
            let parts: Vec<Reference> = low.iter().chain(&high).filter(own).copied().collect();
            for _ in 0..20 {
                let (u, v) = (rng.f32(), rng.f32());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let p = *a + u * (*b - *a) + v * (*c - *a);
                assert!(parts.iter().any(|r| r.hull().bounds().contains(p)), "{p} of {i}");
            }
        }
    }

    #[test]
    fn without_room_nothing_is_cut() {
        let corners = [Vec3::ZERO, Vec3::ONE, Vec3::new(1.0, 1.0, 0.9)];
        let target = Target::Triangle(LeafPrimitive::new(0, 0, false));
        let references = [Reference::new(Bounds3::around(corners), target); 3];
        let plane = Plane { axis: 0, place: 0.5, cost: 0.0 };
        for room in 3..7 {
            let mut to = vec![MaybeUninit::uninit(); room];
            let [low, high] = sort(&references, &plane, &|_| corners, &mut to);
            assert_eq!(low + high, room.min(6));
        }
    }
}
