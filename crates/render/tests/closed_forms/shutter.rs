//! The picture of what moves while the shutter opens and closes: against closed forms, the average of still frames, and other
//! ways to sample the time.

use super::common::{SIGNIFICANCE, check_pixels, film, luma, luminance, scene};
use super::motion::{CARD, moved, rotated, shape, silhouettes, weighted};
use tenfold_math::Vec2;
use tenfold_render::{
    camera::TimeStrategy,
    scene::Scene,
    schedule::{Frozen, RenderSettings},
};
use tenfold_sampling::Variable;
use tenfold_testkit::{Rng, Welford, stats::t_test_two};

/// Parameters of a camera, and the weight they give to a fraction of the time, with a mean of one.
type Curve = (&'static str, fn(f64) -> f64);

const BOX: Curve = ("", |_| 1.0);
const TRIANGLE: Curve = (r#""string shutter" "triangle""#, |x| 2.0 - (4.0 * x - 2.0).abs());
const TRAPEZOID: Curve =
    (r#""string shutter" "trapezoid" "float shutteropening" 0.4 "float shutterclosing" 0.1"#, |x| {
        (x / 0.4).min((1.0 - x) / 0.1).min(1.0) / 0.75
    });
/// Open twice, the second time wider.
const TWICE: Curve = (r#""float shuttercurve" [ 0 1 0.2 1 0.2 0 0.6 0 0.6 1 0.9 3 ]"#, |x| {
    let weight = if x < 0.2 {
        1.0
    } else if !(0.6..=0.9).contains(&x) {
        0.0
    } else {
        1.0 + 2.0 * (x - 0.6) / 0.3
    };
    weight / 0.8
});

/// A card whose path is covered by the curve's weight.
#[test]
fn curves_weigh_the_path() {
    let world = format!(
        "ActiveTransform EndTime Translate 1.2 0 0 Rotate 90 0 0 1 ActiveTransform All {}",
        shape(&CARD)
    );
    for (i, (curve, weight)) in [TRIANGLE, TRAPEZOID, TWICE].into_iter().enumerate() {
        let camera = format!(
            r#"TransformTimes -1 1 Camera "orthographic" "float screenwindow" [ -1 1 -0.5 0.5 ]
            "float shutteropen" -1 "float shutterclose" 1 {curve}"#
        );
        let scene = silhouettes(&format!("Translate -0.6 0 0 {camera}"), &world);
        let at = |t: f64| {
            let s = 0.5 * (t + 1.0);
            moved(&rotated(&CARD, 90.0 * s), 1.2 * s - 0.6, 0.0)
        };
        check_pixels(curve, &luminance(&scene, 2000, 40 + i as u64), &weighted(-1.0, 1.0, weight, at));
    }
}

/// A curve says when light comes in, and not how much: where nothing moves it changes no bit.
#[test]
fn curves_leave_the_exposure_alone() {
    let sky = |curve: &str| {
        let scene = scene(&format!(
            r#"Film "rgb" "integer xresolution" 8 "integer yresolution" 8 Camera "perspective" {curve}
            WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]"#,
        ));
        film(&scene, |s| s.spp = 4).means()
    };
    for curve in [TRIANGLE, TRAPEZOID, TWICE] {
        assert_eq!(sky(curve.0), sky(""));
    }
}

/// A held time is a place in the interval: neither the curve nor the strategy have a say in it.
#[test]
fn held_times_do_not_know_of_curves() {
    let held = |curve: &str, path: bool| {
        let scene = scene(&everything_moves(curve));
        let change = |s: &mut RenderSettings| {
            s.freeze(Frozen::Variable(Variable::Time, Vec2::splat(0.4)));
            s.time = if path { scene.time_along_path("pair").unwrap() } else { TimeStrategy::Shutter };
        };
        film(&scene, change).means()
    };
    let want = held("", false);
    assert!(held(TWICE.0, false) == want && held(TWICE.0, true) == want);
    let still = scene(&everything_moves(r#""float shutteropen" 0.4 "float shutterclose" 0.4000001"#));
    let still = film(&still, |_| {}).means();
    let same = want.iter().zip(&still).filter(|(a, b)| (**a - **b).abs().max_element() < 0.01).count();
    assert!(same * 10 > want.len() * 9, "{same} of {} pixels", want.len());
}

const SIZE: [usize; 2] = [24, 16];
const TILE: usize = 4;
const TILES: usize = SIZE[0] * SIZE[1] / (TILE * TILE);

/// A lit room in which the camera, an instance and a shape within it all go through three keys or four.
fn everything_moves(shutter: &str) -> String {
    format!(
        r#"Film "rgb" "integer xresolution" {} "integer yresolution" {} "float exposuretime" 1 PixelFilter "box"
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
        ObjectInstance "pair""#,
        SIZE[0], SIZE[1]
    )
}

/// Adds the luminance of the tiles of a picture, times `scale`, to `sums`.
fn add_tiles(scene: &Scene, spp: u32, seed: u64, time: &TimeStrategy, scale: f64, sums: &mut [f64; TILES]) {
    let picture = film(scene, |s| (s.spp, s.seed, s.time) = (spp, seed, time.clone())).means();
    for (i, rgb) in picture.into_iter().enumerate() {
        sums[i / SIZE[0] / TILE * (SIZE[0] / TILE) + i % SIZE[0] / TILE] +=
            luma(rgb) * scale / (TILE * TILE) as f64;
    }
}

/// Moments of the tiles of a picture over repetitions with other samples.
fn tiles(repetitions: u64, mut picture: impl FnMut(u64, &mut [f64; TILES])) -> Vec<Welford> {
    let mut moments = vec![Welford::new(); TILES];
    for repetition in 0..repetitions {
        let mut sums = [0.0; TILES];
        picture(repetition, &mut sums);
        moments.iter_mut().zip(sums).for_each(|(m, sum)| m.add(sum));
    }
    moments
}

#[track_caller]
fn check_tiles(what: &str, a: &[Welford], b: &[Welford], tests: usize) {
    let error: f64 = a.iter().chain(b).map(|w| w.standard_error() / w.mean).sum::<f64>() / (2 * TILES) as f64;
    assert!(error < 0.02, "{what}: errors of {error} say little");
    for (i, (a, b)) in a.iter().zip(b).enumerate() {
        t_test_two(a, b).check(&format!("{what}: tile {i}"), SIGNIFICANCE, TILES * tests);
    }
}

/// Whether the pictures of two curves are told apart.
fn differ(a: &[Welford], b: &[Welford]) -> bool {
    a.iter().zip(b).any(|(a, b)| !t_test_two(a, b).passes(SIGNIFICANCE, TILES))
}

/// The picture is the average of still frames, weighted by the curve, at times that are spread evenly with a random place in each share
/// so that they are not biased. Errors are measured on independent repetitions of both.
#[test]
fn blur_is_the_average_of_still_frames() {
    const FRAMES: u32 = 32;
    const REPETITIONS: u64 = 20;
    let (open, close) = (0.1, 0.95);
    let mut blurs = Vec::new();
    for (curve, weight) in [BOX, TRIANGLE, TWICE] {
        let moving = scene(&everything_moves(&format!(
            r#""float shutteropen" {open} "float shutterclose" {close} {curve}"#
        )));
        let blur = tiles(REPETITIONS, |seed, sums| {
            add_tiles(&moving, FRAMES, seed, &TimeStrategy::Shutter, 1.0, sums);
        });
        let mut rng = Rng::new(5);
        let stills = tiles(REPETITIONS, |repetition, sums| {
            for frame in 0..FRAMES {
                let fraction = (f64::from(frame) + rng.f64()) / f64::from(FRAMES);
                let scale = weight(fraction) / f64::from(FRAMES);
                if scale > 0.0 {
                    let time = open + (close - open) * fraction;
                    let shutter =
                        format!(r#""float shutteropen" {time} "float shutterclose" {}"#, time + 1e-6);
                    let seed = 1000 + repetition * u64::from(FRAMES) + u64::from(frame);
                    add_tiles(
                        &scene(&everything_moves(&shutter)),
                        1,
                        seed,
                        &TimeStrategy::Shutter,
                        scale,
                        sums,
                    );
                }
            }
        });
        check_tiles(curve, &blur, &stills, 3);
        blurs.push(blur);
    }
    // What agrees here could have disagreed.
    assert!(differ(&blurs[0], &blurs[1]) && differ(&blurs[0], &blurs[2]) && differ(&blurs[1], &blurs[2]));
}

/// Time sampled along a path, of the object or of the camera, under any curve, gives the picture that time sampled by the curve gives.
#[test]
fn time_along_a_path_gives_the_same_picture() {
    for (curve, _) in [BOX, TRIANGLE, TWICE] {
        // The path rests before the first key and after the last.
        let scene = scene(&everything_moves(&format!(
            r#""float shutteropen" -0.2 "float shutterclose" 1.1 {curve}"#
        )));
        let picture = |time: TimeStrategy, seed: u64| {
            tiles(24, |repetition, sums| add_tiles(&scene, 32, seed + repetition, &time, 1.0, sums))
        };
        let by_shutter = picture(TimeStrategy::Shutter, 0);
        for (name, seed) in [("pair", 100), ("camera", 200)] {
            let along = picture(scene.time_along_path(name).unwrap(), seed);
            check_tiles(&format!("{curve} {name}"), &by_shutter, &along, 6);
        }
    }
}
