use super::{MeshError, MeshParts};
use tenfold_math::{Transform, Vec2, Vec3};

/// Triangles that share vertices, in world space (or in that of an instance).
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    pub(crate) parts: MeshParts,
    /// Whether geometric normals are turned around against the order of the vertices: reversed orientation or a mirroring
    /// transform, but not both.
    pub(crate) flip: bool,
}

impl TriangleMesh {
    /// A mesh whose `parts` are mapped by `to_world`.
    ///
    /// # Errors
    /// Where indices or attributes do not fit, or a value is not finite, before or after the mapping.
    pub fn new(parts: MeshParts, to_world: &Transform, reverse_orientation: bool) -> Result<Self, MeshError> {
        parts.validate(3)?;
        let parts = parts.transformed(to_world, reverse_orientation);
        parts.validate(3)?;
        Ok(Self { parts, flip: reverse_orientation ^ to_world.swaps_handedness() })
    }

    /// How many triangles there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.parts.indices.len() / 3
    }

    /// Whether there is no triangle.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.parts.indices.is_empty()
    }

    /// The parts, in world space.
    #[inline]
    pub fn parts(&self) -> &MeshParts {
        &self.parts
    }

    /// Vertex indices of a triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [usize; 3] {
        let i = &self.parts.indices[3 * triangle..3 * triangle + 3];
        [i[0] as usize, i[1] as usize, i[2] as usize]
    }

    /// Vertex positions of a triangle.
    #[inline]
    pub fn positions(&self, triangle: usize) -> [Vec3; 3] {
        self.corners(triangle).map(|i| self.parts.positions[i])
    }

    /// Texture coordinates at the corners of a triangle: (0,0), (1,0), (1,1) where the mesh has none.
    #[inline]
    pub fn uvs(&self, triangle: usize) -> [Vec2; 3] {
        match &self.parts.uvs {
            Some(uvs) => self.corners(triangle).map(|i| uvs[i]),
            None => [Vec2::ZERO, Vec2::X, Vec2::ONE],
        }
    }

    /// Vertex normals of a triangle, of any length.
    #[inline]
    pub fn normals(&self, triangle: usize) -> Option<[Vec3; 3]> {
        self.parts.normals.as_ref().map(|n| self.corners(triangle).map(|i| n[i]))
    }

    /// Vertex tangents of a triangle, of any length.
    #[inline]
    pub fn tangents(&self, triangle: usize) -> Option<[Vec3; 3]> {
        self.parts.tangents.as_ref().map(|s| self.corners(triangle).map(|i| s[i]))
    }

    /// The face of the file that a triangle came from; 0 where it is not known.
    #[inline]
    pub fn face_index(&self, triangle: usize) -> u32 {
        self.parts.face_indices.as_ref().map_or(0, |f| f[triangle])
    }

    /// How many triangles have no area: no ray can hit them.
    pub fn degenerate_count(&self) -> usize {
        (0..self.len()).filter(|&i| is_degenerate(self.positions(i))).count()
    }
}

/// Whether a triangle has no area, in float arithmetic.
pub(crate) fn is_degenerate([a, b, c]: [Vec3; 3]) -> bool {
    let area = (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared();
    !(area > 0.0 && area.is_finite())
}
