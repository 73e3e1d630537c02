use std::{fmt, hash, marker::PhantomData};

/// A typed 32-bit index into an arena of `T`s.
///
/// ```
/// use tenfold_math::Id;
/// struct Shape;
/// let id: Id<Shape> = Id::new(3);
/// assert_eq!(id.index(), 3);
/// ```
pub struct Id<T> {
    index: u32,
    of: PhantomData<fn() -> T>,
}

impl<T> Id<T> {
    /// The id of the element at `index`; indices are below 2³² − 1.
    #[inline]
    pub const fn new(index: usize) -> Self {
        debug_assert!(index < u32::MAX as usize);
        Self { index: index as u32, of: PhantomData }
    }

    /// The index in the arena.
    #[inline]
    pub const fn index(self) -> usize {
        self.index as usize
    }
}

// Derives would ask the same of `T`, which is only a label.
impl<T> Clone for Id<T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Id<T> {}
impl<T> PartialEq for Id<T> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index
    }
}
impl<T> Eq for Id<T> {}
impl<T> PartialOrd for Id<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl<T> Ord for Id<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.index.cmp(&other.index)
    }
}
impl<T> hash::Hash for Id<T> {
    fn hash<H: hash::Hasher>(&self, state: &mut H) {
        self.index.hash(state);
    }
}
impl<T> fmt::Debug for Id<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.index)
    }
}
