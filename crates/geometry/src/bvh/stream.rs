//! Traversal of sparse hierarchies by several rays at once, in no order: all boxes that the rays meet, and then what is in these (after Wald, Gribble,
//! Boulos and Kensler 2007, and Tsakok 2009).
//!
//! Where most rays pass most leaves, what is nearest needs not be looked at first, and what comes next needs not be known to go on: what rays have come to
//! waits in a list, and the processor has several entries of it at work.

use super::{
    Bvh, Level, Visitor,
    course::{Course, Prepared},
    node::{Child, WIDTH as CHILDREN},
    simd::{Portable, Simd},
    traverse::Slabs,
    triangles::Shear,
};
use std::array::from_fn;
use tenfold_math::{Slots, WIDTH};

/// Entries of a list, of which each node may add as many as it has children.
const ROOM: usize = 1024;
/// So far ahead is loaded what entries refer to.
const AHEAD: usize = 8;

/// What rays have come to.
#[derive(Copy, Clone, Debug)]
pub(super) struct Stream {
    children: [u32; ROOM],
    /// The slot of the ray.
    slots: [u8; ROOM],
    len: usize,
}

impl Stream {
    pub(super) const EMPTY: Self = Self { children: [0; ROOM], slots: [0; ROOM], len: 0 };

    #[inline(always)]
    fn get(&self, at: usize) -> (usize, Child) {
        (usize::from(self.slots[at % ROOM]) % WIDTH, Child(self.children[at % ROOM]))
    }

    #[inline(always)]
    fn has_room(&self) -> bool {
        self.len <= ROOM - CHILDREN
    }

    /// Adds the children whose bits are set in `mask`, for the ray in `slot`. There must be room.
    #[inline(always)]
    fn extend<S: Simd>(&mut self, slot: usize, mask: u32, children: &[u32; CHILDREN]) {
        let room = self.len..self.len + CHILDREN;
        // Whole rows: what is behind the end means nothing.
        self.children[room.clone()].copy_from_slice(&S::compact(mask, children));
        self.slots[room].fill(slot as u8);
        self.len += mask.count_ones() as usize;
    }

    /// Begins to load what an entry refers to that will soon be looked at.
    #[inline(always)]
    fn prefetch(&self, at: usize, bvh: &Bvh) {
        if at + AHEAD < self.len {
            bvh.prefetch(self.get(at + AHEAD).1);
        }
    }
}

impl Bvh {
    /// [`Bvh::traverse`] for the rays in `slots`, each with its visitor. The lists hold anything before and after.
    pub(crate) fn traverse_stream<W: Visitor>(
        &self,
        level: Level,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
        lists: &mut Streams,
    ) {
        match level {
            Level::Portable => self.stream::<Portable, W>(slots, courses, visitors, lists),
            // SAFETY: the token proves that the machine has AVX2.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => unsafe { self.stream_avx2(slots, courses, visitors, lists) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn stream_avx2<W: Visitor>(
        &self,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
        lists: &mut Streams,
    ) {
        self.stream::<super::simd::Avx2, W>(slots, courses, visitors, lists);
    }

    #[inline(always)]
    fn stream<S: Simd, W: Visitor>(
        &self,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
        Streams { nodes, leaves }: &mut Streams,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let slabs: [Slabs; WIDTH] = from_fn(|slot| Slabs::new(&courses[slot]));
        let mut rays = Rays { courses, visitors, t_max: [OVER; WIDTH] };
        (nodes.len, leaves.len) = (0, 0);
        for slot in slots {
            rays.t_max[slot] = rays.visitors[slot].t_max();
            nodes.extend::<S>(slot, 1, &[Child::ROOT.0; CHILDREN]);
        }
        let mut at = 0;
        while at < nodes.len {
            nodes.prefetch(at, self);
            let (slot, child) = nodes.get(at);
            at += 1;
            if !nodes.has_room() {
                rays.follow::<S>(self, slot, child);
                continue;
            }
            let node = &self.nodes[child.index()];
            let (mask, _) = slabs[slot].intersect::<S::F8>(node, rays.t_max[slot]);
            nodes.extend::<S>(slot, mask & !node.leaves(), node.children());
            leaves.extend::<S>(slot, mask & node.leaves(), node.children());
            if !leaves.has_room() {
                rays.visit::<S>(self, leaves);
            }
        }
        rays.visit::<S>(self, leaves);
    }
}

/// Both lists.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Streams {
    nodes: Stream,
    leaves: Stream,
}

impl Streams {
    pub(crate) const EMPTY: Self = Self { nodes: Stream::EMPTY, leaves: Stream::EMPTY };
}

/// The rays on their way.
struct Rays<'a, W> {
    courses: &'a [Prepared; WIDTH],
    visitors: &'a mut [W; WIDTH],
    /// How far they still go.
    t_max: [f32; WIDTH],
}

/// Instead of how far a ray still goes: it meets no box.
const OVER: f32 = -1.0;

impl<W: Visitor> Rays<'_, W> {
    /// Shows visitors the leaves of a list, which is empty then.
    #[inline(always)]
    fn visit<S: Simd>(&mut self, bvh: &Bvh, leaves: &mut Stream) {
        for at in 0..leaves.len {
            leaves.prefetch(at, bvh);
            let (slot, leaf) = leaves.get(at);
            if self.t_max[slot] != OVER {
                let shear = Shear::<S::F8>::new(self.courses[slot].shear());
                let over = bvh.visit(leaf, &shear, &mut self.visitors[slot]);
                self.t_max[slot] = if over { OVER } else { self.visitors[slot].t_max() };
            }
        }
        leaves.len = 0;
    }

    /// Follows a ray by itself, through all below a node.
    #[cold]
    fn follow<S: Simd>(&mut self, bvh: &Bvh, slot: usize, root: Child) {
        if self.t_max[slot] != OVER {
            let over = bvh.follow::<S, W>(root, &self.courses[slot], &mut self.visitors[slot]);
            self.t_max[slot] = if over { OVER } else { self.visitors[slot].t_max() };
        }
    }
}
