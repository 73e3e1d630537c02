use super::{MeshError, MeshParts};
use tenfold_math::{Transform, Vec2, Vec3};

/// Bilinear patches that share vertices, in world space (or in that of an instance). The corners of a patch are given in
/// the order (u, v) = (0,0), (1,0), (0,1), (1,1).
#[derive(Clone, Debug, PartialEq)]
pub struct BilinearMesh {
    pub(crate) parts: MeshParts,
    /// Whether geometric normals are turned around against the order of the vertices: reversed orientation or a mirroring
    /// transform, but not both.
    pub(crate) flip: bool,
}

impl BilinearMesh {
    /// A mesh whose `parts` are mapped by `to_world`; tangents are not used.
    ///
    /// # Errors
    /// Where indices or attributes do not fit, or a value is not finite, before or after the mapping.
    pub fn new(parts: MeshParts, to_world: &Transform, reverse_orientation: bool) -> Result<Self, MeshError> {
        parts.validate(4)?;
        let parts = parts.transformed(to_world, reverse_orientation);
        parts.validate(4)?;
        Ok(Self { parts, flip: reverse_orientation ^ to_world.swaps_handedness() })
    }

    /// How many patches there are.
    #[inline]
    pub fn len(&self) -> usize {
        self.parts.indices.len() / 4
    }

    /// Whether there is no patch.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.parts.indices.is_empty()
    }

    /// The parts, in world space.
    #[inline]
    pub fn parts(&self) -> &MeshParts {
        &self.parts
    }

    /// Vertex indices of a patch.
    #[inline]
    pub fn corners(&self, patch: usize) -> [usize; 4] {
        let i = &self.parts.indices[4 * patch..4 * patch + 4];
        [i[0] as usize, i[1] as usize, i[2] as usize, i[3] as usize]
    }

    /// Vertex positions of a patch.
    #[inline]
    pub fn positions(&self, patch: usize) -> [Vec3; 4] {
        self.corners(patch).map(|i| self.parts.positions[i])
    }

    /// Texture coordinates at the corners of a patch, where the mesh has them.
    #[inline]
    pub fn uvs(&self, patch: usize) -> Option<[Vec2; 4]> {
        self.parts.uvs.as_ref().map(|uvs| self.corners(patch).map(|i| uvs[i]))
    }

    /// Vertex normals of a patch, of any length.
    #[inline]
    pub fn normals(&self, patch: usize) -> Option<[Vec3; 4]> {
        self.parts.normals.as_ref().map(|n| self.corners(patch).map(|i| n[i]))
    }

    /// The face of the file that a patch came from; 0 where it is not known.
    #[inline]
    pub fn face_index(&self, patch: usize) -> u32 {
        self.parts.face_indices.as_ref().map_or(0, |f| f[patch])
    }
}
