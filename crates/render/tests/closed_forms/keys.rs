//! Motion through three keys against closed forms.

use super::common::{check_pixels, film, luminance};
use super::motion::{CARD, Polygon, blurred, camera, check_same, moved, rotated, shape, silhouettes};

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
