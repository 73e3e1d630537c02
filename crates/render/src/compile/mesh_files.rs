//! Mesh files: all that a scene names are read before its shapes are compiled, several at once, and each once.

use super::context::{read_file, string_of};
use rayon::prelude::*;
use std::{
    collections::{HashMap, hash_map::Entry},
    path::PathBuf,
};
use tenfold_geometry::{MeshError, Shape};
use tenfold_math::Transform;
use tenfold_scene::{Description, PlyMesh, Resources, ShapeEntity, read_ply, read_ply_in_pieces};

/// A file at a place: its identity, the transform's bits, and whether its orientation is reversed.
type Placed = (PathBuf, [u32; 12], bool);

/// The mesh files of a scene.
#[derive(Default)]
pub(super) struct MeshFiles {
    files: HashMap<PathBuf, MeshFile>,
    /// What was made of them.
    shapes: HashMap<Placed, Vec<Shape>>,
}

struct MeshFile {
    content: Result<PlyMesh, String>,
    /// How many shapes still need it.
    uses: usize,
}

impl MeshFiles {
    /// Reads all files that shapes of a scene name.
    pub(super) fn read(description: &Description, resources: &dyn Resources) -> Self {
        let in_objects = description.objects.iter().flat_map(|object| &object.shapes);
        let mut uses: HashMap<PathBuf, (&str, usize)> = HashMap::new();
        for name in description.shapes.iter().chain(in_objects).filter_map(file_of) {
            uses.entry(resources.identity(name)).or_insert((name, 0)).1 += 1;
        }
        let files = uses
            .into_par_iter()
            .map(|(identity, (name, uses))| (identity, MeshFile { content: read(resources, name), uses }));
        Self { files: files.collect(), shapes: HashMap::new() }
    }

    /// The shapes of the file `name` at a place, as `build` makes them of its content: the same file at the same place is one mesh.
    /// What is wrong is said in words.
    pub(super) fn shapes(
        &mut self,
        resources: &dyn Resources,
        name: &str,
        place: &Transform,
        reverse: bool,
        build: impl FnOnce(PlyMesh) -> Result<Vec<Shape>, MeshError>,
    ) -> Result<Vec<Shape>, String> {
        let identity = resources.identity(name);
        let placed = (identity.clone(), place.affine().to_cols_array().map(f32::to_bits), reverse);
        let mut file = match self.files.entry(identity) {
            Entry::Occupied(file) => file,
            Entry::Vacant(free) => free.insert_entry(MeshFile { content: read(resources, name), uses: 1 }),
        };
        if let Err(fault) = &file.get().content {
            return Err(fault.clone());
        }
        file.get_mut().uses -= 1;
        let is_last = file.get().uses == 0;
        if let Some(known) = self.shapes.get(&placed) {
            if is_last {
                file.remove();
            }
            return Ok(known.clone());
        }
        // The last shape takes what the others have copied.
        let content =
            if is_last { file.remove().content.ok() } else { file.get().content.as_ref().ok().cloned() };
        let shapes = build(content.unwrap_or_default()).map_err(|error| format!("in \"{name}\": {error}"))?;
        self.shapes.insert(placed, shapes.clone());
        Ok(shapes)
    }
}

/// The file that a shape names, if it names one.
fn file_of(shape: &ShapeEntity) -> Option<&str> {
    if shape.entity.kind != "plymesh" {
        return None;
    }
    string_of(&shape.entity.params, "filename")
}

fn read(resources: &dyn Resources, name: &str) -> Result<PlyMesh, String> {
    if let Some(mesh) = resources.large(name).and_then(|file| read_ply_in_pieces(&file)) {
        return Ok(mesh);
    }
    read_ply(&read_file(resources, name)?).map_err(|error| format!("in \"{name}\": {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{
        io,
        sync::Arc,
        sync::atomic::{AtomicUsize, Ordering},
    };
    use tenfold_math::Vec3;
    use tenfold_scene::{SourceMap, read_pbrt_str};

    const TRIANGLE: &[u8] = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

    /// Counts what is loaded; the name of the file and `./` before it are one.
    #[derive(Default)]
    struct Counted(AtomicUsize);

    impl Resources for Counted {
        fn load(&self, path: &str) -> io::Result<Vec<u8>> {
            self.0.fetch_add(1, Ordering::Relaxed);
            match path.trim_start_matches("./") {
                "a.ply" => Ok(TRIANGLE.to_vec()),
                "bad.ply" => Ok(b"png".to_vec()),
                _ => Err(io::ErrorKind::NotFound.into()),
            }
        }

        fn resolve(&self, path: &str) -> PathBuf {
            PathBuf::from(path.trim_start_matches("./"))
        }
    }

    fn build(mesh: PlyMesh, place: &Transform) -> Result<Vec<Shape>, MeshError> {
        super::super::mesh::ply_shapes(mesh, place, false)
    }

    #[test]
    fn files_are_read_once_and_meshes_at_one_place_are_one() {
        let text = "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\" \
            Shape \"plymesh\" \"string filename\" \"./a.ply\" Shape \"sphere\" \
            Translate 1 0 0 Shape \"plymesh\" \"string filename\" \"a.ply\" \
            ObjectBegin \"o\" Identity Shape \"plymesh\" \"string filename\" \"a.ply\" ObjectEnd \
            Shape \"plymesh\" \"string filename\" \"bad.ply\" Shape \"plymesh\" \"string filename\" \"none.ply\" \
            Shape \"plymesh\" \"string filename\" \"none.ply\"";
        let resources = Counted::default();
        let (description, _) = read_pbrt_str("s", text, &resources, &mut SourceMap::new());
        let mut files = MeshFiles::read(&description, &resources);
        assert_eq!(resources.0.load(Ordering::Relaxed), 3);
        let (here, there) = (Transform::IDENTITY, Transform::translate(Vec3::X));
        let mut mesh = |name: &str, place: &Transform| -> Result<_, String> {
            let shapes = files.shapes(&resources, name, place, false, |mesh| build(mesh, place))?;
            let [Shape::Triangles(mesh)] = &shapes[..] else { panic!("{shapes:?}") };
            Ok(mesh.clone())
        };
        let first = mesh("a.ply", &here).unwrap();
        assert!(Arc::ptr_eq(&first, &mesh("./a.ply", &here).unwrap()));
        let moved = mesh("a.ply", &there).unwrap();
        assert_eq!(moved.parts().positions[0], Vec3::X);
        assert!(Arc::ptr_eq(&first, &mesh("a.ply", &here).unwrap()));
        assert_eq!(mesh("bad.ply", &here).unwrap_err(), "in \"bad.ply\": this is not a PLY file");
        for _ in 0..2 {
            assert!(mesh("./none.ply", &here).unwrap_err().starts_with("cannot read \"none.ply\": "));
        }
        assert_eq!(resources.0.load(Ordering::Relaxed), 3);
        assert_eq!(files.files.len(), 2, "what no shape needs any more is kept");
    }
}
