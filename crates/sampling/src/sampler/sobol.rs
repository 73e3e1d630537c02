//! Owen-scrambled Sobol' points in the order of a shuffled tree.
//!
//! An index of 64 bits at most names a point of the two-dimensional Sobol' sequence (Sobol' 1967). Its upper
//! bits are the path of the pixel in a quadtree, its lower ones the sample. For every dimension its base-4 digits are permuted,
//! each by a permutation that depends on all digits above it, so that every aligned block of the tree stays a block
//! of the sequence, which is a net, while blocks trade places. Then both coordinates are Owen-scrambled (Owen 1995).
//!
//! The lowest digits, which tell the samples of a pixel apart, are permuted as a whole. Under nested permutations four samples that are
//! together in one dimension are together in all, and each four are spread: what two dimensions do together then
//! has up to 4/3 of the variance that independent permutations leave.
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
    /// What permutes the block, besides the dimension.
    block_seed: u64,
    /// The index with its topmost bit in bit 0, without those of the place in the block.
    mirrored: u64,
    /// The place of the sample in its block, and how many there are.
    place: u32,
    size: u32,
    /// The bits of a place.
    place_bits: u32,
    /// 64 less the number of bits of the index.
    shift: u32,
    /// The first bits of all whole digits of the index.
    digits: u64,
}

/// A block of consecutive samples of a pixel, which are permuted freely, is an index of at most so many bits: those that are left
/// by whole digits above.
const BLOCK_BITS: u32 = 6;

impl SobolSample {
    /// The sample `index` of `count` at the place of the tree with the mirrored `path` of 16 base-4 digits. `order` is a hash of the
    /// pixel, `seed` one of what its tree is for.
    #[inline]
    pub(super) fn new(seed: u64, order: u64, path: u32, index: u32, count: u32) -> Self {
        let bits = 32 - (count - 1).leading_zeros();
        let place_bits = bits.min(BLOCK_BITS - bits % 2);
        let place = index & ((1 << place_bits) - 1);
        let first = index - place;
        let size = (count - first).min(1 << place_bits);
        let above = u64::from(first).reverse_bits() >> (32 - bits);
        // With an odd number of bits the last digit has one bit only, and nothing to shear it with.
        let digits = 0x5555_5555_5555_5555 & (u64::MAX >> (32 - (bits & !1)));
        let block_seed = order.wrapping_add(u64::from(first).wrapping_mul(0xa24b_aed4_963e_e407));
        let mirrored = u64::from(path) | above;
        Self { seed, block_seed, mirrored, place, size, place_bits, shift: 32 - bits, digits }
    }

    /// Samples that share a block with this one, itself among them.
    #[inline]
    pub(super) fn block_size(&self) -> u32 {
        self.size
    }

    /// The place in the block.
    #[inline]
    pub(super) fn place(&self) -> u32 {
        self.place
    }

    /// The same with another place in the block.
    #[inline]
    pub(super) fn at_place(&self, place: u32) -> Self {
        Self { place, ..*self }
    }

    /// Whether the block has all its places taken.
    #[inline]
    fn block_is_whole(&self) -> bool {
        self.size == 1 << self.place_bits
    }

    #[inline]
    pub(super) fn get_1d(&self, key: u32) -> f32 {
        let [[x], _] = self.get_lanes(key, self.place);
        x
    }

    #[inline]
    pub(super) fn get_2d(&self, key: u32) -> Vec2 {
        let [[x], [y]] = self.get_lanes(key, self.place);
        Vec2::new(x, y)
    }

    /// The two numbers of the `LANES` samples at the places from `first` in the block, by operations for the lanes of vectors. Places beyond
    /// the block's size get those of its last.
    #[inline(always)]
    pub(super) fn get_lanes<const LANES: usize>(&self, key: u32, first: u32) -> [[f32; LANES]; 2] {
        let h = combine(self.seed, u64::from(key));
        let (mut x, mut y) = match self.block_is_whole() {
            true => self.coordinates_in_whole::<LANES>(h, first),
            false => self.coordinates_in_part::<LANES>(h, first),
        };
        for (coordinates, seed) in [(&mut x, h as u32), (&mut y, (h >> 32) as u32)] {
            coordinates.iter_mut().for_each(|x| *x = scramble(*x, seed).reverse_bits());
        }
        let mut numbers = [[0.0; LANES]; 2];
        for (numbers, coordinates) in numbers.iter_mut().zip([x, y]) {
            numbers.iter_mut().zip(coordinates).for_each(|(number, bits)| *number = unit_f32(bits));
        }
        numbers
    }

    /// The coordinates of points before they are scrambled, their first bits the lowest, for places from `first` in a whole block.
    #[inline(always)]
    fn coordinates_in_whole<const LANES: usize>(&self, h: u64, first: u32) -> ([u32; LANES], [u32; LANES]) {
        // All places of a whole block are taken, so they need not be nested in anything. They are the lowest bits of the index, and the
        // coordinates of the block and of the place add up (without carry).
        let block = (shuffle(self.mirrored, h, self.digits) << self.shift).reverse_bits();
        let (block_x, block_y) = (block as u32, second(block));
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        for (place, (x, y)) in (first..).zip(x.iter_mut().zip(&mut y)) {
            let index = scatter(place, self.place_bits, h ^ self.block_seed);
            // In two steps, as a block of one sample has no bits.
            let index = index.reverse_bits() >> 1 >> (31 - self.place_bits);
            *x = block_x ^ index;
            *y = block_y ^ second_of_few(index);
        }
        (x, y)
    }

    /// The same in a block that is not whole.
    #[inline(always)]
    fn coordinates_in_part<const LANES: usize>(&self, h: u64, first: u32) -> ([u32; LANES], [u32; LANES]) {
        let scattered = |place| scatter(place, self.place_bits, h ^ self.block_seed);
        let mut places = [0; LANES];
        for (place, at) in (first..).zip(&mut places) {
            *at = scattered(place.min(self.size - 1));
        }
        while places.iter().fold(false, |beyond, &place| beyond | (place >= self.size)) {
            for place in &mut places {
                *place = if *place >= self.size { scattered(*place) } else { *place };
            }
        }
        // The place is in the upper word of the index, so the lower one is the same for all.
        let above = (self.mirrored >> 32) as u32;
        let (low, shuffled) = shuffle_above(self.mirrored as u32, h, self.digits);
        let carried = (u64::from(low) << self.shift >> 32) as u32;
        let path_bits = (low << self.shift).reverse_bits();
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        for (place, (x, y)) in places.iter().zip(x.iter_mut().zip(&mut y)) {
            let high = shuffled(above | place.reverse_bits() >> self.shift);
            *x = (high << self.shift | carried).reverse_bits();
            *y = second(u64::from(path_bits ^ *x));
        }
        (x, y)
    }
}

/// A keyed bijection of the numbers of `bits` bits. The variance of a mean asks of a permutation where it takes *pairs*: of few
/// numbers to all others nearly, of many to all others equally often.
#[inline]
fn scatter(x: u32, bits: u32, key: u64) -> u32 {
    let mask = ((1u64 << bits) - 1) as u32;
    let (half, third) = (bits.div_ceil(2), (bits / 3).max(1));
    let x = x.wrapping_mul((key >> 48) as u32 | 1).wrapping_add((key >> 32) as u32) & mask;
    let x = x ^ x >> half;
    let x = x.wrapping_mul((key >> 40) as u32 | 1) & mask;
    let x = x ^ (x >> third & (key >> 56) as u32);
    x.wrapping_mul((key >> 54) as u32 | 1).wrapping_add((key >> 24) as u32) & mask
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

/// What [`shuffle`] makes of the upper words of indices that share the lower one, `low`: its own low word, and a function of the upper ones
/// that has nothing to do with more than 32 bits.
#[inline(always)]
fn shuffle_above(low: u32, h: u64, digits: u64) -> (u32, impl Fn(u32) -> u32) {
    let g = h.rotate_left(32).wrapping_mul(0x9fb2_1c65_1e98_df25);
    let high = |x: u64| (x >> 32) as u32;
    // Step by step, with what the lower word carries into the upper one. No digit begins with its last bit, so it needs none from above.
    let product = |x: u32, c: u64| u64::from(x).wrapping_mul(c);
    let sheared = |x: u32, by: u64| x ^ (x >> 1 & by as u32 & digits as u32);
    let sum = u64::from(low) + u64::from(h as u32);
    let (x1, add) = (sum as u32, high(h).wrapping_add(high(sum)));
    let by1 = product(x1, 0xa3b1_9535_4a39_b70c);
    let x2 = x1 ^ by1 as u32;
    let by2 = product(x2, 0x8cb9_2ba7_2f3d_8dd4).wrapping_add(g);
    let by3 = product(sheared(x2, by2), g | 1);
    let x4 = by3 as u32;
    let by4 = product(x4, 0xe703_7ed1_a0b4_28da);
    let x5 = x4 ^ by4 as u32;
    let by5 = product(x5, 0x1b03_7387_12fa_d5c4).wrapping_add(h >> 7);
    let x6 = sheared(x5, by5);
    let by6 = product(x6, 0xd1b5_4a32_d192_ed02);
    let digits = high(digits);
    let upper = move |x: u32| {
        let times = |x: u32, c: u32, carried: u64| x.wrapping_mul(c).wrapping_add(high(carried));
        let x = x.wrapping_add(add);
        let x = x ^ times(x, 0x4a39_b70c, by1);
        let x = x ^ (x >> 1 & times(x, 0x2f3d_8dd4, by2) & digits);
        let x = times(x, g as u32 | 1, by3);
        let x = x ^ times(x, 0xa0b4_28da, by4);
        let x = x ^ (x >> 1 & times(x, 0x12fa_d5c4, by5) & digits);
        x ^ times(x, 0xd192_ed02, by6)
    };
    (x6 ^ by6 as u32, upper)
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

/// [`second`] of an index below 256.
#[inline]
fn second_of_few(x: u32) -> u32 {
    let x = x ^ (x >> 4 & 0x0f);
    let x = x ^ (x >> 2 & 0x33);
    x ^ (x >> 1 & 0x55)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::mix_bits;
    use std::collections::HashMap;
    use tenfold_testkit::Welford;

    #[test]
    fn the_second_coordinate_has_sobols_matrix() {
        // Column j of the generating matrix is v(j) = v(j - 1) ^ v(j - 1) >> 1 (Bratley and Fox 1988).
        let mut column = 1u64 << 63;
        for j in 0..64 {
            assert_eq!(second(1 << j).reverse_bits(), (column >> 32) as u32, "{j}");
            column ^= column >> 1;
        }
        assert_eq!(second(0b1011), second(0b1000) ^ second(0b11));
        (0..256).for_each(|x| assert_eq!(second_of_few(x), second(x.into())));
    }

    #[test]
    fn scattered_numbers_are_permuted_and_their_pairs_nearly_uniform() {
        for bits in 0..=12 {
            for seed in 1..=50 {
                let mut seen = vec![false; 1 << bits];
                for i in 0..1 << bits {
                    let j = scatter(i, bits, mix_bits(seed));
                    assert!(!std::mem::replace(&mut seen[j as usize], true));
                }
            }
        }
        // The relative mean square deviation of the frequencies of pairs, without what chance adds. These are bounds of what was
        // measured. Permutations nested in blocks of four have 4 for two numbers of a block of 16, and more of 64.
        let mut all = Welford::new();
        for bits in 2..=6 {
            let (n, trials) = (1u32 << bits, 100_000u64);
            for (i, j) in [(0, 1), (1, n - 1), (n / 2, 0), (0, n - 1), (n / 4, n / 2), (3, 2), (n - 3, 1)] {
                if i == j {
                    continue;
                }
                let mut counts = vec![0u64; (n * n) as usize];
                for seed in 1..=trials {
                    let at = |i| scatter(i, bits, mix_bits(seed));
                    counts[(at(i) * n + at(j)) as usize] += 1;
                }
                let each = trials as f64 / f64::from(n * (n - 1));
                let square = |k: u32| (counts[k as usize] as f64 / each - 1.0).powi(2) - 1.0 / each;
                let distinct = (0..n * n).filter(|k| k / n != k % n);
                let deviation = distinct.map(square).sum::<f64>() / f64::from(n * (n - 1));
                assert!(deviation < 0.8, "{bits} bits, pair {i}, {j}: {deviation}");
                all.add(deviation);
            }
        }
        assert!(all.mean < 0.15, "{}", all.mean);
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

    #[test]
    fn words_are_shuffled_as_the_whole() {
        for (seed, digits) in (1..500).flat_map(|s| [(s, 0x5555_5555_5555_5555), (s, 0x0155_5555_5555)]) {
            let (x, h) = (mix_bits(seed), mix_bits(seed + 1000));
            let (low, above) = shuffle_above(x as u32, h, digits);
            let whole = u64::from(above((x >> 32) as u32)) << 32 | u64::from(low);
            assert_eq!(whole, shuffle(x, h, digits));
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
