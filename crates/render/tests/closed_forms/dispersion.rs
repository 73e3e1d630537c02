//! Wavelengths that part: two rules, one picture; and no dispersion as the limit of little.

use super::common::{LAMBDA, SIGNIFICANCE, channels, check_agreement, film, header, radiance, ray, scene};
use tenfold_math::{UVec2, Vec2, Vec3, vec3};
use tenfold_render::film::Film;
use tenfold_render::integrator::DispersionRule::{self, Split, Terminate};
use tenfold_render::scene::Scene;
use tenfold_sampling::SamplerKind;
use tenfold_testkit::Welford;
use tenfold_testkit::image::{Pair, check_tiles};

const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;

/// Bright strips seen through a prism and a ball of `glass`, and the floor they stand on.
fn strips(glass: &str, depth: u32) -> Scene {
    let strip = |x: f64| {
        format!(
            r#"Shape "trianglemesh" "point3 P" [ {x} -1 -3  {0} -1 -3  {0} 4 -3  {x} 4 -3 ] "integer indices" [ 0 1 2 0 2 3 ] "#,
            x + 0.2
        )
    };
    let strips: String = [-2.6, -1.3, 0.0, 1.3, 2.4].map(strip).concat();
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {WIDTH} "integer yresolution" {HEIGHT} PixelFilter "box"
        Integrator "path" "integer maxdepth" {depth} LookAt 0 1 6  0 1 0  0 1 0 Camera "perspective" "float fov" 30
        WorldBegin LightSource "infinite" "rgb L" [ 0.1 0.1 0.1 ]
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 6 6 6 ] Material "diffuse" "rgb reflectance" [ 0 0 0 ] {strips} AttributeEnd
        Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
        Shape "bilinearmesh" "point3 P" [ -5 -0.2 5  5 -0.2 5  -5 -0.2 -5  5 -0.2 -5 ]
        Material "dielectric" {glass}
        AttributeBegin Translate -0.9 1 0 Rotate 12 0 1 0
        Shape "trianglemesh" "point3 P" [ -0.7 -0.9 -0.4  0.7 -0.9 -0.4  0 -0.9 0.7  -0.7 0.9 -0.4  0.7 0.9 -0.4  0 0.9 0.7 ]
        "integer indices" [ 0 1 2  3 5 4  0 3 4 0 4 1  1 4 5 1 5 2  2 5 3 2 3 0 ] AttributeEnd
        Translate 1.1 1 0 Shape "sphere" "float radius" 0.75"#
    ))
}

const F11: &str = r#""spectrum eta" "glass-F11""#;

fn render(scene: &Scene, rule: DispersionRule, spp: u32, seed: u64) -> Film {
    film(scene, |s| {
        (s.dispersion, s.sampling, s.spp, s.seed) = (rule, SamplerKind::PaddedSobol.into(), spp, seed)
    })
}

/// Whether any sample of a pixel can meet glass first: whether a fine grid of rays through it, and just beyond, does.
fn shows_glass(scene: &Scene, pixel: UVec2) -> bool {
    (0..100).any(|i| {
        let offset = Vec2::new((i % 10) as f32, (i / 10) as f32) * 0.13 - Vec2::splat(0.1);
        let ray = scene.camera.ray(pixel.as_vec2() + offset, Vec2::splat(0.5), 0.5);
        scene.world.intersect(&ray, f32::INFINITY, |_| true).is_some_and(|hit| {
            let surface = &scene.surfaces[scene.world.geometry(hit.primitive.geometry).user as usize];
            surface.material.index() == scene.materials.len() - 1
        })
    })
}

/// Whether wavelengths go on together or by themselves, the mean is the same: of tiles, and of single lanes.
#[test]
fn both_rules_agree_in_the_mean() {
    let scene = strips(F11, 12);
    let (split, terminate) = (render(&scene, Split, 128, 1), render(&scene, Terminate, 512, 2));
    let (a, b) = (channels(&split.means()), channels(&terminate.means()));
    check_tiles("rules", Pair { a: &a, b: &b, width: WIDTH as usize, channels: 3 }, 8, SIGNIFICANCE);

    // Rough glass, whose lanes may ride together or part with its roughness; thick, and lit from one side.
    for roughness in [0.0, 0.01, 0.1, 0.4] {
        let ball = super::common::scene(&format!(
            r#"{} AttributeBegin AreaLightSource "diffuse" "spectrum L" [ 300 1 900 1 ] "float scale" 106.856895 "bool twosided" true
            Translate 0.5 0 3.2 Shape "disk" "float radius" 0.8 AttributeEnd
            LightSource "infinite" "spectrum L" [ 300 1 500 2 900 1 ] "float scale" 10
            Material "dielectric" {F11} "bool remaproughness" false "float roughness" {roughness} Shape "sphere""#,
            header(20)
        ));
        for (i, x) in [0.2, 0.6, 0.85].into_iter().enumerate() {
            let ray = ray(vec3(x, 0.1, -4.0), Vec3::Z);
            let measured = |rule, seed| radiance(&ball, ray, rule, 20_000, seed);
            let (split, terminate) = (measured(Split, 10 + i as u64), measured(Terminate, 20 + i as u64));
            for (lane, (a, b)) in split.iter().zip(&terminate).enumerate() {
                let what = format!("roughness {roughness} at {x}, {} nm", LAMBDA[lane]);
                check_agreement(&what, a, b, 0.01, 48);
            }
        }
    }
}

/// All lanes use the same random numbers: as dispersion tends to zero, so does its mark on the picture.
#[test]
fn little_dispersion_tends_to_none() {
    let picture = |glass: &str, rule| render(&strips(glass, 12), rule, 32, 3).means();
    let without = picture(r#""float eta" 1.5"#, Split);
    let with = |epsilon: f64| {
        let glass = format!(r#""spectrum eta" [ 300 {} 900 {} ]"#, 1.5 + epsilon, 1.5 - epsilon);
        let picture = picture(&glass, Split);
        let differences: Vec<f32> =
            picture.iter().zip(&without).map(|(a, b)| (*a - *b).abs().max_element()).collect();
        let close = differences.iter().filter(|d| **d < 1e-3).count() as f64 / differences.len() as f64;
        (close, f64::from(differences.iter().sum::<f32>()) / differences.len() as f64)
    };
    // A single sample that falls on the other side of an outline changes its pixel by up to 6/32.
    let (close, mean) = with(1e-6);
    assert!(close > 0.99 && mean < 1e-3, "{close} of the pixels are close, {mean} is the mean difference");
    // And the more dispersion, the farther.
    let (_, more) = with(0.03);
    assert!(more > 10.0 * mean, "{more} {mean}");
}

/// A glass that only *says* that it has a spectrum is one of constant index, to the bit.
#[test]
fn equal_indices_are_constant() {
    let picture = |glass: &str, rule| render(&strips(glass, 6), rule, 8, 3).means();
    let want = picture(r#""float eta" 1.5"#, Split);
    assert!(want == picture(r#""float eta" 1.5"#, Terminate));
    assert!(want == picture(r#""spectrum eta" [ 300 1.5 900 1.5 ]"#, Split));
}

/// Samples that never meet dispersion keep all their wavelengths: their pixels have the same bits under both rules, and as with glass
/// that does not disperse.
#[test]
fn samples_that_meet_no_dispersion_are_the_same() {
    // A path of one bounce from the floor or from nowhere cannot come from glass.
    let dispersive = strips(F11, 1);
    let (split, terminate) = (render(&dispersive, Split, 32, 5), render(&dispersive, Terminate, 32, 5));
    let plain = render(&strips(r#""float eta" 1.7"#, 1), Split, 32, 5);
    let (mut same, mut glass, mut differing) = (0, 0, 0);
    for pixel in dispersive.film.bounds.pixels() {
        if shows_glass(&dispersive, pixel) {
            glass += 1;
            differing += usize::from(split.pixel(pixel) != terminate.pixel(pixel));
        } else {
            same += 1;
            assert_eq!(split.pixel(pixel), terminate.pixel(pixel), "{pixel}");
            assert_eq!(split.pixel(pixel), plain.pixel(pixel), "{pixel}");
        }
    }
    assert!(same > 100 && glass > 50 && differing > 30, "{same} {glass} {differing}");
}

/// At equal samples parted wavelengths have far less colour noise than a single one, on pixels that show glass: by chromaticity
/// r / (r + g + b), g / (r + g + b), over seeds.
#[test]
fn colour_noise_of_both_rules() {
    let scene = strips(F11, 12);
    let glass: Vec<UVec2> = scene.film.bounds.pixels().filter(|p| shows_glass(&scene, *p)).collect();
    assert!(glass.len() > 50);
    let variance = |rule| {
        let mut moments = vec![[Welford::new(); 2]; glass.len()];
        for seed in 0..16 {
            let film = render(&scene, rule, 32, seed);
            for (pixel, moments) in glass.iter().zip(&mut moments) {
                let rgb = film.pixel(*pixel).mean();
                let sum = rgb.element_sum().max(1e-3);
                moments[0].add(f64::from(rgb.x / sum));
                moments[1].add(f64::from(rgb.y / sum));
            }
        }
        moments.iter().flatten().map(Welford::variance).sum::<f64>() / glass.len() as f64
    };
    let (split, terminate) = (variance(Split), variance(Terminate));
    println!(
        "variance of chromaticity: {split} by splitting, {terminate} by terminating: 1 to {}",
        terminate / split
    );
    assert!(terminate > 3.0 * split, "{terminate} {split}");
}
