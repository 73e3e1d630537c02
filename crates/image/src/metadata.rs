//! What a file says about an image besides its pixels.

use std::collections::BTreeMap;
use tenfold_math::Vec2;

/// CIE xy chromaticities of the red, green and blue primaries and of white, in this order.
pub type Chromaticities = [Vec2; 4];

/// A rectangle of pixels: its top left corner and its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Leftmost column.
    pub x: i32,
    /// Topmost row.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A named value in the header of an EXR file.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// A string of Latin-1 characters.
    Text(String),
    /// A single-precision number.
    F32(f32),
    /// An integer.
    I32(i32),
    /// A 4 × 4 matrix in row-major order, with OpenEXR's row vectors (`v · M`).
    Matrix([f32; 16]),
    /// A list of strings.
    TextList(Vec<String>),
}

/// What a file says about an image besides its pixels. Only EXR files store all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// The colour space of R, G and B; `None` means sRGB.
    pub chromaticities: Option<Chromaticities>,
    /// Where the pixels lie in the display window: the top left corner of the data window.
    pub origin: (i32, i32),
    /// The whole picture of which the pixels are a part; `None` where they are all of it.
    pub display_window: Option<Window>,
    /// Further attributes by name, such as `samplesPerPixel` or `worldToCamera`.
    pub attributes: BTreeMap<String, Attribute>,
}
