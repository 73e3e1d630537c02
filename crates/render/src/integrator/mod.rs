//! The path tracer.
//!
//! One sample of a pixel is one path (or, behind dispersive glass, a few): from the camera backward, at every surface
//! with a light sampled next to the scattered direction, the two combined by multiple importance sampling
//! (Veach 1997, §9.2; other [`Strategies`] are there for comparison), for four wavelengths at once.
//!
//! The paths of sixteen samples of a pixel take every step together ([`PathTracer::trace`]): they meet surfaces, find light, and scatter. What is the same for all of
//! them is computed in vector instructions, the rest for one path after another; either way an estimate has the bits that it has alone.

mod boundary;
mod combine;
mod direct;
mod even;
mod kinds;
mod meet;
mod metal;
mod passing;
mod path;
mod scatter;
mod spectral;
mod strategies;
mod surfaces;
mod tracer;
mod vertices;
mod wave;
mod weights;

pub use combine::CombineStrategy;
pub use spectral::DispersionRule;
pub use strategies::Strategies;
pub use tracer::{PathTracer, RayCounts, Sample, Workspace};
