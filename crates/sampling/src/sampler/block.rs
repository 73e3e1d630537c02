//! The numbers of consecutive samples of a pixel, computed together in the lanes of vectors.

use super::sobol::SobolSample;
use crate::{Dimension, Variable};
use std::cell::Cell;
use tenfold_math::{Floats, Vec2, Vec2s, WIDTH, vectorized};

/// Samples whose numbers are computed together.
const LANES: usize = WIDTH;
/// The largest block of a Sobol' sampler.
const SAMPLES: usize = 64;
/// Vertices of a path whose numbers have room: few paths go further.
const BOUNCES: usize = 8;
const GROUPS: usize = SAMPLES / LANES;
const VARIABLES: usize = Variable::ALL.len();
/// Dimensions whose numbers have room.
const SLOTS: usize = BOUNCES * VARIABLES;

/// The numbers of a dimension of samples that are computed together.
#[derive(Debug, Default)]
#[repr(align(64))]
struct Row {
    x: Cell<Floats>,
    y: Cell<Floats>,
}

impl Row {
    #[inline]
    fn get(&self, lane: usize) -> Vec2 {
        let [x, y]: [&Cell<[f32]>; 2] = [&self.x, &self.y];
        Vec2::new(x.as_slice_of_cells()[lane].get(), y.as_slice_of_cells()[lane].get())
    }

    /// The numbers from the lane `first` on, in the first slots.
    #[inline]
    fn from(&self, first: usize) -> Vec2s {
        let mut numbers = Vec2s { x: self.x.get(), y: self.y.get() };
        if first != 0 {
            numbers.x.rotate_left(first);
            numbers.y.rotate_left(first);
        }
        numbers
    }

    #[inline]
    fn set(&self, numbers: &Vec2s) {
        self.x.set(numbers.x);
        self.y.set(numbers.y);
    }
}

/// Room for the numbers of the samples of one pixel that share a block, to be used again for block after block.
///
/// What a sampler has to do for a number is the same for all samples of a block but for a few integer operations, so they are done
/// for sixteen samples at once when the first of them asks. The numbers are those that every sample by itself would get, to
/// the bit.
#[derive(Debug)]
pub struct SampleRoom {
    /// The block: any of its samples.
    block: Option<SobolSample>,
    /// Per dimension, of which groups of [`LANES`] samples the numbers are known, a bit for each. Four bits above tell which groups
    /// have been asked for: one sample alone may be all that ever asks.
    known: [Cell<u8>; SLOTS],
    /// For every dimension; empty before the first block.
    numbers: Vec<[Row; GROUPS]>,
}

impl Default for SampleRoom {
    fn default() -> Self {
        Self { block: None, known: [const { Cell::new(0) }; SLOTS], numbers: Vec::new() }
    }
}

impl SampleRoom {
    /// Makes room for the block of `sample`; false where its samples are too few to be worth it.
    pub(super) fn begin(&mut self, sample: SobolSample) -> bool {
        if sample.block_size() < 8 {
            return false;
        }
        self.numbers.resize_with(SLOTS, Default::default);
        let block = Some(sample.at_place(0));
        if self.block != block {
            self.block = block;
            self.known.iter_mut().for_each(|known| *known.get_mut() = 0);
        }
        true
    }

    /// Both numbers of a dimension of the sample at `place` of the block.
    #[inline]
    pub(super) fn get(&self, place: u32, dimension: Dimension) -> Vec2 {
        let (slot, group, lane) = locate(place, dimension);
        match self.known.get(slot) {
            Some(known) if known.get() >> group & 1 != 0 => self.numbers[slot][group].get(lane),
            _ => self.compute(place, dimension),
        }
    }

    /// The same of that sample and those after it that are computed with it, in the first slots.
    #[inline]
    pub(super) fn get_lanes(&self, place: u32, dimension: Dimension) -> Vec2s {
        let (slot, group, lane) = locate(place, dimension);
        let Some(known) = self.known.get(slot) else { return self.lanes(place, dimension) };
        if known.get() >> group & 1 == 0 {
            self.fill(place, dimension);
        }
        self.numbers[slot][group].from(lane)
    }

    #[cold]
    fn compute(&self, place: u32, dimension: Dimension) -> Vec2 {
        let Some(block) = &self.block else { return Vec2::ZERO };
        let (slot, group, lane) = locate(place, dimension);
        let asked = 1 << (GROUPS + group);
        match self.known.get(slot) {
            Some(known) if known.get() & asked != 0 => {
                self.fill(place, dimension);
                self.numbers[slot][group].get(lane)
            }
            slot => {
                slot.inspect(|known| known.set(known.get() | asked));
                block.at_place(place).get_2d(dimension.key())
            }
        }
    }

    /// Makes known the numbers of the group that the sample at `place` is in, of a dimension that has room.
    fn fill(&self, place: u32, dimension: Dimension) {
        let (slot, group, lane) = locate(place, dimension);
        self.numbers[slot][group].set(&self.lanes(place - lane as u32, dimension));
        self.known[slot].set(self.known[slot].get() | 1 << group);
    }

    /// The numbers of [`LANES`] samples from that at the place `first`.
    fn lanes(&self, first: u32, dimension: Dimension) -> Vec2s {
        let mut numbers = Vec2s::ZERO;
        if let Some(block) = &self.block {
            lanes(block, dimension.key(), first, &mut numbers);
        }
        numbers
    }
}

/// Where the numbers of a dimension are, and which group and lane a sample has there.
#[inline]
fn locate(place: u32, dimension: Dimension) -> (usize, usize, usize) {
    let slot = usize::from(dimension.bounce) * VARIABLES + dimension.variable as usize;
    (slot, place as usize / LANES, place as usize % LANES)
}

vectorized! {
    /// The numbers of [`LANES`] samples.
    fn lanes(block: &SobolSample, key: u32, first: u32, out: &mut Vec2s) {
        [out.x, out.y] = block.get_lanes(key, first);
    }
}
