//! Broken scenes: each ends with exit code 2 and a finding that names file, line and column, and leaves no file behind.

use crate::Place;

/// The first line of a scene whose world is broken.
const HEAD: &str = "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \
    Sampler \"independent\" \"integer pixelsamples\" 1 Camera \"perspective\" WorldBegin\n";

/// Worlds, which begin in line 2, and the place and a part of the message of what is found first.
const WORLDS: &[(&str, &str, &str)] = &[
    // Files that break off.
    ("Shape", "2:1", "Shape needs a name"),
    ("Shape \"sphere", "2:7", "not closed"),
    ("Shape \"sphere\" \"float radius\"", "2:16", "before the value"),
    ("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0", "2:33", "ends inside the list"),
    ("Translate 1 2", "2:1", "needs 3 numbers"),
    ("AttributeBegin\n  Shape \"sphere\"\n", "2:1", "AttributeEnd"),
    ("ObjectBegin \"o\"\nShape \"sphere\"\n", "2:1", "ObjectEnd"),
    ("AttributeEnd", "2:1", "closes nothing"),
    // Words that do not exist.
    ("Shpae \"sphere\"", "2:1", "did you mean \"Shape\"?"),
    ("Shape \"shpere\"", "2:7", "did you mean \"sphere\"?"),
    ("Shape \"sphere\" \"float raduis\" 1", "2:16", "did you mean \"radius\"?"),
    ("Material \"difuse\"", "2:10", "did you mean \"diffuse\"?"),
    ("LightSource \"pont\"", "2:13", "did you mean \"point\"?"),
    ("AreaLightSource \"difuse\"\nShape \"sphere\"", "2:17", "did you mean \"diffuse\"?"),
    ("Texture \"t\" \"float\" \"constnt\"", "2:21", "did you mean \"constant\"?"),
    ("Material \"diffuse\" \"rgb reflectence\" [ 1 1 1 ]", "2:20", "did you mean \"reflectance\"?"),
    ("Material \"conductor\" \"spectrum eta\" \"metal-Gu-eta\"", "2:37", "metal-Au-eta"),
    ("NamedMaterial \"steel\"\nShape \"sphere\"", "2:15", "steel"),
    ("ObjectInstance \"tree\"", "2:16", "tree"),
    ("Material \"diffuse\" \"texture reflectance\" \"wood\"", "2:42", "wood"),
    ("ColorSpace \"srbg\"", "2:12", "did you mean \"srgb\"?"),
    // Wrong types, counts and values.
    ("Shape \"sphere\" \"float radius\" true", "2:31", "expected a number"),
    ("Shape \"sphere\" \"float radius\" \"one\"", "2:31", "expected a number"),
    ("Shape \"sphere\" \"string radius\" \"one\"", "2:16", "radius"),
    ("Shape \"sphere\" \"float radius\" [ 1 2 ]", "2:31", "one number"),
    ("Shape \"sphere\" \"flaot radius\" 1", "2:16", "did you mean \"float\"?"),
    ("Shape \"sphere\" \"float radius\" 0", "2:31", "radius"),
    ("Shape \"sphere\" \"float radius\" nan", "2:31", "nan"),
    ("Shape \"sphere\" \"float radius\" 1e99", "2:31", "3.4e38"),
    ("LightSource \"point\" \"rgb I\" [ 1 2 ]", "2:29", "3 numbers"),
    ("LightSource \"point\" \"spectrum I\" [ 400 1 500 ]", "2:34", "pairs"),
    ("LightSource \"point\" \"blackbody I\" -5", "2:35", "temperature"),
    (
        "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" \"bool remaproughness\" 3",
        "2:72",
        "true or false",
    ),
    // Transforms.
    ("Translate 0 nan 0\nShape \"sphere\"", "2:13", "nan"),
    ("Scale 0 0 0\nShape \"sphere\"", "2:1", "inverse"),
    ("Transform [ nan 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1 ]\nShape \"sphere\"", "2:13", "nan"),
    ("LookAt 0 0 0  0 0 0  0 1 0", "2:1", "LookAt"),
    ("Rotate 90 0 0 0", "2:1", "Rotate"),
    // Meshes.
    ("Shape \"trianglemesh\"", "2:7", "\"point3 P\""),
    (
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"integer indices\" [ 0 1 3 ]",
        "2:75",
        "out of range",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"integer indices\" [ 0 1 -1 ]",
        "2:75",
        "negative",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"integer indices\" [ 0 1 ]",
        "2:75",
        "multiple of 3",
    ),
    (
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ] \"integer indices\" [ 0 1 2 ]",
        "2:7",
        "area",
    ),
    ("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]", "2:7", "integer indices"),
    ("Shape \"loopsubdiv\" \"integer levels\" 99", "2:37", "levels"),
    ("Shape \"plymesh\"", "2:7", "filename"),
    ("Shape \"plymesh\" \"string filename\" \"missing.ply\"", "2:35", "missing.ply"),
    ("Shape \"plymesh\" \"string filename\" \"folder\"", "2:35", "folder"),
    ("Shape \"plymesh\" \"string filename\" \"empty.ply\"", "2:35", "empty.ply"),
    ("Shape \"plymesh\" \"string filename\" \"text.ply\"", "2:35", "text.ply"),
    ("Shape \"plymesh\" \"string filename\" \"truncated.ply\"", "2:35", "truncated.ply"),
    ("Shape \"plymesh\" \"string filename\" \"huge.ply\"", "2:35", "huge.ply"),
    ("Shape \"plymesh\" \"string filename\" \"hugelist.ply\"", "2:35", "hugelist.ply"),
    ("Shape \"plymesh\" \"string filename\" \"index.ply\"", "2:35", "index.ply"),
    ("Shape \"plymesh\" \"string filename\" \"nan.ply\"", "2:35", "nan.ply"),
    // Files.
    ("Include \"missing.pbrt\"", "2:9", "missing.pbrt"),
    ("Include \"self.pbrt\"", "self.pbrt:1:9", "itself"),
    ("Include \"ping.pbrt\"", "pong.pbrt:1:9", "ping.pbrt"),
    ("Include \"deep0.pbrt\"", "pbrt:1:9", "deep"),
    ("Import \"broken.pbrt\"", "broken.pbrt:3:1", "did you mean \"Shape\"?"),
    ("Include \"packed.pbrt.gz\"", "2:9", "packed.pbrt.gz"),
    ("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"missing.png\"", "2:53", "missing.png"),
    ("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"text.png\"", "2:53", "text.png"),
    ("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"damaged.png\"", "2:53", "damaged.png"),
    ("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"huge.pfm\"", "2:53", "huge.pfm"),
    ("LightSource \"infinite\" \"string filename\" \"missing.exr\"", "2:42", "missing.exr"),
    ("Material \"conductor\" \"spectrum eta\" \"words.spd\"", "2:37", "words.spd"),
    // What pbrt has and tenfold does not have yet.
    ("Material \"hair\"", "2:10", "not supported"),
    ("Shape \"curve\" \"point3 P\" [ 0 0 0 1 1 1 2 2 2 3 3 3 ]", "2:7", "not supported"),
];

/// Whole scenes, the same.
const SCENES: &[(&str, &str, &str)] = &[
    ("", "1:1", "WorldBegin"),
    ("# nothing\n", "1:1", "WorldBegin"),
    ("WorldBegin\nShape \"sphere\"\n", "2:15", "no camera"),
    ("Camera \"perpective\"\nWorldBegin\n", "1:8", "did you mean \"perspective\"?"),
    ("Camera \"perspective\" \"float fov\" 0\nWorldBegin\n", "1:34", "field of view"),
    ("Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 0\nWorldBegin\n", "1:55", "xresolution"),
    (
        "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 2000000000\nWorldBegin\n",
        "1:55",
        "xresolution",
    ),
    (
        "Camera \"perspective\" Film \"rgb\" \"float cropwindow\" [ 1 1 0 1 ]\nWorldBegin\n",
        "1:52",
        "no pixel",
    ),
    ("Camera \"perspective\" Sampler \"sobool\"\nWorldBegin\n", "1:30", "did you mean \"sobol\"?"),
    ("Camera \"perspective\" Sampler \"sobol\" \"integer pixelsamples\" 0\nWorldBegin\n", "1:61", "sample"),
    (
        "Camera \"perspective\" Sampler \"stratified\" \"integer xsamples\" -2 \"integer ysamples\" -3\nWorldBegin\n",
        "1:62",
        "at least one",
    ),
    (
        "Camera \"perspective\" Sampler \"stratified\" \"integer xsamples\" 65536 \"integer ysamples\" 65536\nWorldBegin\n",
        "1:62",
        "too many",
    ),
    (
        "Camera \"perspective\" PixelFilter \"gaussian\" \"float sigma\" 1e9\nWorldBegin\n",
        "1:34",
        "averages nothing",
    ),
    ("Camera \"perspective\" Integrator \"pathh\"\nWorldBegin\n", "1:33", "did you mean \"path\"?"),
    ("Camera \"perspective\" PixelFilter \"box\" \"float xradius\" -1\nWorldBegin\n", "1:56", "radius"),
    ("Camera \"perspective\" PixelFilter \"bxo\"\nWorldBegin\n", "1:34", "did you mean \"box\"?"),
    ("Camera \"perspective\" WorldBegin\nWorldBegin\n", "2:1", "WorldBegin"),
    ("\u{1f600}", "1:1", "directive"),
    ("Camera \"perspective\" \"float screenwindow\" [ 0 0 0 0 ]\nWorldBegin\n", "1:43", "rising order"),
];

/// The files that the worlds name.
fn add_files(place: &Place) {
    let header = |vertices: &str, faces: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
             property float z\nelement face {faces}\nproperty list uint int vertex_indices\nend_header\n"
        )
    };
    let triangle: Vec<u8> =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let with = |header: String, body: &[u8]| [header.as_bytes(), body].concat();
    let face = |count: u32, last: i32| {
        [count.to_le_bytes(), 0i32.to_le_bytes(), 1i32.to_le_bytes(), last.to_le_bytes()].concat()
    };
    place.add("empty.ply", "");
    place.add("text.ply", "this is not a mesh\n");
    place.add("truncated.ply", with(header("100", "50"), &triangle));
    place.add("huge.ply", with(header("180000000", "1"), &triangle));
    place.add("hugelist.ply", with(header("3", "1"), &[&triangle[..], &face(0x7fff_ffff, 2)].concat()));
    place.add("index.ply", with(header("3", "1"), &[&triangle[..], &face(3, 7)].concat()));
    let mut with_nan = triangle.clone();
    with_nan[8..12].copy_from_slice(&f32::NAN.to_le_bytes());
    place.add("nan.ply", with(header("3", "1"), &[&with_nan[..], &face(3, 2)].concat()));
    std::fs::create_dir(place.path("folder")).unwrap();

    place.add("self.pbrt", "Include \"self.pbrt\"\n");
    place.add("ping.pbrt", "Include \"pong.pbrt\"\n");
    place.add("pong.pbrt", "Include \"ping.pbrt\"\n");
    for i in 0..100 {
        place.add(&format!("deep{i}.pbrt"), format!("Include \"deep{}.pbrt\"\n", i + 1));
    }
    place.add("deep100.pbrt", "Shape \"sphere\"\n");
    place.add("broken.pbrt", "# one\n# two\nShpae \"sphere\"\n");
    place.add("packed.pbrt.gz", b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x03\xff\xff\xff");

    place.add("text.png", "not an image\n");
    place.add("damaged.png", b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0dIHDR\x00\x00");
    place.add("huge.pfm", "PF\n20000 20000\n-1.0\nabc");
    place.add("words.spd", "400 one\n");
}

#[test]
fn every_broken_scene_is_told_where() {
    let place = Place::new();
    add_files(&place);
    let before = place.files();
    let worlds = WORLDS.iter().map(|(world, at, part)| (format!("{HEAD}{world}"), at, part));
    let scenes = SCENES.iter().map(|(scene, at, part)| (scene.to_string(), at, part));
    let mut wrong = Vec::new();
    for (scene, at, part) in worlds.chain(scenes) {
        place.add("scene.pbrt", &scene);
        let run = place.run("scene.pbrt -o out.exr");
        let place_of = |line: &str| line.split(": error: ").next().unwrap().to_owned();
        let errors: Vec<&str> = run.err.lines().filter(|line| line.contains(": error: ")).collect();
        let found = errors.first().is_some_and(|first| {
            let place = place_of(first);
            // File, line, column.
            place.rsplit(':').take(2).all(|number| number.parse::<u32>().is_ok())
                && if at.contains("pbrt:") {
                    place.ends_with(at)
                } else {
                    place.starts_with(&format!("scene.pbrt:{at}"))
                }
                && first.contains(part)
        });
        let clean = run.code == Some(2) && run.out.is_empty() && !run.err.contains("panicked");
        if !found || !clean || place.files() != before {
            let _ = std::fs::remove_file(place.path("out.exr"));
            wrong.push(format!("{scene}\nexpected {at} {part}; exit code {:?}\n{}", run.code, run.err));
        }
    }
    let count = WORLDS.len() + SCENES.len();
    assert!(wrong.is_empty(), "{} of {count}:\n\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn scenes_that_cannot_be_read_are_named() {
    let place = Place::new();
    add_files(&place);
    let before = place.files();
    for name in ["missing.pbrt", "folder", "packed.pbrt.gz", "self.pbrt", "truncated.ply"] {
        let run = place.run(&format!("{name} -o out.exr"));
        assert_eq!(run.code, Some(2), "{name}");
        assert!(run.err.contains(name) && run.err.contains("error: "), "{name}: {}", run.err);
        assert!(!run.err.contains("panicked"));
    }
    assert_eq!(place.files(), before);
}

#[test]
fn floods_of_faults_stay_readable() {
    let place = Place::with(&format!("{HEAD}{}", "Shape \"sphere\" \"float radius\" true\n".repeat(20_000)));
    let run = place.run("scene.pbrt");
    assert_eq!(run.code, Some(2));
    assert!(run.err.lines().count() < 200 && run.err.contains("20000 errors"), "{}", run.err.len());
}
