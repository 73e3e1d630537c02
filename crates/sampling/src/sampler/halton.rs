use super::permute::permute;
use super::sobol::scramble;
use super::stratum;
use crate::hash::{combine, mix_bits, unit_f32};
use tenfold_math::Vec2;

/// Scrambled Halton points (Halton 1960; nested scrambling: Owen 1995), padded by dimension.
///
/// The first points of the sequence are taken in an order of its own for every dimension. So none needs a base of its own, and the
/// large ones, whose points are badly spread, are not needed: pairs have the bases 2 and 3, numbers alone base 2.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct Halton {
    count: u32,
    /// Digits in base 3 that tell all indices apart.
    digits: u32,
}

/// A sample of it.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct HaltonSample {
    seed: u64,
    index: u32,
    points: Halton,
}

impl Halton {
    pub(super) fn new(count: u32) -> Self {
        let digits = (0..).find(|d| 3u64.pow(*d) >= u64::from(count)).unwrap_or(21);
        Self { count, digits }
    }

    /// `seed` is that of the pixel and the round.
    #[inline]
    pub(super) fn at(self, seed: u64, index: u32) -> HaltonSample {
        HaltonSample { seed, index, points: self }
    }
}

impl HaltonSample {
    #[inline]
    pub(super) fn get_1d(&self, key: u32) -> f32 {
        let h = combine(self.seed, u64::from(key));
        base_2(permute(self.index, self.points.count, h), mix_bits(h ^ 0xa54f_f53a_5f1d_36f1))
    }

    /// `bits` give the digits in base 3 beyond those of the index.
    #[inline]
    pub(super) fn get_2d(&self, key: u32, bits: u64) -> Vec2 {
        let h = combine(self.seed, u64::from(key));
        let i = permute(self.index, self.points.count, h);
        let x = base_2(i, mix_bits(h ^ 0x510e_527f_ade6_82d1));
        let y = base_3(i, self.points.digits, mix_bits(h ^ 0x9b05_688c_2b3e_6c1f), bits as u32);
        Vec2::new(x, y)
    }
}

/// The Owen-scrambled radical inverse in base 2.
#[inline]
fn base_2(index: u32, seed: u64) -> f32 {
    unit_f32(scramble(index, seed as u32).reverse_bits())
}

/// That in base 3: each digit is permuted in a way that the digits before it choose. Where the index has ended, no other shares
/// the digits before, so all further ones are random together.
#[inline]
fn base_3(index: u32, digits: u32, seed: u64, further: u32) -> f32 {
    let (mut rest, mut h) = (index, seed);
    let (mut cell, mut count) = (0u64, 1u64);
    for _ in 0..digits {
        let digit = u64::from(rest % 3);
        rest /= 3;
        // All six permutations of three are affine.
        let (factor, offset) = (1 + (h & 1), ((h >> 32) * 3) >> 32);
        cell = cell * 3 + (digit * factor + offset) % 3;
        count *= 3;
        h = combine(h, digit);
    }
    stratum::point(cell, count, further)
}
