//! What waits while a ray follows the nearest child.

use super::{
    build::MAX_DEPTH,
    node::{Child, WIDTH},
};
use std::mem::MaybeUninit;

/// Every node on a path leaves at most seven siblings behind; the last may write a whole row; the bottom is marked.
const ENTRIES: usize = (WIDTH - 1) * MAX_DEPTH + WIDTH + 1;

/// Children that wait, the next on top.
///
/// Keys are the bits of the distance to a child's box, the lowest three replaced by its slot in the node, the sign bit set. Distances are not
/// negative, so keys sort as distances do, ties are decided by the slot, and every key is above 0.
pub(super) struct Stack {
    keys: [MaybeUninit<u32>; ENTRIES],
    children: [MaybeUninit<u32>; ENTRIES],
    /// Entries below are initialised; at least one.
    height: usize,
}

impl Stack {
    /// A stack of nothing but its bottom: [`Child::EMPTY`], at no distance.
    #[inline(always)]
    pub(super) fn new() -> Self {
        let mut stack = Self {
            // Not set to zero: a ray that visits few nodes would pay more for that than for its way.
            keys: [MaybeUninit::uninit(); ENTRIES],
            children: [MaybeUninit::uninit(); ENTRIES],
            height: 0,
        };
        stack.push(0, Child::EMPTY.0);
        stack
    }

    /// The key of a child in `slot` whose box is entered at `distance`.
    #[inline(always)]
    pub(super) fn key(distance: f32, slot: u32) -> u32 {
        distance.to_bits() & !7 | slot | 1 << 31
    }

    /// The largest key of a child not farther than `t_max`.
    #[inline(always)]
    fn limit(t_max: f32) -> u32 {
        t_max.to_bits() | 7 | 1 << 31
    }

    #[inline(always)]
    pub(super) fn push(&mut self, key: u32, child: u32) {
        self.keys[self.height].write(key);
        self.children[self.height].write(child);
        self.height += 1;
    }

    /// Pushes the farther of the two children whose bits are set in `mask`, and returns the other.
    #[inline(always)]
    pub(super) fn push_farther(&mut self, mask: u32, near: &[f32; WIDTH], children: &[u32; WIDTH]) -> u32 {
        let slots = [mask.trailing_zeros(), u32::BITS - 1 - mask.leading_zeros()];
        let key = |slot: u32| Self::key(near[slot as usize % WIDTH], slot);
        let child = |slot: u32| children[slot as usize % WIDTH];
        let (a, b) = (key(slots[0]), key(slots[1]));
        let (c, d) = (child(slots[0]), child(slots[1]));
        let swap = b < a;
        self.push(if swap { a } else { b }, if swap { c } else { d });
        if swap { d } else { c }
    }

    /// Where the next entries go: to be written, all of them, before [`Stack::grow`].
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(super) fn room(&mut self) -> [&mut [MaybeUninit<u32>; WIDTH]; 2] {
        let at = self.height;
        let row = |entries: &'_ mut [MaybeUninit<u32>; ENTRIES]| {
            let row = &mut entries[at..at + WIDTH];
            // SAFETY: the slice was checked and has that length.
            unsafe { &mut *row.as_mut_ptr().cast::<[MaybeUninit<u32>; WIDTH]>() }
        };
        [row(&mut self.keys), row(&mut self.children)]
    }

    /// Takes the first `n` entries of [`Stack::room`] in.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(super) fn grow(&mut self, n: usize) {
        self.height += n;
    }

    /// The child that comes next.
    #[inline(always)]
    pub(super) fn top(&self) -> Child {
        // SAFETY: entries below the height, which is not 0, were written.
        Child(unsafe { self.children[self.height - 1].assume_init() })
    }

    /// The next child that is not farther than `t_max`; [`Child::EMPTY`] at the bottom, and only once.
    #[inline(always)]
    pub(super) fn pop(&mut self, t_max: f32) -> Child {
        let limit = Self::limit(t_max);
        loop {
            // It stops at the bottom, whose key is 0.
            self.height -= 1;
            // SAFETY: entries below the height were written.
            let (key, child) =
                unsafe { (self.keys[self.height].assume_init(), self.children[self.height].assume_init()) };
            if key <= limit {
                return Child(child);
            }
        }
    }

    /// The next child at any distance; [`Child::EMPTY`] at the bottom, and only once.
    #[inline(always)]
    pub(super) fn pop_any(&mut self) -> Child {
        self.height -= 1;
        // SAFETY: entries below the height were written.
        Child(unsafe { self.children[self.height].assume_init() })
    }
}
