//! The circle of confusion of the thin lens.

use super::common::{check_mean, check_pixels, film, luminance, pixel_centre, scene, sigmas};
use std::f64::consts::PI;
use tenfold_math::Vec3;
use tenfold_testkit::Welford;
use tenfold_testkit::quadrature::{Tolerance, rectangle};

const SIDE: usize = 24;
const FOCUS: f64 = 3.0;
const LENS: f64 = 0.6;

#[derive(Copy, Clone, Debug)]
enum Camera {
    Perspective,
    Orthographic,
}

impl Camera {
    /// The camera's line; the picture is 2 · 0.5 wide at unit distance (perspective) or everywhere (orthographic).
    fn line(self, lens: f64) -> String {
        let kind = match self {
            Self::Perspective => r#""perspective" "float fov" 90"#,
            Self::Orthographic => r#""orthographic""#,
        };
        format!(
            r#"Camera {kind} "float screenwindow" [ -0.5 0.5 -0.5 0.5 ] "float lensradius" {lens} "float focaldistance" {FOCUS}"#
        )
    }
}

/// The image of a disk of radius `size`, at `centre`, that faces the camera, in pixels.
struct Image {
    centre: [f64; 2],
    /// Radius of the image in focus.
    sharp: f64,
    /// Radius of the circle of confusion.
    blur: f64,
}

impl Image {
    /// A point at depth z and the lens' points are joined by lines that cross the plane of focus, at depth f, in a disk of radius
    /// `R |1 − f/z|` around where the line through the lens' middle does; in the parallel projection, on the film plane,
    /// `R |1 − z/f|`. That is the thin lens' formula, with the film where it images the plane of focus.
    fn new(camera: Camera, centre: [f64; 3], size: f64) -> Self {
        let [x, y, z] = centre;
        let (scale, blur, pixels) = match camera {
            Camera::Perspective => (FOCUS / z, LENS * (1.0 - FOCUS / z).abs(), SIDE as f64 / FOCUS),
            Camera::Orthographic => (1.0, LENS * (1.0 - z / FOCUS).abs(), SIDE as f64),
        };
        let middle = 0.5 * SIDE as f64;
        Self {
            centre: [middle + x * scale * pixels, middle - y * scale * pixels],
            sharp: size * scale * pixels,
            blur: blur * pixels,
        }
    }

    /// The part of the lens from which the film at `distance` pixels from the image's centre sees the disk.
    fn seen_at(&self, distance: f64) -> f64 {
        common_area(distance, self.sharp, self.blur) / (PI * self.blur * self.blur)
    }

    /// The mean of [`Image::seen_at`] over every pixel.
    fn pixels(&self) -> Vec<f64> {
        let tolerance = Tolerance {
            absolute: 1e-5,
            relative: 1e-4,
            pieces: 2,
            evaluations: 20_000,
            ..Tolerance::default()
        };
        let pixel = |i: usize| {
            let low = [(i % SIDE) as f64, (i / SIDE) as f64];
            rectangle(low, [low[0] + 1.0, low[1] + 1.0], &tolerance, |x, y| {
                self.seen_at((x - self.centre[0]).hypot(y - self.centre[1]))
            })
            .value
        };
        (0..SIDE * SIDE).map(pixel).collect()
    }
}

/// The area that two circles of radii `a` and `b` have in common, at distance `d`.
fn common_area(d: f64, a: f64, b: f64) -> f64 {
    if d >= a + b {
        return 0.0;
    }
    if d <= (a - b).abs() {
        return PI * a.min(b).powi(2);
    }
    let angle = |r: f64, s: f64| ((d * d + r * r - s * s) / (2.0 * d * r)).clamp(-1.0, 1.0).acos();
    let (ta, tb) = (angle(a, b), angle(b, a));
    let segment = |r: f64, t: f64| r * r * (t - 0.5 * (2.0 * t).sin());
    segment(a, ta) + segment(b, tb)
}

fn disk(camera: Camera, lens: f64, [x, y, z]: [f64; 3], size: f64) -> tenfold_render::scene::Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {SIDE} "integer yresolution" {SIDE} PixelFilter "box"
        Integrator "path" "integer maxdepth" 1 {} WorldBegin
        Translate {x} {y} {z} ReverseOrientation AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
        Shape "disk" "float radius" {size}"#,
        camera.line(lens)
    ))
}

#[test]
fn circle_of_confusion() {
    for (camera, centre, size) in [
        (Camera::Perspective, [0.2, -0.3, 12.0], 0.6),
        (Camera::Perspective, [0.05, 0.02, 1.4], 0.03),
        (Camera::Orthographic, [0.1, 0.05, 4.2], 0.08),
        (Camera::Orthographic, [-0.1, 0.0, 1.8], 0.06),
    ] {
        let image = Image::new(camera, centre, size);
        assert!(image.blur > 2.0 && image.sharp < 0.5 * image.blur, "{} {}", image.blur, image.sharp);
        let pixels = luminance(&disk(camera, LENS, centre, size), 8192, 3);
        let want = image.pixels();
        check_pixels(&format!("{camera:?} {centre:?}"), &pixels, &want);

        // All light arrives: the blur only spreads it.
        let total: f64 = pixels.iter().map(|p| p.mean).sum();
        let error = pixels.iter().map(Welford::variance_of_mean).sum::<f64>().sqrt();
        let sharp = PI * image.sharp * image.sharp;
        assert!((want.iter().sum::<f64>() / sharp - 1.0).abs() < 1e-3);
        assert!(
            (total - sharp).abs() < sigmas(1) * error && error < 0.02 * sharp,
            "{total} ± {error}: {sharp}"
        );

        // The radius by the second moment: half the squares of both radii, for pixels as wide as 1/√6 in either sense.
        let squared = |i: usize| {
            let p = pixel_centre(i, SIDE);
            (f64::from(p.x) - image.centre[0]).powi(2) + (f64::from(p.y) - image.centre[1]).powi(2)
        };
        let moment: f64 = pixels.iter().enumerate().map(|(i, p)| p.mean * squared(i)).sum::<f64>() / total;
        let error = pixels
            .iter()
            .enumerate()
            .map(|(i, p)| p.variance_of_mean() * (squared(i) - moment).powi(2))
            .sum::<f64>()
            .sqrt()
            / total;
        let want = 0.5 * (image.blur.powi(2) + image.sharp.powi(2)) + 1.0 / 6.0;
        assert!(error < 0.02 * want, "{error} {want}");
        // The step from pixels to their centres is right to a few thousandths only.
        assert!((moment - want).abs() < sigmas(1) * error + 3e-3 * want, "{moment} ± {error}: {want}");
        // And nothing is beyond.
        for (i, p) in pixels.iter().enumerate() {
            if squared(i).sqrt() > image.blur + image.sharp + 0.75 {
                assert_eq!(p.mean, 0.0, "pixel {i}");
            }
        }
    }
}

/// What lies in the plane of focus is as sharp as by a pinhole: all lens points see the same of it.
#[test]
fn in_focus() {
    for camera in [Camera::Perspective, Camera::Orthographic] {
        let seen = |lens| film(&disk(camera, lens, [0.05, 0.1, FOCUS], 0.3), |s| s.spp = 64).means();
        let (sharp, focused) = (seen(0.0), seen(LENS));
        assert!(sharp.iter().any(|&p| p != Vec3::ZERO));
        let differing =
            sharp.iter().zip(&focused).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-6).count();
        // But for samples on the very rim.
        assert!(differing <= 2, "{camera:?}: {differing}");
    }
}

/// As the lens shrinks the picture tends to that of a pinhole, sample by sample.
#[test]
fn pinhole_is_the_limit() {
    let still = |lens: f64| {
        let scene = scene(&format!(
            r#"Film "rgb" "integer xresolution" {SIDE} "integer yresolution" {SIDE} PixelFilter "box" {}
            Sampler "zsobol" "integer pixelsamples" 32
            WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]
            Translate 0 0 5 Material "diffuse" Shape "sphere" "float radius" 1.5
            Translate 0.5 0.5 -3 Material "conductor" Shape "sphere" "float radius" 0.3"#,
            Camera::Perspective.line(lens)
        ));
        film(&scene, |_| {}).means()
    };
    let pinhole = still(0.0);
    let difference = |lens| {
        let picture = still(lens);
        let sum: f32 = pinhole.iter().zip(&picture).map(|(a, b)| (*a - *b).abs().element_sum()).sum();
        f64::from(sum) / (3 * SIDE * SIDE) as f64
    };
    let differences = [0.03, 3e-3, 3e-4, 3e-5].map(difference);
    assert!(differences.windows(2).all(|w| w[1] < 0.5 * w[0]) && differences[3] < 1e-3, "{differences:?}");
}

/// A closed form is of use only where it differs: the same check with a lens of another size fails.
#[test]
#[should_panic(expected = "sum up to")]
fn a_wrong_radius_is_seen() {
    let centre = [0.2, -0.3, 12.0];
    let pixels = luminance(&disk(Camera::Perspective, 0.85 * LENS, centre, 0.6), 8192, 3);
    check_pixels("wrong", &pixels, &Image::new(Camera::Perspective, centre, 0.6).pixels());
}

/// A film pixel weighs all its points, and all of the lens, alike.
#[test]
fn uniform_surroundings_stay_uniform() {
    let scene = scene(&format!(
        r#"Film "rgb" "integer xresolution" {SIDE} "integer yresolution" {SIDE} PixelFilter "gaussian" {}
        WorldBegin LightSource "infinite" "rgb L" [ 1 1 1 ]"#,
        Camera::Perspective.line(LENS)
    ));
    let all = luminance(&scene, 64, 9).iter().fold(Welford::new(), |mut all, p| {
        all.merge(p);
        all
    });
    check_mean("sky", &all, 1.0, 0.01, 1);
}
