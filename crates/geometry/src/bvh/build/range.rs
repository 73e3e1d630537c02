//! References side by side, and how they are split.

use super::{
    Counts, MaybeUninit,
    bins::{around, split},
    grid::{self, Top},
    hull::Hull,
    pair::Pair,
    reference::{Reference, Target},
};
use crate::bvh::{node::LANES, traverse::Level};
use tenfold_math::Bounds3;

/// More references are sorted by a grid first.
const GRID: usize = 1 << 16;

/// Some references and what is around them.
pub(super) struct Range<'a> {
    level: Level,
    references: Pair<'a, Reference>,
    /// Index of the first of them among all.
    first: usize,
    bounds: Hull,
    /// Around their doubled middles; `None` where that is not known yet.
    middles: Option<Hull>,
    /// How they are split, where that is known.
    top: Option<Box<Top>>,
}

impl<'a> Range<'a> {
    /// All references, with a buffer of the same size.
    pub(super) fn all(
        level: Level,
        references: &'a mut [Reference],
        room: &'a mut [MaybeUninit<Reference>],
    ) -> Self {
        let [bounds, middles] = grid::around_all(level, references);
        let references = Pair::new(references, room);
        Self { level, references, first: 0, bounds, middles: Some(middles), top: None }
    }

    pub(super) fn len(&self) -> usize {
        self.references.items().len()
    }

    pub(super) fn first(&self) -> usize {
        self.first
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        self.bounds.bounds()
    }

    pub(super) fn half_area(&self) -> f32 {
        self.bounds.half_area()
    }

    /// Whether one leaf can hold all of it.
    pub(super) fn fits_leaf(&self) -> bool {
        self.len() <= 1 || (self.len() <= LANES && self.references.items().iter().all(Reference::is_triangle))
    }

    /// Brings the references of a leaf to where they belong, and counts it.
    pub(super) fn finish(&mut self, counts: &mut Counts) {
        self.references.finish();
        match self.references.items().first().map(Reference::target) {
            Some(Target::Triangle(_)) => counts.blocks += 1,
            Some(Target::Shape(_)) => counts.shapes += 1,
            Some(Target::Placement(_)) | None => {}
        }
    }

    /// Splits by the heuristic; in the middle where that finds no plane, or where it must (`halve`).
    pub(super) fn split(self, halve: bool) -> [Self; 2] {
        let Self { level, mut references, first, bounds, middles, top } = self;
        if halve {
            return Self::halve(level, references, first, &bounds);
        }
        if let Some(halves) = top.and_then(|top| top.halves) {
            return Self::split_top(level, references, first, halves);
        }
        let middles = middles.unwrap_or_else(|| around(level, references.items())[1]);
        if references.items().len() > GRID {
            let (from, to) = references.sides();
            if let Some(halves) = grid::sort(level, from, &middles, to).and_then(|top| top.halves) {
                // SAFETY: the grid has sorted all references into the room.
                let references = unsafe { references.swapped() };
                return Self::split_top(level, references, first, halves);
            }
        }
        match split(level, references, &middles) {
            Ok([low, high]) => {
                let next = first + low.items.items().len();
                [(low, first), (high, next)].map(|(half, first)| Self {
                    level,
                    references: half.items,
                    first,
                    bounds: half.bounds,
                    middles: Some(half.middles),
                    top: None,
                })
            }
            Err(references) => Self::halve(level, references, first, &bounds),
        }
    }

    /// Splits where the grid did.
    fn split_top(
        level: Level,
        references: Pair<'a, Reference>,
        first: usize,
        [low_top, high_top]: [Box<Top>; 2],
    ) -> [Self; 2] {
        let k = low_top.len;
        let [low, high] = references.split_at(k);
        [(low, first, low_top), (high, first + k, high_top)].map(|(references, first, top)| Self {
            level,
            references,
            first,
            bounds: top.bounds,
            middles: None,
            top: Some(top),
        })
    }

    /// Splits in the middle.
    fn halve(level: Level, mut references: Pair<'a, Reference>, first: usize, bounds: &Hull) -> [Self; 2] {
        let axis = bounds.bounds().longest_axis();
        let k = references.items().len() / 2;
        // A total order: the result must not depend on the algorithm's whims.
        references.items_mut().select_nth_unstable_by(k, |a, b| a.cmp_along(b, axis));
        let [low, high] = references.split_at(k);
        [(low, first), (high, first + k)].map(|(references, first)| {
            let [bounds, middles] = around(level, references.items());
            Self { level, references, first, bounds, middles: Some(middles), top: None }
        })
    }
}
