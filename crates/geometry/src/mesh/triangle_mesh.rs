use super::{BilinearMesh, Mesh, MeshParts};
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

    /// Whether the triangles have shading frames of their own: vertex normals or tangents.
    #[inline]
    pub(crate) fn has_frames(&self) -> bool {
        self.parts.normals.is_some() || self.parts.tangents.is_some()
    }

    /// The rectangles that the triangles make up, two after two, with the same geometric normals: to sample them as such. `None`
    /// where any pair does not, or where the mesh has normals of its own.
    pub fn rectangles(&self) -> Option<BilinearMesh> {
        if self.is_empty() || !self.len().is_multiple_of(2) || self.parts.normals.is_some() {
            return None;
        }
        let pairs = (0..self.len()).step_by(2);
        let positions = pairs.map(|i| rectangle(self.positions(i), self.positions(i + 1)));
        let positions = positions.collect::<Option<Vec<_>>>()?.into_flattened();
        let indices = (0..positions.len() as u32).collect();
        Some(BilinearMesh::of(MeshParts { positions, indices, ..MeshParts::default() }, self.flip))
    }

    /// Whether no triangle has any area: no ray can hit them.
    pub fn has_no_area(&self) -> bool {
        (0..self.len()).all(|i| is_degenerate(self.positions(i)))
    }
}

/// The corners of the rectangle that two triangles with the same sense make up, in the order of a patch.
fn rectangle(first: [Vec3; 3], second: [Vec3; 3]) -> Option<[Vec3; 4]> {
    let turned = |[a, b, c]: [Vec3; 3], by: usize| [[a, b, c], [b, c, a], [c, a, b]][by];
    for i in 0..3 {
        let [a, b, c] = turned(first, i);
        let fourth = (0..3).map(|k| turned(second, k)).find(|t| t[0] == a && t[1] == c);
        let Some([_, _, d]) = fourth else { continue };
        let size = [a, b, c, d].iter().fold(0f32, |m, p| m.max(p.abs().max_element()));
        let (u, v) = (b - a, d - a);
        // Off by no more than rounding: the points of the rectangle must be points of the triangles.
        let closes = (c - b - v).abs().max_element() <= 2.0 * f32::EPSILON * size;
        let is_right = u.dot(v).abs() <= 1e-5 * u.length() * v.length();
        return (closes && is_right && !is_degenerate(first) && !is_degenerate(second))
            .then_some([a, b, d, c]);
    }
    None
}

/// Whether a triangle has no area, in float arithmetic.
pub(crate) fn is_degenerate([a, b, c]: [Vec3; 3]) -> bool {
    let area = (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared();
    !(area > 0.0 && area.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::Transform;

    const QUAD: [[f32; 3]; 4] = [[1.0, 2.0, 3.0], [5.0, 2.0, 3.0], [5.0, 2.0, 4.0], [1.0, 2.0, 4.0]];

    fn mesh(positions: &[[f32; 3]], indices: &[u32]) -> TriangleMesh {
        let positions = positions.iter().map(|&p| p.into()).collect();
        let parts = MeshParts { positions, indices: indices.to_vec(), ..MeshParts::default() };
        TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap()
    }

    #[test]
    fn pairs_that_make_up_rectangles_are_found() {
        for first in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            for second in [[0, 2, 3], [2, 3, 0], [3, 0, 2]] {
                let found = mesh(&QUAD, &[first, second].concat()).rectangles().unwrap();
                let [a, b, d, c] = found.positions(0);
                assert_eq!(found.len(), 1);
                assert_eq!([a, b, c, d].map(|p| p.to_array()), QUAD);
            }
        }
        let turned = mesh(&QUAD, &[0, 2, 1, 0, 3, 2]).rectangles().unwrap().positions(0);
        let normal = (turned[1] - turned[0]).cross(turned[2] - turned[0]);
        assert!(normal.y > 0.0, "the sense of the triangles is kept");
    }

    #[test]
    fn triangles_with_vertices_of_their_own_are_the_same() {
        let shared = mesh(&QUAD, &[2, 1, 0, 0, 2, 3]);
        let separate = shared.separated().unwrap();
        assert_eq!(separate.parts.positions.len(), 6);
        (0..2).for_each(|i| assert_eq!(separate.positions(i), shared.positions(i)));
        assert_eq!(separate.separated(), None);
    }

    #[test]
    fn nothing_else_is_taken_for_a_rectangle() {
        let is_none =
            |positions: &[[f32; 3]], indices: &[u32]| mesh(positions, indices).rectangles().is_none();
        assert!(is_none(&QUAD, &[0, 1, 2]), "one triangle");
        assert!(is_none(&QUAD, &[0, 1, 2, 0, 3, 2]), "against each other's sense");
        assert!(is_none(&QUAD, &[0, 1, 2, 0, 1, 2]), "twice the same");
        let with = |p| [QUAD[0], QUAD[1], QUAD[2], p];
        assert!(is_none(&with([1.0, 2.001, 4.0]), &[0, 1, 2, 0, 2, 3]), "bent");
        assert!(is_none(&with([1.0, 2.0, 4.1]), &[0, 1, 2, 0, 2, 3]), "a trapezium");
        let slanted = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert!(is_none(&slanted, &[0, 1, 2, 0, 2, 3]), "a parallelogram");
        let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        assert!(is_none(&flat, &[0, 1, 2, 0, 2, 3]), "no area");
        let mut bent = mesh(&QUAD, &[0, 1, 2, 0, 2, 3]);
        bent.parts.normals = Some(vec![Vec3::Y; 4]);
        assert!(bent.rectangles().is_none(), "interpolated normals");
    }
}
