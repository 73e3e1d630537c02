//! Tests of the geometry crate through its public interface, in one program.

mod common;
mod hierarchy;
mod sampling;
mod surfaces;
mod watertight;
