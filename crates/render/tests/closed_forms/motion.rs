//! Motion blur: what a pixel shows is the mean over the time that the shutter is open.

use super::common::{area, check_pixels, clip_to_box, film, luminance, scene};
use tenfold_math::Vec3;
use tenfold_render::scene::Scene;

pub(crate) const WIDTH: usize = 20;
pub(crate) const HEIGHT: usize = 10;

pub(crate) type Polygon = Vec<[f64; 2]>;

/// Black shapes before a white sky, seen in parallel along z: x from -1 to 1, y from -0.5 to 0.5.
pub(crate) fn silhouettes(camera: &str, world: &str) -> Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {WIDTH} "integer yresolution" {HEIGHT} "float exposuretime" 1
        PixelFilter "box" Sampler "zsobol" "integer pixelsamples" 64 Integrator "path" "integer maxdepth" 1
        {camera} WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
        Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ] {world}"#
    ))
}

/// The camera of most tests, open from time `open` to `close`.
pub(crate) fn camera(open: f64, close: f64) -> String {
    format!(
        r#"Camera "orthographic" "float screenwindow" [ -1 1 -0.5 0.5 ] "float shutteropen" {open} "float shutterclose" {close}"#
    )
}

/// A polygon with corners in counter-clockwise order, as a shape at z = 3.
pub(crate) fn shape(polygon: &[[f64; 2]]) -> String {
    let points: String = polygon.iter().map(|[x, y]| format!("{x} {y} 3 ")).collect();
    let fan: String = (2..polygon.len()).map(|i| format!("0 {} {i} ", i - 1)).collect();
    format!(r#"Shape "trianglemesh" "point3 P" [ {points} ] "integer indices" [ {fan} ]"#)
}

/// What every pixel sees of the sky, behind a polygon that `at` places at every time.
pub(crate) fn blurred(open: f64, close: f64, at: impl Fn(f64) -> Polygon) -> Vec<f64> {
    weighted(open, close, |_| 1.0, at)
}

/// The same with a weight for every fraction of the time.
pub(crate) fn weighted(
    open: f64,
    close: f64,
    weight: impl Fn(f64) -> f64,
    at: impl Fn(f64) -> Polygon,
) -> Vec<f64> {
    const STEPS: usize = 1500;
    let fraction = |step: usize| (step as f64 + 0.5) / STEPS as f64;
    let total: f64 = (0..STEPS).map(|step| weight(fraction(step))).sum();
    let mut covered = vec![0.0; WIDTH * HEIGHT];
    for step in 0..STEPS {
        let polygon = at(open + (close - open) * fraction(step));
        let share = weight(fraction(step)) / total;
        for (i, sum) in covered.iter_mut().enumerate() {
            let corner = |x: usize, y: usize| [x as f64 * 0.1 - 1.0, 0.5 - y as f64 * 0.1];
            let (left, top) = (i % WIDTH, i / WIDTH);
            let (low, high) = (corner(left, top + 1), corner(left + 1, top));
            // Most pixels are far from the polygon: spare them the clipping.
            let apart = (0..2)
                .any(|k| polygon.iter().all(|p| p[k] <= low[k]) || polygon.iter().all(|p| p[k] >= high[k]));
            if !apart {
                *sum += area(&clip_to_box(&polygon, low, high)) / 0.01 * share;
            }
        }
    }
    covered.iter().map(|c| 1.0 - c).collect()
}

pub(crate) fn moved(polygon: &[[f64; 2]], dx: f64, dy: f64) -> Polygon {
    polygon.iter().map(|[x, y]| [x + dx, y + dy]).collect()
}

pub(crate) fn rotated(polygon: &[[f64; 2]], degrees: f64) -> Polygon {
    let (s, c) = degrees.to_radians().sin_cos();
    polygon.iter().map(|[x, y]| [c * x - s * y, s * x + c * y]).collect()
}

pub(crate) const CARD: [[f64; 2]; 4] = [[-0.12, -0.15], [0.08, -0.15], [0.08, 0.17], [-0.12, 0.17]];

/// A card at constant speed: every point of its path is covered for the same time.
#[test]
fn translation() {
    let world = format!(
        "ActiveTransform StartTime Translate -0.6 -0.2 0 ActiveTransform EndTime Translate 0.7 0.15 0 ActiveTransform All {}",
        shape(&CARD)
    );
    // The times of the transforms are those of the file, 0 and 1, whenever the shutter is open.
    for (i, (open, close)) in [(0.0, 1.0), (0.25, 0.6), (0.9, 1.4)].into_iter().enumerate() {
        let pixels = luminance(&silhouettes(&camera(open, close), &world), 2000, i as u64);
        let want = blurred(open, close, |t| {
            let t = t.min(1.0);
            moved(&CARD, -0.6 + 1.3 * t, -0.2 + 0.35 * t)
        });
        check_pixels(&format!("open from {open} to {close}"), &pixels, &want);
    }
}

/// Transforms may have times of their own.
#[test]
fn transform_times() {
    let scene = format!(
        "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All {}",
        shape(&moved(&CARD, -0.5, 0.0))
    );
    let camera = format!("TransformTimes 0.2 0.5 {}", camera(0.0, 1.0));
    let want = blurred(0.0, 1.0, |t| moved(&CARD, -0.5 + ((t - 0.2) / 0.3).clamp(0.0, 1.0), 0.0));
    check_pixels("times", &luminance(&silhouettes(&camera, &scene), 2000, 5), &want);
}

/// A card on an arm at constant angular speed: the path is an arc, and the time spent over an abscissa 1 / |dx/dt|.
#[test]
fn rotation() {
    let card = moved(&CARD, 0.3, -0.1);
    let world = format!("ActiveTransform EndTime Rotate 150 0 0 1 ActiveTransform All {}", shape(&card));
    let pixels = luminance(&silhouettes(&camera(0.0, 1.0), &world), 2000, 1);
    check_pixels("rotation", &pixels, &blurred(0.0, 1.0, |t| rotated(&card, 150.0 * t)));
}

/// A transform is taken apart into translation, rotation and stretch, and each goes its own way: something that turns about a
/// far point moves along the chord.
#[test]
fn decomposition() {
    let world = format!(
        "ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All Translate 0.4 0 0 ActiveTransform EndTime Scale 2 1 1 ActiveTransform All {}",
        shape(&CARD)
    );
    let pixels = luminance(&silhouettes(&camera(0.0, 1.0), &world), 2000, 2);
    let want = blurred(0.0, 1.0, |t| {
        let stretched: Polygon = CARD.iter().map(|[x, y]| [x * (1.0 + t), *y]).collect();
        moved(&rotated(&stretched, 90.0 * t), 0.4 * (1.0 - t), 0.4 * t)
    });
    check_pixels("decomposition", &pixels, &want);
}

/// A wrong path is seen.
#[test]
#[should_panic(expected = "sum up to")]
fn a_wrong_speed_is_seen() {
    let world = format!("ActiveTransform EndTime Translate 0.8 0 0 ActiveTransform All {}", shape(&CARD));
    let pixels = luminance(&silhouettes(&camera(0.0, 1.0), &world), 2000, 1);
    check_pixels("wrong", &pixels, &blurred(0.0, 1.0, |t| moved(&CARD, 0.6 * t, 0.0)));
}

/// Two pictures by the same samples, which rounding alone tells apart: of all samples at most a few fall on the other side of an
/// outline.
#[track_caller]
pub(crate) fn check_same(what: &str, a: &[Vec3], b: &[Vec3]) {
    let darkest = a.iter().map(|p| p.max_element()).fold(f32::MAX, f32::min);
    assert!(darkest < 0.95, "{what}: there is nothing to see");
    let differing = a.iter().zip(b).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-4).count();
    assert!(differing * 50 <= a.len(), "{what}: {differing} of {} pixels differ", a.len());
}

const PATH: &str = "ActiveTransform StartTime Translate -0.4 -0.1 0 ActiveTransform EndTime Translate 0.6 0.1 0 \
    Rotate 70 0 0 1 ActiveTransform All";

/// A shape that moves, an instance that moves, and a moving shape in an instance: one motion, one picture.
#[test]
fn instances_and_shapes_move_alike() {
    let picture = |world: &str| film(&silhouettes(&camera(0.0, 1.0), world), |_| {}).means();
    let card = shape(&CARD);
    let direct = picture(&format!("{PATH} {card}"));
    let instance = picture(&format!(r#"ObjectBegin "card" {card} ObjectEnd {PATH} ObjectInstance "card""#));
    check_same("moving instance", &direct, &instance);
    let nested = picture(&format!(
        r#"AttributeBegin {PATH} ObjectBegin "card" {card} ObjectEnd AttributeEnd ObjectInstance "card""#
    ));
    check_same("moving shape in an instance", &direct, &nested);
}

/// Only relative motion counts: a camera that moves sees what it would see at rest of a world that moves the other way.
#[test]
fn moving_camera_and_moving_world() {
    let still =
        [CARD.to_vec(), moved(&CARD, 0.5, 0.2), moved(&CARD, -0.6, 0.1)].map(|card| shape(&card)).concat();
    // Both at once would not do: motions are interpolated part by part, and those of the inverse have other parts.
    for motion in ["Translate 0.3 -0.2 0", "Rotate 40 0 0 1"] {
        let motion = format!("ActiveTransform EndTime {motion} ActiveTransform All");
        let camera = camera(0.0, 1.0);
        let moving_world = film(&silhouettes(&camera, &format!("{motion} {still}")), |_| {});
        // The transform before the camera maps the world to the camera.
        let moving_camera = film(&silhouettes(&format!("{motion} {camera}"), &still), |_| {});
        check_same(&motion, &moving_world.means(), &moving_camera.means());
    }
}

/// The film is exposed for as long as the shutter is open, unless it says how long itself.
#[test]
fn exposure() {
    let sky = |film_says: &str| {
        let scene = scene(&format!(
            r#"Film "rgb" "integer xresolution" 8 "integer yresolution" 8 {film_says} PixelFilter "box" {}
            WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]"#,
            camera(0.25, 0.75)
        ));
        let pixels = luminance(&scene, 256, 1);
        pixels.iter().map(|p| p.mean).sum::<f64>() / 64.0
    };
    assert!((sky("") - 0.5).abs() < 0.01, "{}", sky(""));
    assert!((sky(r#""float exposuretime" 1"#) - 1.0).abs() < 0.02);
    assert!((sky(r#""float exposuretime" 2 "float iso" 200"#) - 4.0).abs() < 0.08);
}
