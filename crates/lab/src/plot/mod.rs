//! Plots as SVG elements for pages.
//!
//! They are written here and not by a plotting library (`plotters` and the like) because those write fixed colours: what is
//! drawn here takes its colours from the page's style sheet, by class and `currentColor`, and so follows light and dark.
//! The colours are those of Okabe and Ito (2008), which the colour-blind can tell apart; marks differ in shape, too.

mod axis;
mod bars;
mod chart;
mod svg;

pub use axis::{Axis, Scale};
pub use bars::{Bars, Group};
pub use chart::{Chart, Mark, Point, Series};

/// How many colours there are before they repeat.
pub const COLORS: usize = 8;
