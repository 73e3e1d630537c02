//! Other sizes of the same picture.

use crate::error::ImageErrorKind;
use crate::image::Image;
use crate::wrap::WrapMode;
use rayon::prelude::*;
use std::f64::consts::PI;
use tenfold_math::ops;

/// What one row or column of the result is made of: weights, which sum to one, of consecutive ones of the source.
struct Taps {
    first: i32,
    weights: Vec<f32>,
}

/// sin(πx) / πx times the Lanczos window of the given radius; zero beyond it.
fn lanczos(x: f64, radius: f64) -> f64 {
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { ops::sin(PI * x) / (PI * x) };
    if x.abs() > radius { 0.0 } else { sinc(x) * sinc(x / radius) }
}

/// Weights for going from `old` to `new` samples: Lanczos of radius 2 to more (pbrt-v4's `ResampleWeights`), the exact
/// mean over the covered stretch to fewer.
fn taps(old: u32, new: u32) -> Vec<Taps> {
    let ratio = f64::from(old) / f64::from(new);
    let enlarge = |i: u32| {
        let center = (f64::from(i) + 0.5) * ratio;
        let first = (center - 1.5).floor();
        let weights: Vec<f64> = (0..4).map(|j| lanczos(first + f64::from(j) + 0.5 - center, 2.0)).collect();
        (first as i32, weights)
    };
    let reduce = |i: u32| {
        let (start, end) = (f64::from(i) * ratio, (f64::from(i) + 1.0) * ratio);
        let (first, last) = (start.floor(), (end.ceil() - 1.0).max(start.floor()));
        let covered = |x: f64| (end.min(x + 1.0) - start.max(x)).max(0.0);
        let count = (last - first) as u32 + 1;
        (first as i32, (0..count).map(|j| covered(first + f64::from(j))).collect())
    };
    (0..new)
        .map(|i| {
            let (first, weights) = if new > old { enlarge(i) } else { reduce(i) };
            let sum: f64 = weights.iter().sum();
            Taps { first, weights: weights.iter().map(|w| (w / sum) as f32).collect() }
        })
        .collect()
}

/// Fills the rows of an image, each of `length` values, by all threads: `fill` is given the row's number.
pub(crate) fn for_rows(values: &mut [f32], length: usize, fill: impl Fn(usize, &mut [f32]) + Send + Sync) {
    // No row has no values: sides of zero are refused when the image is made of them.
    let rows_of_a_piece = (1 << 14) / length.max(1) + 1;
    values
        .par_chunks_mut(length.max(1))
        .with_min_len(rows_of_a_piece)
        .enumerate()
        .for_each(|(y, row)| fill(y, row));
}

impl Image {
    /// The picture at another size, as floats: enlarged by a Lanczos filter, with what `wrap` puts beyond the edges, or
    /// reduced to the means over what each pixel covers.
    ///
    /// The filter's negative lobes never make a negative value of non-negative ones.
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where a side is zero.
    pub fn resize(&self, width: u32, height: u32, wrap: WrapMode) -> Result<Image, ImageErrorKind> {
        let channels = self.channels().len();
        let (columns, rows) = (taps(self.width(), width), taps(self.height(), height));
        // Rows of the source, from the first to the last that any row of the result takes, already as wide as it.
        let first = rows.iter().map(|t| t.first).min().unwrap_or(0);
        let last = rows.iter().map(|t| t.first + t.weights.len() as i32).max().unwrap_or(0);
        let row_length = width as usize * channels;
        let mut wide = vec![0.0; (last - first) as usize * row_length];
        for_rows(&mut wide, row_length, |y, row| {
            let y = first + y as i32;
            for (pixel, t) in row.chunks_exact_mut(channels).zip(&columns) {
                for (c, value) in pixel.iter_mut().enumerate() {
                    let source = (t.first..).zip(&t.weights);
                    *value = source.map(|(x, w)| w * self.get_wrapped(x, y, c, wrap)).sum::<f32>();
                }
            }
        });
        let floor = if self.has_negative() { f32::NEG_INFINITY } else { 0.0 };
        let mut values = vec![0.0; height as usize * row_length];
        for_rows(&mut values, row_length, |y, row| {
            let t = &rows[y];
            let start = (t.first - first) as usize;
            for (i, value) in row.iter_mut().enumerate() {
                let source = (start..).zip(&t.weights);
                *value = source.map(|(y, w)| w * wide[y * row_length + i]).sum::<f32>().max(floor);
            }
        });
        let mut image = Image::from_f32(width, height, self.channels().iter().cloned(), values)?;
        image.metadata.chromaticities = self.metadata.chromaticities;
        Ok(image)
    }

    /// Means over blocks of `factor` × `factor` pixels; the blocks at the right and bottom edge may be smaller.
    ///
    /// # Errors
    /// [`ImageErrorKind::Size`] where `factor` is zero.
    pub fn average_pool(&self, factor: u32) -> Result<Image, ImageErrorKind> {
        let channels = self.channels().len();
        let (width, height) = match factor {
            0 => (0, 0),
            n => (self.width().div_ceil(n), self.height().div_ceil(n)),
        };
        let mut values = Vec::with_capacity(width as usize * height as usize * channels);
        for by in 0..height {
            for bx in 0..width {
                let xs = bx * factor..((bx + 1).saturating_mul(factor)).min(self.width());
                let ys = by * factor..((by + 1).saturating_mul(factor)).min(self.height());
                let count = (xs.len() * ys.len()) as f64;
                for c in 0..channels {
                    let row = |y| xs.clone().map(|x| f64::from(self.get(x, y, c))).sum::<f64>();
                    values.push((ys.clone().map(row).sum::<f64>() / count) as f32);
                }
            }
        }
        let mut image = Image::from_f32(width, height, self.channels().iter().cloned(), values)?;
        image.metadata.chromaticities = self.metadata.chromaticities;
        Ok(image)
    }

    fn has_negative(&self) -> bool {
        match self.data() {
            crate::PixelData::U8(..) => false,
            crate::PixelData::F16(v) => v.iter().any(|v| v.to_f32() < 0.0),
            crate::PixelData::F32(v) => v.iter().any(|&v| v < 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(width: u32, height: u32) -> Image {
        Image::from_fn(width, height, ["R", "G"], |x, y| {
            let v = (x * 37 + y * 101) % 17;
            [v as f32, 17.0 - v as f32]
        })
        .unwrap()
    }

    #[test]
    fn reducing_keeps_the_mean() {
        let image = noise(15, 14);
        for (width, height) in [(5, 7), (4, 3), (1, 1), (15, 1)] {
            let small = image.resize(width, height, WrapMode::Clamp).unwrap();
            for c in 0..2 {
                assert!((small.mean(c) - image.mean(c)).abs() < 1e-5, "{width} {height}");
            }
        }
    }

    #[test]
    fn the_same_size_is_the_same_image() {
        let image = noise(5, 4);
        assert_eq!(image.resize(5, 4, WrapMode::Repeat).unwrap().as_f32(), image.as_f32());
    }

    #[test]
    fn enlarging_keeps_constants_and_the_mean_of_repeated_images() {
        let flat = Image::from_fn(3, 5, ["Y"], |_, _| [0.25]).unwrap();
        let large = flat.resize(8, 8, WrapMode::Clamp).unwrap();
        assert!(large.as_f32().unwrap().iter().all(|v| (v - 0.25).abs() < 1e-6));
        let image = noise(6, 6);
        let large = image.resize(12, 12, WrapMode::Repeat).unwrap();
        // Normalising the truncated window shifts the mean a little.
        assert!((large.mean(0) - image.mean(0)).abs() < 0.01 * image.mean(0));
    }

    #[test]
    fn edges_do_not_ring_below_zero() {
        let step = |low: f32| Image::from_fn(4, 1, ["Y"], |x, _| [if x < 2 { low } else { 1.0 }]).unwrap();
        let ringing = |low| {
            let large = step(low).resize(16, 1, WrapMode::Clamp).unwrap();
            large.as_f32().unwrap().iter().copied().fold(f32::INFINITY, f32::min)
        };
        assert_eq!(ringing(0.0), 0.0);
        // Signed data, such as displacements, are left to ring.
        assert!(ringing(-1.0) < -1.0);
    }

    #[test]
    fn pools_are_block_means() {
        let image = Image::from_fn(3, 2, ["Y"], |x, y| [(y * 3 + x) as f32]).unwrap();
        let pooled = image.average_pool(2).unwrap();
        assert_eq!(pooled.resolution(), (2, 1));
        assert_eq!(pooled.as_f32().unwrap(), [2.0, 3.5]);
        assert!(image.average_pool(0).is_err());
    }
}
