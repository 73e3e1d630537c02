//! Surfaces that light passes: masks that are half there, boundaries that scatter nothing, and mixtures with them.

use super::common::{FLAT, check_agreement, check_lanes, check_mean, header, radiance, ray, scene};
use tenfold_math::{Ray, Vec3};
use tenfold_render::integrator::DispersionRule::Split;
use tenfold_spectrum::N;

/// A sheet across the z axis at `z`, with `parameters` of its own.
fn sheet(z: f32, parameters: &str) -> String {
    format!(r#"Shape "bilinearmesh" "point3 P" [ -9 -9 {z} 9 -9 {z} -9 9 {z} 9 9 {z} ] {parameters} "#)
}

const BLACK: &str = r#"Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ] "#;

/// A sheet of it is there by half, and black where it is.
const HALF_BLACK: &str = r#"MakeNamedMaterial "black" "string type" "diffuse" "spectrum reflectance" [ 300 0 900 0 ]
    MakeNamedMaterial "nothing" "string type" "interface"
    MakeNamedMaterial "half" "string type" "mix" "string materials" [ "nothing" "black" ] "float amount" 0.5
    NamedMaterial "half" "#;

fn sky() -> String {
    format!(r#"LightSource "infinite" {FLAT} "#)
}

fn along_z() -> Ray {
    ray(Vec3::ZERO, Vec3::Z)
}

#[test]
fn what_is_half_there_stops_half_of_what_it_is_left() {
    let alpha = r#""float alpha" 0.5"#;
    let two = sheet(1.0, alpha) + &sheet(2.0, alpha);
    let ball = r#"Translate 0 0 5 Shape "sphere" "float alpha" 0.5"#;
    for (what, text) in [
        ("two masks", format!("{BLACK} {two}")),
        ("both sides of a masked sphere", format!("{BLACK} {ball}")),
        ("two mixtures with nothing", format!("{HALF_BLACK} {}", sheet(1.0, "") + &sheet(2.0, ""))),
    ] {
        let scene = scene(&(header(3) + &sky() + &text));
        check_lanes(what, &radiance(&scene, along_z(), Split, 6000, 1), [0.25; N], 0.03, 3);
    }
}

#[test]
fn shadow_rays_meet_masks_as_paths_do() {
    // From a distant light there are shadow rays alone.
    let light =
        r#"LightSource "distant" "point3 from" [ 0 0 0 ] "point3 to" [ 0 0 1 ] "spectrum L" [ 300 1 900 1 ]"#;
    let floor =
        format!(r#"Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ] {}"#, sheet(5.0, ""));
    let masks = format!(
        r#"{BLACK} {m} "#,
        m = sheet(1.0, r#""float alpha" 0.5"#) + &sheet(2.0, r#""float alpha" 0.5"#)
    );
    let seen = |between: &str| {
        let scene = scene(&(header(1) + light + &floor + between));
        radiance(&scene, ray(Vec3::new(0.0, 0.0, 4.0), Vec3::Z), Split, 6000, 2)
    };
    let want = seen("").map(|free| 0.25 * free.mean);
    check_lanes("a floor under two masks", &seen(&masks), want, 0.03, 1);
}

#[test]
fn boundaries_that_scatter_nothing_end_no_path() {
    let boundary = format!(r#"AttributeBegin Material "interface" {} AttributeEnd "#, sheet(1.0, ""));
    let scene = scene(&(header(0) + &sky() + &boundary));
    check_lanes("light behind", &radiance(&scene, along_z(), Split, 4, 3), [1.0; N], 1e-3, 1);
}

#[test]
fn boundaries_do_not_dim_what_they_surround() {
    // A large light near a floor: light samples and scattered directions find it about as often.
    let lamp =
        format!(r#"AttributeBegin AreaLightSource "diffuse" {FLAT} {} AttributeEnd "#, sheet(-3.0, ""));
    let floor =
        format!(r#"Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ] {}"#, sheet(5.0, ""));
    let boundary = format!(r#"AttributeBegin Material "interface" {} AttributeEnd "#, sheet(2.0, ""));
    let seen = |between: &str, seed| {
        let scene = scene(&(header(1) + &lamp + between + &floor));
        radiance(&scene, ray(Vec3::new(0.0, 0.0, 4.0), Vec3::Z), Split, 3000, seed)
    };
    let (with, without) = (seen(&boundary, 4), seen("", 5));
    for i in 0..N {
        check_agreement("with and without a boundary", &with[i], &without[i], 0.01, N);
    }
}

#[test]
fn mixtures_with_nothing_let_their_share_of_light_through() {
    let floor = r#"AttributeBegin Material "diffuse" "spectrum reflectance" [ 300 0.8 900 0.8 ] Shape "disk" "float radius" 3 AttributeEnd "#;
    let scene = scene(&(header(1) + &sky() + floor + HALF_BLACK + r#" Shape "sphere" "float radius" 10"#));
    let seen = radiance(&scene, ray(Vec3::Z, Vec3::NEG_Z), Split, 8000, 6);
    for value in &seen {
        check_mean("a floor in a half-black sphere", value, 0.4, 0.02, N);
    }
}

#[test]
fn depths_beyond_all_bounds_are_bounded() {
    assert_eq!(scene(&(header(100_000) + &sky())).max_depth, u16::MAX);
}
