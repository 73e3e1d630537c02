use super::{accumulate, locate, sanitize};
use tenfold_math::{find_interval, lerp};

/// A density in proportion to a table of values over equal cells of a range (pbrt book §A.4.7).
///
/// Negative and infinite values and NaN count as zero. Where all values are zero, or there are none, the density is uniform.
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseConstant1D {
    f: Vec<f32>,
    cdf: Vec<f32>,
    min: f32,
    max: f32,
    mean: f64,
}

/// A sample of a [`PiecewiseConstant1D`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Sample1D {
    /// The place in the range.
    pub x: f32,
    /// Density per unit of the range.
    pub pdf: f32,
    /// The cell of the table it is in.
    pub cell: usize,
    /// Where in that cell, in `[0, 1)`.
    pub offset: f32,
}

impl PiecewiseConstant1D {
    /// Over `[0, 1]`.
    pub fn new(f: &[f32]) -> Self {
        Self::with_range(f, 0.0, 1.0)
    }

    /// Over `[min, max]`.
    pub fn with_range(f: &[f32], min: f32, max: f32) -> Self {
        let f: Vec<f32> = if f.is_empty() { vec![0.0] } else { f.iter().map(|&f| sanitize(f)).collect() };
        let mut cdf = vec![0.0; f.len() + 1];
        let mean = accumulate(&f, &mut cdf);
        Self { f, cdf, min, max, mean }
    }

    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.f.len()
    }

    /// Never: an empty table counts as one cell.
    pub fn is_empty(&self) -> bool {
        self.f.is_empty()
    }

    /// The integral of the table over its range.
    pub fn integral(&self) -> f32 {
        (self.mean * (f64::from(self.max) - f64::from(self.min))) as f32
    }

    /// A place in the range.
    #[inline]
    pub fn sample(&self, u: f32) -> Sample1D {
        let (cell, offset) = locate(&self.cdf, u);
        let x = lerp((cell as f32 + offset) / self.len() as f32, self.min, self.max);
        Sample1D { x, pdf: self.pdf_of_cell(cell), cell, offset }
    }

    /// Density at `x` per unit of the range; zero outside.
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        self.cell(x).map_or(0.0, |(cell, _)| self.pdf_of_cell(cell))
    }

    /// Probability of a cell of the table.
    #[inline]
    pub fn pmf(&self, cell: usize) -> f32 {
        self.pdf_of_cell(cell) * (self.max - self.min) / self.len() as f32
    }

    /// The number that [`Self::sample`] maps to `x`; `None` outside of the range.
    #[inline]
    pub fn invert(&self, x: f32) -> Option<f32> {
        self.cell(x).map(|(cell, offset)| lerp(offset, self.cdf[cell], self.cdf[cell + 1]))
    }

    /// Density in a cell of the table.
    #[inline]
    pub fn pdf_of_cell(&self, cell: usize) -> f32 {
        let relative = if self.mean > 0.0 { (f64::from(self.f[cell]) / self.mean) as f32 } else { 1.0 };
        relative / (self.max - self.min)
    }

    #[inline]
    fn cell(&self, x: f32) -> Option<(usize, f32)> {
        if !(self.min..=self.max).contains(&x) {
            return None;
        }
        let place = (x - self.min) / (self.max - self.min) * self.len() as f32;
        let cell = (place as usize).min(self.len() - 1);
        Some((cell, place - cell as f32))
    }

    /// The cell that holds the number `u`, as [`Self::sample`] finds it.
    #[inline]
    pub fn cell_of(&self, u: f32) -> usize {
        find_interval(self.cdf.len(), |i| self.cdf[i] <= u)
    }
}
