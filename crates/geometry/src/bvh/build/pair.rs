//! Sorting out of place, to and fro between two buffers.

use std::mem::MaybeUninit;

/// Items in a buffer that may be larger, and another of the same size: splitting them moves them there. It may be missing as long as nothing is split.
pub(super) struct Pair<'a, T> {
    /// Where the items are, and the other: empty where it is missing.
    sides: [&'a mut [MaybeUninit<T>]; 2],
    /// Which part of the first holds items: initialised, always.
    start: usize,
    len: usize,
    /// Whether the items are in the buffer where they belong in the end.
    is_home: bool,
}

impl<'a, T: Copy> Pair<'a, T> {
    /// The first `len` items of `home`, without another buffer.
    ///
    /// # Safety
    /// They must be initialised.
    pub(super) unsafe fn new(home: &'a mut [MaybeUninit<T>], len: usize) -> Self {
        assert!(len <= home.len());
        Self { sides: [home, &mut []], start: 0, len, is_home: true }
    }

    /// Takes the other buffer where it is missing: as much room as is said.
    pub(super) fn furnish(&mut self, room: impl FnOnce(usize) -> &'a mut [MaybeUninit<T>]) {
        let n = self.capacity();
        if self.sides[1].len() < n {
            self.sides[1] = &mut room(n)[..n];
        }
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// How many more items there is room for.
    pub(super) fn slack(&self) -> usize {
        self.sides[0].len() - self.len
    }

    pub(super) fn items(&self) -> &[T] {
        // SAFETY: they are initialised.
        unsafe { initialised(&self.sides[0][self.start..self.start + self.len]) }
    }

    pub(super) fn items_mut(&mut self) -> &mut [T] {
        let items = &mut self.sides[0][self.start..self.start + self.len];
        // SAFETY: they are initialised, and nothing but items can be written to them.
        unsafe { std::slice::from_raw_parts_mut(items.as_mut_ptr().cast(), items.len()) }
    }

    /// The items, and the other side.
    pub(super) fn sides(&mut self) -> (&[T], &mut [MaybeUninit<T>]) {
        let [items, room] = &mut self.sides;
        // SAFETY: they are initialised.
        (unsafe { initialised(&items[self.start..self.start + self.len]) }, room)
    }

    /// The other side, after items were written to it: `low` at its front and `high` at its back. `need` tells how much of the slack halves want.
    ///
    /// # Safety
    /// They must be initialised.
    pub(super) unsafe fn swapped(self, low: usize, high: usize, need: impl Fn(&[T]) -> f32) -> [Self; 2] {
        let Self { sides: [room, items], is_home, .. } = self;
        let slack = items.len().checked_sub(low + high).expect("as much room as was written");
        let half =
            |len, sides: [&'a mut [MaybeUninit<T>]; 2], start| Self { sides, start, len, is_home: !is_home };
        let mut cut = low;
        if slack > 0 {
            // They overlap in nothing but slack.
            let needs = [(0, low), (items.len() - high, high)].map(|(start, len)| {
                // SAFETY: by the caller's promise.
                need(unsafe { initialised(&items[start..start + len]) })
            });
            // The cast makes 0 of what is not a number.
            cut += ((slack as f32 * (needs[0] / (needs[0] + needs[1]))) as usize).min(slack);
        }
        let (low_items, high_items) = items.split_at_mut(cut);
        let (low_room, high_room) = room.split_at_mut(cut);
        let start = high_items.len() - high;
        [half(low, [low_items, low_room], 0), half(high, [high_items, high_room], start)]
    }

    /// The first `k` and the others, where they are.
    pub(super) fn split_at(self, k: usize) -> [Self; 2] {
        let Self { sides: [items, room], start, len, is_home } = self;
        assert!(k <= len);
        let (low, high) = items.split_at_mut(start + k);
        let (low_room, high_room) = room.split_at_mut(room.len().min(start + k));
        [
            Self { sides: [low, low_room], start, len: k, is_home },
            Self { sides: [high, high_room], start: 0, len: len - k, is_home },
        ]
    }

    /// How many items the buffers can hold.
    pub(super) fn capacity(&self) -> usize {
        self.sides[0].len()
    }

    /// Brings the items home; returns how many places lie before them.
    pub(super) fn finish(&mut self) -> usize {
        if !self.is_home {
            let part = self.start..self.start + self.len;
            let [items, home] = &mut self.sides;
            home[part.clone()].copy_from_slice(&items[part]);
        }
        self.start
    }
}

/// Items that are all there.
///
/// # Safety
/// They must be initialised.
// `<[MaybeUninit<T>]>::assume_init_ref`, which is newer than the oldest compiler that builds this.
pub(in crate::bvh) unsafe fn initialised<T>(items: &[MaybeUninit<T>]) -> &[T] {
    // SAFETY: by the caller's promise; both have one layout.
    unsafe { std::slice::from_raw_parts(items.as_ptr().cast(), items.len()) }
}
