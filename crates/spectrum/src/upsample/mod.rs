//! RGB to smooth spectra: Jakob and Hanika 2019, *A Low-Dimensional Function Space for Efficient Spectral Upsampling*.

mod solve;
mod table;

pub(crate) use solve::Solver;
pub use table::SigmoidTable;
