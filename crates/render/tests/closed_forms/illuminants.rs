//! Light of a known spectrum, straight from the lamp to the film: published chromaticities through the matrix of sRGB.

use super::common::{SIGNIFICANCE, film, scene};
use tenfold_sampling::SamplerKind;
use tenfold_testkit::Welford;
use tenfold_testkit::stats::t_test_mean;

/// Linear sRGB of luminance 1 at chromaticity (x, y), by the matrix of IEC 61966-2-1.
fn srgb([x, y]: [f64; 2]) -> [f64; 3] {
    let xyz = [x / y, 1.0, (1.0 - x - y) / y];
    [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]
        .map(|row| row.iter().zip(xyz).map(|(m, v)| m * v).sum())
}

/// Checks that the lamp shows `want`, but for `tolerance` of what is published with few digits.
#[track_caller]
fn check(what: &str, lamp: &str, want: [f64; 3], tolerance: f64) {
    let scene = scene(&format!(
        r#"Film "rgb" "integer xresolution" 8 "integer yresolution" 8 PixelFilter "box"
        Integrator "path" "integer maxdepth" 0 Camera "orthographic" WorldBegin
        ReverseOrientation AreaLightSource "diffuse" {lamp} Translate 0 0 2 Shape "disk" "float radius" 5"#
    ));
    let film = film(&scene, |s| {
        (s.sampling, s.spp) = (SamplerKind::PaddedSobol.into(), 1024);
    });
    for channel in 0..3 {
        let pixels: Welford = film.means().iter().map(|p| f64::from(p[channel])).collect();
        assert!(pixels.standard_error() < 1e-3, "{what}: {pixels:?}");
        let nearest = pixels.mean + (want[channel] - pixels.mean).clamp(-tolerance, tolerance);
        let test = t_test_mean(&Welford { mean: nearest, ..pixels }, want[channel]);
        assert!(
            test.passes(SIGNIFICANCE, 3 * 15),
            "{what}: {} in channel {channel} of {want:?}",
            pixels.mean
        );
    }
}

/// CIE 015:2018, tables 3 and T.8.1; the D50 is pbrt-v4's, which is bluer than the CIE's.
#[test]
fn standard_illuminants() {
    for (name, xy) in [
        ("stdillum-A", [0.44757, 0.40745]),
        ("stdillum-D50", [0.33682, 0.35802]),
        ("stdillum-D65", [0.31272, 0.32903]),
        ("illum-acesD60", [0.32168, 0.33767]),
        ("stdillum-F2", [0.37208, 0.37529]),
        ("stdillum-F7", [0.31292, 0.32933]),
        ("stdillum-F11", [0.38052, 0.37713]),
    ] {
        check(name, &format!(r#""spectrum L" "{name}""#), srgb(xy), 2.5e-3);
    }
}

/// Chromaticities of the Planckian locus (Wyszecki and Stiles, *Color Science*, table I(3.11)).
#[test]
fn black_bodies() {
    for (kelvin, xy) in [(2856, [0.44757, 0.40745]), (5000, [0.34510, 0.35161]), (6500, [0.31352, 0.32363])] {
        check(&format!("{kelvin} K"), &format!(r#""blackbody L" {kelvin}"#), srgb(xy), 2.5e-3);
    }
}

/// The equal-energy spectrum is at (1/3, 1/3), and a colour is itself.
#[test]
fn equal_energy_and_colours() {
    check("E", r#""spectrum L" [ 300 1 900 1 ]"#, srgb([1.0 / 3.0; 2]), 1e-3);
    for rgb in [[1.0, 1.0, 1.0], [0.9, 0.4, 0.1], [0.2, 0.5, 1.7]] {
        let lamp = format!(r#""rgb L" [ {} {} {} ]"#, rgb[0], rgb[1], rgb[2]);
        check(&lamp, &lamp, rgb, 2e-3);
    }
    // Scale and power: a disk of radius 5 that emits with radiance L has power π L times its area.
    let power = std::f64::consts::PI.powi(2) * 25.0;
    let white = |factor: f64| [factor; 3];
    check("scale", r#""rgb L" [ 1 1 1 ] "float scale" 2.5"#, white(2.5), 3e-3);
    check("power", &format!(r#""rgb L" [ 1 1 1 ] "float power" {}"#, 1.5 * power), white(1.5), 2e-3);
}
