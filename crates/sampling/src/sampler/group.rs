use super::{Pattern, PixelSample};
use crate::{Dimension, Variable};
use arrayvec::ArrayVec;
use std::ops::Deref;
use tenfold_math::{Floats, Slots, UVec2, Vec2, Vec2s, WIDTH};

/// Consecutive samples of a pixel, at most [`WIDTH`], one in each slot: asked for the numbers of many at once.
#[derive(Clone, Debug, Default)]
pub struct SampleGroup<'a>(pub(super) ArrayVec<PixelSample<'a>, WIDTH>);

impl SampleGroup<'_> {
    /// The slots that have a sample.
    #[inline]
    pub fn slots(&self) -> Slots {
        Slots::first(self.len())
    }

    /// See [`PixelSample::pixel`]; the first pixel where there are no samples.
    #[inline]
    pub fn pixel(&self) -> UVec2 {
        self.first().map_or(UVec2::ZERO, PixelSample::pixel)
    }

    /// See [`PixelSample::held`].
    #[inline]
    pub fn held(&self, variable: Variable) -> Option<Vec2> {
        self.first()?.held(variable)
    }

    /// [`PixelSample::get_1d`] of the samples in `slots`; any number in the others.
    #[inline]
    pub fn get_1d(&self, slots: Slots, dimension: Dimension) -> Floats {
        if let Some(both) = self.kept(slots, dimension) {
            return both.x;
        }
        let mut numbers = [0.0; WIDTH];
        slots.for_each(|slot| numbers[slot] = self[slot].get_1d(dimension));
        numbers
    }

    /// [`PixelSample::get_2d`] of the samples in `slots`; any numbers in the others.
    #[inline]
    pub fn get_2d(&self, slots: Slots, dimension: Dimension) -> Vec2s {
        if let Some(both) = self.kept(slots, dimension) {
            return both;
        }
        let mut numbers = Vec2s::ZERO;
        slots.for_each(|slot| numbers.set(slot, self[slot].get_2d(dimension)));
        numbers
    }

    /// The numbers of all, where they are computed together and it is worth it.
    #[inline]
    fn kept(&self, slots: Slots, dimension: Dimension) -> Option<Vec2s> {
        let Pattern::Kept(room, place) = self.first()?.pattern else { return None };
        (slots.len() > 1).then(|| room.get_lanes(place, dimension))
    }
}

impl<'a> Deref for SampleGroup<'a> {
    type Target = [PixelSample<'a>];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// One sample by itself.
impl<'a> From<PixelSample<'a>> for SampleGroup<'a> {
    #[inline]
    fn from(sample: PixelSample<'a>) -> Self {
        Self(std::iter::once(sample).collect())
    }
}
