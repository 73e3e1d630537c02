//! The whole renderer against closed forms: scenes as text in, radiance or pictures out.
//!
//! Every comparison states its confidence: a right renderer fails a check with probability [`common::SIGNIFICANCE`], seeds are
//! fixed, and checks that could not see a fault of the stated size fail as well.

// Expected values are compared within errors that dwarf what the platform's functions may differ by.
#![allow(clippy::disallowed_methods)]

mod combined;
mod common;
mod dispersion;
mod equivalence;
mod frozen;
mod furnaces;
mod illuminants;
mod keys;
mod lens;
mod motion;
mod noise;
mod passing;
mod penumbra;
mod pictures;
mod prism;
mod shutter;
mod strategies;
