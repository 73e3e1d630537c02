//! Traversal of large hierarchies by several rays at once, each on its way: all take one step, then all take the next.
//!
//! What the rays will look at is loaded for all together, and since no step waits for that of another ray, the processor has several at work.

use super::{
    Bvh, Level, Visitor,
    course::{Course, Prepared},
    node::Child,
    simd::{Portable, Simd},
    stack::Stack,
    traverse::Slabs,
    triangles::Shear,
};
use std::array::from_fn;
use tenfold_math::{Slots, WIDTH};

impl Bvh {
    /// [`Bvh::traverse`] for the rays in `slots`, each with its visitor.
    pub(crate) fn traverse_slots<W: Visitor>(
        &self,
        level: Level,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
    ) {
        match level {
            Level::Portable => self.interleave::<Portable, W>(slots, courses, visitors),
            // SAFETY: the token proves that the machine has AVX2.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => unsafe { self.interleave_avx2(slots, courses, visitors) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn interleave_avx2<W: Visitor>(
        &self,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
    ) {
        self.interleave::<super::simd::Avx2, W>(slots, courses, visitors);
    }

    #[inline(always)]
    fn interleave<S: Simd, W: Visitor>(
        &self,
        slots: Slots,
        courses: &[Prepared; WIDTH],
        visitors: &mut [W; WIDTH],
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let slabs: [Slabs; WIDTH] = from_fn(|slot| Slabs::new(&courses[slot]));
        let mut stacks: [Stack; WIDTH] = from_fn(|_| Stack::new());
        let mut next = [Child::ROOT; WIDTH];
        let (mut at_nodes, mut at_leaves) = (slots, Slots::NONE);
        while !at_nodes.or(at_leaves).is_empty() {
            // Leaves by themselves: which of both comes next cannot be foretold, and would be guessed wrong as often as not.
            at_leaves.for_each(|slot| self.prefetch(next[slot]));
            at_nodes.for_each(|slot| self.prefetch(next[slot]));
            let (mut nodes, mut leaves) = (Slots::NONE, Slots::NONE);
            let mut go_on = |next: &mut Child, slot: usize, child: Child| {
                *next = child;
                nodes.insert_if(slot, child.is_node());
                leaves.insert_if(slot, child.is_leaf());
            };
            for slot in at_nodes {
                let (stack, visitor) = (&mut stacks[slot], &visitors[slot]);
                let node = &self.nodes[next[slot].index()];
                let (mask, near) = slabs[slot].intersect(node, visitor.t_max());
                // No branches on how many children are met.
                if W::ANY {
                    S::push(stack, mask, node.children());
                } else {
                    S::push_all_sorted(stack, mask, near, node.children());
                }
                go_on(&mut next[slot], slot, Self::pop(stack, visitor));
            }
            for slot in at_leaves {
                let (stack, visitor) = (&mut stacks[slot], &mut visitors[slot]);
                let shear = Shear::<S::F8>::new(courses[slot].shear());
                if !self.visit(next[slot], &shear, visitor) {
                    go_on(&mut next[slot], slot, Self::pop(stack, visitor));
                }
            }
            (at_nodes, at_leaves) = (nodes, leaves);
        }
    }
}
