//! `--progress json`: one object a line, the last one `completed` or `failed`, whatever happens.

use crate::{Place, Run};
use serde_json::Value;

/// The lines of a run; there must be one last line, and it must come last.
fn events(run: &Run) -> Vec<Value> {
    let events: Vec<Value> = run.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let ends = |event: &&Value| event["event"] == "completed" || event["event"] == "failed";
    assert_eq!(events.iter().filter(ends).count(), 1, "{}", run.out);
    assert!(ends(&events.last().unwrap()), "{}", run.out);
    events
}

#[test]
fn a_render_starts_and_completes() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt --progress json -o a.exr -o b.png --strategy scatter=cosine");
    let events = events(&run);
    let (first, last) = (&events[0], events.last().unwrap());
    assert_eq!((&first["event"], &first["scene"]), (&"started".into(), &"scene.pbrt".into()));
    assert_eq!(first["samples"], 23 * 17 * 3);
    assert_eq!(first["strategy"], "light=complementary,scatter=cosine,combine=mis,time=shutter");
    assert_eq!(last["event"], "completed");
    assert_eq!(last["outputs"], serde_json::json!(["a.exr", "b.png"]));
    assert_eq!(last["samples"], 23 * 17 * 3);
    assert!(last["path_rays"].as_u64().unwrap() >= 23 * 17 * 3);
    let progress: Vec<_> = events.iter().filter(|e| e["event"] == "progress").collect();
    assert_eq!(progress.last().unwrap()["percent"], 100.0);
}

#[test]
fn a_pixel_comes_with_its_value() {
    let place = Place::new();
    let events = events(&place.succeed("scene.pbrt --progress=json --pixel 3,4"));
    let value = events.last().unwrap()["value"].as_array().unwrap().clone();
    assert_eq!(value.len(), 3);
}

#[test]
fn faults_of_the_scene_are_events() {
    let place = Place::with("WorldBegin\nShape \"sphere\" \"float radius\" true\n");
    let run = place.run("scene.pbrt --progress json");
    assert_eq!(run.code, Some(2));
    let events = events(&run);
    let found = events.iter().find(|e| e["event"] == "diagnostic").unwrap();
    assert_eq!((&found["severity"], &found["file"]), (&"error".into(), &"scene.pbrt".into()));
    assert_eq!((&found["line"], &found["column"]), (&2.into(), &31.into()));
    let last = events.last().unwrap();
    assert_eq!((&last["event"], &last["exit_code"]), (&"failed".into(), &2.into()));
}

#[test]
fn every_failure_has_its_last_line() {
    let place = Place::new();
    for (line, code) in [
        ("--progress json --no-such-option", 2),
        ("--no-such-option --progress=json", 2),
        ("--progress json --spp 0", 2),
        ("--progress json --mse-reference-image a.exr", 2),
        ("missing.pbrt --progress json", 2),
        ("scene.pbrt --progress json -o a.jpg", 2),
        ("scene.pbrt --progress json -o missing/a.exr", 1),
        ("scene.pbrt --progress json --pixel 99,99", 2),
    ] {
        let run = place.run(line);
        assert_eq!(run.code, Some(code), "{line}: {}", run.err);
        let last = events(&run).pop().unwrap();
        assert_eq!((&last["event"], &last["exit_code"]), (&"failed".into(), &code.into()), "{line}");
        assert!(!last["message"].as_str().unwrap().is_empty(), "{line}");
    }
    assert_eq!(place.files(), ["scene.pbrt"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_render_keeps_what_it_has() {
    use std::{
        io::{BufRead, BufReader, Read},
        process::{Command, Stdio},
    };
    let place = Place::new();
    let mut command = place.command();
    command.args(["scene.pbrt", "--progress", "json", "--spp", "10000000", "-o", "a.exr"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut lines = String::new();
    while !lines.contains("\"progress\"") {
        assert!(out.read_line(&mut lines).unwrap() > 0, "{lines}");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    out.read_to_string(&mut lines).unwrap();
    let output = child.wait_with_output().unwrap();
    let run = Run { out: lines, ..Run::from(output) };
    assert_eq!(run.code, Some(1), "{}", run.err);
    let last = events(&run).pop().unwrap();
    assert!(last["event"] == "failed" && last["message"].as_str().unwrap().contains("interrupted"));
    assert!(place.read("a.exr").metadata.attributes.contains_key("interruptedAfterSamples"));
}
