//! The choice of a light: near, bright ones that face the point in question more often.

mod bounds;
mod clusters;
mod cone;
mod descent;
mod split;
mod tree;

pub use bounds::LightBounds;
pub(crate) use tree::MAX_LIGHTS;
pub(super) use tree::{Entry, LightTree, TreeSample};
