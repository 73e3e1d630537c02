//! Cutting a few long slanted triangles before the tree is built, so that their boxes overlap less (Karras and Aila 2013, §4.2).

use super::reference::{Reference, Target, padded};
use super::source::{References, Summary, for_blocks, one};
use crate::bvh::node::LeafPrimitive;
use rayon::prelude::*;
use tenfold_math::{Bounds3, Vec3, ops};

/// Where more cuts than this share of the triangles' number are wanted, splits of space do better than cuts.
const MANY: f32 = 0.05;
/// They may add this share.
const LATER: f32 = 0.3;
/// A triangle whose priority is this many times the mean is cut once: meshes of alike triangles stay whole.
const OUTSTANDING: f32 = 2.0;
/// Cuts of one triangle.
const MOST: f32 = 63.0;
/// The cutting planes are those of an octree of this depth.
const LEVELS: u32 = 20;
/// Boxes are large, and looked at for cuts, whose area is this many times that of the mean root of an area.
const LARGE: f32 = 4.0;
/// About so many triangles tell the mean priority.
const SAMPLE: usize = 1 << 12;
/// Triangles handled together by a thread.
const CHUNK: usize = 1 << 14;

/// The octree whose planes cut.
#[derive(Copy, Clone)]
struct Octree {
    origin: Vec3,
    size: f32,
}

impl Octree {
    fn cell(&self, x: f32, axis: usize) -> u32 {
        ((x - self.origin[axis]) * ((1 << LEVELS) as f32 / self.size)) as u32
    }

    /// The plane of the coarsest level that goes through a box: the level, counted from the finest, the axis and the place.
    fn plane(&self, b: &Bounds3) -> Option<(u32, usize, f32)> {
        let mut best: Option<(u32, usize, f32)> = None;
        for axis in 0..3 {
            let [low, high] = [self.cell(b.min[axis], axis), self.cell(b.max[axis], axis)];
            if low >= high {
                continue;
            }
            let level = u32::BITS - 1 - (low ^ high).leading_zeros();
            let longer = |other: usize| b.diagonal()[axis] > b.diagonal()[other];
            if best.is_none_or(|(l, other, _)| level > l || level == l && longer(other)) {
                let place =
                    self.origin[axis] + (high >> level << level) as f32 * (self.size / (1 << LEVELS) as f32);
                best = Some((level, axis, place));
            }
        }
        best.filter(|&(_, axis, place)| b.min[axis] < place && place < b.max[axis])
    }

    /// How much cutting a triangle promises: the cube root of the area of its box that is for nothing, weighted by the level of the plane that
    /// would cut it first.
    fn priority(&self, p: [Vec3; 3]) -> f32 {
        let b = Bounds3::around(p);
        let Some((level, ..)) = self.plane(&b) else { return 0.0 };
        let c = (p[1] - p[0]).cross(p[2] - p[0]).abs();
        // A right triangle fills half of its box, and cuts would not make it better by much.
        let wasted = (2.0 * b.half_area() - 2.0 * c.element_sum()).max(0.0);
        let priority = ops::cbrt(wasted * (1u32 << level) as f32);
        if priority.is_finite() { priority } else { 0.0 }
    }
}

/// How many cuts a priority is worth.
fn cuts(priority: f32, scale: f32) -> usize {
    (priority * scale).min(MOST) as usize
}

/// What is cut.
pub(super) enum Cuts {
    /// The triangles of these numbers, in order, into these parts: few are long.
    Before(Vec<(u32, Reference)>),
    /// Whatever splits of space want, into at most so many more parts: many are.
    Meanwhile(usize),
}

/// Finds what to cut. The result does not depend on the number of threads.
pub(super) fn presplit(
    references: &(impl References + ?Sized),
    summary: &Summary,
    positions: &(impl Fn(LeafPrimitive) -> [Vec3; 3] + Sync + ?Sized),
) -> Cuts {
    let n = references.len();
    let corners = |r: &Reference| match r.target() {
        Target::Triangle(id) => Some(positions(id)),
        _ => None,
    };
    let bounds = summary.all.bounds.bounds();
    let octree = Octree { origin: bounds.min, size: bounds.diagonal().max_element() };
    // Meshes of alike triangles have no large ones: looking at all corners would take long.
    let large = LARGE * ((summary.all.sizes / n as f64) as f32).powi(2);
    let large: Vec<(u32, f32)> = summary
        .larger_than(large)
        .into_par_iter()
        .flat_map_iter(|numbers| {
            let mut found = Vec::new();
            for_blocks(references, numbers.start..n.min(numbers.end), |start, block| {
                for (i, r) in block.iter().enumerate().filter(|(_, r)| r.hull().half_area() > large) {
                    found.push(((start + i) as u32, corners(r).map_or(0.0, |p| octree.priority(p))));
                }
            });
            found
        })
        .collect();
    let sample = (0..n).step_by(n.div_ceil(SAMPLE));
    let (sum, count) = sample
        .filter_map(|i| corners(&one(references, i as u32)))
        .fold((0.0, 0), |(sum, count), p| (sum + f64::from(octree.priority(p)), count + 1));
    let mean = (sum / f64::from(count.max(1))) as f32;
    let scale = (1.0 / (OUTSTANDING * mean)).min(f32::MAX);
    let share = |part: f32| (part * n as f32) as usize;
    if large.iter().map(|&(_, priority)| cuts(priority, scale)).sum::<usize>() > share(MANY) {
        return Cuts::Meanwhile(share(LATER));
    }
    // All parts of a chunk, with what they are parts of.
    let cut = |chunk: &[(u32, f32)]| {
        let mut parts = Vec::new();
        for &(index, priority) in chunk {
            let cuts @ 1.. = cuts(priority, scale) else { continue };
            let reference = one(references, index);
            if let Some(corners) = corners(&reference) {
                let size = Bounds3::around(corners).diagonal().max_element();
                octree.cut(&corners, cuts, &mut |b| {
                    parts.push((index, reference.with_bounds(padded(b, size))))
                });
            }
        }
        parts
    };
    Cuts::Before(large.par_chunks(CHUNK).flat_map_iter(cut).collect())
}

impl Octree {
    /// Cuts a convex polygon and gives the boxes of its parts.
    fn cut(&self, polygon: &[Vec3], cuts: usize, give: &mut impl FnMut(Bounds3)) {
        let bounds = Bounds3::around(polygon.iter().copied());
        let Some((_, axis, place)) = self.plane(&bounds).filter(|_| cuts > 0) else { return give(bounds) };
        let mut halves = [Vec::with_capacity(8), Vec::with_capacity(8)];
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            if a[axis] <= place {
                halves[0].push(a);
            }
            if a[axis] >= place {
                halves[1].push(a);
            }
            if (a[axis] < place) != (b[axis] < place) && a[axis] != place && b[axis] != place {
                // In double precision: what is left of the error is far below what boxes are padded by.
                let (a, b) = (a.as_dvec3(), b.as_dvec3());
                let s = (f64::from(place) - a[axis]) / (b[axis] - a[axis]);
                let mut p = (a + s * (b - a)).as_vec3();
                p[axis] = place;
                halves.iter_mut().for_each(|half| half.push(p));
            }
        }
        let size = |half: &[Vec3]| Bounds3::around(half.iter().copied()).diagonal().max_element();
        let [low, high] = [size(&halves[0]), size(&halves[1])];
        let left = cuts - 1;
        let for_low = ((left as f32 * low / (low + high)).round() as usize).min(left);
        self.cut(&halves[0], for_low, give);
        self.cut(&halves[1], left - for_low, give);
    }
}
