//! Vectors, transforms, motion, bounds, frames and rays.
//!
//! Points, vectors and normals are all [`Vec3`]: what a value means is said by the function that takes it
//! ([`Transform::point`], [`Transform::vector`], [`Transform::normal`]).

mod bounds;
mod frame;
mod id;
mod motion;
mod octahedral;
pub mod ops;
mod prefetch;
mod ray;
mod scalar;
mod spherical;
mod transform;
mod wide;

pub use bounds::Bounds3;
pub use frame::Frame;
pub use glam::{Affine3A, DVec2, DVec3, Mat3, Mat4, Quat, UVec2, Vec2, Vec3, Vec3A, Vec4, vec2, vec3};
pub use id::Id;
pub use motion::{Key, Motion, Trs};
pub use octahedral::{equal_area_sphere_to_square, equal_area_square_to_sphere};
pub use prefetch::prefetch;
pub use ray::{Ray, offset_ray_origin};
pub use scalar::{find_interval, gamma, higher, lerp, lower, next_up, sqr};
pub use spherical::{
    angle_between, direction_to_spherical, spherical_direction, spherical_quad_area, spherical_triangle_area,
};
pub use transform::Transform;
pub use wide::{Floats, Rays, Slots, Vec2s, Vec3s, WIDTH, normalize, select};

/// The largest float below one: uniform random numbers lie in `[0, ONE_MINUS_EPSILON]`.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;
