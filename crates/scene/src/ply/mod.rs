//! The reader of the PLY format for meshes (G. Turk, "The PLY Polygon File Format", 1994), as far as pbrt's `plymesh` goes.

mod body;
mod bulk;
mod header;

use crate::LargeFile;
use std::borrow::Cow;
use tenfold_math::{Vec2, Vec3};

/// A mesh of triangles and quadrilaterals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlyMesh {
    /// The vertices; finite.
    pub positions: Vec<Vec3>,
    /// The normals: one a vertex, or none.
    pub normals: Vec<Vec3>,
    /// The texture coordinates: one pair a vertex, or none.
    pub uvs: Vec<Vec2>,
    /// The corners of the triangles; all are vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The corners of the quadrilaterals in the order of a bilinear patch: (0,0), (1,0), (0,1), (1,1). The file has
    /// them around the perimeter; pbrt's `plymesh` swaps the last two in the same way.
    pub quads: Vec<[u32; 4]>,
    /// A number for every face that the file gives, or none: those of the triangles, then those of the quadrilaterals.
    pub face_indices: Vec<i32>,
}

/// Why a PLY file cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlyError {
    /// It does not begin with the word `ply`.
    #[error("this is not a PLY file")]
    NotPly,
    /// Its gzip packing is damaged.
    #[error("the gzip data are damaged: {0}")]
    Gzip(String),
    /// A line of the header means nothing.
    #[error("line {line} of the header: {message}")]
    Header {
        /// The line, from one.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// The header has no end.
    #[error("the header has no `end_header`")]
    UnfinishedHeader,
    /// There are no vertices, or no faces.
    #[error("there are no {0}")]
    Empty(&'static str),
    /// An element lacks a property.
    #[error("element \"{element}\" has no property \"{property}\"")]
    MissingProperty {
        /// The element.
        element: &'static str,
        /// The property.
        property: &'static str,
    },
    /// A property is a list and should not be, or the other way round.
    #[error("property \"{0}\" is a list where one number belongs, or the other way round")]
    WrongShape(String),
    /// The header claims more than the file can hold.
    #[error("the header claims {count} of \"{element}\", more than a file of {bytes} bytes can hold")]
    TooLarge {
        /// The element.
        element: String,
        /// How many it is said to have.
        count: u64,
        /// The size of the file, unpacked.
        bytes: usize,
    },
    /// The file ends too early.
    #[error("the file ends in item {index} of \"{element}\"")]
    Truncated {
        /// The element.
        element: String,
        /// The item, from zero.
        index: u64,
    },
    /// A word of an ASCII file is not a number.
    #[error("item {index} of \"{element}\" has \"{word}\" where a number belongs")]
    NotANumber {
        /// The element.
        element: String,
        /// The item, from zero.
        index: u64,
        /// The word.
        word: String,
    },
    /// A position, a normal or a texture coordinate is NaN or infinite.
    #[error("vertex {0} has a coordinate that is not finite")]
    NotFinite(u64),
    /// A face has fewer than three or more than four corners.
    #[error("face {face} has {corners} corners: only triangles and quadrilaterals are supported")]
    Polygon {
        /// The face, from zero.
        face: u64,
        /// How many corners it has.
        corners: i64,
    },
    /// A face refers to a vertex that is not there.
    #[error("face {face} has the vertex {index}, but there are only {vertices}, counted from 0")]
    IndexOutOfRange {
        /// The face, from zero.
        face: u64,
        /// The vertex that it names.
        index: i64,
        /// How many vertices there are.
        vertices: u64,
    },
}

/// How much a packed file may hold.
const MAX_UNPACKED: u64 = 1 << 32;

/// Reads a mesh from the bytes of a PLY file: ASCII or binary of either byte order, packed by gzip or not.
///
/// Vertices take their normals from `nx ny nz` and their texture coordinates from `u v`, `s t`, `texture_u texture_v` or
/// `texture_s texture_t`; faces have `vertex_indices` or `vertex_index`, and may have `face_indices`.
///
/// # Errors
/// Where the file is damaged, truncated, claims more than it holds, refers to vertices that are not there, or has
/// faces of fewer than three or more than four corners.
pub fn read_ply(bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let bytes = if bytes.starts_with(&[0x1f, 0x8b]) {
        let unpacked = crate::unpack(bytes.to_vec(), MAX_UNPACKED);
        Cow::Owned(unpacked.map_err(|error| PlyError::Gzip(error.to_string()))?)
    } else {
        Cow::Borrowed(bytes)
    };
    let header = header::parse(&bytes)?;
    body::read(&header, &bytes)
}

/// A header that is longer is not looked for in pieces.
const HEAD: u64 = 1 << 14;

/// As [`read_ply`], from a file whose bytes are not kept: where it is binary, and the items of its elements all have the same size. `None` where they do not,
/// or anything is wrong: [`read_ply`] reads the others, and says what.
pub fn read_ply_in_pieces(file: &LargeFile) -> Option<PlyMesh> {
    let mut head = vec![0; HEAD.min(file.len()) as usize];
    file.read_at(0, &mut head).ok()?;
    // Of a line that ends here the end is not known.
    let header = header::parse(&head).ok().filter(|header| header.body < head.len())?;
    body::read_pieces(&header, file)
}
