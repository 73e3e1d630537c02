//! Files that include each other, that are packed, missing or not text.

use crate::{Files, lines, read_with};
use std::io::Write;
use tenfold_scene::{SourceMap, read_pbrt};

fn packed(text: &str) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn circles_of_includes_are_found() {
    let files = Files::new([("a", "Include \"b\""), ("b", "\n  Include \"a\""), ("i", "Import \"i\"")]);
    let (_, found) = read_with(&files, "WorldBegin Include \"s\" Include \"a\" Import \"i\"");
    assert_eq!(
        found,
        [
            "s:1:20: error: \"s\" includes itself",
            "b:2:11: error: \"a\" includes itself (the circle is a → b → a)",
            "i:1:8: error: \"i\" includes itself",
        ]
    );
}

#[test]
fn a_file_may_be_included_again_after_its_end() {
    let files = Files::new([("a", "Shape \"sphere\"")]);
    let (d, found) = read_with(&files, "WorldBegin Include \"a\" Include \"a\" Import \"a\"");
    assert_eq!(found, [""; 0]);
    assert_eq!(d.shapes.len(), 3);
}

#[test]
fn includes_are_bounded_in_depth_and_number() {
    let mut files = Files::default();
    let names: Vec<&'static str> = (0..80).map(|i| &*format!("f{i}").leak()).collect();
    for pair in names.windows(2) {
        files.0.insert(pair[0], format!("Include \"{}\"", pair[1]).into_bytes());
    }
    let (_, found) = read_with(&files, "WorldBegin Include \"f0\"");
    assert_eq!(found, ["f63:1:9: error: files include each other more than 64 deep"]);
    // Each file twice in the one before it: 2^40 in all.
    for pair in names[..40].windows(2) {
        files.0.insert(pair[0], format!("Include \"{}\" Include \"{}\"", pair[1], pair[1]).into_bytes());
    }
    files.0.insert("f39", b" ".to_vec());
    let (_, found) = read_with(&files, "WorldBegin Include \"f0\"");
    assert_eq!(found.len(), 1);
    assert!(found[0].ends_with("more than 100000 files are included"), "{}", found[0]);
}

#[test]
fn bytes_that_are_not_text() {
    let mut files = Files::default();
    files.0.insert("latin", b"# gr\xfcn\nShape \"gr\xfcn\"\nShape \"ok\"\n\xfc".to_vec());
    files.0.insert("wide", b"\xff\xfeS\0h\0".to_vec());
    files.0.insert("bom", b"\xef\xbb\xbfShape \"disk\"".to_vec());
    files.0.insert("zip", b"\x1f\x8b\x08\x00nonsense".to_vec());
    let text =
        "WorldBegin Include \"latin\" Include \"bom\" Include \"wide\" Include \"zip\" Include \"gone\"";
    let (d, found) = read_with(&files, text);
    assert_eq!(found[0], "latin:2:7: error: this string is not text in UTF-8");
    assert_eq!(found[1], "latin:4:1: error: this is not text in UTF-8");
    assert_eq!(
        found[2],
        "s:1:50: error: cannot read \"wide\": the text is in UTF-16; pbrt's format is UTF-8"
    );
    assert!(found[3].starts_with("s:1:65: error: cannot read \"zip\": "), "{}", found[3]);
    assert_eq!(found[4], "s:1:79: error: cannot read \"gone\": there is no such file");
    assert_eq!(found.len(), 5);
    let kinds: Vec<_> = d.shapes.iter().map(|s| s.entity.kind.as_str()).collect();
    assert_eq!(kinds, ["ok", "disk"]);
}

#[test]
fn files_on_disk_are_found_beside_the_scene() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    std::fs::create_dir(path("sub")).unwrap();
    // As in pbrt, names are relative to the scene and not to the file that says them.
    std::fs::write(path("scene.pbrt"), "WorldBegin Include \"sub/a.pbrt\" Import \"z.pbrt.gz\"").unwrap();
    std::fs::write(path("sub/a.pbrt"), "Include \"sub/b.pbrt\"\nInclude \"b.pbrt\" Include \"sub\"").unwrap();
    std::fs::write(path("sub/b.pbrt"), "Shape \"disk\" Include \"./sub/../scene.pbrt\"").unwrap();
    std::fs::write(path("z.pbrt.gz"), packed("Shape \"sphere\"")).unwrap();
    let mut sources = SourceMap::new();
    let (d, diagnostics) = read_pbrt(&path("scene.pbrt"), &mut sources);
    let kinds: Vec<_> = d.shapes.iter().map(|s| s.entity.kind.as_str()).collect();
    assert_eq!(kinds, ["disk", "sphere"]);
    let shown = |name: &str| path(name).display().to_string();
    assert_eq!(
        lines(&diagnostics, &sources),
        [
            format!(
                "{}:1:22: error: \"./sub/../scene.pbrt\" includes itself (the circle is scene.pbrt → a.pbrt → b.pbrt → ./sub/../scene.pbrt)",
                shown("sub/b.pbrt")
            ),
            format!(
                "{}:2:9: error: cannot read \"{}\": there is no such file",
                shown("sub/a.pbrt"),
                shown("b.pbrt")
            ),
            format!(
                "{}:2:26: error: cannot read \"{}\": not a regular file",
                shown("sub/a.pbrt"),
                shown("sub")
            ),
        ]
    );
    assert_eq!(sources.files().len(), 4);

    let mut sources = SourceMap::new();
    let (_, diagnostics) = read_pbrt(&path("nothing.pbrt"), &mut sources);
    let missing = format!("error: cannot read \"{}\": there is no such file", shown("nothing.pbrt"));
    assert_eq!(lines(&diagnostics, &sources), [missing]);
}
