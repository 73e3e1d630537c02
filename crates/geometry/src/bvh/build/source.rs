//! Where references come from: boxes are made when they are asked for, more than once, which costs less than memory to keep them in.

use super::{bins, hull::Hull, reference::Reference};
use crate::bvh::{traverse::Level, with_capacity};
use rayon::prelude::*;
use std::ops::Range;

/// References that are read together: they fit the cache near the processor.
const BLOCK: usize = 4096;

/// What a hierarchy is built over.
pub(crate) trait References: Sync {
    /// How many there are.
    fn len(&self) -> usize;

    /// Some of them, made in `room` where they lie nowhere.
    fn read<'a>(&'a self, range: Range<usize>, room: &'a mut Vec<Reference>) -> &'a [Reference];
}

impl References for [Reference] {
    fn len(&self) -> usize {
        self.len()
    }

    fn read<'a>(&'a self, range: Range<usize>, _: &'a mut Vec<Reference>) -> &'a [Reference] {
        &self[range]
    }
}

/// All of them.
pub(super) fn collect(source: &(impl References + ?Sized)) -> Vec<Reference> {
    let n = source.len();
    let mut all = with_capacity(n);
    all.spare_capacity_mut()[..n].par_chunks_mut(BLOCK).enumerate().for_each_init(
        Vec::new,
        |room, (i, to)| {
            let block = source.read(BLOCK * i..BLOCK * i + to.len(), room);
            assert_eq!(block.len(), to.len());
            to.iter_mut().zip(block).for_each(|(to, reference)| _ = to.write(*reference));
        },
    );
    // SAFETY: all were written, as many as asserted.
    unsafe { all.set_len(n) };
    all
}

/// Reads a range block by block.
pub(super) fn for_blocks(
    source: &(impl References + ?Sized),
    range: Range<usize>,
    mut f: impl FnMut(usize, &[Reference]),
) {
    let mut room = Vec::new();
    for start in range.clone().step_by(BLOCK) {
        f(start, source.read(start..range.end.min(start + BLOCK), &mut room));
    }
}

/// What is known of references from one look at all of them.
#[derive(Copy, Clone, Debug)]
pub(super) struct Summary {
    pub(super) bounds: Hull,
    /// Around the doubled middles.
    pub(super) middles: Hull,
    /// The sum of the roots of half the areas.
    pub(super) sizes: f64,
}

impl Summary {
    const EMPTY: Self = Self { bounds: Hull::EMPTY, middles: Hull::EMPTY, sizes: 0.0 };

    pub(super) fn of(source: &(impl References + ?Sized)) -> Self {
        let level = Level::detect();
        let blocks: Vec<Self> = (0..source.len().div_ceil(BLOCK))
            .into_par_iter()
            .map_init(Vec::new, |room, i| {
                let block = source.read(BLOCK * i..source.len().min(BLOCK * (i + 1)), room);
                let [bounds, middles] = bins::around(level, block);
                let sizes = block.iter().map(|r| f64::from(r.hull().half_area().sqrt())).sum();
                Self { bounds, middles, sizes }
            })
            .collect();
        // Sums in a fixed order.
        blocks.iter().fold(Self::EMPTY, |a, b| Self {
            bounds: a.bounds.union(&b.bounds),
            middles: a.middles.union(&b.middles),
            sizes: a.sizes + b.sizes,
        })
    }
}
