//! The numbers of consecutive samples of a pixel, computed together in the lanes of vectors.

use super::sobol::SobolSample;
use crate::{Dimension, Variable};
use std::cell::Cell;
use tenfold_math::{Vec2, WIDTH};

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

/// The numbers of a dimension, in groups that are computed together.
type Row = [[Cell<Vec2>; LANES]; GROUPS];

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
    numbers: Vec<Row>,
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
        self.numbers.resize_with(SLOTS, Row::default);
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
        let slot = usize::from(dimension.bounce) * VARIABLES + dimension.variable as usize;
        let (group, lane) = (place as usize / LANES, place as usize % LANES);
        match self.known.get(slot) {
            Some(known) if known.get() >> group & 1 != 0 => self.numbers[slot][group][lane].get(),
            _ => self.compute(place, dimension),
        }
    }

    #[cold]
    fn compute(&self, place: u32, dimension: Dimension) -> Vec2 {
        let Some(block) = &self.block else { return Vec2::ZERO };
        let slot = usize::from(dimension.bounce) * VARIABLES + dimension.variable as usize;
        let (group, lane) = (place as usize / LANES, place as usize % LANES);
        let asked = 1 << (GROUPS + group);
        let known = match self.known.get(slot) {
            Some(known) if known.get() & asked != 0 => known,
            slot => {
                slot.inspect(|known| known.set(known.get() | asked));
                return block.at_place(place).get_2d(dimension.key());
            }
        };
        let [x, y] = lanes(block, dimension.key(), (group * LANES) as u32);
        let row = &self.numbers[slot][group];
        row.iter().zip(x.into_iter().zip(y)).for_each(|(cell, (x, y))| cell.set(Vec2::new(x, y)));
        known.set(known.get() | 1 << group);
        row[lane].get()
    }
}

/// The numbers of [`LANES`] samples.
#[cfg(target_arch = "x86_64")]
fn lanes(block: &SobolSample, key: u32, first: u32) -> [[f32; LANES]; 2] {
    #[target_feature(enable = "avx2")]
    fn avx2(block: &SobolSample, key: u32, first: u32) -> [[f32; LANES]; 2] {
        block.get_lanes(key, first)
    }
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has the instructions.
        return unsafe { avx2(block, key, first) };
    }
    block.get_lanes(key, first)
}

/// The numbers of [`LANES`] samples.
#[cfg(not(target_arch = "x86_64"))]
fn lanes(block: &SobolSample, key: u32, first: u32) -> [[f32; LANES]; 2] {
    block.get_lanes(key, first)
}
