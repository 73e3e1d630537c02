//! Options, messages and exit codes.

use crate::Place;

#[test]
fn help_tells_examples_and_exit_codes() {
    let place = Place::new();
    for line in ["--help", "render --help", "-h"] {
        let run = place.succeed(line);
        for part in ["Examples:", "Exit codes:", "--cropwindow", "--progress", "zsobol"] {
            assert!(run.out.contains(part), "{line}: {part}");
        }
        assert!(run.err.is_empty());
    }
    assert_eq!(place.succeed("--version").out, format!("tenfold {}\n", env!("CARGO_PKG_VERSION")));
    assert_eq!(place.files(), ["scene.pbrt"]);
}

#[test]
fn wrong_command_lines_say_what_is_wrong() {
    let place = Place::new();
    for (line, part) in [
        ("scene.pbrt --sppp 3", "'--spp'"),
        ("scene.pbrt --spp", "--spp"),
        ("scene.pbrt --spp none", "none"),
        ("scene.pbrt --cropwindow 0,1,0", "4 numbers"),
        ("scene.pbrt --cropwindow 0.5,0.5,0,1", "no pixel"),
        ("scene.pbrt --pixel 23,0", "23 × 17"),
        ("scene.pbrt --pixel -1,0", "23 × 17"),
        ("scene.pbrt --pixelbounds 30,40,0,4", "no pixel"),
        ("scene.pbrt --freeze lense", "did you mean lens?"),
        ("scene.pbrt --sampler zsobl", "did you mean zsobol?"),
        ("scene.pbrt --strategy light=solid-angel", "did you mean solid-angle?"),
        ("scene.pbrt -o picture", "suffix"),
        ("scene.pbrt -o picture.exe", ".exr"),
        ("scene.pbrt -o picture.jpg", "only read"),
        ("scene.pbrt other.pbrt", "other.pbrt"),
        ("scene.gltf", ".gltf"),
        ("scene.pbrt --display-server localhost:14158", "--progress json"),
        ("scene.pbrt --log a=b=c", "--log"),
    ] {
        let run = place.run(line);
        assert_eq!(run.code, Some(2), "{line}: {}", run.err);
        assert!(run.err.contains(part), "{line}: {}", run.err);
        assert!(run.out.is_empty() && !run.err.contains("panicked"), "{line}");
    }
    assert_eq!(place.files(), ["scene.pbrt"]);
}

#[test]
fn places_that_cannot_be_written_are_found_before_the_render() {
    let place = Place::new();
    std::fs::create_dir(place.path("folder.exr")).unwrap();
    for line in ["-o missing/a.exr", "-o folder.exr", "-o a.exr -o missing/b.png"] {
        // More samples than there is time for.
        let run = place.run(&format!("scene.pbrt --spp 4000000000 {line}"));
        assert_eq!(run.code, Some(1), "{line}: {}", run.err);
        assert!(run.err.contains("cannot write"), "{line}: {}", run.err);
    }
    assert_eq!(place.files(), ["folder.exr", "scene.pbrt"]);
}

#[test]
fn quiet_runs_say_nothing_but_errors() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt --quiet --gpu");
    assert_eq!((run.out, run.err), (String::new(), String::new()));
    assert!(!place.run("missing.pbrt --quiet").err.is_empty());
}

#[test]
fn options_of_pbrt_without_effect_are_noted() {
    let place = Place::new();
    let run = place.succeed("-spp 1 --wavefront --render-coord-sys world scene.pbrt -outfile a.exr");
    assert!(run.err.contains("--wavefront does not change the picture"), "{}", run.err);
    assert_eq!(place.files(), ["a.exr", "scene.pbrt"]);
}

#[test]
fn tables_and_logs_are_there_when_asked_for() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt --stats --log tenfold=info");
    for part in ["shadow rays", "primitives", "rendering", "lights", "INFO tenfold"] {
        assert!(run.err.contains(part), "{part}: {}", run.err);
    }
    assert!(run.out.is_empty());
}

#[test]
fn the_largest_picture_does_not_end_in_an_abort() {
    let scene = crate::SCENE.replace("xresolution\" 23", "xresolution\" 65536");
    let place = Place::with(&scene.replace("yresolution\" 17", "yresolution\" 65536"));
    let run = place.run("scene.pbrt --spp 1 --pixel 1,1");
    assert_eq!(run.code, Some(0), "{}", run.err);
}
