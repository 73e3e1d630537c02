use super::permute::permute;
use crate::hash::{combine, unit_f32};
use tenfold_math::{ONE_MINUS_EPSILON, Vec2};

/// The grid of a round: one stratum for each sample, all of the same area.
///
/// In two dimensions the unit square is cut into rows and each row into cells. Where the count has two factors
/// within 1 : 2 of each other this is the classic grid. Otherwise (7, 97, ...) some rows have one cell more
/// and are higher by as much, so that every count of samples is stratified in both axes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct Stratified {
    count: u32,
    /// Cells in an ordinary row.
    base: u32,
    /// Rows of `base` cells; the rest have one more.
    ordinary: u32,
}

/// A sample of it.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct StratifiedSample {
    seed: u64,
    index: u32,
    grid: Stratified,
}

impl Stratified {
    pub(super) fn new(count: u32) -> Self {
        let root = f64::from(count).sqrt();
        let divisor = (1..=root as u32).rev().find(|d| count.is_multiple_of(*d)).unwrap_or(1);
        let rows = if count / divisor <= 2 * divisor { divisor } else { root.round() as u32 };
        Self { count, base: count / rows, ordinary: rows - count % rows }
    }

    /// `seed` is that of the pixel and the round.
    #[inline]
    pub(super) fn at(self, seed: u64, index: u32) -> StratifiedSample {
        StratifiedSample { seed, index, grid: self }
    }

    /// The stratum `cell` with a point of the unit square stretched over it.
    #[inline]
    fn point(self, cell: u32, jitter: Vec2) -> Vec2 {
        let before = self.ordinary * self.base;
        let (first, width, column) = if cell < before {
            (cell - cell % self.base, self.base, cell % self.base)
        } else {
            let (c, width) = (cell - before, self.base + 1);
            (before + c - c % width, width, c % width)
        };
        let x = (f64::from(column) + f64::from(jitter.x)) / f64::from(width);
        let y = (f64::from(first) + f64::from(jitter.y) * f64::from(width)) / f64::from(self.count);
        Vec2::new(x as f32, y as f32).min(Vec2::splat(ONE_MINUS_EPSILON))
    }
}

impl StratifiedSample {
    /// `bits` give the place in the stratum.
    #[inline]
    pub(super) fn get_1d(&self, key: u32, bits: u64) -> f32 {
        let n = self.grid.count;
        let cell = permute(self.index, n, combine(self.seed, u64::from(key)));
        let x = (f64::from(cell) + f64::from(unit_f32(bits as u32))) / f64::from(n);
        (x as f32).min(ONE_MINUS_EPSILON)
    }

    #[inline]
    pub(super) fn get_2d(&self, key: u32, bits: u64) -> Vec2 {
        let cell = permute(self.index, self.grid.count, combine(self.seed, u64::from(key)));
        self.grid.point(cell, Vec2::new(unit_f32(bits as u32), unit_f32((bits >> 32) as u32)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_tile_the_square_and_have_one_area() {
        for count in (1..130).chain([1000, 1024, 4093]) {
            let grid = Stratified::new(count);
            let mut area = 0.0;
            for cell in 0..count {
                let low = grid.point(cell, Vec2::ZERO).as_dvec2();
                let size = grid.point(cell, Vec2::ONE).as_dvec2() - low;
                assert!((size.x * size.y * f64::from(count) - 1.0).abs() < 2e-3, "{count} {cell}");
                area += size.x * size.y;
            }
            assert!((area - 1.0).abs() < 1e-4, "{count}: {area}");
        }
    }

    #[test]
    fn grids_are_the_classic_ones_where_there_are_any() {
        let shape = |n| {
            let g = Stratified::new(n);
            (g.ordinary, g.base, (n - g.ordinary * g.base) / (g.base + 1))
        };
        assert_eq!(shape(1), (1, 1, 0));
        assert_eq!(shape(8), (2, 4, 0));
        assert_eq!(shape(12), (3, 4, 0));
        assert_eq!(shape(64), (8, 8, 0));
        assert_eq!(shape(7), (2, 2, 1));
        assert_eq!(shape(97), (3, 9, 7));
    }
}
