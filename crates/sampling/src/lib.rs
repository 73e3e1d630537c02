//! Named sample dimensions, samplers, warps with their densities, and tabulated distributions.
//!
//! A random number is a pure function of (seed, pixel, sample index, [`Dimension`]): a [`Sampler`] made from the settings
//! gives a [`PixelSample`] for a pixel and an index, and that answers for dimensions by name, in any order.
//! [`warp`] and [`distribution`] turn such numbers into points, directions and choices with known densities.

mod allocation;
mod dimension;
pub mod distribution;
mod group;
pub mod hash;
mod sampler;
pub mod warp;

pub use allocation::neyman_shares;
pub use dimension::{Dimension, Variable};
pub use distribution::{
    AliasTable, PiecewiseConstant1D, PiecewiseConstant2D, PiecewiseLinear1D, sample_discrete,
};
pub use hash::{hash, mix_bits};
pub use sampler::{Draw, Mapped, PixelSample, SampleGroup, SamplePlan, SampleRoom, Sampler, SamplerKind};
