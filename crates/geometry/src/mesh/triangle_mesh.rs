use super::Mesh;
use tenfold_math::{Vec2, Vec3};

/// Triangles that share vertices.
pub type TriangleMesh = Mesh<3>;

impl TriangleMesh {
    /// Texture coordinates at the corners of a triangle: (0,0), (1,0), (1,1) where the mesh has none.
    #[inline]
    pub fn uvs(&self, triangle: usize) -> [Vec2; 3] {
        match &self.parts.uvs {
            Some(uvs) => self.at_corners(triangle, uvs),
            None => [Vec2::ZERO, Vec2::X, Vec2::ONE],
        }
    }

    /// Vertex tangents of a triangle, of any length.
    #[inline]
    pub fn tangents(&self, triangle: usize) -> Option<[Vec3; 3]> {
        self.parts.tangents.as_ref().map(|s| self.at_corners(triangle, s))
    }

    /// Whether no triangle has any area: no ray can hit them.
    pub fn has_no_area(&self) -> bool {
        (0..self.len()).all(|i| is_degenerate(self.positions(i)))
    }
}

/// Whether a triangle has no area, in float arithmetic.
pub(crate) fn is_degenerate([a, b, c]: [Vec3; 3]) -> bool {
    let area = (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared();
    !(area > 0.0 && area.is_finite())
}
