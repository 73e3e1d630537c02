//! Rounding to few levels without bands.

/// Threshold of the ordered dither for channel `c` at pixel (x, y), in (0, 1): a value between two levels is rounded up
/// where its fraction exceeds one minus the threshold, so `floor(value + threshold)`.
///
/// The thresholds are the additive sequence of Roberts ("The Unreasonable Effectiveness of Quasirandom Sequences",
/// 2018, R₂) over the pixel grid: a rank-1 lattice, whose low frequencies are weak, so every small neighbourhood holds
/// evenly spread thresholds. Integer arithmetic makes it the same everywhere; the channels are shifted by the golden
/// ratio against each other. Thresholds are the middles of 1024 steps, so a value within 1/2048 of a level keeps it.
pub fn dither_offset(x: u32, y: u32, c: u32) -> f32 {
    // 2³² times 1/g and 1/g² (g = 1.3247…, the plastic number), and 1/φ.
    const X: u32 = 3_242_174_889;
    const Y: u32 = 2_447_445_414;
    const C: u32 = 2_654_435_769;
    let phase = x.wrapping_mul(X).wrapping_add(y.wrapping_mul(Y)).wrapping_add(c.wrapping_mul(C));
    ((phase >> 22) as f32 + 0.5) / 1024.0
}

/// Integer in 0..=max that the normalised code `v` in [0, 1] is dithered to.
pub(crate) fn quantize(v: f32, max: f32, x: u32, y: u32, c: u32) -> f32 {
    (v * max + dither_offset(x, y, c)).floor().min(max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_patches_keep_their_value() {
        for c in 0..3 {
            for step in 0..=50 {
                let value = 100.0 + step as f32 / 50.0;
                for (x0, y0) in [(0, 0), (1000, 17), (123, 4567)] {
                    let mut sum = 0.0;
                    for y in 0..16 {
                        for x in 0..16 {
                            sum += quantize(value / 255.0, 255.0, x0 + x, y0 + y, c);
                        }
                    }
                    let mean = sum / 256.0;
                    assert!((mean - value).abs() < 0.1, "{value} became {mean}");
                }
            }
        }
    }

    #[test]
    fn levels_are_kept() {
        for code in 0..=255_u8 {
            for x in 0..64 {
                for y in 0..64 {
                    assert_eq!(quantize(f32::from(code) / 255.0, 255.0, x, y, 1), f32::from(code));
                }
            }
        }
    }

    #[test]
    fn neighbours_differ() {
        // Blue-noise-like: neighbouring thresholds are far apart (at least 0.24 around the circle).
        for (x, y) in [(0, 0), (31, 7), (400, 300)] {
            for (dx, dy) in [(1, 0), (0, 1)] {
                let d = (dither_offset(x, y, 0) - dither_offset(x + dx, y + dy, 0)).abs();
                assert!(d.min(1.0 - d) > 0.24);
            }
        }
    }
}
