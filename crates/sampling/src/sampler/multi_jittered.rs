use super::n_rooks::NRooksSample;
use super::permute::permute;
use super::stratum;
use crate::hash::{combine, mix_bits};
use tenfold_math::Vec2;

/// The grid of correlated multi-jittered pairs: Kensler 2013, "Correlated Multi-Jittered Sampling" (Pixar technical memo 13-01).
///
/// The samples of a round lie in different cells of `columns` × `rows`, and where these fill the grid, also in different strata
/// of each axis cut into as many as there are samples (Chiu, Shirley and Wang 1994). The order of the fine strata
/// is the same in all columns and in all rows, which keeps neighbours apart. Other counts leave a part of
/// the last row empty: y stays stratified, x has some strata more than samples.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct MultiJittered {
    columns: u32,
    rows: u32,
}

/// A sample of it. Numbers that come alone are N rooks.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct MultiJitteredSample {
    rooks: NRooksSample,
    grid: MultiJittered,
}

impl MultiJittered {
    /// The full grid nearest to the square where there is one not longer than 1 : 2, else Kensler's.
    pub(super) fn new(count: u32) -> Self {
        let root = f64::from(count).sqrt() as u32;
        let divisor = (1..=root).rev().find(|d| count.is_multiple_of(*d)).unwrap_or(1);
        let columns = if count / divisor <= 2 * divisor { divisor } else { root };
        Self { columns, rows: count.div_ceil(columns) }
    }

    #[inline]
    pub(super) fn at(self, rooks: NRooksSample) -> MultiJitteredSample {
        MultiJitteredSample { rooks, grid: self }
    }
}

impl MultiJitteredSample {
    /// `bits` give the place in the stratum.
    #[inline]
    pub(super) fn get_1d(&self, key: u32, bits: u64) -> f32 {
        self.rooks.get_1d(key, bits)
    }

    #[inline]
    pub(super) fn get_2d(&self, key: u32, bits: u64) -> Vec2 {
        let NRooksSample { seed, index, count } = self.rooks;
        let MultiJittered { columns, rows } = self.grid;
        let h = combine(seed, u64::from(key));
        let s = permute(index, count, h);
        let column = permute(s % columns, columns, mix_bits(h ^ 0xbb67_ae85_84ca_a73b));
        let fine = permute(s / columns, rows, mix_bits(h ^ 0x3c6e_f372_fe94_f82b));
        let (columns, rows) = (u64::from(columns), u64::from(rows));
        let x = stratum::point(u64::from(column) * rows + u64::from(fine), columns * rows, bits as u32);
        let y = stratum::point(u64::from(s), u64::from(count), (bits >> 32) as u32);
        Vec2::new(x, y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_full_where_they_can_be() {
        let shape = |n| {
            let g = MultiJittered::new(n);
            (g.columns, g.rows)
        };
        for (n, expected) in [
            (1, (1, 1)),
            (2, (1, 2)),
            (3, (1, 3)),
            (7, (2, 4)),
            (8, (2, 4)),
            (12, (3, 4)),
            (18, (3, 6)),
            (64, (8, 8)),
            (97, (9, 11)),
            (u32::MAX, (65_535, 65_537)),
        ] {
            assert_eq!(shape(n), expected, "{n}");
        }
    }
}
