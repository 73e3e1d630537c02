//! Whatever a file holds, reading it ends with a description and findings, never with a panic.

use crate::{Files, read_with};
use proptest::prelude::*;
use tenfold_scene::read_ply;

const SCENE: &str = r#"# A scene with a little of everything, é.
Option "disablepixeljitter" true
Film "rgb" "integer xresolution" 640 "integer yresolution" [ 480 ] "string filename" "a.exr"
TransformTimes [ 0 0.4 1 ] LookAt 0 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" 38 "float shutteropen" [ 0 ]
ColorSpace "rec2020" MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ]
WorldBegin
Attribute "shape" "texture alpha" "holes"
Texture "holes" "float" "checkerboard" "float uscale" 6 "float tex1" 1e-3
MakeNamedMaterial "m" "string type" [ "conductor" ] "spectrum eta" "metal-Au-eta" "spectrum k" [ 400 1 500 2 ]
ObjectBegin "tree" NamedMaterial "m" AttributeBegin Rotate -90 1 0 0
Shape "cylinder" "float radius" 0.07 "float zmin" 0 ReverseOrientation AttributeEnd ObjectEnd
AttributeBegin Translate -1.6 0 0 ActiveTransform 1 Scale 1 2 3 ActiveTransform All ObjectInstance "tree" AttributeEnd
LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ] "blackbody b" 3000 CoordinateSystem "c" CoordSysTransform "camera"
MediumInterface "fog" "" AreaLightSource "diffuse" "bool twosided" true
Shape "trianglemesh" "point3 P" [ -8 0 -8  -8 0 8  8 0 8 ] "integer indices" [ 0 1 2 ] "string s" "a\"\\"
Include "inc" Import "imp" Transform [ 1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 ] Identity
"#;

fn files() -> Files {
    Files::new([
        ("inc", "AttributeBegin Shape \"disk\" AttributeEnd"),
        ("imp", "Include \"inc\" Material \"x\""),
    ])
}

/// Bytes and words that are likely to matter.
fn piece() -> impl Strategy<Value = Vec<u8>> {
    let words: [&[u8]; 22] = [
        b"\"",
        b"[",
        b"]",
        b"\\",
        b"#",
        b"\n",
        b" ",
        b"\0",
        b"\xff",
        b"\xc3",
        b"-",
        b"1e999",
        b"nan",
        b"2147483648",
        b"AttributeEnd ",
        b"ObjectEnd ",
        b"ObjectBegin \"o\" ",
        b"AttributeBegin ",
        b"Include \"inc\" ",
        b"Import \"imp\" ",
        b"Include \"s\" ",
        b"\"float x\" ",
    ];
    prop_oneof![
        4 => prop::sample::select(words.to_vec()).prop_map(<[u8]>::to_vec),
        1 => prop::collection::vec(any::<u8>(), 0..8),
    ]
}

/// A place, a length and what comes there.
type Edit = (f64, usize, Vec<u8>);

/// Replaces stretches of bytes; places and lengths are fractions.
fn mutate(bytes: &[u8], edits: &[Edit], cut: Option<f64>) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for (place, length, piece) in edits {
        let start = (place * bytes.len() as f64) as usize;
        let end = (start + length).min(bytes.len());
        bytes.splice(start..end, piece.iter().copied());
    }
    if let Some(cut) = cut {
        bytes.truncate((cut * bytes.len() as f64) as usize);
    }
    bytes
}

fn edits() -> impl Strategy<Value = (Vec<Edit>, Option<f64>)> {
    let edit = (0.0..1.0f64, 0..12usize, piece());
    (prop::collection::vec(edit, 0..6), prop::option::of(0.0..1.0f64))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_scenes_never_panic((edits, cut) in edits()) {
        let mut files = files();
        files.0.insert("main", mutate(SCENE.as_bytes(), &edits, cut));
        // Through an include, so that the bytes need not be text.
        let (_, found) = read_with(&files, "Include \"main\"");
        for line in found {
            // Places are computed while the lines are made; each finding has one.
            prop_assert!(line.contains(": "), "{line}");
        }
    }

    #[test]
    fn mutated_meshes_never_panic(which in 0..3usize, (edits, cut) in edits()) {
        let mesh = &crate::ply::samples()[which];
        let _ = read_ply(&mutate(mesh, &edits, cut));
    }

    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut files = Files::default();
        files.0.insert("main", bytes.clone());
        read_with(&files, "WorldBegin Include \"main\"");
        let _ = read_ply(&bytes);
        let _ = read_ply(&[b"ply\n", &bytes[..]].concat());
    }
}

#[test]
fn the_scene_itself_is_sound_and_every_truncation_is_survived() {
    let (_, found) = read_with(&files(), SCENE);
    assert_eq!(found, [""; 0]);
    let mut files = files();
    for end in 0..SCENE.len() {
        files.0.insert("main", SCENE.as_bytes()[..end].to_vec());
        read_with(&files, "Include \"main\"");
    }
}
