/// A number in the stratum `cell` of `[0, 1)` cut into `count` equal ones; `jitter` gives the place in it.
///
/// Of the multiples of 2⁻²⁴ it takes one that truly lies in the stratum: a sum and a quotient in `f32` would
/// now and then round up into the next.
#[inline]
pub(super) fn point(cell: u64, count: u64, jitter: u32) -> f32 {
    let (low, high) = (bound(cell, count), bound(cell + 1, count));
    let k = low + ((u64::from(high - low) * u64::from(jitter)) >> 32) as u32;
    // More than 2²⁴ strata may hold no multiple.
    k.min((1 << 24) - 1) as f32 * (1.0 / (1u32 << 24) as f32)
}

/// `cell / count` in multiples of 2⁻²⁴, rounded up. The quotient is exact where it is an integer, and elsewhere
/// too far from one to be rounded to it while `count` is below 2²⁸.
#[inline]
fn bound(cell: u64, count: u64) -> u32 {
    let x = cell as f64 * f64::from(1u32 << 24) / count as f64;
    let below = x as u32;
    below + u32::from(f64::from(below) < x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stay_in_their_strata() {
        for count in (1u64..600).chain([4093, 4096, 65_537, 999_983]) {
            let last = count - 1;
            for cell in [0, 1, 2, count / 3, count / 2, last.saturating_sub(1), last] {
                let cell = cell.min(last);
                for jitter in [0, 1, 1 << 31, u32::MAX] {
                    let x = f64::from(point(cell, count, jitter));
                    assert_eq!((x * count as f64) as u64, cell, "{count} {jitter}");
                }
            }
        }
        for count in [1 << 24, u64::from(u32::MAX), 3u64.pow(21)] {
            for cell in [0, count / 2, count - 1] {
                let x = f64::from(point(cell, count, u32::MAX));
                assert!((x - cell as f64 / count as f64).abs() <= 1.0 / f64::from(1u32 << 24) && x < 1.0);
            }
        }
    }

    #[test]
    fn jitter_spans_the_stratum() {
        for cell in 0..3 {
            let at = |jitter| f64::from(point(cell, 3, jitter)) * 3.0 - cell as f64;
            assert!(at(0) < 1e-6 && at(u32::MAX) > 1.0 - 1e-6 && (at(1 << 31) - 0.5).abs() < 1e-6);
        }
    }
}
