//! Subdivision surfaces.

mod loop_scheme;

pub use loop_scheme::{SubdivisionError, loop_subdivide};
