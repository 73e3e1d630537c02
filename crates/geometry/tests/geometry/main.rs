//! Tests of the geometry crate through its public interface, in one program.

mod common;
mod hierarchy;
mod sampling;
mod slots;
mod surfaces;
mod watertight;
