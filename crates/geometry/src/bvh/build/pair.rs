//! Sorting out of place, to and fro between two buffers.

use std::mem::MaybeUninit;

/// Items, and room for as many: splitting them moves them there.
pub(super) struct Pair<'a, T> {
    items: &'a mut [T],
    room: &'a mut [MaybeUninit<T>],
    /// Whether the items are in the buffer where they belong in the end.
    is_home: bool,
}

impl<'a, T: Copy> Pair<'a, T> {
    /// `items` are where they belong.
    pub(super) fn new(items: &'a mut [T], room: &'a mut [MaybeUninit<T>]) -> Self {
        let room = &mut room[..items.len()];
        Self { items, room, is_home: true }
    }

    pub(super) fn items(&self) -> &[T] {
        self.items
    }

    pub(super) fn items_mut(&mut self) -> &mut [T] {
        self.items
    }

    /// The items, and the room, of the same size.
    pub(super) fn sides(&mut self) -> (&[T], &mut [MaybeUninit<T>]) {
        (self.items, self.room)
    }

    /// The other side, after all of the room was written.
    ///
    /// # Safety
    /// All of the room must be initialised.
    pub(super) unsafe fn swapped(self) -> Self {
        let Self { items, room, is_home } = self;
        // SAFETY: initialised items may be seen as ones that may not be: nothing but items is written to them.
        let other = unsafe {
            std::slice::from_raw_parts_mut(items.as_mut_ptr().cast::<MaybeUninit<T>>(), items.len())
        };
        // SAFETY: by the caller's promise all of them are initialised.
        let items = unsafe { std::slice::from_raw_parts_mut(room.as_mut_ptr().cast::<T>(), room.len()) };
        Self { items, room: other, is_home: !is_home }
    }

    /// The first `k` and the others.
    pub(super) fn split_at(self, k: usize) -> [Self; 2] {
        let Self { items, room, is_home } = self;
        let (low, high) = items.split_at_mut(k);
        let (low_room, high_room) = room.split_at_mut(k);
        [Self { items: low, room: low_room, is_home }, Self { items: high, room: high_room, is_home }]
    }

    /// Brings the items home.
    pub(super) fn finish(&mut self) {
        if !self.is_home {
            for (room, item) in self.room.iter_mut().zip(&*self.items) {
                room.write(*item);
            }
        }
    }
}
