//! Hashes of small integers: the source of all randomness.

/// A bijection of 64-bit words with full avalanche: Stafford's mixer 13, the finaliser of splitmix64
/// (Steele, Lea and Flood 2014). It maps 0 to 0.
#[inline]
pub const fn mix_bits(v: u64) -> u64 {
    let v = (v ^ (v >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let v = (v ^ (v >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    v ^ (v >> 31)
}

/// A hash of `state` and `word`; chains of it hash sequences.
#[inline]
pub const fn combine(state: u64, word: u64) -> u64 {
    // The golden ratio's fraction, as in splitmix64, keeps zeros from mapping to zeros.
    mix_bits(
        state.rotate_left(23) ^ word.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xd6e8_feb8_6659_fd93),
    )
}

/// A hash of a sequence of words; sequences of different lengths have unrelated hashes.
#[inline]
pub const fn hash(words: &[u32]) -> u64 {
    let mut state = words.len() as u64;
    let mut i = 0;
    while i < words.len() {
        state = combine(state, words[i] as u64);
        i += 1;
    }
    state
}

/// The uniform number in `[0, 1)` given by the upper 24 of 32 bits.
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    // By way of a signed integer, for which more machines have an instruction.
    (bits >> 8) as i32 as f32 * (1.0 / (1u32 << 24) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::{Options, chi2};

    #[test]
    fn one_bit_of_input_flips_half_the_bits_of_output() {
        // Binomial(20 000, 1/2) per pair of bits: 4096 of them stay within six standard deviations.
        let n = 20_000u32;
        for bit in 0..64 {
            let mut flips = [0u32; 64];
            for i in 0..n {
                let x = u64::from(i) << (i % 3 * 16);
                let d = combine(7, x) ^ combine(7, x ^ (1 << bit));
                (0..64).for_each(|k| flips[k] += (d >> k & 1) as u32);
            }
            for f in flips {
                assert!(
                    (f64::from(f) - f64::from(n) / 2.0).abs() < 6.0 * (f64::from(n) / 4.0).sqrt(),
                    "{bit}: {f}"
                );
            }
        }
    }

    #[test]
    fn hashes_of_small_words_are_uniform() {
        for shift in [0, 16, 32, 48, 56] {
            let mut counts = [0u64; 256];
            for i in 0..256 {
                for j in 0..256 {
                    counts[(hash(&[i, j]) >> shift) as usize & 255] += 1;
                }
            }
            chi2::counts_test(&counts, &[256.0; 256], &Options { tests: 5, ..Options::default() })
                .check("hash");
        }
        assert_ne!(hash(&[0]), hash(&[0, 0]));
    }

    #[test]
    fn unit_floats_stay_below_one() {
        assert_eq!(unit_f32(u32::MAX), tenfold_math::ONE_MINUS_EPSILON);
        assert_eq!(unit_f32(0), 0.0);
    }
}
