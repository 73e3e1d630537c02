//! Vectors of floats, portable and by AVX2. Both round alike (no fused multiply-add), so results are the same bits.

use super::node::LANES;

/// A vector of `N` floats.
///
/// `min` and `max` return the second argument where either is NaN, as the instructions of x86 do.
pub(super) trait Vector<const N: usize>: Copy {
    fn load(a: &[f32; N]) -> Self;
    fn splat(x: f32) -> Self;
    fn to_array(self) -> [f32; N];
    fn add(self, b: Self) -> Self;
    fn sub(self, b: Self) -> Self;
    fn mul(self, b: Self) -> Self;
    fn div(self, b: Self) -> Self;
    fn min(self, b: Self) -> Self;
    fn max(self, b: Self) -> Self;
    fn abs(self) -> Self;
    /// Bit `i` tells whether `self[i] <= b[i]`; false for NaN.
    fn le(self, b: Self) -> u32;
    /// Bit `i` tells whether `self[i] < b[i]`; false for NaN.
    fn lt(self, b: Self) -> u32;
    /// Bit `i` tells whether `self[i] == b[i]`; false for NaN.
    fn eq(self, b: Self) -> u32;
}

/// Which implementation of [`Vector`] to use.
pub(super) trait Simd {
    /// For the boxes of a node.
    type F8: Vector<8>;
    /// For the triangles of a block.
    type Triangles: Vector<LANES>;
}

/// Plain arrays, for every machine.
pub(super) struct Portable;

impl Simd for Portable {
    type F8 = Array<8>;
    type Triangles = Array<LANES>;
}

/// A vector as a plain array.
#[derive(Copy, Clone)]
pub(super) struct Array<const N: usize>([f32; N]);

impl<const N: usize> Array<N> {
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], b.0[i])))
    }

    #[inline(always)]
    fn bits(self, b: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..N).fold(0, |bits, i| bits | u32::from(f(self.0[i], b.0[i])) << i)
    }
}

impl<const N: usize> Vector<N> for Array<N> {
    #[inline(always)]
    fn load(a: &[f32; N]) -> Self {
        Self(*a)
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; N])
    }
    #[inline(always)]
    fn to_array(self) -> [f32; N] {
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
    use super::{Simd, Vector};
    use std::arch::x86_64::*;

    /// AVX2. Its vectors are to be used only inside functions with that target feature.
    pub(in super::super) struct Avx2;

    impl Simd for Avx2 {
        type F8 = Vec8;
        type Triangles = Vec4;
    }

    #[derive(Copy, Clone)]
    pub(in super::super) struct Vec4(__m128);
    #[derive(Copy, Clone)]
    pub(in super::super) struct Vec8(__m256);

    /// Implements [`Vector`] by intrinsics.
    macro_rules! vector {
        ($name:ident, $n:literal, $load:ident, $store:ident, $set:ident, $add:ident, $sub:ident, $mul:ident, $div:ident,
         $min:ident, $max:ident, $andnot:ident, $cmp:ident, $movemask:ident) => {
            // SAFETY (of every block): the machine has AVX2, or this type is not used (see `Avx2`); the pointers come
            // from references to arrays of the full length.
            impl Vector<$n> for $name {
                #[inline(always)]
                fn load(a: &[f32; $n]) -> Self {
                    Self(unsafe { $load(a.as_ptr()) })
                }
                #[inline(always)]
                fn splat(x: f32) -> Self {
                    Self(unsafe { $set(x) })
                }
                #[inline(always)]
                fn to_array(self) -> [f32; $n] {
                    let mut a = [0.0; $n];
                    unsafe { $store(a.as_mut_ptr(), self.0) };
                    a
                }
                #[inline(always)]
                fn add(self, b: Self) -> Self {
                    Self(unsafe { $add(self.0, b.0) })
                }
                #[inline(always)]
                fn sub(self, b: Self) -> Self {
                    Self(unsafe { $sub(self.0, b.0) })
                }
                #[inline(always)]
                fn mul(self, b: Self) -> Self {
                    Self(unsafe { $mul(self.0, b.0) })
                }
                #[inline(always)]
                fn div(self, b: Self) -> Self {
                    Self(unsafe { $div(self.0, b.0) })
                }
                #[inline(always)]
                fn min(self, b: Self) -> Self {
                    Self(unsafe { $min(self.0, b.0) })
                }
                #[inline(always)]
                fn max(self, b: Self) -> Self {
                    Self(unsafe { $max(self.0, b.0) })
                }
                #[inline(always)]
                fn abs(self) -> Self {
                    Self(unsafe { $andnot($set(-0.0), self.0) })
                }
                #[inline(always)]
                fn le(self, b: Self) -> u32 {
                    unsafe { $movemask($cmp::<_CMP_LE_OQ>(self.0, b.0)) as u32 }
                }
                #[inline(always)]
                fn lt(self, b: Self) -> u32 {
                    unsafe { $movemask($cmp::<_CMP_LT_OQ>(self.0, b.0)) as u32 }
                }
                #[inline(always)]
                fn eq(self, b: Self) -> u32 {
                    unsafe { $movemask($cmp::<_CMP_EQ_OQ>(self.0, b.0)) as u32 }
                }
            }
        };
    }

    vector!(
        Vec4,
        4,
        _mm_loadu_ps,
        _mm_storeu_ps,
        _mm_set1_ps,
        _mm_add_ps,
        _mm_sub_ps,
        _mm_mul_ps,
        _mm_div_ps,
        _mm_min_ps,
        _mm_max_ps,
        _mm_andnot_ps,
        _mm_cmp_ps,
        _mm_movemask_ps
    );
    vector!(
        Vec8,
        8,
        _mm256_loadu_ps,
        _mm256_storeu_ps,
        _mm256_set1_ps,
        _mm256_add_ps,
        _mm256_sub_ps,
        _mm256_mul_ps,
        _mm256_div_ps,
        _mm256_min_ps,
        _mm256_max_ps,
        _mm256_andnot_ps,
        _mm256_cmp_ps,
        _mm256_movemask_ps
    );
}
