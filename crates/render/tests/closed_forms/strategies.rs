//! Strategies of sampling: noise differs, the picture does not.

use super::common::{Files, SIGNIFICANCE, film, scene_with};
use tenfold_image::{Format, Image, WriteOptions};
use tenfold_math::{UVec2, Vec3};
use tenfold_render::bxdf::ScatterStrategy::{self, Bsdf, Cosine, Uniform};
use tenfold_render::film::{Film, PixelBounds};
use tenfold_render::integrator::CombineStrategy::{self, BsdfOnly, LightOnly, Mis};
use tenfold_render::integrator::Strategies;
use tenfold_render::light::LightStrategy::{self, ByTexture, Complementary, SolidAngle, UniformArea};
use tenfold_render::scene::Scene;
use tenfold_testkit::stats::t_test_two;
use tenfold_testkit::{TTest, Welford};

const SIZE: UVec2 = UVec2::new(24, 16);
/// Pixels on a side of a tile.
const TILE: u32 = 8;
/// Renders with seeds of their own, by which the noise is known; and samples a pixel of each.
const RENDERS: u64 = 16;
const SPP: u32 = 16;
/// How many scenes are compared: all comparisons together have [`SIGNIFICANCE`].
const SCENES: usize = 2;

/// Every strategy alone beside the defaults of the others, and some of their combinations.
const STRATEGIES: [Strategies; 9] = [
    by(UniformArea, Bsdf, Mis),
    by(SolidAngle, Bsdf, Mis),
    by(Complementary, Uniform, Mis),
    by(ByTexture, Cosine, Mis),
    by(ByTexture, Bsdf, LightOnly),
    by(ByTexture, Bsdf, BsdfOnly),
    by(UniformArea, Uniform, Mis),
    by(UniformArea, Cosine, LightOnly),
    by(SolidAngle, Cosine, BsdfOnly),
];

const fn by(light: LightStrategy, scatter: ScatterStrategy, combine: CombineStrategy) -> Strategies {
    Strategies { light, scatter, combine }
}

const CAMERA: &str = r#"Film "rgb" "integer xresolution" 24 "integer yresolution" 16 PixelFilter "box"
    Integrator "path" "integer maxdepth" 5 LookAt 0 1.2 5  0 0.7 0  0 1 0 Camera "perspective" "float fov" 32 WorldBegin
    Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
    Shape "bilinearmesh" "point3 P" [ -4 0 4  4 0 4  -4 0 -3  4 0 -3 ] "#;

/// A picture that shines, a lamp, a sky with a bright side, a point; metal, a coat with a delta and one without, paper.
fn lamps(lamp: f64) -> Scene {
    let pattern = |x: u32, y: u32| if (x + y).is_multiple_of(3) { [4.0, 2.0, 1.0] } else { [0.1, 0.2, 0.4] };
    let picture = Image::from_fn(6, 4, ["R", "G", "B"], pattern).unwrap();
    let bright = |x: u32, y: u32| if x < 2 && y > 1 { [3.0, 2.5, 2.0] } else { [0.2, 0.3, 0.4] };
    let sky = Image::from_fn(8, 8, ["R", "G", "B"], bright).unwrap();
    let bytes = |image: &Image| image.to_bytes(Format::Pfm, &WriteOptions::default()).unwrap();
    let files = Files::from([("picture.pfm", bytes(&picture)), ("sky.pfm", bytes(&sky))]);
    let text = format!(
        r#"{CAMERA} LightSource "infinite" "string filename" "sky.pfm" "float scale" 0.4
        LightSource "point" "point3 from" [ 2 3 2 ] "rgb I" [ 1 1 1 ]
        AttributeBegin AreaLightSource "diffuse" "string filename" "picture.pfm" "float scale" 2
        Shape "bilinearmesh" "point3 P" [ -2 1.2 -1.5  0.5 1.2 -1.5  -2 2.8 -1.5  0.5 2.8 -1.5 ]
        "point2 uv" [ 0 0  1 0  0 1  1 1 ] AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ {lamp} {lamp} {lamp} ]
        Translate 1.3 1.9 -0.6 Shape "sphere" "float radius" 0.5 AttributeEnd
        AttributeBegin Material "conductor" "float roughness" 0.3 "bool remaproughness" false
        Translate -1.2 0.5 0 Shape "sphere" "float radius" 0.5 AttributeEnd
        AttributeBegin Material "coateddiffuse" "rgb reflectance" [ 0.3 0.5 0.2 ] "float roughness" 0
        Translate 0 0.5 0.3 Shape "sphere" "float radius" 0.5 AttributeEnd
        AttributeBegin Material "coatedconductor" "float interface.roughness" 0 "float conductor.roughness" 0.3
        "bool remaproughness" false Translate 1.2 0.5 0.4 Shape "sphere" "float radius" 0.5 AttributeEnd
        Material "diffusetransmission" "rgb reflectance" [ 0.3 0.3 0.1 ] "rgb transmittance" [ 0.4 0.2 0.1 ]
        Shape "bilinearmesh" "point3 P" [ -0.5 0 1.4  0.3 0 1.4  -0.5 0.5 1.1  0.3 0.5 1.1 ]"#
    );
    scene_with(&text, &files)
}

/// A ball of smooth glass and sheets of ground glass, all of which disperse; the second sheet parts wavelengths.
fn glass() -> Scene {
    let sheet = |x: f64| {
        format!(
            r#""bool remaproughness" false
            Shape "bilinearmesh" "point3 P" [ {x} 0.1 0.4  {0} 0.1 0.4  {x} 1.2 0  {0} 1.2 0 ] AttributeEnd"#,
            x + 1.0
        )
    };
    let (first, second) = (sheet(-0.6), sheet(0.6));
    let text = format!(
        r#"{CAMERA} LightSource "infinite" "rgb L" [ 0.3 0.4 0.5 ]
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 3 2.5 2 ] "bool twosided" true
        Shape "bilinearmesh" "point3 P" [ -3 0.5 -2  3 0.5 -2  -3 3 -2  3 3 -2 ] AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 2 2 2 ]
        Translate 0 3.5 2 Shape "sphere" "float radius" 1 AttributeEnd
        AttributeBegin Material "dielectric" "spectrum eta" "glass-F11"
        Translate -1.2 0.6 0 Shape "sphere" "float radius" 0.5 AttributeEnd
        AttributeBegin Material "dielectric" "spectrum eta" "glass-F11" "float roughness" 0.4 {first}
        AttributeBegin Material "dielectric" "spectrum eta" [ 400 1.9 700 1.3 ] "float roughness" 0.3 {second}"#
    );
    scene_with(&text, &Files::default())
}

/// Moments of the channels of tiles over independent renders.
fn tiles(scene: &Scene, strategies: Strategies, seed: u64) -> Vec<Welford> {
    let size = SIZE / TILE;
    let mut moments = vec![Welford::new(); (3 * size.x * size.y) as usize];
    for render in 0..RENDERS {
        let film =
            film(scene, |s| (s.spp, s.seed, s.strategies) = (SPP, seed * RENDERS + render, strategies));
        for (i, moments) in moments.chunks_exact_mut(3).enumerate() {
            let mean = tile_mean(&film, UVec2::new(i as u32 % size.x, i as u32 / size.x) * TILE);
            (0..3).for_each(|c| moments[c].add(f64::from(mean[c])));
        }
    }
    moments
}

fn tile_mean(film: &Film, min: UVec2) -> Vec3 {
    let tile = PixelBounds { min, max: min + TILE };
    tile.pixels().map(|p| film.pixel(p).mean()).sum::<Vec3>() / tile.area() as f32
}

/// The test in which two pictures differ the most; whose values are multiplied by `factor` in the first.
fn worst(a: &[Welford], b: &[Welford], factor: f64) -> TTest {
    let scaled = |w: &Welford| Welford { mean: w.mean * factor, squares: w.squares * factor * factor, ..*w };
    let tests = a.iter().zip(b).map(|(a, b)| t_test_two(&scaled(a), b));
    tests.min_by(|s, t| s.p.total_cmp(&t.p)).unwrap()
}

/// Compares all strategies with the defaults; and sees that the comparison could tell a density that is off by a twentieth.
fn check(name: &str, scene: &Scene) {
    let want = tiles(scene, Strategies::default(), 0);
    let tests = SCENES * want.len() * STRATEGIES.len();
    for (i, strategies) in STRATEGIES.into_iter().enumerate() {
        let got = tiles(scene, strategies, 1 + i as u64);
        let right = worst(&got, &want, 1.0);
        assert!(right.passes(SIGNIFICANCE, tests), "{name}, {strategies}: {right:?}");
        let wrong = worst(&got, &want, 1.05);
        assert!(!wrong.passes(SIGNIFICANCE, tests), "{name}, {strategies}: blunt, {wrong:?}");
    }
}

#[test]
fn lamps_look_the_same_by_all() {
    check("lamps", &lamps(6.0));
}

/// Each of them does something else.
#[test]
fn strategies_differ_sample_by_sample() {
    let scene = lamps(6.0);
    let one = |strategies| film(&scene, |s| (s.spp, s.strategies) = (1, strategies)).means();
    let default = one(Strategies::default());
    for strategies in STRATEGIES {
        assert!(one(strategies) != default, "{strategies}");
    }
}

#[test]
fn glass_looks_the_same_by_all() {
    check("glass", &glass());
}

/// Where lights are sampled alone, no light is left to scattered directions.
#[test]
fn light_sampling_alone_finds_even_skies_too() {
    let scene = glass();
    let one =
        |light, combine| film(&scene, |s| (s.spp, s.strategies) = (1, by(light, Bsdf, combine))).means();
    assert!(one(Complementary, LightOnly) == one(ByTexture, LightOnly));
    assert!(one(Complementary, Mis) != one(ByTexture, Mis));
}

/// A wrong density of one light alone shows, too: as if its samples weighed a tenth too much.
#[test]
fn a_wrong_density_of_one_light_shows() {
    let sampled = by(ByTexture, Bsdf, LightOnly);
    let (right, wrong) = (tiles(&lamps(6.0), sampled, 0), tiles(&lamps(6.6), sampled, 1));
    let test = worst(&wrong, &right, 1.0);
    assert!(!test.passes(SIGNIFICANCE, SCENES * right.len() * STRATEGIES.len()), "{test:?}");
}
