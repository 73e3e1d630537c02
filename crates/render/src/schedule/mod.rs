//! The schedule: which pixels are rendered when and by whom.
//!
//! The work is cut into items, a block of samples of a tile of pixels each, which the threads take from a shared counter.
//! A sample is a pure function of the scene, the seed, the pixel and its index, and the film adds exactly: neither the
//! cut nor the order nor the number of threads can change the picture.
//!
//! A render takes as many samples a pixel as it is told, or as many as bring the noise to a target ([`NoiseSettings`]).

mod adaptive;
mod estimator;
mod frozen;
mod items;
mod render;
mod settings;
mod statistics;

pub use adaptive::{
    Allocation, Noise, NoiseReport, NoiseSettings, Stop, box_mean, brightness, relative_error, tile_sums,
};
pub use estimator::PixelEstimator;
pub use frozen::Frozen;
pub use render::{Progress, Render, render};
pub use settings::{RenderSettings, TileOrder};
pub use statistics::{DroppedSample, Statistics};
