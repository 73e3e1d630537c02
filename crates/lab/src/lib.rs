//! Experiments on the renderer, and the pages that show what came out.
//!
//! An experiment is a function from what it looks at and its options to a plain struct of numbers; another function
//! makes a [`Page`] of that: one HTML file that needs nothing else, with its numbers as CSV files beside it. [`plot`] draws the
//! figures, [`Picture`] holds the pictures. An experiment that takes long tells of its [`Work`].

pub mod attribution;
pub mod convergence;
pub mod effects;
pub mod page;
mod picture;
pub mod plot;
pub mod portrait;
mod table;
mod work;

pub use page::Page;
pub use picture::Picture;
pub use table::{Cell, Table};
pub use work::{Interrupted, Work};
