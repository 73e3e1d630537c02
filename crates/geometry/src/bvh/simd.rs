//! Vectors of floats, portable and by AVX2. Both round alike (no fused multiply-add), so results are the same bits.

use super::{node::WIDTH, stack::Stack};

/// A vector of eight floats.
///
/// `min` and `max` return the second argument where either is NaN, as the instructions of x86 do.
pub(super) trait Vector: Copy {
    fn load(a: &[f32; WIDTH]) -> Self;
    fn splat(x: f32) -> Self;
    fn to_array(self) -> [f32; WIDTH];
    fn add(self, b: Self) -> Self;
    fn sub(self, b: Self) -> Self;
    fn mul(self, b: Self) -> Self;
    fn div(self, b: Self) -> Self;
    fn min(self, b: Self) -> Self;
    fn max(self, b: Self) -> Self;
    fn abs(self) -> Self;
    /// With 0 in the fourth and the last lane.
    fn corners(self) -> Self;
    /// The last four before the first four.
    fn swap_halves(self) -> Self;
    /// Rounded towards zero; for numbers that an `i32` can hold.
    fn truncate(self) -> [i32; WIDTH];
    /// Bit `i` tells whether `self[i] <= b[i]`; false for NaN.
    fn le(self, b: Self) -> u32;
    /// Bit `i` tells whether `self[i] < b[i]`; false for NaN.
    fn lt(self, b: Self) -> u32;
    /// Bit `i` tells whether `self[i] == b[i]`; false for NaN.
    fn eq(self, b: Self) -> u32;
}

/// Which implementation of [`Vector`] to use.
pub(super) trait Simd {
    /// For the boxes of a node and the triangles of a block.
    type F8: Vector;

    /// Takes the children whose bits are set in `mask`, of which there must be two or more: returns the one nearest by `near` and puts the
    /// others on the stack, the farthest first. `near` is nowhere negative.
    fn push_sorted(stack: &mut Stack, mask: u32, near: Self::F8, children: &[u32; WIDTH]) -> u32;

    /// Puts the children whose bits are set in `mask` on the stack, the farthest first, without branches.
    fn push_all_sorted(stack: &mut Stack, mask: u32, near: Self::F8, children: &[u32; WIDTH]);

    /// The children whose bits are set in `mask`, those of later slots first, and behind them anything.
    fn compact(mask: u32, children: &[u32; WIDTH]) -> [u32; WIDTH];

    /// Puts the children whose bits are set in `mask` on the stack, those of later slots first, at no distance.
    fn push(stack: &mut Stack, mask: u32, children: &[u32; WIDTH]);
}

/// The bits that are set in an index, the highest first: for [`Simd::push`].
static SLOTS: [[u8; WIDTH]; 1 << WIDTH] = {
    let mut table = [[0; WIDTH]; 1 << WIDTH];
    let mut mask = 0;
    while mask < 1 << WIDTH {
        let (mut n, mut slot) = (0, WIDTH);
        while slot > 0 {
            slot -= 1;
            if mask >> slot & 1 != 0 {
                table[mask][n] = slot as u8;
                n += 1;
            }
        }
        mask += 1;
    }
    table
};

/// Plain arrays, for every machine.
pub(super) struct Portable;

impl Simd for Portable {
    type F8 = Array;

    fn push_sorted(stack: &mut Stack, mask: u32, near: Array, children: &[u32; WIDTH]) -> u32 {
        Self::push_all_sorted(stack, mask, near, children);
        stack.pop_any().0
    }

    fn push_all_sorted(stack: &mut Stack, mut mask: u32, near: Array, children: &[u32; WIDTH]) {
        let mut keys = [0; WIDTH];
        let mut n = 0;
        while mask != 0 {
            let slot = mask.trailing_zeros();
            mask &= mask - 1;
            let key = Stack::key(near.0[slot as usize], slot);
            let mut at = n;
            while at > 0 && keys[at - 1] < key {
                keys[at] = keys[at - 1];
                at -= 1;
            }
            keys[at] = key;
            n += 1;
        }
        let child = |key: u32| children[key as usize % WIDTH];
        keys[..n].iter().for_each(|&key| stack.push(key, child(key)));
    }

    fn compact(mask: u32, children: &[u32; WIDTH]) -> [u32; WIDTH] {
        SLOTS[mask as usize % SLOTS.len()].map(|slot| children[usize::from(slot) % WIDTH])
    }

    fn push(stack: &mut Stack, mask: u32, children: &[u32; WIDTH]) {
        let row = Self::compact(mask, children);
        row[..mask.count_ones() as usize].iter().for_each(|&child| stack.push(0, child));
    }
}

/// A vector as a plain array.
#[derive(Copy, Clone)]
pub(super) struct Array([f32; WIDTH]);

impl Array {
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], b.0[i])))
    }

    #[inline(always)]
    fn bits(self, b: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..WIDTH).fold(0, |bits, i| bits | u32::from(f(self.0[i], b.0[i])) << i)
    }
}

impl Vector for Array {
    #[inline(always)]
    fn load(a: &[f32; WIDTH]) -> Self {
        Self(*a)
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; WIDTH])
    }
    #[inline(always)]
    fn to_array(self) -> [f32; WIDTH] {
        self.0
    }
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self.zip(b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self.zip(b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        self.zip(b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        self.zip(b, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, b: Self) -> Self {
        self.zip(b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, b: Self) -> Self {
        self.zip(b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn corners(self) -> Self {
        Self(std::array::from_fn(|i| if i % 4 == 3 { 0.0 } else { self.0[i] }))
    }
    #[inline(always)]
    fn swap_halves(self) -> Self {
        Self(std::array::from_fn(|i| self.0[i ^ 4]))
    }
    #[inline(always)]
    fn truncate(self) -> [i32; WIDTH] {
        self.0.map(|x| x as i32)
    }
    #[inline(always)]
    fn le(self, b: Self) -> u32 {
        self.bits(b, |a, b| a <= b)
    }
    #[inline(always)]
    fn lt(self, b: Self) -> u32 {
        self.bits(b, |a, b| a < b)
    }
    #[inline(always)]
    fn eq(self, b: Self) -> u32 {
        self.bits(b, |a, b| a == b)
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{SLOTS, Simd, Stack, Vector, WIDTH};
    use std::arch::x86_64::*;

    /// AVX2. Its vectors are to be used only inside functions with that target feature.
    pub(in super::super) struct Avx2;

    impl Simd for Avx2 {
        type F8 = Vec8;

        #[inline(always)]
        fn push_sorted(stack: &mut Stack, mask: u32, near: Vec8, children: &[u32; WIDTH]) -> u32 {
            // SAFETY: the machine has AVX2, or this type is not used.
            unsafe { push_sorted(stack, mask, near.0, children) }
        }

        #[inline(always)]
        fn push_all_sorted(stack: &mut Stack, mask: u32, near: Vec8, children: &[u32; WIDTH]) {
            // SAFETY: the machine has AVX2, or this type is not used.
            unsafe { push_all_sorted(stack, mask, near.0, children) }
        }

        #[inline(always)]
        fn compact(mask: u32, children: &[u32; WIDTH]) -> [u32; WIDTH] {
            let mut row = [0; WIDTH];
            // SAFETY: the machine has AVX2, or this type is not used; the row has the length of a vector.
            unsafe { _mm256_storeu_si256(row.as_mut_ptr().cast(), compact(mask, children)) };
            row
        }

        #[inline(always)]
        fn push(stack: &mut Stack, mask: u32, children: &[u32; WIDTH]) {
            // SAFETY: the machine has AVX2, or this type is not used.
            unsafe { push(stack, mask, children) }
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn push(stack: &mut Stack, mask: u32, children: &[u32; WIDTH]) {
        let [_, room] = stack.room();
        // SAFETY: the room has the length of a vector.
        unsafe { _mm256_storeu_si256(room.as_mut_ptr().cast(), compact(mask, children)) };
        stack.grow(mask.count_ones() as usize);
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn compact(mask: u32, children: &[u32; WIDTH]) -> __m256i {
        let slots = &SLOTS[mask as usize % SLOTS.len()];
        // SAFETY: the arrays have the lengths of these vectors.
        let (slots, row) =
            unsafe { (_mm_loadl_epi64(slots.as_ptr().cast()), _mm256_loadu_si256(children.as_ptr().cast())) };
        _mm256_permutevar8x32_epi32(row, _mm256_cvtepu8_epi32(slots))
    }

    /// Sorts all lanes in descending order by a bitonic network (Batcher 1968), with 0 for those that are not in the mask. The nearest is
    /// found apart, in fewer steps: the next node waits for it alone.
    #[inline]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn push_sorted(stack: &mut Stack, mask: u32, near: __m256, children: &[u32; WIDTH]) -> u32 {
        let (keys, within) = (keys(near), lanes(mask));
        // Found by itself: that takes less time than to sort.
        let nearest = {
            let keys = _mm256_or_si256(keys, _mm256_xor_si256(within, _mm256_set1_epi32(-1)));
            let m = _mm_min_epu32(_mm256_castsi256_si128(keys), _mm256_extracti128_si256::<1>(keys));
            let m = _mm_min_epu32(m, _mm_shuffle_epi32::<0b01_00_11_10>(m));
            let m = _mm_min_epu32(m, _mm_shuffle_epi32::<0b10_11_00_01>(m));
            children[_mm_cvtsi128_si32(m) as usize % WIDTH]
        };
        write_sorted(stack, _mm256_and_si256(keys, within), children);
        stack.grow(mask.count_ones() as usize - 1);
        nearest
    }

    #[inline]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn push_all_sorted(stack: &mut Stack, mask: u32, near: __m256, children: &[u32; WIDTH]) {
        write_sorted(stack, _mm256_and_si256(keys(near), lanes(mask)), children);
        stack.grow(mask.count_ones() as usize);
    }

    /// The lanes whose bits are set.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn lanes(mask: u32) -> __m256i {
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits)
    }

    /// As `Stack::key`.
    #[inline]
    #[target_feature(enable = "avx2")]
    fn keys(near: __m256) -> __m256i {
        let slots = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let distance = _mm256_and_si256(_mm256_castps_si256(near), _mm256_set1_epi32(!7));
        _mm256_or_si256(distance, _mm256_or_si256(slots, _mm256_set1_epi32(i32::MIN)))
    }

    /// Writes keys and their children to the room on the stack, the largest key first.
    #[inline]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn write_sorted(stack: &mut Stack, mut v: __m256i, children: &[u32; WIDTH]) {
        macro_rules! stage {
            ($other:expr, $high:literal) => {
                let other = $other;
                v = _mm256_blend_epi32::<$high>(_mm256_max_epu32(v, other), _mm256_min_epu32(v, other));
            };
        }
        // Lanes in pairs, against each other in fours, in pairs; then the same in eights.
        stage!(_mm256_shuffle_epi32::<0b10_11_00_01>(v), 0b1010_1010);
        stage!(_mm256_shuffle_epi32::<0b00_01_10_11>(v), 0b1100_1100);
        stage!(_mm256_shuffle_epi32::<0b10_11_00_01>(v), 0b1010_1010);
        stage!(_mm256_permutevar8x32_epi32(v, _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0)), 0b1111_0000);
        stage!(_mm256_shuffle_epi32::<0b01_00_11_10>(v), 0b1100_1100);
        stage!(_mm256_shuffle_epi32::<0b10_11_00_01>(v), 0b1010_1010);
        // SAFETY: the array has the full length.
        let row = unsafe { _mm256_loadu_si256(children.as_ptr().cast()) };
        // Of each index the lowest three bits count: the slot.
        let sorted = _mm256_permutevar8x32_epi32(row, v);
        let [keys, children] = stack.room();
        // SAFETY: both have the length of a vector.
        unsafe {
            _mm256_storeu_si256(keys.as_mut_ptr().cast(), v);
            _mm256_storeu_si256(children.as_mut_ptr().cast(), sorted);
        }
    }

    #[derive(Copy, Clone)]
    pub(in super::super) struct Vec8(__m256);

    // SAFETY (of every block): the machine has AVX2, or this type is not used (see `Avx2`); the pointers come
    // from references to arrays of the full length.
    impl Vector for Vec8 {
        #[inline(always)]
        fn load(a: &[f32; WIDTH]) -> Self {
            Self(unsafe { _mm256_loadu_ps(a.as_ptr()) })
        }
        #[inline(always)]
        fn splat(x: f32) -> Self {
            Self(unsafe { _mm256_set1_ps(x) })
        }
        #[inline(always)]
        fn to_array(self) -> [f32; WIDTH] {
            let mut a = [0.0; WIDTH];
            unsafe { _mm256_storeu_ps(a.as_mut_ptr(), self.0) };
            a
        }
        #[inline(always)]
        fn add(self, b: Self) -> Self {
            Self(unsafe { _mm256_add_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn sub(self, b: Self) -> Self {
            Self(unsafe { _mm256_sub_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn mul(self, b: Self) -> Self {
            Self(unsafe { _mm256_mul_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn div(self, b: Self) -> Self {
            Self(unsafe { _mm256_div_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn min(self, b: Self) -> Self {
            Self(unsafe { _mm256_min_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn max(self, b: Self) -> Self {
            Self(unsafe { _mm256_max_ps(self.0, b.0) })
        }
        #[inline(always)]
        fn abs(self) -> Self {
            Self(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
        }
        #[inline(always)]
        fn corners(self) -> Self {
            Self(unsafe { _mm256_blend_ps::<0b1000_1000>(self.0, _mm256_setzero_ps()) })
        }
        #[inline(always)]
        fn swap_halves(self) -> Self {
            Self(unsafe { _mm256_permute2f128_ps::<1>(self.0, self.0) })
        }
        #[inline(always)]
        fn truncate(self) -> [i32; WIDTH] {
            let mut a = [0; WIDTH];
            unsafe { _mm256_storeu_si256(a.as_mut_ptr().cast(), _mm256_cvttps_epi32(self.0)) };
            a
        }
        #[inline(always)]
        fn le(self, b: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, b.0)) as u32 }
        }
        #[inline(always)]
        fn lt(self, b: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, b.0)) as u32 }
        }
        #[inline(always)]
        fn eq(self, b: Self) -> u32 {
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, b.0)) as u32 }
        }
    }
}
