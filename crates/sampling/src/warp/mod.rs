//! Maps of uniform numbers to points and directions, each with its density and, where there is one, its inverse.
//!
//! Every map is continuous in its arguments up to measure zero, so that a well-spread pattern of numbers stays well spread.

mod cone;
mod disk;
mod hemisphere;
mod line;
mod normal;
mod spherical_rectangle;
mod spherical_triangle;
mod triangle;

pub use cone::{invert_uniform_cone, sample_uniform_cone, uniform_cone_pdf};
pub use disk::{
    invert_uniform_disk_concentric, invert_uniform_disk_polar, sample_uniform_disk_concentric,
    sample_uniform_disk_polar, uniform_disk_pdf,
};
pub use hemisphere::{
    cosine_hemisphere_pdf, invert_cosine_hemisphere, invert_uniform_hemisphere, invert_uniform_sphere,
    sample_cosine_hemisphere, sample_uniform_hemisphere, sample_uniform_sphere, uniform_hemisphere_pdf,
    uniform_sphere_pdf,
};
pub use line::{
    bilinear_pdf, exponential_pdf, invert_bilinear, invert_exponential, invert_linear, invert_tent,
    linear_pdf, sample_bilinear, sample_exponential, sample_linear, sample_tent, tent_pdf,
};
pub use normal::{TruncatedNormal, erf, invert_normal, normal_pdf, sample_normal, sample_two_normals};
pub use spherical_rectangle::SphericalRectangle;
pub use spherical_triangle::{SphericalTriangle, TrianglePoint};
use tenfold_math::ops;
pub use triangle::{invert_uniform_triangle, sample_uniform_triangle};

use std::f32::consts::TAU;

/// The azimuth of `(x, y)` as a fraction of a turn in `[0, 1)`.
#[inline]
fn turn(x: f32, y: f32) -> f32 {
    let t = ops::atan2(y, x) / TAU;
    // A tiny negative angle plus one rounds to one.
    if t < 0.0 { (t + 1.0).min(tenfold_math::ONE_MINUS_EPSILON) } else { t }
}
