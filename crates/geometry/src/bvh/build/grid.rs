//! Many references at once: they are counted in the cells of a grid, the upper tree is grown over the cells, and their numbers are sorted into its leaves in one
//! go (after Ganestam, Barringer, Doggett and Akenine-Möller 2015). Whatever the number of threads, the result is the same.

use super::{
    bins::{self, Item},
    hull::Hull,
    pair::Pair,
    reference::Reference,
    source::{References, for_blocks},
};
use crate::bvh::traverse::Level;
use rayon::prelude::*;
use std::{mem::MaybeUninit, ops::Range};

/// References of a chunk at least, and how many chunks there are at most.
const CHUNK: usize = 1 << 14;
const CHUNKS: usize = 32;
/// The upper tree ends where a leaf has at most this many references: they and their copies fit the caches near the processor.
const PIECE: usize = 1 << 13;
/// It also ends where there are fewer cells than this, and at most so many references.
const FEW: usize = 8;
const MOST: usize = 1 << 16;
/// Trees over more cells are grown on several threads.
const PARALLEL: usize = 1 << 11;

/// Part of the upper tree.
pub(super) struct Top {
    pub(super) bounds: Hull,
    /// How many references there are.
    pub(super) len: usize,
    /// How many cells.
    cells: usize,
    /// `None` for a leaf.
    pub(super) halves: Option<[Box<Top>; 2]>,
}

/// References whose middles are in one cell.
#[derive(Copy, Clone)]
struct Cell {
    hull: Hull,
    index: u32,
    count: u32,
}

impl Item for Cell {
    #[inline(always)]
    fn hull(&self) -> &Hull {
        &self.hull
    }
    #[inline(always)]
    fn count(&self) -> u32 {
        self.count
    }
}

/// A grid over the doubled middles of references.
#[derive(Copy, Clone)]
struct Grid {
    origin: [f32; 3],
    scale: [f32; 3],
    bits: u32,
}

impl Grid {
    fn new(middles: &Hull, n: usize) -> Self {
        let bits = if n < 1 << 18 {
            4
        } else if n < 1 << 21 {
            5
        } else {
            6
        };
        let origin = [middles.0[0], middles.0[1], middles.0[2]];
        let scale = std::array::from_fn(|axis| {
            let d = -(middles.0[axis] + middles.0[axis + 4]);
            if d > 0.0 { (1 << bits) as f32 * 0.999_99 / d } else { 0.0 }
        });
        Self { origin, scale, bits }
    }

    fn cells(&self) -> usize {
        1 << (3 * self.bits)
    }

    #[inline(always)]
    fn cell(&self, reference: &Reference) -> usize {
        let hull = &reference.hull().0;
        let place = |axis: usize| {
            let x = (hull[axis] - hull[axis + 4] - self.origin[axis]) * self.scale[axis];
            // The first makes 0 of what is not a number.
            let x = x.max(0.0).min(((1 << self.bits) - 1) as f32);
            x as usize
        };
        (place(2) << self.bits | place(1)) << self.bits | place(0)
    }
}

/// The cells that hold something, each once.
struct Cells {
    cells: Vec<Cell>,
    /// Where in the list a cell is, plus one; 0 for those that are not.
    slots: Vec<u32>,
}

impl Cells {
    fn new(grid: &Grid) -> Self {
        Self { cells: Vec::new(), slots: vec![0; grid.cells()] }
    }

    #[inline(always)]
    fn at(&mut self, index: usize) -> &mut Cell {
        let slot = &mut self.slots[index];
        if *slot == 0 {
            self.cells.push(Cell { hull: Hull::EMPTY, index: index as u32, count: 0 });
            *slot = self.cells.len() as u32;
        }
        &mut self.cells[*slot as usize - 1]
    }
}

/// The numbers of all references in the order of the leaves of the upper tree, and this. `None` where the doubled `middles` coincide.
pub(super) fn sort(
    level: Level,
    references: &(impl References + ?Sized),
    middles: &Hull,
) -> Option<(Vec<u32>, Box<Top>)> {
    let grid = Grid::new(middles, references.len());
    let chunk = references.len().div_ceil(CHUNKS).max(CHUNK);
    let starts = (0..references.len()).step_by(chunk);
    let chunks: Vec<Range<usize>> = starts.map(|start| start..references.len().min(start + chunk)).collect();
    let counted: Vec<Vec<Cell>> = chunks
        .par_iter()
        .map(|chunk| {
            let mut cells = Cells::new(&grid);
            for_blocks(references, chunk.clone(), |_, block| {
                for reference in block {
                    let cell = cells.at(grid.cell(reference));
                    cell.hull = cell.hull.union(reference.hull());
                    cell.count += 1;
                }
            });
            cells.cells
        })
        .collect();
    let mut all = Cells::new(&grid);
    for part in counted.iter().flatten() {
        let cell = all.at(part.index as usize);
        cell.hull = cell.hull.union(&part.hull);
        cell.count += part.count;
    }
    let Cells { mut cells, slots: mut leaf_of } = all;
    let n = cells.len();
    if n < 2 {
        return None;
    }
    let [bounds, middles] = bins::around(level, &cells);
    let mut other = Vec::with_capacity(n);
    let mut home = Vec::with_capacity(n);
    home.extend(cells.iter().map(|cell| MaybeUninit::new(*cell)));
    // SAFETY: all of them are cells.
    let mut pair = unsafe { Pair::new(&mut home, n) };
    pair.furnish(|_| other.spare_capacity_mut());
    let top = grow(level, pair, bounds, &middles);
    // SAFETY: sorted cells are cells.
    cells.iter_mut().zip(&home).for_each(|(cell, sorted)| *cell = unsafe { sorted.assume_init() });
    let mut leaves = 0;
    let mut rest = &cells[..];
    top.for_leaves(&mut |leaf| {
        rest.split_off(..leaf.cells)
            .into_iter()
            .flatten()
            .for_each(|cell| leaf_of[cell.index as usize] = leaves);
        leaves += 1;
    });
    // Where the references of each chunk go, leaf by leaf.
    let counts: Vec<Vec<u32>> = counted
        .par_iter()
        .map(|cells| {
            let mut counts = vec![0; leaves as usize];
            cells.iter().for_each(|cell| counts[leaf_of[cell.index as usize] as usize] += cell.count);
            counts
        })
        .collect();
    let mut rooms: Vec<Vec<_>> = counts.iter().map(|_| Vec::with_capacity(leaves as usize)).collect();
    let mut numbers = vec![0; references.len()];
    let mut rest = &mut numbers[..];
    for leaf in 0..leaves as usize {
        for (counts, rooms) in counts.iter().zip(&mut rooms) {
            rooms.push(
                rest.split_off_mut(..counts[leaf] as usize).expect("as much room as was counted").iter_mut(),
            );
        }
    }
    chunks.into_par_iter().zip(rooms).for_each(|(chunk, mut rooms)| {
        for_blocks(references, chunk, |start, block| {
            for (i, reference) in block.iter().enumerate() {
                let room = &mut rooms[leaf_of[grid.cell(reference)] as usize];
                *room.next().expect("as much room as was counted") = (start + i) as u32;
            }
        });
    });
    Some((numbers, Box::new(top)))
}

/// The part of the upper tree over some cells.
fn grow(level: Level, mut cells: Pair<'_, Cell>, bounds: Hull, middles: &Hull) -> Top {
    let n = cells.items().len();
    let len = cells.items().iter().map(|cell| cell.count as usize).sum();
    let halves = match len > PIECE && (n >= FEW || len > MOST) {
        true => bins::sort(level, &mut cells, middles),
        false => None,
    };
    let Some(halves) = halves else {
        cells.finish();
        return Top { bounds, len, cells: n, halves: None };
    };
    // SAFETY: all cells were written.
    let [low, high] = unsafe { cells.swapped(halves.low, n - halves.low, |_| 0.0) };
    let ([low_bounds, high_bounds], [low_middles, high_middles]) = (halves.bounds, halves.middles);
    let low = || Box::new(grow(level, low, low_bounds, &low_middles));
    let high = || Box::new(grow(level, high, high_bounds, &high_middles));
    let (low, high) = match n > PARALLEL {
        true => rayon::join(low, high),
        false => (low(), high()),
    };
    Top { bounds, len, cells: n, halves: Some([low, high]) }
}

impl Top {
    /// In order.
    fn for_leaves(&self, f: &mut impl FnMut(&Self)) {
        match &self.halves {
            None => f(self),
            Some(halves) => halves.iter().for_each(|half| half.for_leaves(f)),
        }
    }
}
