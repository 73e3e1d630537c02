use super::{PiecewiseConstant1D, accumulate, locate, sanitize};
use tenfold_math::{ONE_MINUS_EPSILON, Vec2, lerp};

/// A density in proportion to a table of values over equal cells of a rectangle: first the row by the rows' sums, then the
/// cell within the row (pbrt book §A.5.6). Values count as in [`PiecewiseConstant1D`].
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstant2D {
    f: Vec<f32>,
    /// The running sums of each row, one longer than the row.
    conditional: Vec<f32>,
    marginal: PiecewiseConstant1D,
    width: usize,
    min: Vec2,
    max: Vec2,
    mean: f64,
}

/// A sample of a [`PiecewiseConstant2D`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Sample2D {
    /// The point of the rectangle.
    pub point: Vec2,
    /// Density per unit of area.
    pub pdf: f32,
    /// Column and row of the cell it is in.
    pub cell: [usize; 2],
    /// Where in that cell, in `[0, 1)²`.
    pub offset: Vec2,
}

impl PiecewiseConstant2D {
    /// Over the unit square; `f` holds rows of `width` values, the first row that at `y = 0`. What is left of an incomplete last
    /// row does not count.
    pub fn new(f: &[f32], width: usize) -> Self {
        Self::with_range(f, width, Vec2::ZERO, Vec2::ONE)
    }

    /// Over the rectangle from `min` to `max`.
    pub fn with_range(f: &[f32], width: usize, min: Vec2, max: Vec2) -> Self {
        let height = f.len().checked_div(width).unwrap_or(0);
        let (f, width) = if height == 0 {
            (vec![0.0], 1)
        } else {
            (f[..width * height].iter().map(|&f| sanitize(f)).collect::<Vec<_>>(), width)
        };
        let height = f.len() / width;
        let mut conditional = vec![0.0; height * (width + 1)];
        let rows: Vec<f64> = f
            .chunks_exact(width)
            .zip(conditional.chunks_exact_mut(width + 1))
            .map(|(row, cdf)| accumulate(row, cdf))
            .collect();
        let mean = rows.iter().sum::<f64>() / height as f64;
        let sums: Vec<f32> = rows.iter().map(|&r| r as f32).collect();
        let marginal = PiecewiseConstant1D::with_range(&sums, min.y, max.y);
        Self { f, conditional, marginal, width, min, max, mean }
    }

    /// Columns and rows of the table.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.marginal.len()]
    }

    /// The integral of the table over its rectangle.
    pub fn integral(&self) -> f32 {
        let size = (self.max - self.min).as_dvec2();
        (self.mean * size.x * size.y) as f32
    }

    /// A point of the rectangle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Sample2D {
        let row = self.marginal.sample(u.y);
        let (column, offset) = locate(self.row(row.cell), u.x);
        let x = lerp((column as f32 + offset) / self.width as f32, self.min.x, self.max.x);
        Sample2D {
            point: Vec2::new(x, row.x),
            pdf: self.pdf_of_cell([column, row.cell]),
            cell: [column, row.cell],
            offset: Vec2::new(offset, row.offset),
        }
    }

    /// Density at `p` per unit of area; zero outside.
    #[inline]
    pub fn pdf(&self, p: Vec2) -> f32 {
        self.cell(p).map_or(0.0, |(cell, _)| self.pdf_of_cell(cell))
    }

    /// Density in a cell of the table.
    #[inline]
    pub fn pdf_of_cell(&self, cell: [usize; 2]) -> f32 {
        let f = self.f[cell[1] * self.width + cell[0]];
        let relative = if self.mean > 0.0 { (f64::from(f) / self.mean) as f32 } else { 1.0 };
        relative / ((self.max.x - self.min.x) * (self.max.y - self.min.y))
    }

    /// The numbers that [`Self::sample`] maps to `p`; `None` outside of the rectangle.
    #[inline]
    pub fn invert(&self, p: Vec2) -> Option<Vec2> {
        let (cell, offset) = self.cell(p)?;
        let row = self.row(cell[1]);
        let x = lerp(offset, row[cell[0]], row[cell[0] + 1]);
        Some(Vec2::new(x, self.marginal.invert(p.y)?).min(Vec2::splat(ONE_MINUS_EPSILON)))
    }

    #[inline]
    fn row(&self, row: usize) -> &[f32] {
        &self.conditional[row * (self.width + 1)..(row + 1) * (self.width + 1)]
    }

    /// The cell that holds `p`, and where in it along x.
    #[inline]
    fn cell(&self, p: Vec2) -> Option<([usize; 2], f32)> {
        if !(p.cmpge(self.min).all() && p.cmple(self.max).all()) {
            return None;
        }
        let size = Vec2::new(self.width as f32, self.marginal.len() as f32);
        let place = (p - self.min) / (self.max - self.min) * size;
        let column = (place.x as usize).min(self.width - 1);
        let row = (place.y as usize).min(self.marginal.len() - 1);
        Some(([column, row], place.x - column as f32))
    }
}
