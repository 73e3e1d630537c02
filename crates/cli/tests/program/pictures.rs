//! The files that a render writes.

use crate::{Place, SCENE};
use tenfold_image::{Attribute, srgb_to_linear};

#[test]
fn the_scene_names_the_file_unless_the_command_line_does() {
    let place = Place::new();
    let run = place.succeed("scene.pbrt");
    assert_eq!(place.files(), ["named.exr", "scene.pbrt"]);
    assert!(run.err.contains("named.exr: 23 × 17 pixels with 3 samples"), "{}", run.err);
    assert!(run.err.contains("rays"), "{}", run.err);

    let place = Place::with(&SCENE.replace("\"string filename\" \"named.exr\"", ""));
    place.succeed("render scene.pbrt --spp 1");
    assert_eq!(place.files(), ["scene.pbrt", "tenfold.exr"]);
}

#[test]
fn standard_input_is_a_scene() {
    use std::{io::Write, process::Stdio};
    let place = Place::new();
    let mut command = place.command();
    command.args(["-", "-q", "--quick", "-o", "a.pfm"]).stdin(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(SCENE.as_bytes()).unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(place.files(), ["a.pfm", "scene.pbrt"]);
}

#[test]
fn the_default_scene_needs_no_file() {
    let place = Place::new();
    let run = place.succeed("--spp 1 --pixelbounds 0,4,0,4");
    assert_eq!(place.files(), ["scene.pbrt", "tenfold.png"]);
    assert!(run.err.contains("tenfold.png"), "{}", run.err);
    assert_eq!(place.read("tenfold.png").resolution(), (4, 4));
}

#[test]
fn all_formats_hold_the_same_picture() {
    let place = Place::new();
    place.succeed("scene.pbrt -o a.exr -o a.pfm -o a.png -o a.hdr");
    place.succeed("scene.pbrt --outfile=deep.png --png16");
    let exr = place.read("a.exr");
    assert_eq!(place.read("a.pfm").as_f32(), exr.as_f32());
    let [hdr, png, deep] = ["a.hdr", "a.png", "deep.png"].map(|name| place.read(name));
    let clipped = |x, y, c| exr.get(x, y, c).clamp(0.0, 1.0);
    for (x, y, c) in (0..17).flat_map(|y| (0..23).flat_map(move |x| (0..3).map(move |c| (x, y, c)))) {
        let brightest = (0..3).map(|c| exr.get(x, y, c)).fold(0.0, f32::max);
        assert!((hdr.get(x, y, c) - exr.get(x, y, c).max(0.0)).abs() <= brightest / 128.0);
        // A step of 8-bit codes at this brightness, in either direction: dithering.
        let tolerance = |codes: f32| {
            let code = tenfold_image::linear_to_srgb(clipped(x, y, c));
            srgb_to_linear((code + 1.5 / codes).min(1.0)) - srgb_to_linear((code - 1.5 / codes).max(0.0))
        };
        assert!((png.get(x, y, c) - clipped(x, y, c)).abs() <= tolerance(255.0));
        assert!((deep.get(x, y, c) - clipped(x, y, c)).abs() <= tolerance(65535.0));
    }
}

#[test]
fn exr_files_tell_their_story() {
    let place = Place::new();
    let image = place.picture("--seed 42 --spp 2");
    let text = |name: &str| match image.metadata.attributes.get(name) {
        Some(Attribute::Text(text)) => text.clone(),
        other => panic!("{name}: {other:?}"),
    };
    assert_eq!(text("software"), format!("tenfold {}", env!("CARGO_PKG_VERSION")));
    assert_eq!([text("scene"), text("seed"), text("sampler")], ["scene.pbrt", "42", "zsobol"]);
    assert_eq!(text("strategy"), "light=complementary,scatter=bsdf,combine=mis,time=shutter");
    assert!(!image.metadata.attributes.contains_key("frozen"));
    assert_eq!(image.metadata.attributes["samplesPerPixel"], Attribute::I32(2));
    assert!(matches!(image.metadata.attributes["renderTimeSeconds"], Attribute::F32(s) if s > 0.0));
    let [red, .., white] = image.metadata.chromaticities.unwrap();
    assert!((red.x - 0.64).abs() < 1e-5 && (white.y - 0.329).abs() < 1e-3);
    assert_eq!(image.metadata.origin, (0, 0));
}

#[test]
fn what_is_frozen_is_told() {
    let place = Place::new();
    let image = place.picture("--sampler lens=n-rooks --freeze time=0.25,pixel --freeze dispersion");
    let text = |name: &str| match &image.metadata.attributes[name] {
        Attribute::Text(text) => text.clone(),
        other => panic!("{name}: {other:?}"),
    };
    assert_eq!(text("sampler"), "zsobol, pixel held at 0.5, lens=n-rooks, time held at 0.25");
    assert_eq!(text("frozen"), "pixel=0.5,time=0.25,dispersion=587.56");
    assert_ne!(image.as_f32(), place.picture("--sampler lens=n-rooks").as_f32());
}

#[test]
fn wide_colours_keep_their_meaning() {
    // The same scene on a film of another colour space: other numbers, the same PNG.
    let place = Place::new();
    let scene = SCENE
        .replace("Film", "ColorSpace \"rec2020\"\nFilm")
        .replace("LookAt", "ColorSpace \"srgb\"\nLookAt");
    place.add("wide.pbrt", scene);
    place.succeed("scene.pbrt -o srgb.exr -o srgb.png");
    place.succeed("wide.pbrt -o wide.exr -o wide.png");
    let [srgb, wide] = ["srgb.exr", "wide.exr"].map(|name| place.read(name));
    assert_ne!(srgb.as_f32(), wide.as_f32());
    assert!((wide.metadata.chromaticities.unwrap()[0].x - 0.708).abs() < 1e-5);
    let [srgb, wide] = ["srgb.png", "wide.png"].map(|name| place.read(name));
    let code =
        |image: &tenfold_image::Image, x, y, c| tenfold_image::linear_to_srgb(image.get(x, y, c)) * 255.0;
    for (x, y, c) in (0..17).flat_map(|y| (0..23).flat_map(move |x| (0..3).map(move |c| (x, y, c)))) {
        assert!((code(&srgb, x, y, c) - code(&wide, x, y, c)).abs() < 1.5, "{x},{y}");
    }
}

#[test]
fn a_picture_that_is_there_already_is_replaced_or_kept() {
    let place = Place::new();
    place.add("out.exr", "something else");
    place.picture("--spp 1");
    place.add("out.exr", "something else");
    place.add("broken.pbrt", "WorldBegin Shape");
    assert_eq!(place.run("broken.pbrt -o out.exr").code, Some(2));
    assert_eq!(std::fs::read(place.path("out.exr")).unwrap(), b"something else");
}
