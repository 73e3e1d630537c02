//! From a scene's description to its picture.
//!
//! [`compile::compile`] checks a description and makes a [`scene::Scene`] of it, or reports what is wrong with it;
//! [`schedule::render`] renders that to a [`film::Film`], on many threads, by the paths of [`integrator::PathTracer`].
//!
//! Everything else is a family of things that scenes are made of, each in a module of its own: scattering functions ([`bxdf`]),
//! [`texture`]s, [`material`]s, [`light`]s, [`camera`]s and pixel [`filter`]s. Nothing depends on anything but the scene, the settings and
//! the seed: the same picture comes out bit for bit, whatever the threads and tiles.

pub mod bxdf;
pub mod camera;
pub mod compile;
pub mod film;
pub mod filter;
pub mod integrator;
pub mod light;
pub mod material;
pub mod movers;
pub mod scene;
pub mod schedule;
pub mod texture;
