//! References side by side, and how they are split.

use super::{
    Counts,
    bins::{self, around},
    grid::{self, Top},
    hull::Hull,
    pair::Pair,
    reference::{Reference, Target},
    room::{Pool, Room},
    source::Summary,
    spatial::{self, Positions},
};
use crate::bvh::{node::LANES, traverse::Level};
use tenfold_math::Bounds3;

/// More references are sorted by a grid first, where none are to be cut.
pub(super) const GRID: usize = 1 << 16;
/// Splits of space are looked for where halves overlap by this share of the area around both.
const OVERLAP: f32 = 0.3;

/// How many cuts some references are worth: large ones more than small ones, but not by as much as they are larger.
fn need(references: &[Reference]) -> f32 {
    references.iter().map(|r| r.hull().half_area().sqrt()).sum()
}

/// What is the same for all ranges.
#[derive(Copy, Clone)]
pub(super) struct Context<'a> {
    pub(super) level: Level,
    pub(super) positions: &'a Positions<'a>,
    pub(super) pool: &'a Pool,
}

/// Some references and what is around them.
pub(super) struct Range<'a> {
    context: Context<'a>,
    references: Pair<'a, Reference>,
    /// Where their room begins among all.
    first: usize,
    bounds: Hull,
    /// Around their doubled middles; `None` where that is not known yet.
    middles: Option<Hull>,
    /// How they are split, where that is known.
    top: Option<Box<Top>>,
}

impl<'a> Range<'a> {
    /// All references, sorted by a grid to its leaves or not at all.
    pub(super) fn all(
        context: Context<'a>,
        references: Pair<'a, Reference>,
        summary: &Summary,
        top: Option<Box<Top>>,
    ) -> Self {
        let Summary { bounds, middles, .. } = *summary;
        Self { context, references, first: 0, bounds, middles: Some(middles), top }
    }

    pub(super) fn len(&self) -> usize {
        self.references.len()
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        self.bounds.bounds()
    }

    pub(super) fn pool(&self) -> &'a Pool {
        self.context.pool
    }

    pub(super) fn half_area(&self) -> f32 {
        self.bounds.half_area()
    }

    /// Whether one leaf can hold all of it.
    pub(super) fn fits_leaf(&self) -> bool {
        self.len() <= 1 || (self.len() <= LANES && self.references.items().iter().all(Reference::is_triangle))
    }

    /// Brings the references of a leaf to where they belong, and counts it. Returns the index of the first.
    pub(super) fn finish(&mut self, counts: &mut Counts) -> usize {
        match self.references.items().first().map(Reference::target) {
            Some(Target::Triangle(_)) => counts.blocks += 1,
            Some(Target::Shape(_)) => counts.shapes += 1,
            Some(Target::Placement(_)) | None => {}
        }
        self.first + self.references.finish()
    }

    /// Splits by the heuristic; in the middle where that finds no plane, or where it must (`halve`). May take `room` to sort in.
    pub(super) fn split(mut self, halve: bool, room: &'a mut Room<'_>) -> [Self; 2] {
        if halve {
            return self.halve();
        }
        if let Some(halves) = self.top.take().and_then(|top| top.halves) {
            return self.split_top(halves);
        }
        self.references.furnish(|n| room.take(n));
        let level = self.context.level;
        let middles = self.middles.unwrap_or_else(|| around(level, self.references.items())[1]);
        if self.len() > GRID && self.references.slack() == 0 {
            let (from, to) = self.references.sides();
            if let Some([low, high]) = grid::sort(level, from, &middles, to).and_then(|top| top.halves) {
                // SAFETY: the grid has sorted all references into the room.
                let [references, _] = unsafe { self.references.swapped(low.len + high.len, 0, need) };
                return Self { references, ..self }.split_top([low, high]);
            }
        }
        let halves = bins::sort(level, &mut self.references, &middles);
        if let Some([low, high]) = self.sort_space(halves.as_ref()) {
            // SAFETY: so many were written.
            let pairs = unsafe { self.references.swapped(low, high, need) };
            return Self::pair(self.context, self.first, pairs, None);
        }
        let Some(halves) = halves else { return self.halve() };
        let n = self.len();
        // SAFETY: all of them were written.
        let pairs = unsafe { self.references.swapped(halves.low, n - halves.low, need) };
        let [low_bounds, high_bounds] = halves.bounds;
        let [low_middles, high_middles] = halves.middles;
        let around = [[low_bounds, low_middles], [high_bounds, high_middles]];
        Self::pair(self.context, self.first, pairs, Some(around))
    }

    /// Two ranges, and what is around them and their doubled middles where that is known.
    fn pair(
        context: Context<'a>,
        first: usize,
        [low, high]: [Pair<'a, Reference>; 2],
        hulls: Option<[[Hull; 2]; 2]>,
    ) -> [Self; 2] {
        let next = first + low.capacity();
        let level = context.level;
        let [low_hulls, high_hulls] =
            hulls.unwrap_or_else(|| [around(level, low.items()), around(level, high.items())]);
        [(low, first, low_hulls), (high, next, high_hulls)].map(|(references, first, [bounds, middles])| {
            Self { context, references, first, bounds, middles: Some(middles), top: None }
        })
    }

    /// Splits space where that is better than `halves`, into which the references were sorted: sorts them again. Returns how many there are in both halves.
    fn sort_space(&mut self, halves: Option<&bins::Halves>) -> Option<[usize; 2]> {
        if self.references.slack() == 0 || self.len() <= 2 * LANES {
            return None;
        }
        if let Some(halves) = halves {
            let overlap = halves.bounds[0].intersection(&halves.bounds[1]);
            if overlap.is_none_or(|overlap| !(overlap.half_area() > OVERLAP * self.half_area())) {
                return None;
            }
        }
        let (references, room) = self.references.sides();
        let positions = self.context.positions;
        let plane = spatial::find(references, &self.bounds, positions)?;
        (halves.is_none_or(|halves| plane.cost < halves.cost))
            .then(|| spatial::sort(references, &plane, positions, room))
    }

    /// Splits where the grid did.
    fn split_top(self, [low_top, high_top]: [Box<Top>; 2]) -> [Self; 2] {
        let k = low_top.len;
        let Self { context, references, first, .. } = self;
        let [low, high] = references.split_at(k);
        [(low, first, low_top), (high, first + k, high_top)].map(|(references, first, top)| Self {
            context,
            references,
            first,
            bounds: top.bounds,
            middles: None,
            top: Some(top),
        })
    }

    /// Splits in the middle.
    fn halve(self) -> [Self; 2] {
        let Self { context, mut references, first, bounds, .. } = self;
        let axis = bounds.bounds().longest_axis();
        let k = references.len() / 2;
        // A total order: the result must not depend on the algorithm's whims.
        references.items_mut().select_nth_unstable_by(k, |a, b| a.cmp_along(b, axis));
        Self::pair(context, first, references.split_at(k), None)
    }
}
