//! Room for sorting.

use super::{pair::Pair, reference::Reference, source::References};
use crate::bvh::with_capacity;
use std::{
    mem::MaybeUninit,
    sync::{Mutex, PoisonError},
};

/// Buffers that are not in use: as many as were at once, which are a few for every thread.
#[derive(Default)]
pub(super) struct Pool(Mutex<Vec<Vec<Reference>>>);

/// Two buffers that are taken when they are needed, and go back to the pool.
pub(super) struct Room<'a> {
    pool: &'a Pool,
    buffers: [Vec<Reference>; 2],
}

impl Pool {
    pub(super) fn room(&self) -> Room<'_> {
        Room { pool: self, buffers: [const { Vec::new() }; 2] }
    }

    fn buffers(&self) -> std::sync::MutexGuard<'_, Vec<Vec<Reference>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Room<'_> {
    /// Room for `n` references.
    pub(super) fn take(&mut self, n: usize) -> &mut [MaybeUninit<Reference>] {
        let [buffer, _] = &mut self.buffers;
        take(self.pool, buffer, n);
        &mut buffer.spare_capacity_mut()[..n]
    }

    /// The references of some numbers, with these, and room for as many.
    pub(super) fn make(&mut self, source: &dyn References, numbers: &[u32]) -> Pair<'_, Reference> {
        let n = numbers.len();
        let [room, made] = &mut self.buffers;
        take(self.pool, room, n);
        take(self.pool, made, n);
        source.choose(numbers, made);
        assert_eq!(made.len(), n);
        made.iter_mut().zip(numbers).for_each(|(made, &number)| *made = made.with_number(number));
        made.clear();
        // SAFETY: they were made.
        let mut pair = unsafe { Pair::new(&mut made.spare_capacity_mut()[..n], n) };
        pair.furnish(|_| &mut room.spare_capacity_mut()[..n]);
        pair
    }
}

fn take(pool: &Pool, buffer: &mut Vec<Reference>, n: usize) {
    *buffer = pool.buffers().pop().unwrap_or_default();
    if buffer.capacity() < n {
        *buffer = with_capacity(n);
    }
}

impl Drop for Room<'_> {
    fn drop(&mut self) {
        let taken = self.buffers.iter_mut().filter(|buffer| buffer.capacity() > 0);
        taken.for_each(|buffer| self.pool.buffers().push(std::mem::take(buffer)));
    }
}
