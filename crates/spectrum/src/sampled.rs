//! Values at the wavelengths of a path, in one SIMD register.

use std::ops::{Add, AddAssign, Div, DivAssign, Index, Mul, MulAssign, Neg, Sub, SubAssign};

use tenfold_math::Vec4;

use crate::N;

/// One value for each of the [`N`] wavelengths of a [`crate::SampledWavelengths`].
#[derive(Copy, Clone, PartialEq, Debug, Default)]
pub struct SampledSpectrum(pub Vec4);

impl SampledSpectrum {
    /// Zero at every wavelength.
    pub const ZERO: Self = Self(Vec4::ZERO);
    /// One at every wavelength.
    pub const ONE: Self = Self(Vec4::ONE);

    /// The same value at every wavelength.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self(Vec4::splat(v))
    }

    /// From one value per lane.
    #[inline]
    pub const fn new(v: [f32; N]) -> Self {
        Self(Vec4::from_array(v))
    }

    /// From a function of the lane.
    #[inline]
    pub fn from_fn(f: impl FnMut(usize) -> f32) -> Self {
        Self::new(std::array::from_fn(f))
    }

    /// The lanes as an array.
    #[inline]
    pub fn to_array(self) -> [f32; N] {
        self.0.to_array()
    }

    /// Value of lane `i`, `i < N`.
    #[inline]
    pub fn lane(self, i: usize) -> f32 {
        self.0[i]
    }

    /// Sets lane `i`, `i < N`.
    #[inline]
    pub fn set_lane(&mut self, i: usize, v: f32) {
        self.0[i] = v;
    }

    /// Whether every lane is zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self.0 == Vec4::ZERO
    }

    /// Largest lane.
    #[inline]
    pub fn max_component(self) -> f32 {
        self.0.max_element()
    }

    /// Smallest lane.
    #[inline]
    pub fn min_component(self) -> f32 {
        self.0.min_element()
    }

    /// Mean of the lanes.
    #[inline]
    pub fn average(self) -> f32 {
        self.sum() * (1.0 / N as f32)
    }

    /// Sum of the lanes, added pairwise in a fixed order: `(0 + 1) + (2 + 3)`.
    #[inline]
    pub fn sum(self) -> f32 {
        let [a, b, c, d] = self.0.to_array();
        (a + b) + (c + d)
    }

    /// Lane-wise exponential.
    #[inline]
    pub fn exp(self) -> Self {
        Self(self.0.exp())
    }

    /// Lane-wise square root.
    #[inline]
    pub fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// Lane-wise quotient, 0 where the divisor is 0.
    #[inline]
    pub fn safe_div(self, d: Self) -> Self {
        let zero = d.0.cmpeq(Vec4::ZERO);
        Self(Vec4::select(zero, Vec4::ZERO, self.0 / Vec4::select(zero, Vec4::ONE, d.0)))
    }

    /// Negative lanes raised to 0.
    #[inline]
    pub fn clamp_zero(self) -> Self {
        Self(self.0.max(Vec4::ZERO))
    }

    /// Lanes limited to `[lo, hi]`.
    #[inline]
    pub fn clamp(self, lo: f32, hi: f32) -> Self {
        Self(self.0.max(Vec4::splat(lo)).min(Vec4::splat(hi)))
    }

    /// Lane-wise maximum.
    #[inline]
    pub fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0))
    }

    /// Lane-wise minimum.
    #[inline]
    pub fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0))
    }

    /// Whether no lane is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.0.is_finite()
    }

    /// `self` at `t = 0`, `o` at `t = 1`, linear between.
    #[inline]
    pub fn lerp(self, o: Self, t: f32) -> Self {
        self * (1.0 - t) + o * t
    }
}

impl Index<usize> for SampledSpectrum {
    type Output = f32;
    #[inline]
    fn index(&self, i: usize) -> &f32 {
        &self.0[i]
    }
}

impl Neg for SampledSpectrum {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl std::iter::Sum for SampledSpectrum {
    #[inline]
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::ZERO, |a, b| a + b)
    }
}

/// A binary operator between spectra, and between a spectrum and a number on either side.
macro_rules! operator {
    ($op:ident, $f:ident, $assign:ident, $g:ident) => {
        impl $op for SampledSpectrum {
            type Output = Self;
            #[inline]
            fn $f(self, o: Self) -> Self {
                Self(self.0.$f(o.0))
            }
        }
        impl $op<f32> for SampledSpectrum {
            type Output = Self;
            #[inline]
            fn $f(self, o: f32) -> Self {
                Self(self.0.$f(Vec4::splat(o)))
            }
        }
        impl $op<SampledSpectrum> for f32 {
            type Output = SampledSpectrum;
            #[inline]
            fn $f(self, o: SampledSpectrum) -> SampledSpectrum {
                SampledSpectrum(Vec4::splat(self).$f(o.0))
            }
        }
        impl $assign for SampledSpectrum {
            #[inline]
            fn $g(&mut self, o: Self) {
                self.0.$g(o.0);
            }
        }
        impl $assign<f32> for SampledSpectrum {
            #[inline]
            fn $g(&mut self, o: f32) {
                self.0.$g(Vec4::splat(o));
            }
        }
    };
}

operator!(Add, add, AddAssign, add_assign);
operator!(Sub, sub, SubAssign, sub_assign);
operator!(Mul, mul, MulAssign, mul_assign);
operator!(Div, div, DivAssign, div_assign);

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::ops;

    #[test]
    fn arithmetic_is_lane_wise() {
        let a = SampledSpectrum::new([1.0, 2.0, 3.0, 4.0]);
        let b = SampledSpectrum::from_fn(|i| (i + 1) as f32 * 2.0);
        assert_eq!(a + b, a * 3.0);
        assert_eq!(b - a, a);
        assert_eq!(b / a, SampledSpectrum::splat(2.0));
        assert_eq!(a * b / 2.0, a * a);
        assert_eq!(1.0 - a, -(a - 1.0));
        assert_eq!(12.0 / a, SampledSpectrum::new([12.0, 6.0, 4.0, 3.0]));
        let mut c = a;
        c += b;
        c -= a;
        c *= a;
        c /= a;
        c *= 2.0;
        c /= 2.0;
        assert_eq!(c, b);
        assert_eq!(a.sum(), 10.0);
        assert_eq!(a.average(), 2.5);
        assert_eq!((a.min_component(), a.max_component()), (1.0, 4.0));
        assert_eq!(a.lerp(b, 0.5), a * 1.5);
        assert_eq!(a[2], 3.0);
    }

    #[test]
    fn edge_cases_of_division_and_finiteness() {
        let a = SampledSpectrum::new([1.0, -2.0, 0.0, 4.0]);
        let d = SampledSpectrum::new([0.0, 2.0, 0.0, -0.0]);
        assert_eq!(a.safe_div(d), SampledSpectrum::new([0.0, -1.0, 0.0, 0.0]));
        assert_eq!(a.clamp_zero(), SampledSpectrum::new([1.0, 0.0, 0.0, 4.0]));
        assert!(SampledSpectrum::ZERO.is_black() && !a.is_black());
        assert!(a.is_finite());
        assert!(!(a / 0.0).is_finite());
        assert_eq!(SampledSpectrum::ONE.exp().lane(3), ops::exp(1f32));
        assert_eq!(SampledSpectrum::splat(9.0).sqrt(), SampledSpectrum::splat(3.0));
    }
}
