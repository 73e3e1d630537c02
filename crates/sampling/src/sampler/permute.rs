/// The place of `index` in a random permutation of `[0, n)`, which `seed` (well mixed) chooses.
///
/// A keyed bijection of the smallest power of two that holds `n`, applied again while it leads out of the range
/// (cycle walking; Black and Rogaway 2002; for sampling, Kensler 2013). `index` must be below `n`.
#[inline]
pub(super) fn permute(index: u32, n: u32, seed: u64) -> u32 {
    if n <= 1 {
        return 0;
    }
    debug_assert!(index < n);
    let mask = u32::MAX >> (n - 1).leading_zeros();
    let bits = 32 - mask.leading_zeros();
    let (half, third) = (bits.div_ceil(2), bits.div_ceil(3));
    let mut i = index;
    loop {
        let mut key = seed;
        for _ in 0..6 {
            // Bijections of the masked bits: a sum, shifts to the right, an odd product.
            let k = key as u32;
            i = i.wrapping_add(k) & mask;
            i ^= (i >> half) & (k >> 3);
            i = i.wrapping_mul((k >> 6) | 1) & mask;
            i ^= (i >> third) & (k >> 9);
            key = key.rotate_right(11);
        }
        if i < n {
            return i;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::mix_bits;
    use tenfold_testkit::{Options, chi2};

    #[test]
    fn it_is_a_permutation() {
        for n in (1..70).chain([100, 128, 1000, 4096, 5000]) {
            for seed in 0..10 {
                let mut seen = vec![false; n as usize];
                for i in 0..n {
                    let j = permute(i, n, mix_bits(seed + 1));
                    assert!(!std::mem::replace(&mut seen[j as usize], true));
                }
            }
        }
    }

    #[test]
    fn places_and_pairs_of_places_are_uniform() {
        let o = Options { tests: 40, ..Options::default() };
        for n in [2u32, 3, 4, 5, 7, 8, 16, 23, 64] {
            for (i, j) in [(0, 1), (1, n - 1), (n / 2, n / 2 - 1), (0, n - 1)] {
                if i == j {
                    continue;
                }
                let mut counts = vec![0u64; (n * n) as usize];
                let trials = 50 * u64::from(n * n).max(1000);
                for seed in 0..trials {
                    let s = mix_bits(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
                    counts[(permute(i, n, s) * n + permute(j, n, s)) as usize] += 1;
                }
                let each = trials as f64 / f64::from(n * (n - 1));
                let expected: Vec<f64> =
                    (0..n * n).map(|k| if k / n == k % n { 0.0 } else { each }).collect();
                chi2::counts_test(&counts, &expected, &o).check(&format!("n = {n}, pair {i}, {j}"));
            }
        }
    }
}
