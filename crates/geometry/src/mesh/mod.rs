//! Meshes: shared vertices, and what is wrong with bad ones.

mod bilinear_mesh;
mod triangle_mesh;

pub use bilinear_mesh::BilinearMesh;
pub use triangle_mesh::TriangleMesh;
pub(crate) use triangle_mesh::is_degenerate;

use rayon::prelude::*;
use tenfold_math::{Transform, Vec2, Vec3, prefetch};

/// What a mesh is made from, still in object space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshParts {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex normals, of any length.
    pub normals: Option<Vec<Vec3>>,
    /// Vertex tangents (pbrt's "S").
    pub tangents: Option<Vec<Vec3>>,
    /// Vertex texture coordinates.
    pub uvs: Option<Vec<Vec2>>,
    /// Vertex indices: three for a triangle, four for a patch (in the order 00, 10, 01, 11).
    pub indices: Vec<u32>,
    /// For each primitive, the face of the file that it came from.
    pub face_indices: Option<Vec<u32>>,
}

/// Why a mesh was refused.
#[derive(Copy, Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// There are not whole primitives in the index list.
    #[error("the number of vertex indices, {count}, is not a multiple of {arity}")]
    IndexCount {
        /// How many indices there are.
        count: usize,
        /// Vertices of one primitive.
        arity: usize,
    },
    /// An index points past the last vertex.
    #[error("vertex index {index} (number {at} of the list) is out of range: there are {vertices} vertices")]
    IndexOutOfRange {
        /// Its position in the list.
        at: usize,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An attribute has another number of values than there are vertices or primitives.
    #[error("there are {count} {attribute}, but {expected} are needed")]
    AttributeCount {
        /// The attribute's name in the plural.
        attribute: &'static str,
        /// How many values it has.
        count: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A value is NaN or infinite.
    #[error("value {at} of the {attribute} is not finite")]
    NotFinite {
        /// The attribute's name in the plural.
        attribute: &'static str,
        /// The index of the value.
        at: usize,
    },
    /// There are more primitives than an index can name.
    #[error("{count} primitives are too many for one mesh")]
    TooLarge {
        /// How many there are.
        count: usize,
    },
}

impl MeshParts {
    /// Refuses what cannot be a mesh of primitives with `arity` vertices.
    pub(crate) fn validate(&self, arity: usize) -> Result<(), MeshError> {
        let (count, vertices) = (self.indices.len(), self.positions.len());
        if count % arity != 0 {
            return Err(MeshError::IndexCount { count, arity });
        }
        if count / arity >= (1 << 31) {
            return Err(MeshError::TooLarge { count: count / arity });
        }
        let lengths = [
            ("normals", self.normals.as_ref().map(Vec::len), vertices),
            ("tangents", self.tangents.as_ref().map(Vec::len), vertices),
            ("texture coordinates", self.uvs.as_ref().map(Vec::len), vertices),
            ("face indices", self.face_indices.as_ref().map(Vec::len), count / arity),
        ];
        for (attribute, length, expected) in lengths {
            if let Some(count) = length.filter(|&length| length != expected) {
                return Err(MeshError::AttributeCount { attribute, count, expected });
            }
        }
        if let Some(at) = first(&self.indices, |&i| i as usize >= vertices) {
            return Err(MeshError::IndexOutOfRange { at, index: self.indices[at], vertices });
        }
        self.check_finite()
    }

    /// Refuses values that are not finite.
    fn check_finite(&self) -> Result<(), MeshError> {
        finite("positions", &self.positions, |p| p.is_finite())?;
        finite("normals", self.normals.as_deref().unwrap_or(&[]), |n| n.is_finite())?;
        finite("tangents", self.tangents.as_deref().unwrap_or(&[]), |s| s.is_finite())?;
        finite("texture coordinates", self.uvs.as_deref().unwrap_or(&[]), |uv| uv.is_finite())
    }

    /// The parts mapped by `to_world`. Normals turn around with reversed orientation, as pbrt has it.
    pub(crate) fn transformed(mut self, to_world: &Transform, reverse_orientation: bool) -> Self {
        let sign = if reverse_orientation { -1.0 } else { 1.0 };
        each(&mut self.positions, |p| to_world.point(p));
        each(self.normals.as_deref_mut().unwrap_or_default(), |n| sign * to_world.normal(n));
        each(self.tangents.as_deref_mut().unwrap_or_default(), |s| to_world.vector(s));
        self
    }
}

/// Primitives of `N` corners that share vertices, in world space (or in that of an instance).
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh<const N: usize> {
    pub(crate) parts: MeshParts,
    /// Whether geometric normals are turned around against the order of the vertices: reversed orientation or a mirroring
    /// transform, but not both.
    pub(crate) flip: bool,
    /// Whether every vertex is of one corner, in the order of the corners: indices say nothing then, and are not read.
    is_separate: bool,
}

impl<const N: usize> Mesh<N> {
    /// A mesh whose `parts` are mapped by `to_world`.
    ///
    /// # Errors
    /// Where indices or attributes do not fit, or a value is not finite, before or after the mapping.
    pub fn new(parts: MeshParts, to_world: &Transform, reverse_orientation: bool) -> Result<Self, MeshError> {
        parts.validate(N)?;
        let parts = parts.transformed(to_world, reverse_orientation);
        parts.check_finite()?;
        Ok(Self::of(parts, reverse_orientation ^ to_world.swaps_handedness()))
    }

    /// A mesh of valid parts in world space.
    pub(crate) fn of(parts: MeshParts, flip: bool) -> Self {
        let is_separate = parts.indices.iter().enumerate().all(|(corner, &vertex)| vertex as usize == corner);
        Self { parts, flip, is_separate }
    }

    /// The same primitives with vertices of their own: for primitives that are looked up anywhere, in memory that is far away. `None` where they
    /// have them.
    #[must_use]
    pub fn separated(&self) -> Option<Self> {
        let parts = &self.parts;
        if self.is_separate || u32::try_from(parts.indices.len()).is_err() {
            return None;
        }
        fn each<T: Copy>(indices: &[u32], values: &[T]) -> Vec<T> {
            indices.iter().map(|&vertex| values[vertex as usize]).collect()
        }
        let parts = MeshParts {
            positions: each(&parts.indices, &parts.positions),
            normals: parts.normals.as_ref().map(|n| each(&parts.indices, n)),
            tangents: parts.tangents.as_ref().map(|s| each(&parts.indices, s)),
            uvs: parts.uvs.as_ref().map(|uv| each(&parts.indices, uv)),
            indices: (0..parts.indices.len() as u32).collect(),
            face_indices: parts.face_indices.clone(),
        };
        Some(Self::of(parts, self.flip))
    }

    /// How many primitives there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.parts.indices.len() / N
    }

    /// Whether there is no primitive.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.parts.indices.is_empty()
    }

    /// The parts, in world space.
    #[inline]
    pub fn parts(&self) -> &MeshParts {
        &self.parts
    }

    /// Vertex indices of a primitive.
    #[inline]
    pub fn corners(&self, primitive: usize) -> [usize; N] {
        if self.is_separate {
            return std::array::from_fn(|corner| N * primitive + corner);
        }
        let indices = &self.parts.indices[N * primitive..N * (primitive + 1)];
        std::array::from_fn(|corner| indices[corner] as usize)
    }

    /// The values that a vertex attribute has at the corners of a primitive.
    #[inline]
    fn at_corners<T: Copy>(&self, primitive: usize, attribute: &[T]) -> [T; N] {
        self.corners(primitive).map(|vertex| attribute[vertex])
    }

    /// Vertex positions of a primitive.
    #[inline]
    pub fn positions(&self, primitive: usize) -> [Vec3; N] {
        self.at_corners(primitive, &self.parts.positions)
    }

    /// Vertex positions of a primitive, where they lie beside each other.
    #[inline]
    pub(crate) fn separate_positions(&self, primitive: usize) -> Option<&[Vec3; N]> {
        if self.is_separate { self.parts.positions[N * primitive..].first_chunk() } else { None }
    }

    /// Begins to load the vertex positions of a primitive, where they lie beside each other.
    #[inline]
    pub(crate) fn prefetch(&self, primitive: usize) {
        if let Some(positions) = self.separate_positions(primitive) {
            prefetch(positions);
        }
    }

    /// Vertex normals of a primitive, of any length.
    #[inline]
    pub fn normals(&self, primitive: usize) -> Option<[Vec3; N]> {
        self.parts.normals.as_ref().map(|n| self.at_corners(primitive, n))
    }

    /// The face of the file that a primitive came from; 0 where it is not known.
    #[inline]
    pub fn face_index(&self, primitive: usize) -> u32 {
        self.parts.face_indices.as_ref().map_or(0, |f| f[primitive])
    }
}

fn finite<T: Sync>(
    attribute: &'static str,
    values: &[T],
    is_finite: impl Fn(&T) -> bool + Send + Sync,
) -> Result<(), MeshError> {
    match first(values, |v| !is_finite(v)) {
        Some(at) => Err(MeshError::NotFinite { attribute, at }),
        None => Ok(()),
    }
}

/// Values in one piece of work, at least: meshes are mostly small, but some have millions of vertices.
const GRAIN: usize = 1 << 14;

/// Where the first value is that a predicate holds for.
fn first<T: Sync>(values: &[T], holds: impl Fn(&T) -> bool + Send + Sync) -> Option<usize> {
    values.par_chunks(GRAIN).enumerate().find_map_first(|(i, chunk)| {
        // Without branches, which vector code has none of: mostly there is none.
        let is_there = chunk.iter().fold(false, |any, value| any | holds(value));
        let at = || chunk.iter().position(&holds).map(|at| GRAIN * i + at);
        if is_there { at() } else { None }
    })
}

/// Maps all values.
fn each(values: &mut [Vec3], map: impl Fn(Vec3) -> Vec3 + Send + Sync) {
    values.par_iter_mut().with_min_len(GRAIN).for_each(|v| *v = map(*v));
}
