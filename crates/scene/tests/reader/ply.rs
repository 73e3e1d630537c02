//! Meshes in PLY files.

use std::io::Write;
use tenfold_math::{Vec2, Vec3};
use tenfold_scene::{LargeFile, PlyError, PlyMesh, read_ply, read_ply_in_pieces};

/// Bytes of a binary body.
#[derive(Default)]
struct Body {
    bytes: Vec<u8>,
    big: bool,
}

impl Body {
    fn put<const N: usize>(&mut self, mut bytes: [u8; N]) {
        // The arguments are little-endian.
        if self.big {
            bytes.reverse();
        }
        self.bytes.extend_from_slice(&bytes);
    }

    fn f32(&mut self, v: f32) {
        self.put(v.to_le_bytes());
    }
}

const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n\
    element face 2\nproperty list uchar int vertex_indices\nproperty int face_indices\nend_header\n";

fn binary(big: bool) -> Vec<u8> {
    let mut body = Body { big, ..Body::default() };
    for i in 0..4 {
        let (x, y) = ((i & 1) as f32, (i >> 1) as f32);
        body.f32(x);
        body.f32(y);
        body.put(0.5f64.to_le_bytes());
        body.put([255]);
        [0.0, 0.0, 1.0, x, y].into_iter().for_each(|v| body.f32(v));
    }
    for (corners, number) in [(vec![0i32, 1, 3, 2], 7i32), (vec![0, 1, 2], 9)] {
        body.put([corners.len() as u8]);
        corners.iter().for_each(|c| body.put(c.to_le_bytes()));
        body.put(number.to_le_bytes());
    }
    let order = if big { "big" } else { "little" };
    [
        format!("ply\nformat binary_{order}_endian 1.0\ncomment gr").as_bytes(),
        b"\xfcn\n",
        HEADER.as_bytes(),
        &body.bytes,
    ]
    .concat()
}

fn ascii() -> Vec<u8> {
    let body = "0 0 .5 255 0 0 1 0 0\n1 0 0.5 255 0 0 1 1 0\n0 1 5e-1 255 0 0 1 0 1\r\n1 1 0.5 255 0 0 1 1 1\n\
        4 0 1 3 2 7\n3 0 1 2 9";
    format!("ply\r\nformat ascii 1.0\r\nobj_info x y z\r\n{}{body}", HEADER.replace('\n', "\r\n"))
        .into_bytes()
}

/// The same mesh in all formats.
pub(crate) fn samples() -> [Vec<u8>; 3] {
    [ascii(), binary(false), binary(true)]
}

fn expected() -> PlyMesh {
    let positions = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.5));
    PlyMesh {
        positions: positions.to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: positions.map(|p| Vec2::new(p.x, p.y)).to_vec(),
        triangles: vec![[0, 1, 2]],
        quads: vec![[0, 1, 2, 3]],
        face_indices: vec![9, 7],
    }
}

/// An ASCII file with one triangle, with other words in the place of `from`.
fn triangle(from: &str, to: &str) -> Result<PlyMesh, PlyError> {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    assert!(text.contains(from), "{from}");
    read_ply(text.replacen(from, to, 1).as_bytes())
}

fn fault(from: &str, to: &str) -> String {
    triangle(from, to).unwrap_err().to_string()
}

#[test]
fn all_formats_give_the_same_mesh() {
    for bytes in samples() {
        assert_eq!(read_ply(&bytes).unwrap(), expected());
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&bytes).unwrap();
        assert_eq!(read_ply(&encoder.finish().unwrap()).unwrap(), expected());
    }
}

#[test]
fn names_that_pbrt_knows() {
    let mesh = triangle("x", "x").unwrap();
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && mesh.face_indices.is_empty());
    assert!(triangle("vertex_indices", "vertex_index").is_ok());
    for [u, v] in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]] {
        let header =
            HEADER.replace("float u", &format!("float {u}")).replace("float v", &format!("float {v}"));
        let text = String::from_utf8(ascii()).unwrap().replace(&HEADER.replace('\n', "\r\n"), &header);
        assert_eq!(read_ply(text.as_bytes()).unwrap(), expected());
    }
    // Two of three normals are none.
    let text = String::from_utf8(ascii()).unwrap().replace("float nz", "float n");
    assert!(read_ply(text.as_bytes()).unwrap().normals.is_empty());
}

#[test]
fn other_elements_and_properties_are_passed_over() {
    let text = "ply\nformat ascii 1.0\nelement none 99\nelement edge 2\nproperty int a\nproperty list uchar float b\n\
        element face 1\nproperty list uchar int other\nproperty list uchar int vertex_indices\n\
        element vertex 3\nproperty float z\nproperty float y\nproperty float x\nend_header\n\
        1 0 2 3 .5 .6 .7\n1 5 3 0 1 2\n1 2 3 4 5 6 7 8 9";
    let mesh = read_ply(text.as_bytes()).unwrap();
    assert_eq!(mesh.positions[0], Vec3::new(3.0, 2.0, 1.0));
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
}

#[test]
fn faults_are_named() {
    assert_eq!(fault("ply", "png"), "this is not a PLY file");
    assert_eq!(read_ply(b""), Err(PlyError::NotPly));
    assert_eq!(fault("ascii", "ebcdic"), "line 2 of the header: unknown format \"ebcdic\"");
    assert_eq!(fault("format ascii 1.0\n", ""), "line 8 of the header: the header has no line \"format\"");
    assert_eq!(fault("float x", "flaot x"), "line 4 of the header: unknown type \"flaot\"");
    assert_eq!(fault("element vertex 3\n", ""), "line 3 of the header: a property before the first element");
    assert_eq!(fault("vertex 3", "vertex -3"), "line 3 of the header: \"-3\" is no number of items");
    assert_eq!(
        fault("property float x", "propriety float x"),
        "line 4 of the header: \"propriety float x\" means nothing"
    );
    assert_eq!(fault("end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ""), "the header has no `end_header`");
    assert_eq!(fault("float x", "float w"), "element \"vertex\" has no property \"x\"");
    assert_eq!(fault("vertex_indices", "corners"), "element \"face\" has no property \"vertex_indices\"");
    assert_eq!(
        fault("list uchar int", "int"),
        "property \"vertex_indices\" is a list where one number belongs, or the other way round"
    );
    assert_eq!(fault("vertex 3", "vertex 0"), "there are no vertices");
    assert_eq!(fault("face 1", "face 0"), "there are no faces");
    assert_eq!(fault("element face", "element fase"), "there are no faces");
    assert_eq!(fault("3 0 1 2", "3 0 1"), "the file ends in item 0 of \"face\"");
    assert_eq!(fault("1 0 0", "1 x 0"), "item 1 of \"vertex\" has \"x\" where a number belongs");
    assert_eq!(fault("1 0 0", "1 nan 0"), "vertex 1 has a coordinate that is not finite");
    assert_eq!(
        fault("3 0 1 2", "5 0 1 2 0 1"),
        "face 0 has 5 corners: only triangles and quadrilaterals are supported"
    );
    assert_eq!(fault("3 0 1 2", "3 0 1 3"), "face 0 has the vertex 3, but there are only 3, counted from 0");
    assert_eq!(
        fault("3 0 1 2", "3 0 1 -1"),
        "face 0 has the vertex -1, but there are only 3, counted from 0"
    );
    assert_eq!(
        fault("\n0 0 0", " \n\u{fffd} 0 0"),
        "item 0 of \"vertex\" has \"\u{fffd}\" where a number belongs"
    );
}

#[test]
fn claims_beyond_the_file_are_refused_before_memory_is_taken() {
    for count in ["2147483648", "18446744073709551615", "1000"] {
        let text = fault("vertex 3", &format!("vertex {count}"));
        assert!(
            text.starts_with(&format!("the header claims {count} of \"vertex\", more than a file of")),
            "{text}"
        );
    }
    for (big, count) in [(false, "2147483648"), (true, "4000000000")] {
        let header = String::from_utf8_lossy(&binary(big)).replace("face 2", &format!("face {count}"));
        assert!(matches!(read_ply(header.as_bytes()), Err(PlyError::TooLarge { .. })));
    }
    // Every truncation of the body is found.
    let whole = binary(false);
    let body = whole.len() - 4 * 37 - 38;
    for end in body..whole.len() {
        assert!(read_ply(&whole[..end]).is_err(), "{end}");
    }
}

/// A number in the types that PLY files have.
fn number(scalar: &str, v: f64, big: bool) -> Vec<u8> {
    let mut bytes = match scalar {
        "char" => (v as i8).to_le_bytes().to_vec(),
        "uchar" => (v as u8).to_le_bytes().to_vec(),
        "short" => (v as i16).to_le_bytes().to_vec(),
        "ushort" => (v as u16).to_le_bytes().to_vec(),
        "int" => (v as i32).to_le_bytes().to_vec(),
        "uint" => (v as u32).to_le_bytes().to_vec(),
        "float" => (v as f32).to_le_bytes().to_vec(),
        _ => v.to_le_bytes().to_vec(),
    };
    if big {
        bytes.reverse();
    }
    bytes
}

/// A strip of faces with as many corners each, in the three formats: ASCII first. `change` may damage one number, given by element, item
/// and place.
fn strip(
    [float, length, index]: [&str; 3],
    corners: usize,
    faces: usize,
    change: impl Fn(&str, usize, usize) -> Option<f64>,
) -> [Vec<u8>; 3] {
    let vertices = faces + corners - 1;
    let header = format!(
        "element vertex {vertices}\nproperty uchar red\nproperty {float} u\nproperty {float} v\n\
         property {float} z\nproperty {float} y\nproperty {float} x\nproperty {float} nx\n\
         property float ny\nproperty double nz\nelement face {faces}\nproperty short face_indices\n\
         property list {length} {index} vertex_indices\nproperty uchar flags\nend_header\n"
    );
    let types = ["uchar", float, float, float, float, float, float, "float", "double"];
    let mut rows: Vec<Vec<(&str, f64)>> = Vec::new();
    for i in 0..vertices {
        let value = |k: usize| change("vertex", i, k).unwrap_or(((i * 7 + k * 3) % 101) as f64);
        rows.push(types.iter().enumerate().map(|(k, ty)| (*ty, value(k))).collect());
    }
    for i in 0..faces {
        let mut row = vec![("short", (i % 999) as f64), (length, corners as f64)];
        row.extend((0..corners).map(|k| (index, change("face", i, k).unwrap_or((i + k) as f64))));
        row.push(("uchar", 1.0));
        rows.push(row);
    }
    let text: Vec<String> =
        rows.iter().map(|row| row.iter().map(|(_, v)| format!("{v} ")).collect()).collect();
    let binary = |order: &str, big: bool| {
        let body = rows.iter().flatten().flat_map(|(ty, v)| number(ty, *v, big));
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{header}").into_bytes();
        bytes.extend(body);
        bytes
    };
    let ascii = format!("ply\nformat ascii 1.0\n{header}{}\n", text.join("\n"));
    [ascii.into_bytes(), binary("little", false), binary("big", true)]
}

/// What is read of a file piece by piece.
fn in_pieces(bytes: &[u8]) -> Option<PlyMesh> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("mesh.ply");
    std::fs::write(&path, bytes).unwrap();
    read_ply_in_pieces(&LargeFile::open(&path).unwrap())
}

#[test]
fn files_with_items_of_several_sizes_or_a_long_header_are_not_read_in_pieces() {
    let [_, binary, _] = strip(TYPES[0], 4, 100, |_, _, _| None);
    assert!(in_pieces(&binary).is_some());
    // The last face gets one corner less: behind its number and the length of its list there were four, and its flags.
    let mut mixed = binary.clone();
    let length = mixed.len() - 18;
    assert_eq!(mixed[length], 4);
    mixed[length] = 3;
    mixed.truncate(mixed.len() - 4);
    assert_eq!(in_pieces(&mixed), None);
    assert_eq!(read_ply(&mixed).unwrap().triangles.len(), 1);
    let mut commented = b"ply\n".to_vec();
    commented.extend([&b"comment "[..], &[b'x'; 100], b"\n"].concat().repeat(200));
    commented.extend(&binary[4..]);
    assert_eq!(in_pieces(&commented), None);
    assert_eq!(read_ply(&commented), read_ply(&binary));
}

const TYPES: [[&str; 3]; 5] = [
    ["float", "uchar", "int"],
    ["float", "char", "uint"],
    ["double", "int", "ushort"],
    ["short", "ushort", "short"],
    ["uchar", "double", "double"],
];

#[test]
fn meshes_read_in_bulk_are_those_read_one_by_one() {
    for types in TYPES {
        for corners in [3, 4] {
            let files = strip(types, corners, 20_000, |_, _, _| None);
            let mesh = read_ply(&files[0]).unwrap();
            assert_eq!(mesh.positions[1], Vec3::new(22.0, 19.0, 16.0));
            assert_eq!((mesh.normals.len(), mesh.uvs.len()), (mesh.positions.len(), mesh.positions.len()));
            assert_eq!((mesh.triangles.len() + mesh.quads.len(), mesh.face_indices.len()), (20_000, 20_000));
            assert_eq!(in_pieces(&files[0]), None, "ASCII");
            for binary in &files[1..] {
                assert_eq!(read_ply(binary).unwrap(), mesh, "{types:?}");
                assert_eq!(in_pieces(binary).unwrap(), mesh, "{types:?}");
                assert_eq!(in_pieces(&binary[..binary.len() - 1]), None);
                let cut = read_ply(&binary[..binary.len() - 1]).unwrap_err();
                assert_eq!(cut.to_string(), "the file ends in item 19999 of \"face\"");
            }
        }
    }
}

#[test]
fn faults_in_bulk_are_those_found_one_by_one() {
    let change = |what: &'static str, item: usize, place: usize, value: f64| {
        move |w: &str, i: usize, k: usize| ((w, i, k) == (what, item, place)).then_some(value)
    };
    for corners in [3, 4] {
        for types in &TYPES[..3] {
            let vertices = 20_000 + corners - 1;
            // Two bad ones: the first is named.
            let bad = |w: &str, i: usize, k: usize| {
                change("face", 12_345, 2, 30_000.0)(w, i, k).or(change("face", 19_000, 0, 40_000.0)(w, i, k))
            };
            for bytes in strip(*types, corners, 20_000, bad) {
                let message =
                    format!("face 12345 has the vertex 30000, but there are only {vertices}, counted from 0");
                assert_eq!(read_ply(&bytes).unwrap_err().to_string(), message);
                assert_eq!(in_pieces(&bytes), None);
            }
        }
        for bytes in strip(TYPES[0], corners, 20_000, change("face", 15_000, 1, -1.0)) {
            assert!(matches!(
                read_ply(&bytes),
                Err(PlyError::IndexOutOfRange { face: 15_000, index: -1, .. })
            ));
        }
        // Of a position, a texture coordinate, and a normal.
        for place in [4, 2, 8] {
            for bytes in strip(TYPES[0], corners, 20_000, change("vertex", 9_876, place, f64::NAN)) {
                assert_eq!(read_ply(&bytes), Err(PlyError::NotFinite(9_876)));
                assert_eq!(in_pieces(&bytes), None);
            }
        }
    }
}
