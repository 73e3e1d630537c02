//! How far an image is from its reference.

use crate::error::ImageErrorKind;
use crate::image::Image;

/// The ε of [`Comparison::relative_mse`] (Rousselle et al. 2011).
pub const RELATIVE_MSE_EPSILON: f64 = 0.01;

/// The differences between an image and a reference, over their red, green and blue channels (three times the same in grey
/// images). NaN wherever values that are not finite or references of zero spoil a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Mean of the image over the mean of the reference, per channel.
    pub mean_ratio: [f64; 3],
    /// Mean of the squared difference, over all pixels and channels.
    pub mse: f64,
    /// Mean of the squared difference over the squared reference plus [`RELATIVE_MSE_EPSILON`].
    pub relative_mse: f64,
    /// Differences of square tiles.
    pub tiles: TileDifferences,
    /// Values of the image that are not finite.
    pub not_finite: usize,
}

/// Absolute differences of the means of square tiles, each relative to the reference's tile (not below zero) plus 5 % of
/// the reference's mean: noise averages out, and darkness does not exaggerate.
#[derive(Clone, Debug, PartialEq)]
pub struct TileDifferences {
    /// Median over all tiles and channels.
    pub median: f64,
    /// 95th percentile over the tiles, per channel.
    pub p95: [f64; 3],
    /// Maximum over all tiles and channels.
    pub max: f64,
}

impl Comparison {
    /// Whether every value is finite, every channel's mean is within `mean` of the reference's and the 95th percentile
    /// of the tiles within `tiles`, both relative.
    pub fn is_within(&self, mean: f64, tiles: f64) -> bool {
        self.not_finite == 0
            && self.mean_ratio.iter().all(|r| (r - 1.0).abs() <= mean)
            && self.tiles.p95.iter().all(|&d| d <= tiles)
    }
}

/// Compares `image` with `reference` by all measures, with tiles of `tile` × `tile` pixels (8 is usual). Tiles that do not
/// fit at the right and bottom edge are left out.
///
/// # Errors
/// [`ImageErrorKind::Size`] where the sizes differ or not one tile fits.
pub fn compare(image: &Image, reference: &Image, tile: u32) -> Result<Comparison, ImageErrorKind> {
    check_sizes(image, reference)?;
    let tiles = tile_differences(&signed_tile_differences(image, reference, tile)?);
    let (mut sums, mut reference_sums) = ([0.0; 3], [0.0; 3]);
    let (mut squares, mut relative, mut not_finite) = (0.0, 0.0, 0);
    let (width, height) = image.resolution();
    for y in 0..height {
        for x in 0..width {
            let (v, r) = (image.rgb(x, y).to_array(), reference.rgb(x, y).to_array());
            for c in 0..3 {
                not_finite += usize::from(!v[c].is_finite());
                let (v, r) = (f64::from(v[c]), f64::from(r[c]));
                sums[c] += v;
                reference_sums[c] += r;
                let square = (v - r) * (v - r);
                squares += square;
                relative += square / (r * r + RELATIVE_MSE_EPSILON);
            }
        }
    }
    let count = f64::from(width) * f64::from(height) * 3.0;
    Ok(Comparison {
        mean_ratio: std::array::from_fn(|c| sums[c] / reference_sums[c]),
        mse: squares / count,
        relative_mse: relative / count,
        tiles,
        not_finite,
    })
}

/// The signed difference of each whole tile, as an image of one pixel a tile; see [`TileDifferences`].
///
/// # Errors
/// As [`compare`].
pub fn signed_tile_differences(image: &Image, reference: &Image, tile: u32) -> Result<Image, ImageErrorKind> {
    check_sizes(image, reference)?;
    let (width, height) = image.resolution();
    let (columns, rows) = (width.checked_div(tile).unwrap_or(0), height.checked_div(tile).unwrap_or(0));
    let [r, g, b] = reference.rgb_channels().map(|c| reference.mean(c));
    Image::from_fn(columns, rows, ["R", "G", "B"], |tx, ty| {
        let (v, reference) = (tile_mean(image, tx, ty, tile), tile_mean(reference, tx, ty, tile));
        std::array::from_fn(|c| {
            let mean = [r, g, b][c];
            ((v[c] - reference[c]) / (reference[c].max(0.0) + 0.05 * mean)) as f32
        })
    })
}

fn tile_mean(image: &Image, tx: u32, ty: u32, tile: u32) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for y in ty * tile..(ty + 1) * tile {
        for x in tx * tile..(tx + 1) * tile {
            for (sum, v) in sum.iter_mut().zip(image.rgb(x, y).to_array()) {
                *sum += f64::from(v);
            }
        }
    }
    sum.map(|s| s / (f64::from(tile) * f64::from(tile)))
}

fn check_sizes(image: &Image, reference: &Image) -> Result<(), ImageErrorKind> {
    if image.resolution() == reference.resolution() {
        return Ok(());
    }
    let pixels = |i: &Image| u64::from(i.width()) * u64::from(i.height());
    let (width, height) = reference.resolution();
    Err(ImageErrorKind::Size {
        width,
        height,
        channels: 1,
        expected: pixels(reference),
        found: pixels(image),
    })
}

fn tile_differences(signed: &Image) -> TileDifferences {
    let tiles = signed.as_f32().unwrap_or_default();
    let channel = |c: usize| tiles.iter().skip(c).step_by(3).map(|d| f64::from(d.abs())).collect();
    let all: Vec<f64> = tiles.iter().map(|d| f64::from(d.abs())).collect();
    // `f64::max` would pass over a NaN.
    let max = all.iter().copied().fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a });
    TileDifferences {
        median: percentile(all, 0.5),
        p95: std::array::from_fn(|c| percentile(channel(c), 0.95)),
        max,
    }
}

/// Percentile by linear interpolation between order statistics, as numpy's default. NaN where one of the values is, or
/// there is none.
fn percentile(mut values: Vec<f64>, fraction: f64) -> f64 {
    if values.is_empty() || values.iter().any(|v| v.is_nan()) {
        return f64::NAN;
    }
    values.sort_by(f64::total_cmp);
    let place = fraction * (values.len() - 1) as f64;
    let (low, high) = (values[place.floor() as usize], values[place.ceil() as usize]);
    low + (high - low) * place.fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> Image {
        Image::from_fn(width, height, ["Y"], |x, y| [value(x, y)]).unwrap()
    }

    #[test]
    fn an_image_equals_itself() {
        let image = grey(8, 8, |x, y| (x + y) as f32);
        let c = compare(&image, &image, 4).unwrap();
        assert_eq!(c.mean_ratio, [1.0; 3]);
        assert_eq!((c.mse, c.relative_mse, c.tiles.max, c.tiles.median), (0.0, 0.0, 0.0, 0.0));
        assert!(c.is_within(0.0, 0.0));
    }

    #[test]
    fn measures_have_the_values_worked_out_by_hand() {
        // The reference is 1 on the left and 3 on the right (mean 2); the image 1.5 and 3.
        let reference = grey(4, 2, |x, _| if x < 2 { 1.0 } else { 3.0 });
        let image = grey(4, 2, |x, _| if x < 2 { 1.5 } else { 3.0 });
        let c = compare(&image, &reference, 2).unwrap();
        assert_eq!(c.mean_ratio, [1.125; 3]);
        assert_eq!(c.mse, 0.125);
        assert!((c.relative_mse - 0.125 / 1.01).abs() < 1e-9);
        // The left tile differs by 0.5 / (1 + 0.05 · 2), the right one not.
        let left = 0.5 / 1.1;
        assert!((c.tiles.max - left).abs() < 1e-6);
        assert!((c.tiles.median - 0.5 * left).abs() < 1e-6);
        assert!(c.tiles.p95.iter().all(|p| (p - 0.95 * left).abs() < 1e-6));
        assert!(c.is_within(0.13, 0.44) && !c.is_within(0.12, 0.44) && !c.is_within(0.13, 0.43));
    }

    #[test]
    fn channels_are_kept_apart() {
        let rgb = |g| Image::from_fn(8, 8, ["R", "G", "B"], |_, _| [1.0, g, 1.0]).unwrap();
        let c = compare(&rgb(2.0), &rgb(1.0), 8).unwrap();
        assert_eq!(c.mean_ratio, [1.0, 2.0, 1.0]);
        assert!(c.tiles.p95[0] == 0.0 && c.tiles.p95[1] > 0.9 && c.tiles.p95[2] == 0.0);
    }

    #[test]
    fn values_that_are_not_finite_never_pass() {
        let reference = grey(16, 16, |_, _| 1.0);
        for bad in [f32::NAN, f32::INFINITY] {
            let image = grey(16, 16, |x, y| if (x, y) == (3, 3) { bad } else { 1.0 });
            let c = compare(&image, &reference, 8).unwrap();
            assert_eq!(c.not_finite, 3);
            assert!(!c.is_within(1e9, 1e9));
        }
    }

    #[test]
    fn sizes_must_agree_and_hold_a_tile() {
        let a = grey(8, 8, |_, _| 1.0);
        assert!(compare(&a, &grey(8, 9, |_, _| 1.0), 8).is_err());
        assert!(compare(&a, &a, 9).is_err());
        assert!(compare(&a, &a, 0).is_err());
        // What is left at the edges does not count.
        let b = grey(8, 8, |x, _| if x < 6 { 1.0 } else { 9.0 });
        assert_eq!(compare(&b, &a, 6).unwrap().tiles.max, 0.0);
    }

    #[test]
    fn percentiles_interpolate() {
        assert_eq!(percentile(vec![4.0, 1.0, 3.0, 2.0], 0.5), 2.5);
        assert_eq!(percentile((0..=100).map(f64::from).collect(), 0.95), 95.0);
        assert!(percentile(vec![], 0.5).is_nan());
    }
}
