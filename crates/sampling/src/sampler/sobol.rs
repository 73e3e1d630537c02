//! Owen-scrambled Sobol' points in the order of a shuffled tree.
//!
//! An index of 64 bits at most names a point of the two-dimensional Sobol' sequence (Sobol' 1967). Its upper
//! bits are the path of the pixel in a quadtree, its lower ones the sample. For every dimension its base-4 digits are permuted,
//! each by a permutation that depends on all digits above it, so that every aligned block of the tree stays a block
//! of the sequence, which is a net, while blocks trade places. Then both coordinates are Owen-scrambled (Owen 1995).
//!
//! Nested permutations need no loop over digits. With the topmost digit in the *lowest* bits, sums and products of integers
//! carry towards the lower digits only, as Laine and Karras (2011) use for Owen scrambling in base 2. Sums and products permute
//! a digit in eight of the 24 ways; the rest comes from shears, which add the digit's one bit to the other
//! where bits derived from the digits above say so.

use crate::hash::{combine, unit_f32};
use tenfold_math::Vec2;

#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct SobolSample {
    seed: u64,
    /// The index with its topmost bit in bit 0.
    mirrored: u64,
    /// The first bits of all whole digits of the index.
    digits: u64,
    /// 64 less the number of bits of the index.
    shift: u32,
}

impl SobolSample {
    /// The sample `index` of `count` at the place of the tree with the `mirrored` path of 16 base-4 digits.
    #[inline]
    pub(super) fn new(seed: u64, mirrored: u64, index: u32, count: u32) -> Self {
        let bits = 32 - (count - 1).leading_zeros();
        let low = u64::from(index).reverse_bits() >> (32 - bits);
        // With an odd number of bits the last digit has one bit only, and nothing to shear it with.
        let whole = 32 + (bits & !1);
        let digits = 0x5555_5555_5555_5555 & (u64::MAX >> (64 - whole));
        Self { seed, mirrored: mirrored | low, digits, shift: 32 - bits }
    }

    #[inline]
    pub(super) fn get_1d(&self, key: u32) -> f32 {
        let h = combine(self.seed, u64::from(key));
        let index = shuffle(self.mirrored, h, self.digits) << self.shift;
        let x = scramble(((index >> 32) as u32).reverse_bits(), h as u32);
        unit_f32(x.reverse_bits())
    }

    #[inline]
    pub(super) fn get_2d(&self, key: u32) -> Vec2 {
        let h = combine(self.seed, u64::from(key));
        let index = (shuffle(self.mirrored, h, self.digits) << self.shift).reverse_bits();
        let x = scramble(index as u32, h as u32);
        let y = scramble(second(index), (h >> 32) as u32);
        let bits = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
        Vec2::new(unit_f32((bits >> 32) as u32), unit_f32(bits as u32))
    }
}

/// Permutes the base-4 digits of a mirrored index, each by a permutation that the digits above it and `h` choose.
#[inline]
fn shuffle(x: u64, h: u64, digits: u64) -> u64 {
    let g = h.rotate_left(32).wrapping_mul(0x9fb2_1c65_1e98_df25);
    // Bit k of an even multiple of x depends on the bits below k alone, so each line can be undone from the lowest bit up.
    // Of a multiple of four, both bits of a digit depend on other digits alone: these choose the shears.
    let x = x.wrapping_add(h);
    let x = x ^ x.wrapping_mul(0xa3b1_9535_4a39_b70c);
    let x = x ^ (x >> 1 & x.wrapping_mul(0x8cb9_2ba7_2f3d_8dd4).wrapping_add(g) & digits);
    let x = x.wrapping_mul(g | 1);
    let x = x ^ x.wrapping_mul(0xe703_7ed1_a0b4_28da);
    let x = x ^ (x >> 1 & x.wrapping_mul(0x1b03_7387_12fa_d5c4).wrapping_add(h >> 7) & digits);
    x ^ x.wrapping_mul(0xd1b5_4a32_d192_ed02)
}

/// Owen-scrambles the fraction whose *lowest* bit is the first (Laine and Karras 2011, with the constants
/// found by Vegdahl 2021, "Building a Better LK Hash").
#[inline]
pub(super) fn scramble(x: u32, seed: u32) -> u32 {
    let x = x ^ x.wrapping_mul(0x3d20_adea);
    let x = x.wrapping_add(seed).wrapping_mul((seed >> 16) | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The second coordinate of the Sobol' point `index`, the fraction's first bit the lowest.
///
/// The generating matrix is Pascal's modulo 2: as polynomials over GF(2), bit k standing for zᵏ, the coordinate is the
/// index with z replaced by z + 1. Halves are replaced recursively: (z + 1)ⁿ = zⁿ + 1 for powers of two n.
#[inline]
fn second(index: u64) -> u32 {
    let x = index as u32 ^ (index >> 32) as u32;
    let x = x ^ (x >> 16);
    let x = x ^ (x >> 8 & 0x00ff_00ff);
    let x = x ^ (x >> 4 & 0x0f0f_0f0f);
    let x = x ^ (x >> 2 & 0x3333_3333);
    x ^ (x >> 1 & 0x5555_5555)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::mix_bits;
    use std::collections::HashMap;

    #[test]
    fn the_second_coordinate_has_sobols_matrix() {
        // Column j of the generating matrix is v(j) = v(j - 1) ^ v(j - 1) >> 1 (Bratley and Fox 1988).
        let mut column = 1u64 << 63;
        for j in 0..64 {
            assert_eq!(second(1 << j).reverse_bits(), (column >> 32) as u32, "{j}");
            column ^= column >> 1;
        }
        assert_eq!(second(0b1011), second(0b1000) ^ second(0b11));
    }

    #[test]
    fn shuffles_are_nested_bijections_of_digits() {
        let digits = 0x5555_5555_5555_5555;
        for seed in 1..200 {
            let h = mix_bits(seed);
            // A prefix of k digits goes to a prefix of k digits, and no two go to the same.
            for k in 1..6 {
                let mask = (1u64 << (2 * k)) - 1;
                let mut seen = vec![false; 1 << (2 * k)];
                for prefix in 0..=mask {
                    let y = shuffle(prefix, h, digits) & mask;
                    assert_eq!(shuffle(prefix | mix_bits(prefix + 9) << (2 * k), h, digits) & mask, y);
                    assert!(!std::mem::replace(&mut seen[y as usize], true));
                }
            }
        }
    }

    /// The permutation, 0 to 23, that `shuffle` makes of the digit at bits 2k under the digits above, `prefix`.
    fn permutation(prefix: u64, k: u32, h: u64, ids: &HashMap<[u64; 4], usize>) -> usize {
        ids[&[0, 1, 2, 3].map(|d| shuffle(prefix | d << (2 * k), h, 0x5555_5555_5555_5555) >> (2 * k) & 3)]
    }

    fn ids() -> HashMap<[u64; 4], usize> {
        let all = (0..256u64).map(|i| [i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6 & 3]);
        all.filter(|p| p.iter().fold(0, |m, d| m | 1 << d) == 15).zip(0..).collect()
    }

    /// Σ (observed − expected)² / expected over the number of trials, of a table of pairs against independence:
    /// 0 where they are, 23 where one decides the other.
    fn dependence(pairs: &[u64]) -> f64 {
        let n: u64 = pairs.iter().sum();
        let row = |p: usize| pairs[p * 24..][..24].iter().sum::<u64>() as f64;
        let column = |q: usize| (0..24).map(|p| pairs[p * 24 + q]).sum::<u64>() as f64;
        let (rows, columns): (Vec<f64>, Vec<f64>) =
            ((0..24).map(row).collect(), (0..24).map(column).collect());
        let cell = |k: usize| {
            let expected = rows[k / 24] * columns[k % 24] / n as f64;
            if expected > 0.0 { (pairs[k] as f64 - expected).powi(2) / expected } else { 0.0 }
        };
        (0..576).map(cell).sum::<f64>() / n as f64
    }

    #[test]
    fn digits_take_all_permutations_and_each_prefix_its_own() {
        // A hash for every digit would make all 24 equally likely, and permutations under different prefixes independent.
        // The few products used instead come near: these are the bounds of what was measured, and far from what a
        // permutation in base 2 does (16 of the 24 never occur). The topmost digits, constant in any picture below
        // 16 384 pixels, are not asked so much.
        let (ids, n) = (ids(), 40_000u64);
        for k in [2, 3, 8, 15, 16, 18, 22] {
            let prefix = 0x0012_3456_789a & ((1u64 << (2 * k)) - 1);
            let of = |prefix, i| permutation(prefix, k, mix_bits(i + 1), &ids);
            let mut counts = [0u64; 24];
            (0..n).for_each(|i| counts[of(prefix, i)] += 1);
            for c in counts {
                let share = c as f64 * 24.0 / n as f64;
                assert!((0.6..1.5).contains(&share), "digit {k}: {counts:?}");
            }
            for flip in [0, k, 2 * k - 4, 2 * k - 3, 2 * k - 2, 2 * k - 1] {
                let mut pairs = vec![0u64; 576];
                (0..n).for_each(|i| pairs[of(prefix, i) * 24 + of(prefix ^ 1 << flip, i)] += 1);
                let limit = if k < 4 {
                    1.0
                } else if flip + 2 < 2 * k {
                    0.1
                } else {
                    0.4
                };
                assert!(dependence(&pairs) < limit, "digit {k}, flip {flip}: {}", dependence(&pairs));
            }
        }
    }
}
