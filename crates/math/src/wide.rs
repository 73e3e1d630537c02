//! Many vectors side by side, for loops that the compiler turns into vector instructions.

use crate::{Ray, Vec2, Vec3};

/// How many paths are traced side by side: the floats of the widest vector registers.
pub const WIDTH: usize = 16;

/// One number in each slot.
pub type Floats = [f32; WIDTH];

/// Some of the [`WIDTH`] slots.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Slots(u16);

impl Slots {
    /// No slot.
    pub const NONE: Self = Self(0);

    /// The first `count` slots, of which there are at most [`WIDTH`].
    #[inline]
    pub fn first(count: usize) -> Self {
        debug_assert!(count <= WIDTH);
        Self(((1u32 << count) - 1) as u16)
    }

    /// Adds a slot.
    #[inline]
    pub fn insert(&mut self, slot: usize) {
        self.0 |= 1 << slot;
    }

    /// Adds a slot where a condition holds, without a branch.
    #[inline]
    pub fn insert_if(&mut self, slot: usize, condition: bool) {
        self.0 |= u16::from(condition) << slot;
    }

    /// Whether a slot is among them.
    #[inline]
    pub fn contains(self, slot: usize) -> bool {
        self.0 >> slot & 1 == 1
    }

    /// Whether there is none.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many there are.
    #[inline]
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Of each slot, whether it is among them.
    #[inline]
    pub fn flags(self) -> [bool; WIDTH] {
        std::array::from_fn(|slot| self.contains(slot))
    }

    /// Those for which `is_kept` holds.
    #[inline]
    #[must_use]
    pub fn keep(self, mut is_kept: impl FnMut(usize) -> bool) -> Self {
        let mut kept = Self::NONE;
        self.filter(|&slot| is_kept(slot)).for_each(|slot| kept.insert(slot));
        kept
    }

    /// All bits in these slots, none in others: for [`select`].
    #[inline]
    pub fn masks(self) -> [u32; WIDTH] {
        std::array::from_fn(|slot| u32::from(self.contains(slot)).wrapping_neg())
    }

    /// Those of both.
    #[inline]
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Those that are not in `other`.
    #[inline]
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl Iterator for Slots {
    type Item = usize;

    /// Takes the first slot out.
    #[inline]
    fn next(&mut self) -> Option<usize> {
        let slot = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (slot < WIDTH).then_some(slot)
    }
}

/// `new` where `mask` has all bits, `old` where it has none. Of a condition that chooses between two numbers in memory, the compiler makes one that
/// chooses between their places, which vectors have not.
#[inline(always)]
pub fn select(mask: u32, new: f32, old: f32) -> f32 {
    f32::from_bits(new.to_bits() & mask | old.to_bits() & !mask)
}

/// A vector in each slot, coordinate by coordinate.
#[derive(Copy, Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Vec3s {
    /// First coordinates.
    pub x: Floats,
    /// Second coordinates.
    pub y: Floats,
    /// Third coordinates.
    pub z: Floats,
}

impl Vec3s {
    /// Zero everywhere.
    pub const ZERO: Self = Self { x: [0.0; WIDTH], y: [0.0; WIDTH], z: [0.0; WIDTH] };

    /// The vector in a slot.
    #[inline(always)]
    pub fn get(&self, slot: usize) -> Vec3 {
        Vec3::new(self.x[slot], self.y[slot], self.z[slot])
    }

    /// Sets the vector in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, v: Vec3) {
        (self.x[slot], self.y[slot], self.z[slot]) = (v.x, v.y, v.z);
    }

    /// Sets the vector in a slot where `mask` has all bits, as [`select`].
    #[inline(always)]
    pub fn set_where(&mut self, mask: u32, slot: usize, v: Vec3) {
        let Vec3 { x, y, z } = self.get(slot);
        self.set(slot, Vec3::new(select(mask, v.x, x), select(mask, v.y, y), select(mask, v.z, z)));
    }
}

impl Default for Vec3s {
    fn default() -> Self {
        Self::ZERO
    }
}

/// A vector in each slot, coordinate by coordinate.
#[derive(Copy, Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Vec2s {
    /// First coordinates.
    pub x: Floats,
    /// Second coordinates.
    pub y: Floats,
}

impl Vec2s {
    /// Zero everywhere.
    pub const ZERO: Self = Self { x: [0.0; WIDTH], y: [0.0; WIDTH] };

    /// The vector in a slot.
    #[inline(always)]
    pub fn get(&self, slot: usize) -> Vec2 {
        Vec2::new(self.x[slot], self.y[slot])
    }

    /// Sets the vector in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, v: Vec2) {
        (self.x[slot], self.y[slot]) = (v.x, v.y);
    }
}

impl Default for Vec2s {
    fn default() -> Self {
        Self::ZERO
    }
}

/// A ray in each slot.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Rays {
    /// Where they start.
    pub origin: Vec3s,
    /// Where they go.
    pub direction: Vec3s,
    /// Their instants.
    pub time: Floats,
}

impl Rays {
    /// The ray in a slot.
    #[inline(always)]
    pub fn get(&self, slot: usize) -> Ray {
        Ray::new(self.origin.get(slot), self.direction.get(slot), self.time[slot])
    }

    /// Sets the ray in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, ray: Ray) {
        self.origin.set(slot, ray.origin);
        self.direction.set(slot, ray.direction);
        self.time[slot] = ray.time;
    }
}

/// `v.normalize()`, to the bit, for loops over slots: of glam's square root the compiler does not know that vectors have it too.
#[inline(always)]
pub fn normalize(v: Vec3) -> Vec3 {
    v * (1.0 / v.length_squared().sqrt())
}

/// Defines a function that is compiled several times, for the vector instructions that processors may have, and calls what is for this one.
///
/// Its loops over slots become vector instructions where they have no branches and where what they call is inlined. The results are
/// the same bits: the compiler neither reorders nor fuses operations on floats.
#[macro_export]
macro_rules! vectorized {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) $(-> $out:ty)? $body:block) => {
        $(#[$meta])*
        $vis fn $name($($arg: $type),*) $(-> $out)? {
            #[inline(always)]
            fn portable($($arg: $type),*) $(-> $out)? $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
                fn avx512($($arg: $type),*) $(-> $out)? {
                    portable($($arg),*)
                }
                #[target_feature(enable = "avx2")]
                fn avx2($($arg: $type),*) $(-> $out)? {
                    portable($($arg),*)
                }
                if is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                {
                    // SAFETY: the processor has the instructions.
                    return unsafe { avx512($($arg),*) };
                }
                if is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has the instructions.
                    return unsafe { avx2($($arg),*) };
                }
            }
            portable($($arg),*)
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_are_a_set_in_order() {
        let mut slots = Slots::first(3);
        slots.insert(15);
        assert_eq!(slots.collect::<Vec<_>>(), [0, 1, 2, 15]);
        assert_eq!(slots.len(), 4);
        assert_eq!(slots.without(Slots::first(2)).collect::<Vec<_>>(), [2, 15]);
        assert_eq!(slots.keep(|slot| slot % 2 == 1).collect::<Vec<_>>(), [1, 15]);
        assert_eq!(Slots::first(2).or(slots), slots);
        assert!(slots.contains(15) && !slots.contains(3) && !slots.is_empty() && Slots::NONE.is_empty());
        assert_eq!(Slots::first(WIDTH).len(), WIDTH);
        let mut chosen = Vec3s::ZERO;
        let masks = slots.masks();
        (0..WIDTH).for_each(|slot| chosen.set_where(masks[slot], slot, Vec3::X));
        (0..WIDTH).for_each(|slot| assert_eq!(chosen.get(slot) == Vec3::X, slots.contains(slot)));
    }

    #[test]
    fn what_is_set_is_there_again() {
        let mut rays = Rays::default();
        let ray = Ray::new(Vec3::X, Vec3::Y, 0.5);
        rays.set(7, ray);
        assert_eq!((rays.get(7), rays.get(8).direction), (ray, Vec3::ZERO));
        let mut points = Vec2s::ZERO;
        points.set(15, Vec2::ONE);
        assert_eq!((points.get(15), points.get(14)), (Vec2::ONE, Vec2::ZERO));
    }

    #[test]
    fn unit_vectors_are_glams() {
        for i in 1..1000 {
            let v = Vec3::new(i as f32 * 0.37, -1.0 / i as f32, (i % 7) as f32);
            assert_eq!(normalize(v), v.normalize());
        }
    }

    vectorized! {
        /// Roots of sums.
        fn roots(x: &Floats, y: &Floats, out: &mut Floats) {
            for i in 0..WIDTH {
                out[i] = (x[i] + y[i]).sqrt();
            }
        }
    }

    #[test]
    fn vectorized_functions_compute_what_they_say() {
        let x: Floats = std::array::from_fn(|i| i as f32);
        let mut out = [0.0; WIDTH];
        roots(&x, &[0.5; WIDTH], &mut out);
        (0..WIDTH).for_each(|i| assert_eq!(out[i], (x[i] + 0.5).sqrt()));
    }
}
