use crate::{MeshError, MeshParts};
use std::{collections::HashMap, f32::consts::PI};
use tenfold_math::Vec3;
use tenfold_math::ops;

/// Why a mesh cannot be subdivided.
#[derive(Copy, Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SubdivisionError {
    /// The mesh itself is bad.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A face names the same vertex twice.
    #[error("face {face} uses a vertex more than once")]
    DegenerateFace {
        /// The face.
        face: usize,
    },
    /// More than two faces share an edge, or two that go round it in the same direction.
    #[error("the edge from vertex {from} to vertex {to} of face {face} belongs to another face already")]
    NonManifoldEdge {
        /// The face.
        face: usize,
        /// Where the edge begins.
        from: u32,
        /// Where it ends.
        to: u32,
    },
}

/// Loop subdivision (Loop 1987) with the boundary rules of Hoppe et al. (1994), as pbrt-v4 does it: `levels` times
/// every triangle becomes four, then the vertices are moved to the limit surface, and their normals are those of its
/// tangents there. Vertices that no face uses are left out.
///
/// # Errors
/// For bad meshes, edges with more than two faces, faces of opposite orientation side by side, and results that are
/// too large.
pub fn loop_subdivide(
    levels: u32,
    indices: &[u32],
    positions: &[Vec3],
) -> Result<MeshParts, SubdivisionError> {
    let cage = MeshParts { positions: positions.to_vec(), indices: indices.to_vec(), ..MeshParts::default() };
    cage.validate(3)?;
    let count = (0..levels).try_fold(indices.len() / 3, |n, _| n.checked_mul(4)).unwrap_or(usize::MAX);
    if count >= 1 << 28 {
        return Err(MeshError::TooLarge { count }.into());
    }
    let mut surface = Surface::new(cage)?;
    for _ in 0..levels {
        surface = surface.refined();
    }
    Ok(surface.into_limit())
}

/// No face: the other side of a boundary edge.
const NONE: u32 = u32::MAX;

fn next(i: usize) -> usize {
    (i + 1) % 3
}

fn previous(i: usize) -> usize {
    (i + 2) % 3
}

/// Triangles that know their neighbours.
struct Surface {
    positions: Vec<Vec3>,
    /// One of the faces of each vertex.
    start: Vec<u32>,
    on_boundary: Vec<bool>,
    faces: Vec<Face>,
}

#[derive(Copy, Clone)]
struct Face {
    corners: [u32; 3],
    /// Across the edges from each corner to the next.
    neighbours: [u32; 3],
}

impl Face {
    /// The number of a vertex among the corners. Every walk comes to faces that have it.
    fn number(&self, vertex: u32) -> usize {
        self.corners.iter().position(|&v| v == vertex).unwrap_or(0)
    }
}

impl Surface {
    fn new(cage: MeshParts) -> Result<Self, SubdivisionError> {
        // Renumber to the vertices that are used, in their order.
        let mut number = vec![NONE; cage.positions.len()];
        cage.indices.iter().for_each(|&v| number[v as usize] = 0);
        let mut positions = Vec::new();
        for (n, p) in number.iter_mut().zip(&cage.positions).filter(|(n, _)| **n == 0) {
            *n = positions.len() as u32;
            positions.push(*p);
        }
        let mut faces: Vec<Face> = Vec::with_capacity(cage.indices.len() / 3);
        // The face and corner at which each directed edge begins.
        let mut edges: HashMap<(u32, u32), (u32, usize)> = HashMap::with_capacity(cage.indices.len());
        let mut start = vec![NONE; positions.len()];
        for (face, corners) in cage.indices.chunks_exact(3).enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            if a == b || b == c || c == a {
                return Err(SubdivisionError::DegenerateFace { face });
            }
            let corners = [a, b, c].map(|v| number[v as usize]);
            faces.push(Face { corners, neighbours: [NONE; 3] });
            for i in 0..3 {
                let (from, to) = (corners[i], corners[next(i)]);
                if edges.insert((from, to), (face as u32, i)).is_some() {
                    let named = [a, b, c];
                    return Err(SubdivisionError::NonManifoldEdge {
                        face,
                        from: named[i],
                        to: named[next(i)],
                    });
                }
                if let Some(&(other, j)) = edges.get(&(to, from)) {
                    faces[face].neighbours[i] = other;
                    faces[other as usize].neighbours[j] = face as u32;
                }
                start[from as usize] = face as u32;
            }
        }
        let mut surface = Self { on_boundary: vec![false; positions.len()], positions, start, faces };
        for vertex in 0..surface.positions.len() as u32 {
            surface.on_boundary[vertex as usize] = surface.is_on_boundary(vertex);
        }
        Ok(surface)
    }

    /// The next face around a vertex.
    fn next_face(&self, face: u32, vertex: u32) -> u32 {
        let face = &self.faces[face as usize];
        face.neighbours[face.number(vertex)]
    }

    /// The face before around a vertex.
    fn previous_face(&self, face: u32, vertex: u32) -> u32 {
        let face = &self.faces[face as usize];
        face.neighbours[previous(face.number(vertex))]
    }

    fn is_on_boundary(&self, vertex: u32) -> bool {
        let start = self.start[vertex as usize];
        let mut face = start;
        loop {
            face = self.next_face(face, vertex);
            if face == NONE || face == start {
                return face == NONE;
            }
        }
    }

    /// The vertices around a vertex, in order; from one end to the other on the boundary.
    fn ring(&self, vertex: u32, ring: &mut Vec<Vec3>) {
        ring.clear();
        let corner = |face: u32, step: fn(usize) -> usize| {
            let face = &self.faces[face as usize];
            self.positions[face.corners[step(face.number(vertex))] as usize]
        };
        let start = self.start[vertex as usize];
        let mut face = start;
        if self.on_boundary[vertex as usize] {
            loop {
                let after = self.next_face(face, vertex);
                if after == NONE {
                    break;
                }
                face = after;
            }
            ring.push(corner(face, next));
            while face != NONE {
                ring.push(corner(face, previous));
                face = self.previous_face(face, vertex);
            }
        } else {
            loop {
                ring.push(corner(face, next));
                face = self.next_face(face, vertex);
                if face == start {
                    break;
                }
            }
        }
    }

    /// A vertex moved toward its ring: by `inner(valence)` to each neighbour, or by `boundary` to the two on the boundary.
    fn smoothed(&self, vertex: u32, ring: &mut Vec<Vec3>, inner: fn(f32) -> f32, boundary: f32) -> Vec3 {
        self.ring(vertex, ring);
        let p = self.positions[vertex as usize];
        if self.on_boundary[vertex as usize] {
            return (1.0 - 2.0 * boundary) * p + boundary * (ring[0] + ring[ring.len() - 1]);
        }
        let n = ring.len() as f32;
        let weight = inner(n);
        (1.0 - n * weight) * p + weight * ring.iter().sum::<Vec3>()
    }

    /// Every face in four: child `k` at corner `k`, child 3 in the middle.
    fn refined(&self) -> Self {
        let child = |face: usize, k: usize| (4 * face + k) as u32;
        let mut ring = Vec::new();
        // Even vertices keep their numbers.
        let mut positions: Vec<Vec3> =
            (0..self.positions.len() as u32).map(|v| self.smoothed(v, &mut ring, beta, 1.0 / 8.0)).collect();
        let mut start: Vec<u32> = (0..self.positions.len() as u32)
            .map(|v| {
                let face = self.start[v as usize] as usize;
                child(face, self.faces[face].number(v))
            })
            .collect();
        let mut on_boundary = self.on_boundary.clone();

        // Odd vertices, one for each edge.
        let mut on_edge = vec![[NONE; 3]; self.faces.len()];
        for (i, face) in self.faces.iter().enumerate() {
            for k in 0..3 {
                if on_edge[i][k] != NONE {
                    continue;
                }
                let [a, b, opposite] =
                    [k, next(k), previous(k)].map(|k| self.positions[face.corners[k] as usize]);
                let vertex = positions.len() as u32;
                on_edge[i][k] = vertex;
                let other = face.neighbours[k];
                if other == NONE {
                    positions.push(0.5 * (a + b));
                } else {
                    // The neighbour's edge begins where this one ends.
                    let neighbour = &self.faces[other as usize];
                    let j = neighbour.number(face.corners[next(k)]);
                    let across = self.positions[neighbour.corners[previous(j)] as usize];
                    positions.push(3.0 / 8.0 * (a + b) + 1.0 / 8.0 * (opposite + across));
                    on_edge[other as usize][j] = vertex;
                }
                on_boundary.push(other == NONE);
                start.push(child(i, 3));
            }
        }

        let mut faces = Vec::with_capacity(4 * self.faces.len());
        for (i, face) in self.faces.iter().enumerate() {
            let middle = on_edge[i];
            for k in 0..3 {
                let vertex = face.corners[k];
                // The child at the same vertex of a neighbour.
                let beside = |other: u32| match other {
                    NONE => NONE,
                    other => child(other as usize, self.faces[other as usize].number(vertex)),
                };
                let (mut corners, mut neighbours) = ([0; 3], [0; 3]);
                corners[k] = vertex;
                corners[next(k)] = middle[k];
                corners[previous(k)] = middle[previous(k)];
                neighbours[k] = beside(face.neighbours[k]);
                neighbours[next(k)] = child(i, 3);
                neighbours[previous(k)] = beside(face.neighbours[previous(k)]);
                faces.push(Face { corners, neighbours });
            }
            faces.push(Face {
                corners: middle,
                neighbours: [child(i, next(0)), child(i, next(1)), child(i, next(2))],
            });
        }
        Self { positions, start, on_boundary, faces }
    }

    /// The vertices on the limit surface, with its normals (of any length).
    fn into_limit(mut self) -> MeshParts {
        let mut ring = Vec::new();
        let vertices = 0..self.positions.len() as u32;
        self.positions =
            vertices.clone().map(|v| self.smoothed(v, &mut ring, limit_weight, 1.0 / 5.0)).collect();
        let normals = vertices
            .map(|v| {
                self.ring(v, &mut ring);
                let [s, t] = if self.on_boundary[v as usize] {
                    boundary_tangents(&ring, self.positions[v as usize])
                } else {
                    inner_tangents(&ring)
                };
                s.cross(t)
            })
            .collect();
        MeshParts {
            positions: self.positions,
            normals: Some(normals),
            indices: self.faces.iter().flat_map(|f| f.corners).collect(),
            ..MeshParts::default()
        }
    }
}

/// Weight of each neighbour of an inner vertex with `n` of them (Warren's choice of Loop's β).
fn beta(n: f32) -> f32 {
    if n == 3.0 { 3.0 / 16.0 } else { 3.0 / (8.0 * n) }
}

/// Weight of each neighbour for the limit of an inner vertex.
fn limit_weight(n: f32) -> f32 {
    1.0 / (n + 3.0 / (8.0 * beta(n)))
}

/// Tangents of the limit surface at an inner vertex: the eigenvectors of the subdominant eigenvalue.
fn inner_tangents(ring: &[Vec3]) -> [Vec3; 2] {
    let n = ring.len() as f32;
    let along = |f: fn(f32) -> f32| -> Vec3 {
        ring.iter().enumerate().map(|(j, p)| f(2.0 * PI * j as f32 / n) * *p).sum()
    };
    [along(ops::cos), along(ops::sin)]
}

/// Tangents along and across the boundary at the vertex `p` (Hoppe et al. 1994, table 2).
fn boundary_tangents(ring: &[Vec3], p: Vec3) -> [Vec3; 2] {
    let (first, last) = (ring[0], ring[ring.len() - 1]);
    let across = match ring.len() {
        2 => first + last - 2.0 * p,
        3 => ring[1] - p,
        4 => -first + 2.0 * ring[1] + 2.0 * ring[2] - last - 2.0 * p,
        n => {
            let theta = PI / (n - 1) as f32;
            let inner: Vec3 = (1..n - 1)
                .map(|k| (2.0 * ops::cos(theta) - 2.0) * ops::sin(k as f32 * theta) * ring[k])
                .sum();
            -(ops::sin(theta) * (first + last) + inner)
        }
    };
    [last - first, across]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn icosahedron() -> (Vec<u32>, Vec<Vec3>) {
        let g = 0.5 * (1.0 + 5f32.sqrt());
        let mut positions = Vec::new();
        for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
            positions.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
        }
        // The faces are the triples at distance 2 of each other, turned outward.
        let near = |a: usize, b: usize| (positions[a].distance(positions[b]) - 2.0).abs() < 1e-4;
        let mut indices = Vec::new();
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if near(a, b) && near(b, c) && near(c, a) {
                        let outward = positions[a].dot(positions[b].cross(positions[c])) > 0.0;
                        let face = if outward { [a, b, c] } else { [a, c, b] };
                        indices.extend(face.map(|i| i as u32));
                    }
                }
            }
        }
        (indices, positions)
    }

    #[test]
    fn an_icosahedron_comes_to_its_limit() {
        let (indices, positions) = icosahedron();
        assert_eq!(indices.len(), 60);
        // The corners' limit does not depend on how often the mesh was refined.
        let limits: Vec<MeshParts> =
            (0..6).map(|levels| loop_subdivide(levels, &indices, &positions).unwrap()).collect();
        // Closed form: five neighbours of weight γ at height 1/√5 of the circumradius.
        let gamma = 1.0 / (5.0 + 3.0 / (8.0 * (3.0 / 40.0)));
        let want = 1.0 - 5.0 * gamma * (1.0 - 1.0 / 5f32.sqrt());
        for (levels, limit) in limits.iter().enumerate() {
            assert_eq!(limit.indices.len(), 60 << (2 * levels));
            for (p, n) in limit.positions[..12].iter().zip(limit.normals.as_ref().unwrap()) {
                assert!((p.length() / positions[0].length() - want).abs() < 1e-5, "{levels}");
                // By symmetry normals are radial; they point inward or outward alike.
                assert!(n.normalize().cross(p.normalize()).length() < 1e-4);
            }
        }
        // Refining brings the flat faces to the surface: in the end each step gains a quarter of the one before.
        let area = |m: &MeshParts| -> f32 {
            m.indices
                .chunks_exact(3)
                .map(|f| {
                    let [a, b, c] = [0, 1, 2].map(|k| m.positions[f[k] as usize]);
                    0.5 * (b - a).cross(c - a).length()
                })
                .sum()
        };
        let steps: Vec<f32> = limits.windows(2).map(|w| area(&w[1]) - area(&w[0])).collect();
        for w in steps[2..].windows(2) {
            assert!((w[0] / w[1] - 4.0).abs() < 0.2, "{steps:?}");
        }
    }

    #[test]
    fn normals_point_to_the_side_of_the_faces() {
        let (indices, positions) = icosahedron();
        let limit = loop_subdivide(2, &indices, &positions).unwrap();
        let normals = limit.normals.unwrap();
        for face in limit.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| limit.positions[face[k] as usize]);
            let n = (b - a).cross(c - a);
            // pbrt walks the rings clockwise: the normals of a mesh turned outward point inward.
            assert!(face.iter().all(|&v| normals[v as usize].dot(n) < 0.0));
        }
    }

    #[test]
    fn a_flat_sheet_stays_flat_and_its_boundary_straight() {
        let n = 5u32;
        let positions: Vec<Vec3> =
            (0..n * n).map(|i| Vec3::new((i % n) as f32, (i / n) as f32, 0.0)).collect();
        let mut indices = Vec::new();
        for y in 0..n - 1 {
            for x in 0..n - 1 {
                let i = y * n + x;
                indices.extend([i, i + 1, i + n + 1, i, i + n + 1, i + n]);
            }
        }
        let limit = loop_subdivide(3, &indices, &positions).unwrap();
        for (p, normal) in limit.positions.iter().zip(limit.normals.unwrap()) {
            assert!(p.z == 0.0 && (0.0..=4.0).contains(&p.x) && (0.0..=4.0).contains(&p.y));
            assert!(normal.x == 0.0 && normal.y == 0.0 && normal.z != 0.0, "{p} {normal}");
        }
        // The boundary is a cubic B-spline: straight on the two spans that no corner bends.
        let along_edge = limit.positions.iter().filter(|p| p.y == 0.0).count();
        assert_eq!(along_edge, 2 * 8 + 1);
    }

    #[test]
    fn bad_meshes_are_refused() {
        let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE];
        let error = |indices: &[u32]| loop_subdivide(1, indices, &p).err();
        assert_eq!(
            error(&[0, 1, 2, 0, 1, 3]),
            Some(SubdivisionError::NonManifoldEdge { face: 1, from: 0, to: 1 })
        );
        assert!(matches!(
            error(&[0, 1, 2, 1, 0, 3, 1, 0, 4]),
            Some(SubdivisionError::NonManifoldEdge { face: 2, .. })
        ));
        assert_eq!(error(&[0, 1, 1]), Some(SubdivisionError::DegenerateFace { face: 0 }));
        assert!(matches!(error(&[0, 1]), Some(SubdivisionError::Mesh(MeshError::IndexCount { .. }))));
        assert!(matches!(error(&[0, 1, 9]), Some(SubdivisionError::Mesh(MeshError::IndexOutOfRange { .. }))));
        assert!(loop_subdivide(1, &[0, 1, 2], &[Vec3::ZERO, Vec3::X, Vec3::NAN]).is_err());
        assert!(matches!(
            loop_subdivide(40, &[0, 1, 2], &p),
            Err(SubdivisionError::Mesh(MeshError::TooLarge { .. }))
        ));
        // Two fans that touch in one vertex, a lone triangle, nothing at all, and unused vertices are fine.
        assert!(error(&[0, 1, 2, 0, 3, 4]).is_none());
        assert!(loop_subdivide(3, &[], &p).unwrap().indices.is_empty());
        assert_eq!(loop_subdivide(0, &[0, 1, 2], &p).unwrap().positions.len(), 3);
    }
}
