use super::Mesh;
use tenfold_math::Vec2;

/// Bilinear patches that share vertices. The corners of a patch are given in the order (u, v) = (0,0), (1,0), (0,1), (1,1);
/// tangents are not used.
pub type BilinearMesh = Mesh<4>;

impl BilinearMesh {
    /// Texture coordinates at the corners of a patch, where the mesh has them.
    #[inline]
    pub fn uvs(&self, patch: usize) -> Option<[Vec2; 4]> {
        self.parts.uvs.as_ref().map(|uvs| self.at_corners(patch, uvs))
    }
}
