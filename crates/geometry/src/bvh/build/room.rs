//! Room for sorting.

use super::reference::Reference;
use crate::bvh::with_capacity;
use std::{
    mem::MaybeUninit,
    sync::{Mutex, PoisonError},
};

/// Buffers that are not in use: as many as were at once, which are a few for every thread.
#[derive(Default)]
pub(super) struct Pool(Mutex<Vec<Vec<Reference>>>);

/// A buffer that is taken when it is needed, and goes back to the pool.
pub(super) struct Room<'a> {
    pool: &'a Pool,
    buffer: Vec<Reference>,
}

impl Pool {
    pub(super) fn room(&self) -> Room<'_> {
        Room { pool: self, buffer: Vec::new() }
    }

    fn buffers(&self) -> std::sync::MutexGuard<'_, Vec<Vec<Reference>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Room<'_> {
    /// Room for `n` references.
    pub(super) fn take(&mut self, n: usize) -> &mut [MaybeUninit<Reference>] {
        self.buffer = self.pool.buffers().pop().unwrap_or_default();
        if self.buffer.capacity() < n {
            self.buffer = with_capacity(n);
        }
        &mut self.buffer.spare_capacity_mut()[..n]
    }
}

impl Drop for Room<'_> {
    fn drop(&mut self) {
        if self.buffer.capacity() > 0 {
            self.pool.buffers().push(std::mem::take(&mut self.buffer));
        }
    }
}
