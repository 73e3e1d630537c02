//! Chi-squared and t tests, quadrature and image comparison: used by tests only.
//!
//! Unlike the rest of the project, this crate may panic: [`chi2::ChiSquared::check`] and its kin are assertions.

pub mod chi2;
pub mod image;
pub mod quadrature;
mod rng;
pub mod special;
pub mod stats;

pub use chi2::{ChiSquared, Options};
pub use rng::Rng;
pub use stats::{TTest, Welford, sidak, t_test_mean, t_test_two};
