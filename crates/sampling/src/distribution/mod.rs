//! Tabulated distributions: sums are made in double precision in the order of the table, so that they are the same everywhere.

mod alias;
mod discrete;
mod piecewise_1d;
mod piecewise_2d;
mod piecewise_linear;

pub use alias::AliasTable;
pub use discrete::{DiscreteSample, sample_discrete};
pub use piecewise_1d::{PiecewiseConstant1D, Sample1D};
pub use piecewise_2d::{PiecewiseConstant2D, Sample2D};
pub use piecewise_linear::PiecewiseLinear1D;

use tenfold_math::find_interval;

/// What a table may hold: negative and infinite values and NaN count as zero.
fn sanitize(f: f32) -> f32 {
    if f.is_finite() && f > 0.0 { f } else { 0.0 }
}

/// Fills `cdf`, one longer than `f`, with the running sums of `f` from 0 to exactly 1, and returns the mean of `f`. Where all of `f` is
/// zero the distribution is uniform and the mean 0.
fn accumulate(f: &[f32], cdf: &mut [f32]) -> f64 {
    let total: f64 = f.iter().map(|&f| f64::from(f)).sum();
    let n = f.len() as f64;
    let mut sum = 0.0;
    cdf[0] = 0.0;
    for (i, &f) in f.iter().enumerate() {
        sum += f64::from(f);
        cdf[i + 1] = if total > 0.0 { sum / total } else { (i + 1) as f64 / n } as f32;
    }
    total / n
}

/// The cell of `cdf` that holds `u`, and the place within it in `[0, 1)`.
#[inline]
fn locate(cdf: &[f32], u: f32) -> (usize, f32) {
    let cell = find_interval(cdf.len(), |i| cdf[i] <= u);
    let width = cdf[cell + 1] - cdf[cell];
    let offset = if width > 0.0 { (u - cdf[cell]) / width } else { 0.0 };
    (cell, offset.clamp(0.0, tenfold_math::ONE_MINUS_EPSILON))
}
