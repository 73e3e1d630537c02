//! The noise of a picture: what it is, and its estimate. `docs/noise.md` explains it.

/// How far the surroundings of a pixel reach, whose mean luminance its error is relative to: windows of 11 × 11 pixels.
const SURROUNDINGS: usize = 5;

/// Part of the picture's mean luminance that is added to that of the surroundings: a floor for black.
const FLOOR: f64 = 0.01;

/// Edge length, in pixels, of the tiles whose errors are taken to be independent.
const TILE: usize = 8;

/// The 97.5th percentile of the standard normal distribution.
const NORMAL_97_5: f64 = 1.959_964;

/// The noise of a picture.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Noise {
    /// The square root of the mean over the pixels of the variance of the luminance over the squared local brightness.
    pub value: f64,
    /// The ends of its 95 % confidence interval, where there have been enough rounds to tell.
    pub interval: Option<[f64; 2]>,
}

impl Noise {
    /// The noise of a picture whose rows are of `width` pixels, with these local brightnesses and variances of luminance.
    /// `difference` is that of two independent estimates of each variance.
    pub(super) fn estimate(
        variances: &[f64],
        difference: Option<&[f64]>,
        brightness: &[f64],
        width: usize,
    ) -> Self {
        let square = mean(&relative(variances, brightness));
        // The mean of two estimates errs by half their difference, which is zero in the mean. Neighbours may err alike, so
        // it is tiles whose errors add by their squares.
        let interval = difference.map(|difference| {
            let sums = tile_sums(&relative(difference, brightness), width);
            let error = 0.5 * sums.iter().map(|s| s * s).sum::<f64>().sqrt() / variances.len().max(1) as f64;
            [-NORMAL_97_5, NORMAL_97_5].map(|z| (square + z * error).max(0.0).sqrt())
        });
        Self { value: square.sqrt(), interval }
    }

    /// The relative standard error of the squared value, where it is known.
    pub(super) fn doubt(&self) -> Option<f64> {
        let [_, high] = self.interval?;
        let square = self.value * self.value;
        (square > 0.0).then(|| (high * high - square) / (NORMAL_97_5 * square))
    }
}

/// The sum of the values in each tile of 8 × 8 pixels, row by row, of a picture whose rows are of `width` pixels. Neighbours may
/// depend on each other; tiles are taken to be independent.
pub fn tile_sums(values: &[f64], width: usize) -> Vec<f64> {
    let columns = width.div_ceil(TILE).max(1);
    let mut sums = vec![0.0; columns * (values.len() / width.max(1)).div_ceil(TILE)];
    for (i, value) in values.iter().enumerate() {
        sums[i / width / TILE * columns + i % width / TILE] += value;
    }
    sums
}

/// The local brightness of each pixel: the mean luminance of its surroundings, as far as they are in the picture, plus 1 % of
/// the mean of all.
pub fn brightness(luminance: &[f64], width: usize) -> Vec<f64> {
    let floor = FLOOR * mean(luminance);
    box_mean(luminance, width, SURROUNDINGS).into_iter().map(|d| d + floor).collect()
}

/// Variances of luminance relative to the squares of brightnesses. What is black and has no variance has no noise.
pub(super) fn relative(variances: &[f64], brightness: &[f64]) -> Vec<f64> {
    let relative = |(&v, &d): (&f64, &f64)| if v == 0.0 { 0.0 } else { v / (d * d) };
    variances.iter().zip(brightness).map(relative).collect()
}

/// The mean over windows that reach `radius` pixels from their centre in each direction, as far as there are pixels.
pub fn box_mean(values: &[f64], width: usize, radius: usize) -> Vec<f64> {
    let height = values.len() / width.max(1);
    let window = |i: usize, n: usize| i.saturating_sub(radius)..(i + radius + 1).min(n);
    let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let rows: Vec<f64> = pixels().map(|(x, y)| mean(&values[y * width..][window(x, width)])).collect();
    pixels()
        .map(|(x, y)| {
            let column = window(y, height);
            let count = column.len() as f64;
            column.map(|y| rows[y * width + x]).sum::<f64>() / count
        })
        .collect()
}

/// The true noise of a picture, given its luminances and those of a `reference` without noise, in rows of `width` pixels: the
/// square root of the mean of the squared errors over the squared local brightness of the reference.
///
/// The expectation of its square is what [`Noise`] estimates the square root of.
pub fn relative_error(luminance: &[f64], reference: &[f64], width: usize) -> f64 {
    let brightness = brightness(reference, width);
    let squares: Vec<f64> = luminance.iter().zip(reference).map(|(a, b)| (a - b) * (a - b)).collect();
    mean(&relative(&squares, &brightness)).sqrt()
}

/// The mean of some values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_testkit::Rng;

    #[test]
    fn windows_end_at_the_border() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        let means = box_mean(&values, 4, 1);
        assert!((means[0] - 2.5).abs() < 1e-12 && (means[5] - 5.0).abs() < 1e-12);
        assert!((means[11] - 8.5).abs() < 1e-12);
    }

    #[test]
    fn a_grey_picture_has_the_noise_worked_out_by_hand() {
        let grey = vec![2.0; 24 * 16];
        let d = brightness(&grey, 24);
        assert!(d.iter().all(|d| (d - 2.02).abs() < 1e-12));
        let noise = Noise::estimate(&vec![0.04; 24 * 16], None, &d, 24);
        assert!((noise.value - 0.2 / 2.02).abs() < 1e-12 && noise.interval.is_none());
        let brighter = vec![2.2; 24 * 16];
        assert!((relative_error(&brighter, &grey, 24) - 0.2 / 2.02).abs() < 1e-9);
    }

    #[test]
    fn black_has_a_floor() {
        let mut picture = vec![0.0; 64 * 64];
        assert_eq!(Noise::estimate(&picture, None, &brightness(&picture, 64), 64).value, 0.0);
        picture[0] = 4096.0;
        assert!((brightness(&picture, 64)[64 * 64 - 1] - 0.01).abs() < 1e-12);
    }

    /// The intervals hold the truth about as often as they say, for pixels whose true variances differ widely.
    #[test]
    fn the_interval_covers() {
        let (width, height) = (40, 24);
        let mut rng = Rng::new(4);
        let true_variances: Vec<f64> =
            (0..width * height).map(|i| 1.0 + (i % 7 * (i / 400)) as f64).collect();
        let truth = mean(&true_variances).sqrt();
        let covered = (0..400).filter(|_| {
            // Exponential values, as chi-squared ones with two degrees of freedom are.
            let mut half = || -> Vec<f64> {
                true_variances.iter().map(|v| -v * tenfold_math::ops::ln(1.0 - rng.f64())).collect()
            };
            let (a, b) = (half(), half());
            let both: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect();
            let difference: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
            let noise = Noise::estimate(&both, Some(&difference), &vec![1.0; width * height], width);
            let [low, high] = noise.interval.unwrap();
            low <= truth && truth <= high
        });
        let covered = covered.count();
        // Binomial(400, 0.95): 380 ± 4.4 standard deviations.
        assert!((361..=399).contains(&covered), "{covered}");
    }
}
