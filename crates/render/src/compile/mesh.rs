//! Compiles meshes: those written out in the scene, those in files of their own, and subdivision surfaces.

use super::context::Context;
use std::sync::Arc;
use tenfold_geometry::{BilinearMesh, MeshError, MeshParts, Shape, TriangleMesh, loop_subdivide};
use tenfold_math::Transform;
use tenfold_scene::{ParamType, Params, PlyMesh};

/// Each level quarters every triangle: more of them fit no memory.
const MOST_LEVELS: i32 = 12;

pub(super) fn triangle_mesh(params: &Params<'_>, place: &Transform, reverse: bool) -> Option<Shape> {
    let parts = MeshParts {
        normals: given(params.normals("N")),
        tangents: given(params.vector3s("S")),
        face_indices: face_indices(params)?,
        ..parts(params, &[0, 1, 2])?
    };
    report(params, TriangleMesh::new(parts, place, reverse)).map(|mesh| Shape::Triangles(Arc::new(mesh)))
}

pub(super) fn bilinear_mesh(params: &Params<'_>, place: &Transform, reverse: bool) -> Option<Shape> {
    let parts = MeshParts {
        normals: given(params.normals("N")),
        face_indices: face_indices(params)?,
        ..parts(params, &[0, 1, 2, 3])?
    };
    report(params, BilinearMesh::new(parts, place, reverse)).map(|mesh| Shape::Patches(Arc::new(mesh)))
}

pub(super) fn loop_subdivision(params: &Params<'_>, place: &Transform, reverse: bool) -> Option<Shape> {
    let levels = params.one_int("levels", 3);
    if !(0..=MOST_LEVELS).contains(&levels) {
        params.error("levels", format!("levels of subdivision go from 0 to {MOST_LEVELS}, found {levels}"));
        return None;
    }
    let scheme = params.one_string("scheme", "loop");
    if scheme != "loop" {
        params.error("scheme", format!("the only scheme of subdivision is \"loop\", found \"{scheme}\""));
        return None;
    }
    let parts = parts(params, &[])?;
    match loop_subdivide(levels as u32, &parts.indices, &parts.positions) {
        Ok(parts) => report(params, TriangleMesh::new(parts, place, reverse))
            .map(|mesh| Shape::Triangles(Arc::new(mesh))),
        Err(error) => {
            params.error("indices", error.to_string());
            None
        }
    }
}

pub(super) fn ply_mesh(
    cx: &mut Context<'_>,
    params: &Params<'_>,
    place: &Transform,
    reverse: bool,
) -> Vec<Shape> {
    if params.has("displacement") {
        cx.unsupported(params.span_of("displacement"), "the displacement of a mesh");
    }
    // How finely a displaced mesh is divided.
    params.one_float("edgelength", 1.0);
    let Some(name) = params.string("filename") else {
        if !params.has("filename") {
            params.missing("filename", ParamType::String);
        }
        return Vec::new();
    };
    let span = params.span_of("filename");
    let resources = cx.resources;
    let shapes = cx.meshes.shapes(resources, name, place, reverse, |mesh| ply_shapes(mesh, place, reverse));
    shapes.map_err(|message| cx.diagnostics.error(span, message)).unwrap_or_default()
}

/// The triangles and the quadrilaterals of a file.
pub(super) fn ply_shapes(mesh: PlyMesh, place: &Transform, reverse: bool) -> Result<Vec<Shape>, MeshError> {
    let PlyMesh { positions, normals, uvs, triangles, quads, mut face_indices } = mesh;
    let quad_faces = face_indices.split_off(triangles.len().min(face_indices.len()));
    let mut vertices = MeshParts {
        positions,
        normals: (!normals.is_empty()).then_some(normals),
        uvs: (!uvs.is_empty()).then_some(uvs),
        ..MeshParts::default()
    };
    let with_faces = |vertices: MeshParts, indices: Vec<u32>, faces: Vec<i32>| {
        let faces = faces.into_iter().map(|i| i as u32).collect::<Vec<_>>();
        MeshParts { indices, face_indices: (!faces.is_empty()).then_some(faces), ..vertices }
    };
    let mut shapes = Vec::new();
    if !triangles.is_empty() {
        // The vertices are shared by both parts: each gets its own, for the rare mesh that has both.
        let own = if quads.is_empty() { std::mem::take(&mut vertices) } else { vertices.clone() };
        let parts = with_faces(own, triangles.into_flattened(), face_indices);
        shapes.push(Shape::Triangles(Arc::new(TriangleMesh::new(parts, place, reverse)?)));
    }
    if !quads.is_empty() {
        let parts = with_faces(vertices, quads.into_flattened(), quad_faces);
        shapes.push(Shape::Patches(Arc::new(BilinearMesh::new(parts, place, reverse)?)));
    }
    Ok(shapes)
}

/// Positions, texture coordinates and indices; where there are none of these, but as many vertices as one primitive has,
/// `only` it.
fn parts(params: &Params<'_>, only: &[u32]) -> Option<MeshParts> {
    let positions = params.point3s("P");
    if positions.is_empty() {
        if !params.has("P") {
            params.missing("P", ParamType::Point3);
        }
        return None;
    }
    let given_indices = params.ints("indices");
    let indices = if !params.has("indices") && positions.len() == only.len() {
        only.to_vec()
    } else if given_indices.is_empty() {
        if !params.has("indices") {
            params.missing("indices", ParamType::Integer);
        }
        return None;
    } else {
        indices(params, "indices", given_indices)?
    };
    Some(MeshParts {
        positions: positions.to_vec(),
        uvs: given(params.point2s("uv")),
        indices,
        ..MeshParts::default()
    })
}

fn face_indices(params: &Params<'_>) -> Option<Option<Vec<u32>>> {
    match params.ints("faceIndices") {
        [] => Some(None),
        given => indices(params, "faceIndices", given).map(Some),
    }
}

/// Indices, none of which may be negative.
fn indices(params: &Params<'_>, name: &str, given: &[i32]) -> Option<Vec<u32>> {
    let converted: Result<Vec<u32>, _> =
        given.iter().enumerate().map(|(at, &i)| u32::try_from(i).map_err(|_| (at, i))).collect();
    converted
        .map_err(|(at, i)| {
            params.error(name, format!("\"{name}\" must not be negative, found {i} at place {at}"))
        })
        .ok()
}

fn given<T: Clone>(values: &[T]) -> Option<Vec<T>> {
    (!values.is_empty()).then(|| values.to_vec())
}

fn report<T>(params: &Params<'_>, mesh: Result<T, MeshError>) -> Option<T> {
    mesh.map_err(|error| {
        let name = match &error {
            MeshError::IndexOutOfRange { .. } | MeshError::IndexCount { .. } => "indices",
            _ => "P",
        };
        params.error(name, error.to_string());
    })
    .ok()
}
