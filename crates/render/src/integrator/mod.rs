//! The path tracer.
//!
//! One sample of a pixel is one path (or, behind dispersive glass, a few): from the camera backward, at every surface
//! with a light sampled next to the scattered direction, the two combined by multiple importance sampling
//! (Veach 1997, §9.2; other [`Strategies`] are there for comparison), for four wavelengths at once.

mod combine;
mod even;
mod path;
mod spectral;
mod strategies;
mod tracer;
mod wave;
mod weights;

pub use combine::CombineStrategy;
pub use spectral::DispersionRule;
pub use strategies::Strategies;
pub use tracer::{PathTracer, RayCounts, Sample, Workspace};
