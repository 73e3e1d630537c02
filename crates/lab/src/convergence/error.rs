use tenfold_math::UVec2;
use tenfold_render::schedule::tile_sums;

/// A mean squared error with its standard error.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct MeanSquare {
    pub(super) value: f64,
    pub(super) standard_error: f64,
}

impl MeanSquare {
    /// The root, and its standard error to first order; zero where noise of the reference made the square negative.
    pub(super) fn root(self) -> [f64; 2] {
        let root = self.value.max(0.0).sqrt();
        [root, if root > 0.0 { 0.5 * self.standard_error / root } else { self.standard_error.sqrt() }]
    }
}

/// Collects the squared errors of several renders, pixel by pixel.
///
/// The standard error of their mean comes from the differences between renders, tile by tile: some parts of a picture are always
/// noisier than others, which makes the mean no less certain. Within a tile, neighbours may depend on each other.
pub(super) struct SquaredErrors {
    size: UVec2,
    /// Mean squared error of each tile, a row a render.
    tiles: Vec<Vec<f64>>,
}

impl SquaredErrors {
    pub(super) fn new(size: UVec2) -> Self {
        Self { size, tiles: Vec::new() }
    }

    /// Adds a render: the squared error of each pixel, row by row.
    pub(super) fn add(&mut self, squares: &[f64]) {
        let sums = tile_sums(squares, self.size.x as usize);
        // Tiles weigh by their pixels, and sum up to the mean over all.
        self.tiles.push(sums.into_iter().map(|s| s / squares.len() as f64).collect());
    }

    /// The mean over all pixels and renders; its standard error is NaN of one render.
    pub(super) fn mean(&self) -> MeanSquare {
        let renders = self.tiles.len() as f64;
        let count = self.tiles.first().map_or(0, Vec::len);
        let (mut value, mut variance) = (0.0, 0.0);
        for tile in 0..count {
            let mean = self.tiles.iter().map(|t| t[tile]).sum::<f64>() / renders;
            let squares: f64 = self.tiles.iter().map(|t| (t[tile] - mean) * (t[tile] - mean)).sum();
            value += mean;
            variance += squares / (renders - 1.0) / renders;
        }
        MeanSquare { value, standard_error: variance.sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TILE: u32 = 8;

    #[test]
    fn tiles_that_differ_do_not_blur_the_mean() {
        // Two tiles of one column each, of 1 and 9 in both renders: the mean is 5, and certain.
        let mut errors = SquaredErrors::new(UVec2::new(2 * TILE, 1));
        let row: Vec<f64> = (0..2 * TILE).map(|x| if x < TILE { 1.0 } else { 9.0 }).collect();
        errors.add(&row);
        errors.add(&row);
        assert_eq!(errors.mean(), MeanSquare { value: 5.0, standard_error: 0.0 });
        // A render of all 3 more: each tile's variance is 3, and that of its share of the mean of three renders ¼ · 3 / 3.
        errors.add(&row.iter().map(|v| v + 3.0).collect::<Vec<_>>());
        let mean = errors.mean();
        assert!((mean.value - 6.0).abs() < 1e-12 && (mean.standard_error - 0.5f64.sqrt()).abs() < 1e-12);
        let [root, error] = mean.root();
        assert!((root - 6f64.sqrt()).abs() < 1e-12 && (error - 0.5 * 0.5f64.sqrt() / root).abs() < 1e-12);
    }

    #[test]
    fn standard_errors_are_those_of_repeated_experiments() {
        // Squares of the same noise at every pixel: the mean over repetitions of the estimated variance is the variance of the mean.
        let mut state = 1u64;
        let mut uniform = || {
            state = tenfold_sampling::mix_bits(state.wrapping_add(0x9e37_79b9_7f4a_7c15));
            state as f64 / 2f64.powi(64)
        };
        let (repetitions, size) = (400, UVec2::new(20, 13));
        let (mut means, mut estimated) = (Vec::new(), 0.0);
        for _ in 0..repetitions {
            let mut errors = SquaredErrors::new(size);
            for _ in 0..4 {
                errors.add(&(0..260).map(|i| uniform() * f64::from(1 + i % 20)).collect::<Vec<_>>());
            }
            let mean = errors.mean();
            means.push(mean.value);
            estimated += mean.standard_error * mean.standard_error / f64::from(repetitions);
        }
        let centre = means.iter().sum::<f64>() / f64::from(repetitions);
        let true_variance =
            means.iter().map(|m| (m - centre) * (m - centre)).sum::<f64>() / f64::from(repetitions - 1);
        // The variance of 400 means is known to 7 %; the bound is at four times that.
        assert!((estimated / true_variance - 1.0).abs() < 0.3, "{}", estimated / true_variance);
    }
}
