//! Motion through three and more keys: closed forms, and the average of still frames.

use super::common::{SIGNIFICANCE, channels, check_pixels, film, luma, luminance, scene};
use super::motion::{CARD, Polygon, blurred, camera, check_same, moved, rotated, shape, silhouettes};
use tenfold_testkit::{Rng, Welford, stats::t_test_two};

/// The parabola through three points.
fn parabola(t: [f64; 3], y: [f64; 3]) -> impl Fn(f64) -> f64 {
    move |x| {
        let basis = |i: usize| {
            let others = (0..3).filter(|j| *j != i);
            others.map(|j| (x - t[j]) / (t[i] - t[j])).product::<f64>()
        };
        (0..3).map(|i| y[i] * basis(i)).sum()
    }
}

const TIMES: [f64; 3] = [0.1, 0.35, 0.9];
const X: [f64; 3] = [-0.7, 0.1, 0.6];
const Y: [f64; 3] = [-0.25, 0.25, -0.1];
const DEGREES: [f64; 3] = [0.0, 100.0, 80.0];

/// `TransformTimes`, and the transforms at each key.
fn keys() -> (String, String) {
    let key =
        |i: usize| format!("ActiveTransform {i} Translate {} {} 0 Rotate {} 0 0 1 ", X[i], Y[i], DEGREES[i]);
    let transforms: String = (0..3).map(key).collect();
    (
        format!("TransformTimes [ {} {} {} ] ", TIMES[0], TIMES[1], TIMES[2]),
        transforms + "ActiveTransform All ",
    )
}

/// The card on its path: place and angle go as the parabolas through their keys.
fn card(t: f64) -> Polygon {
    let t = t.clamp(TIMES[0], TIMES[2]);
    moved(&rotated(&CARD, parabola(TIMES, DEGREES)(t)), parabola(TIMES, X)(t), parabola(TIMES, Y)(t))
}

#[test]
fn three_keys() {
    let (times, transforms) = keys();
    let world = transforms + &shape(&CARD);
    // The whole path, with rests before and after it; and a part of it.
    for (i, (open, close)) in [(0.0, 1.0), (0.3, 0.4)].into_iter().enumerate() {
        let scene = silhouettes(&(times.clone() + &camera(open, close)), &world);
        let pixels = luminance(&scene, 2000, 11 + i as u64);
        check_pixels(&format!("open from {open} to {close}"), &pixels, &blurred(open, close, card));
    }
}

/// Straight from key to key is another path.
#[test]
#[should_panic(expected = "sum up to")]
fn corners_in_the_path_are_seen() {
    let (times, transforms) = keys();
    let scene = silhouettes(&(times + &camera(0.0, 1.0)), &(transforms + &shape(&CARD)));
    let straight = |t: f64, y: [f64; 3]| {
        let i = usize::from(t > TIMES[1]);
        let s = ((t - TIMES[i]) / (TIMES[i + 1] - TIMES[i])).clamp(0.0, 1.0);
        y[i] * (1.0 - s) + y[i + 1] * s
    };
    let want =
        blurred(0.0, 1.0, |t| moved(&rotated(&CARD, straight(t, DEGREES)), straight(t, X), straight(t, Y)));
    check_pixels("corners", &luminance(&scene, 2000, 13), &want);
}

#[test]
fn shapes_instances_and_shapes_in_instances_go_alike() {
    let (times, transforms) = keys();
    let head = times + &camera(0.0, 1.0);
    let picture = |world: &str| film(&silhouettes(&head, world), |_| {}).means();
    let card = shape(&CARD);
    let direct = picture(&format!("{transforms} {card}"));
    let object = format!(r#"ObjectBegin "card" {card} ObjectEnd"#);
    check_same("instance", &direct, &picture(&format!(r#"{object} {transforms} ObjectInstance "card""#)));
    let nested = format!(r#"AttributeBegin {transforms} {object} AttributeEnd ObjectInstance "card""#);
    check_same("shape in an instance", &direct, &picture(&nested));
}

/// A lit room in which the camera, an instance and a shape within it all go through three keys or four.
fn everything_moves(shutter: &str) -> String {
    format!(
        r#"Film "rgb" "integer xresolution" 24 "integer yresolution" 16 "float exposuretime" 1 PixelFilter "box"
        Integrator "path" "integer maxdepth" 2 TransformTimes [ 0 0.3 0.6 1 ]
        ActiveTransform 0 LookAt 0 1 5  0 0 0  0 1 0 ActiveTransform 1 LookAt 0.4 1.1 5  0 0.2 0  0 1 0
        ActiveTransform 2 LookAt 0.3 1.3 5  0.2 0 0  0.1 1 0 ActiveTransform 3 LookAt 0 1.3 5  0 0 0  0 1 0
        ActiveTransform All Camera "perspective" "float fov" 36 {shutter}
        WorldBegin LightSource "infinite" "rgb L" [ 0.6 0.7 0.8 ]
        LightSource "distant" "rgb L" [ 2 1.8 1.5 ] "point3 from" [ 2 3 4 ]
        AttributeBegin Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.4 ]
        Shape "trianglemesh" "integer indices" [ 0 2 1 2 3 1 ] "point3 P" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]
        AttributeEnd Material "diffuse" "rgb reflectance" [ 0.8 0.2 0.1 ]
        ObjectBegin "pair" Shape "sphere" "float radius" 0.4
        ActiveTransform 1 Translate 0.3 0.2 0 Rotate 60 0 1 0 ActiveTransform EndTime Rotate 140 1 1 0 ActiveTransform All
        Translate 0.8 0 0 Shape "disk" "float radius" 0.5 ObjectEnd
        ActiveTransform 0 Translate -1 -0.5 0 ActiveTransform 1 Translate -0.2 0.8 0 Rotate 40 0 0 1
        ActiveTransform 2 Translate 0.6 0.4 0.3 Scale 1.3 1 1 ActiveTransform 3 Translate 0.9 -0.4 0
        ObjectInstance "pair""#
    )
}

/// The picture of a path is the average of still frames, at times that are spread evenly with a random place in each share, so
/// that they are not biased. Errors are measured on independent repetitions of both.
#[test]
fn a_path_is_the_average_of_still_frames() {
    const FRAMES: usize = 32;
    const REPETITIONS: u64 = 24;
    let (open, close) = (0.1, 0.95);
    let moving =
        scene(&everything_moves(&format!(r#""float shutteropen" {open} "float shutterclose" {close}"#)));
    // 4 × 4 pixels each.
    let tile = |pixel: usize| pixel / 24 / 4 * 6 + pixel % 24 / 4;
    let mut averages = [vec![Welford::new(); 24], vec![Welford::new(); 24]];
    let mut rng = Rng::new(5);
    for repetition in 0..REPETITIONS {
        let mut blur = [0.0; 24];
        let shot = film(&moving, |s| (s.spp, s.seed) = (FRAMES as u32, repetition)).means();
        shot.iter().enumerate().for_each(|(i, rgb)| blur[tile(i)] += luma(*rgb));
        let mut stills = [0.0; 24];
        for frame in 0..FRAMES {
            let time = open + (close - open) * (frame as f64 + rng.f64()) / FRAMES as f64;
            let shutter = format!(r#""float shutteropen" {time} "float shutterclose" {}"#, time + 1e-6);
            let still = scene(&everything_moves(&shutter));
            let seed = 1000 + repetition * FRAMES as u64 + frame as u64;
            let shot = film(&still, |s| (s.spp, s.seed) = (1, seed)).means();
            shot.iter().enumerate().for_each(|(i, rgb)| stills[tile(i)] += luma(*rgb) / FRAMES as f64);
        }
        (0..24).for_each(|i| averages[0][i].add(blur[i]));
        (0..24).for_each(|i| averages[1][i].add(stills[i]));
    }
    for (i, (blur, stills)) in averages[0].iter().zip(&averages[1]).enumerate() {
        t_test_two(blur, stills).check(&format!("tile {i}"), SIGNIFICANCE, 24);
    }
    // A first frame, or a last one, is another picture.
    let still = scene(&everything_moves(r#""float shutteropen" 0.1 "float shutterclose" 0.10001"#));
    let shot = channels(&film(&still, |s| s.spp = 64).means());
    let blurred = channels(&film(&moving, |s| s.spp = 64).means());
    let differing = shot.iter().zip(&blurred).filter(|(a, b)| (*a - *b).abs() > 0.05).count();
    assert!(differing * 5 > shot.len(), "{differing} of {}", shot.len());
}
