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

    /// Makes those of some numbers: the content of `room`.
    fn read(&self, range: Range<usize>, room: &mut Vec<Reference>);

    /// Makes some that lie anywhere: the content of `room`.
    fn choose(&self, numbers: &[u32], room: &mut Vec<Reference>);
}

/// The reference of a number.
pub(super) fn one(source: &(impl References + ?Sized), number: u32) -> Reference {
    let mut one = Vec::with_capacity(1);
    source.choose(&[number], &mut one);
    one[0]
}

/// Some of all references, in an order of their own.
pub(super) struct Chosen<'a> {
    pub(super) all: &'a dyn References,
    pub(super) numbers: &'a [u32],
}

impl References for Chosen<'_> {
    fn len(&self) -> usize {
        self.numbers.len()
    }

    fn read(&self, range: Range<usize>, room: &mut Vec<Reference>) {
        self.all.choose(&self.numbers[range], room);
    }

    fn choose(&self, numbers: &[u32], room: &mut Vec<Reference>) {
        let numbers: Vec<u32> = numbers.iter().map(|&number| self.numbers[number as usize]).collect();
        self.all.choose(&numbers, room);
    }
}

/// References some of which are cut.
pub(super) struct Cut<'a, S> {
    whole: &'a S,
    /// The first parts of those that are cut, with their numbers, in order.
    instead: Vec<(u32, Reference)>,
    /// The other parts: behind all.
    more: Vec<Reference>,
}

impl<'a, S: References> Cut<'a, S> {
    /// With parts, in the order of what they are parts of.
    pub(super) fn new(whole: &'a S, parts: Vec<(u32, Reference)>) -> Self {
        let (mut instead, mut more): (Vec<(u32, Reference)>, _) = (Vec::new(), Vec::new());
        for (number, part) in parts {
            match instead.last().is_some_and(|(last, _)| *last == number) {
                true => more.push(part),
                false => instead.push((number, part)),
            }
        }
        Self { whole, instead, more }
    }

    /// What is known where `whole` is known of what was cut: most blocks are as they were.
    pub(super) fn summary(&self, whole: &Summary) -> Summary {
        Summary::with(self, |range| {
            let next = self.instead.partition_point(|(cut, _)| (*cut as usize) < range.start);
            let is_cut = self.instead.get(next).is_some_and(|(cut, _)| (*cut as usize) < range.end);
            (!is_cut && range.end <= self.whole.len()).then(|| whole.blocks[range.start / BLOCK])
        })
    }
}

impl<S: References> References for Cut<'_, S> {
    fn len(&self) -> usize {
        self.whole.len() + self.more.len()
    }

    fn read(&self, range: Range<usize>, room: &mut Vec<Reference>) {
        let n = self.whole.len();
        self.whole.read(range.start.min(n)..range.end.min(n), room);
        let from = self.instead.partition_point(|(number, _)| (*number as usize) < range.start);
        let cut = self.instead[from..].iter().map(|(number, part)| (*number as usize, part));
        cut.take_while(|(number, _)| *number < range.end)
            .for_each(|(number, part)| room[number - range.start] = *part);
        room.extend_from_slice(&self.more[range.start.max(n) - n..range.end.max(n) - n]);
    }

    fn choose(&self, numbers: &[u32], room: &mut Vec<Reference>) {
        let n = self.whole.len() as u32;
        if numbers.iter().all(|&number| number < n) {
            self.whole.choose(numbers, room);
        } else {
            // Other parts take the places of the last that is whole.
            let whole: Vec<u32> = numbers.iter().map(|&number| number.min(n - 1)).collect();
            self.whole.choose(&whole, room);
        }
        // Numbers of which none is cut: the next is mostly one of them, too.
        let mut uncut = 0..0;
        for (&number, reference) in numbers.iter().zip(room) {
            if uncut.contains(&number) {
                continue;
            }
            let next = self.instead.partition_point(|(cut, _)| *cut < number);
            match (number.checked_sub(n), self.instead.get(next)) {
                (Some(more), _) => *reference = self.more[more as usize],
                (None, Some((cut, part))) if *cut == number => *reference = *part,
                (None, after) => {
                    let before = next.checked_sub(1).map_or(0, |before| self.instead[before].0 + 1);
                    uncut = before..after.map_or(n, |(cut, _)| *cut);
                }
            }
        }
    }
}

/// All of them, and room for more.
pub(super) fn collect(source: &(impl References + ?Sized), extra: usize) -> Vec<Reference> {
    let n = source.len();
    let mut all = with_capacity(n + extra);
    all.spare_capacity_mut()[..n].par_chunks_mut(BLOCK).enumerate().for_each_init(
        Vec::new,
        |room, (i, to)| {
            source.read(BLOCK * i..BLOCK * i + to.len(), room);
            assert_eq!(room.len(), to.len());
            to.iter_mut().zip(room).for_each(|(to, reference)| _ = to.write(*reference));
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
        source.read(start..range.end.min(start + BLOCK), &mut room);
        f(start, &room);
    }
}

/// What is known of references from one look at all of them.
#[derive(Clone, Debug)]
pub(super) struct Summary {
    /// Of everything.
    pub(super) all: Look,
    /// Of each block of numbers.
    blocks: Vec<Look>,
}

/// What is seen of some references.
#[derive(Copy, Clone, Debug)]
pub(super) struct Look {
    pub(super) bounds: Hull,
    /// Around the doubled middles.
    pub(super) middles: Hull,
    /// The sum of the roots of half the areas.
    pub(super) sizes: f64,
    /// The sum of half the areas.
    pub(super) areas: f64,
    /// The largest half area.
    largest: f32,
}

impl Look {
    const EMPTY: Self =
        Self { bounds: Hull::EMPTY, middles: Hull::EMPTY, sizes: 0.0, areas: 0.0, largest: 0.0 };

    fn at(level: Level, references: &[Reference]) -> Self {
        let [bounds, middles] = bins::around(level, references);
        let (mut sizes, mut areas, mut largest) = (0.0, 0.0, 0.0);
        for area in references.iter().map(|r| r.hull().half_area()) {
            sizes += f64::from(area.sqrt());
            areas += f64::from(area);
            largest = if area > largest { area } else { largest };
        }
        Self { bounds, middles, sizes, areas, largest }
    }
}

impl Summary {
    pub(super) fn of(source: &(impl References + ?Sized)) -> Self {
        Self::with(source, |_| None)
    }

    /// Looks at the blocks of which nothing is `known`.
    fn with(
        source: &(impl References + ?Sized),
        known: impl Fn(Range<usize>) -> Option<Look> + Sync,
    ) -> Self {
        let level = Level::detect();
        let blocks: Vec<Look> = (0..source.len().div_ceil(BLOCK))
            .into_par_iter()
            .map_init(Vec::new, |room, i| {
                let range = BLOCK * i..source.len().min(BLOCK * (i + 1));
                known(range.clone()).unwrap_or_else(|| {
                    source.read(range, room);
                    Look::at(level, room)
                })
            })
            .collect();
        // Sums in a fixed order.
        let all = blocks.iter().fold(Look::EMPTY, |a, b| Look {
            bounds: a.bounds.union(&b.bounds),
            middles: a.middles.union(&b.middles),
            sizes: a.sizes + b.sizes,
            areas: a.areas + b.areas,
            largest: a.largest.max(b.largest),
        });
        Self { all, blocks }
    }

    /// The numbers of blocks that hold something of more than half an area.
    pub(super) fn larger_than(&self, area: f32) -> Vec<Range<usize>> {
        let blocks = self.blocks.iter().enumerate().filter(|(_, look)| look.largest > area);
        blocks.map(|(i, _)| BLOCK * i..BLOCK * (i + 1)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{build::Target, node::LeafPrimitive};
    use tenfold_math::{Bounds3, Vec3};
    use tenfold_testkit::Rng;

    struct Whole(Vec<Reference>);

    impl References for Whole {
        fn len(&self) -> usize {
            self.0.len()
        }
        fn read(&self, range: Range<usize>, room: &mut Vec<Reference>) {
            room.clear();
            room.extend_from_slice(&self.0[range]);
        }
        fn choose(&self, numbers: &[u32], room: &mut Vec<Reference>) {
            room.clear();
            room.extend(numbers.iter().map(|&number| self.0[number as usize]));
        }
    }

    #[test]
    fn what_is_known_of_blocks_that_are_cut_is_found_anew() {
        let mut rng = Rng::new(3);
        let mut reference = |i| {
            let p = rng.vec3();
            let bounds = Bounds3::around([p, p + 0.1 * rng.vec3()]);
            Reference::new(bounds, Target::Triangle(LeafPrimitive::new(0, i, false)))
        };
        let n = 5 * BLOCK as u32 / 2;
        let mut whole = Whole((0..n).map(&mut reference).collect());
        // Alone the largest, and at the corners of all, until it is cut.
        let middle = BLOCK + 7;
        let target = whole.0[middle].target();
        whole.0[middle] = Reference::new(Bounds3::around([Vec3::splat(-9.0), Vec3::splat(9.0)]), target);
        let known = Summary::of(&whole);
        assert!(matches!(&known.larger_than(1.0)[..], [one] if *one == (BLOCK..2 * BLOCK)));
        let parts = [(middle as u32, reference(n)), (middle as u32, reference(n)), (n - 1, reference(n))];
        let cut = Cut::new(&whole, parts.to_vec());
        let (found, want) = (cut.summary(&known), Summary::of(&cut));
        assert_eq!(format!("{found:?}"), format!("{want:?}"));
        assert!(found.larger_than(1.0).is_empty() && found.all.bounds.bounds().min.min_element() >= 0.0);
    }

    #[test]
    fn parts_take_the_places_of_what_is_cut() {
        let reference = |x: f32, i: u32| {
            let target = Target::Triangle(LeafPrimitive::new(0, i, false));
            Reference::new(Bounds3::around([Vec3::splat(x)]), target)
        };
        let whole = Whole((0..10).map(|i| reference(i as f32, i)).collect());
        let parts = [(2, 2.25), (2, 2.5), (2, 2.75), (3, 3.5), (9, 9.25), (9, 9.5)];
        let cut = Cut::new(&whole, parts.map(|(i, x)| (i, reference(x, i))).to_vec());
        let want = [0.0, 1.0, 2.25, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 9.25, 2.5, 2.75, 9.5];
        assert_eq!(cut.len(), want.len());
        let places = |references: &[Reference]| -> Vec<f32> {
            references.iter().map(|r| r.hull().bounds().min.x).collect()
        };
        let mut room = Vec::new();
        for start in 0..=want.len() {
            for end in start..=want.len() {
                cut.read(start..end, &mut room);
                assert_eq!(places(&room), want[start..end]);
            }
        }
        assert_eq!(places(&collect(&cut, 5)), want);
        let numbers = [12, 0, 2, 9, 4, 3, 10];
        let chosen = Chosen { all: &cut, numbers: &numbers };
        for (start, end) in [(0, 7), (1, 4), (3, 3)] {
            chosen.read(start..end, &mut room);
            let want: Vec<f32> = numbers[start..end].iter().map(|&number| want[number as usize]).collect();
            assert_eq!(places(&room), want);
        }
        chosen.choose(&[1, 0, 6], &mut room);
        assert_eq!(places(&room), [want[0], want[12], want[10]]);
    }
}
