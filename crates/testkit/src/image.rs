//! Comparison of noisy pictures tile by tile.

use crate::stats::{TTest, Welford, sidak, t_test_mean};

/// Two pictures of the same size, as rows of pixels with interleaved channels.
#[derive(Copy, Clone, Debug)]
pub struct Pair<'a> {
    /// The first picture, `width · height · channels` values.
    pub a: &'a [f32],
    /// The second picture.
    pub b: &'a [f32],
    /// Pixels in a row.
    pub width: usize,
    /// Values in a pixel.
    pub channels: usize,
}

/// One channel of one tile.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Tile {
    /// Pixel column of the tile's left edge.
    pub x: usize,
    /// Pixel row of the tile's upper edge.
    pub y: usize,
    /// Which channel.
    pub channel: usize,
    /// Mean of the first picture over the tile.
    pub mean_a: f64,
    /// Mean of the second picture over the tile.
    pub mean_b: f64,
    /// Student's test of the pixels' differences against zero.
    pub test: TTest,
}

/// Tests every channel of every `size × size` tile for equal means: a Student's test of the differences of
/// corresponding pixels, whose noise must be independent between pixels. Tiles cut by the border count too.
pub fn compare_tiles(pair: Pair<'_>, size: usize) -> Vec<Tile> {
    let Pair { a, b, width, channels } = pair;
    assert!(a.len() == b.len() && width > 0 && channels > 0 && size > 0, "pictures of unlike or no size");
    assert_eq!(a.len() % (width * channels), 0, "the last row is cut short");
    let height = a.len() / (width * channels);
    let mut tiles = Vec::new();
    for y in (0..height).step_by(size) {
        for x in (0..width).step_by(size) {
            for channel in 0..channels {
                let (mut wa, mut wb, mut wd) = (Welford::new(), Welford::new(), Welford::new());
                for row in y..(y + size).min(height) {
                    for column in x..(x + size).min(width) {
                        let i = (row * width + column) * channels + channel;
                        let (va, vb) = (f64::from(a[i]), f64::from(b[i]));
                        wa.add(va);
                        wb.add(vb);
                        wd.add(va - vb);
                    }
                }
                let test = t_test_mean(&wd, 0.0);
                tiles.push(Tile { x, y, channel, mean_a: wa.mean, mean_b: wb.mean, test });
            }
        }
    }
    tiles
}

/// Panics, naming the worst tiles, where the means of any tile differ at the `significance` of all tiles together.
#[track_caller]
pub fn check_tiles(what: &str, pair: Pair<'_>, size: usize, significance: f64) {
    let mut tiles = compare_tiles(pair, size);
    let limit = sidak(significance, tiles.len());
    let count = tiles.len();
    tiles.retain(|t| t.test.p < limit || t.test.p.is_nan());
    tiles.sort_by(|s, t| s.test.p.total_cmp(&t.test.p));
    let worst: Vec<String> = tiles.iter().take(8).map(|t| format!("{t:?}")).collect();
    assert!(
        tiles.is_empty(),
        "{what}: {} of {count} tiles differ, the worst:\n{}",
        tiles.len(),
        worst.join("\n")
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    fn noise(seed: u64, n: usize) -> Vec<f32> {
        let mut rng = Rng::new(seed);
        (0..n).map(|_| rng.f32()).collect()
    }

    #[test]
    fn equal_pictures_pass_and_a_shifted_tile_does_not() {
        let (a, mut b) = (noise(1, 40 * 30 * 3), noise(2, 40 * 30 * 3));
        check_tiles("noise", Pair { a: &a, b: &b, width: 40, channels: 3 }, 8, 0.01);
        for y in 8..16 {
            for x in 16..24 {
                b[(y * 40 + x) * 3 + 1] += 0.4;
            }
        }
        let tiles = compare_tiles(Pair { a: &a, b: &b, width: 40, channels: 3 }, 8);
        let worst = tiles.iter().min_by(|s, t| s.test.p.total_cmp(&t.test.p)).unwrap();
        assert_eq!((worst.x, worst.y, worst.channel), (16, 8, 1));
        assert!(!worst.test.passes(0.01, tiles.len()));
    }
}
