//! References side by side, and how they are split.

use super::{
    Counts,
    bins::{self, around},
    grid::{self, Top},
    hull::Hull,
    pair::Pair,
    reference::{Reference, Target},
    room::{Pool, Room},
    source::{Chosen, Look, References, Summary, one},
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
    pub(super) source: &'a dyn References,
    pub(super) positions: &'a Positions<'a>,
    pub(super) pool: &'a Pool,
}

/// Some references and what is around them.
pub(super) struct Range<'a> {
    context: Context<'a>,
    items: Items<'a>,
    /// Where their room begins among all.
    first: usize,
    bounds: Hull,
    /// Around their doubled middles; `None` where that is not known yet.
    middles: Option<Hull>,
}

/// What a range has of its references.
pub(super) enum Items<'a> {
    /// Their numbers, which a grid has sorted to the leaves of an upper tree.
    Numbers(&'a mut [u32], Box<Top>),
    /// Themselves; where they were made of numbers, for a while: the order of these is what is kept.
    References(Pair<'a, Reference>, Option<&'a mut [u32]>),
}

impl<'a> Range<'a> {
    /// All references.
    pub(super) fn all(context: Context<'a>, items: Items<'a>, summary: &Summary) -> Self {
        let Look { bounds, middles, .. } = summary.all;
        Self { context, items, first: 0, bounds, middles: Some(middles) }
    }

    pub(super) fn len(&self) -> usize {
        match &self.items {
            Items::Numbers(numbers, _) => numbers.len(),
            Items::References(references, _) => references.len(),
        }
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
        let are_triangles = || match &self.items {
            Items::Numbers(numbers, _) => numbers.iter().all(|&number| self.one(number).is_triangle()),
            Items::References(references, _) => references.items().iter().all(Reference::is_triangle),
        };
        self.len() <= 1 || (self.len() <= LANES && are_triangles())
    }

    /// Brings the content of a leaf to where it belongs, and counts it. Returns the index of the first.
    pub(super) fn finish(&mut self, counts: &mut Counts) -> usize {
        let target = match &self.items {
            Items::Numbers(numbers, _) => numbers.first().map(|&number| self.one(number).target()),
            Items::References(references, _) => references.items().first().map(Reference::target),
        };
        match target {
            Some(Target::Triangle(_)) => counts.blocks += 1,
            Some(Target::Shape(_)) => counts.shapes += 1,
            Some(Target::Placement(_)) | None => {}
        }
        match &mut self.items {
            Items::Numbers(..) => {}
            Items::References(references, None) => return self.first + references.finish(),
            Items::References(references, Some(numbers)) => {
                let order = references.items().iter().map(Reference::number);
                numbers.iter_mut().zip(order).for_each(|(number, sorted)| *number = sorted);
            }
        }
        self.first
    }

    fn one(&self, number: u32) -> Reference {
        one(self.context.source, number)
    }

    /// Where its room begins among all.
    pub(super) fn first(&self) -> usize {
        self.first
    }

    /// Splits by the heuristic; in the middle where that finds no plane, or where it must (`halve`). May take `room` to sort in.
    pub(super) fn split(self, halve: bool, room: &'a mut Room<'_>) -> [Self; 2] {
        let Self { context, items, first, bounds, middles } = self;
        let (mut references, numbers) = match items {
            Items::References(mut references, numbers) => {
                if !halve {
                    references.furnish(|n| room.take(n));
                }
                (references, numbers)
            }
            Items::Numbers(numbers, top) => match halves_of(context, numbers, *top).filter(|_| !halve) {
                Some(halves) => return Self::split_top(context, first, numbers, halves),
                None => (room.make(context.source, numbers), Some(numbers)),
            },
        };
        if halve {
            return Self::halve(context, first, references, numbers, &bounds);
        }
        let middles = middles.unwrap_or_else(|| around(context.level, references.items())[1]);
        let halves = bins::sort(context.level, &mut references, &middles);
        if let Some([low, high]) = sort_space(context, &mut references, &bounds, halves.as_ref()) {
            // SAFETY: so many were written.
            let pairs = unsafe { references.swapped(low, high, need) };
            return Self::pair(context, first, pairs, numbers, None);
        }
        let Some(halves) = halves else { return Self::halve(context, first, references, numbers, &bounds) };
        let n = references.len();
        // SAFETY: all of them were written.
        let pairs = unsafe { references.swapped(halves.low, n - halves.low, need) };
        let [low_bounds, high_bounds] = halves.bounds;
        let [low_middles, high_middles] = halves.middles;
        let around = [[low_bounds, low_middles], [high_bounds, high_middles]];
        Self::pair(context, first, pairs, numbers, Some(around))
    }

    /// Two ranges, and what is around them and their doubled middles where that is known.
    fn pair(
        context: Context<'a>,
        first: usize,
        [low, high]: [Pair<'a, Reference>; 2],
        numbers: Option<&'a mut [u32]>,
        hulls: Option<[[Hull; 2]; 2]>,
    ) -> [Self; 2] {
        let next = first + low.capacity();
        let level = context.level;
        let [low_hulls, high_hulls] =
            hulls.unwrap_or_else(|| [around(level, low.items()), around(level, high.items())]);
        let (low_numbers, high_numbers) = numbers.map(|numbers| numbers.split_at_mut(low.len())).unzip();
        let halves = [(low, low_numbers, first, low_hulls), (high, high_numbers, next, high_hulls)];
        halves.map(|(references, numbers, first, [bounds, middles])| {
            let items = Items::References(references, numbers);
            Self { context, items, first, bounds, middles: Some(middles) }
        })
    }

    /// Splits where the grid did.
    fn split_top(
        context: Context<'a>,
        first: usize,
        numbers: &'a mut [u32],
        [low_top, high_top]: [Box<Top>; 2],
    ) -> [Self; 2] {
        let next = first + low_top.len;
        let (low, high) = numbers.split_at_mut(low_top.len);
        [(low, low_top, first), (high, high_top, next)].map(|(numbers, top, first)| {
            let bounds = top.bounds;
            Self { context, items: Items::Numbers(numbers, top), first, bounds, middles: None }
        })
    }

    /// Splits in the middle.
    fn halve(
        context: Context<'a>,
        first: usize,
        mut references: Pair<'a, Reference>,
        numbers: Option<&'a mut [u32]>,
        bounds: &Hull,
    ) -> [Self; 2] {
        let axis = bounds.bounds().longest_axis();
        let k = references.len() / 2;
        // A total order: the result must not depend on the algorithm's whims.
        references.items_mut().select_nth_unstable_by(k, |a, b| a.cmp_along(b, axis));
        Self::pair(context, first, references.split_at(k), numbers, None)
    }
}

/// The halves of an upper tree. A leaf of it that is too full gets a grid of its own.
fn halves_of(context: Context<'_>, numbers: &mut [u32], top: Top) -> Option<[Box<Top>; 2]> {
    if top.halves.is_some() || numbers.len() <= GRID {
        return top.halves;
    }
    let chosen = Chosen { all: context.source, numbers };
    let (order, top) = grid::sort(context.level, &chosen, &Summary::of(&chosen).all.middles)?;
    let halves = top.halves?;
    let sorted: Vec<u32> = order.iter().map(|&i| numbers[i as usize]).collect();
    numbers.copy_from_slice(&sorted);
    Some(halves)
}

/// Splits space where that is better than `halves`, into which references were sorted: sorts them again. Returns how many there are in both halves.
fn sort_space(
    context: Context<'_>,
    references: &mut Pair<'_, Reference>,
    bounds: &Hull,
    halves: Option<&bins::Halves>,
) -> Option<[usize; 2]> {
    if references.slack() == 0 || references.len() <= 2 * LANES {
        return None;
    }
    if let Some(halves) = halves {
        let overlap = halves.bounds[0].intersection(&halves.bounds[1]);
        if overlap.is_none_or(|overlap| !(overlap.half_area() > OVERLAP * bounds.half_area())) {
            return None;
        }
    }
    let (references, room) = references.sides();
    let plane = spatial::find(references, bounds, context.positions)?;
    (halves.is_none_or(|halves| plane.cost < halves.cost))
        .then(|| spatial::sort(references, &plane, context.positions, room))
}
