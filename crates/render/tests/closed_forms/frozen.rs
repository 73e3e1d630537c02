//! Variables held at a value: what is left of a picture without their effects.

use super::common::{SIGNIFICANCE, channels, film, scene};
use tenfold_math::{UVec2, Vec2, Vec3};
use tenfold_render::integrator::Workspace;
use tenfold_render::scene::Scene;
use tenfold_render::schedule::{Frozen, PixelEstimator, RenderSettings};
use tenfold_sampling::{Sampler, SamplerKind, Variable};
use tenfold_spectrum::{SampledWavelengths, named};
use tenfold_testkit::image::{Pair, check_tiles};
use tenfold_testkit::{Rng, Welford};

const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;
const MIDDLE: Vec2 = Vec2::splat(0.5);

/// A picture of `world` through a thin lens.
fn picture(filter: &str, lens: f32, world: &str) -> Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {WIDTH} "integer yresolution" {HEIGHT} PixelFilter "{filter}"
        Integrator "path" "integer maxdepth" 8 LookAt 0 1 6  0 1 0  0 1 0
        Camera "perspective" "float fov" 30 "float lensradius" {lens} "float focaldistance" 6 WorldBegin {world}"#
    ))
}

/// A glass ball on a floor before a sky and a bright strip; a mover, a rough metal, a coat, a half there sheet and a mix.
fn variety(filter: &str, glass: &str, lens: f32) -> Scene {
    let world = format!(
        r#"LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
        Shape "trianglemesh" "point3 P" [ 0.2 -1 -3  0.6 -1 -3  0.6 4 -3  0.2 4 -3 ] "integer indices" [ 0 1 2 0 2 3 ]
        Translate -2 3 2 Shape "sphere" "float radius" 0.3 AttributeEnd
        MakeNamedMaterial "red" "string type" "coateddiffuse" "rgb reflectance" [ 0.7 0.2 0.1 ]
        MakeNamedMaterial "metal" "string type" "conductor" "float roughness" 0.2
        AttributeBegin Material "mix" "string materials" [ "red" "metal" ] "float amount" 0.6
        Shape "bilinearmesh" "point3 P" [ -5 0 5  5 0 5  -5 0 -5  5 0 -5 ] AttributeEnd
        AttributeBegin Translate -1.2 0.5 1 ActiveTransform EndTime Translate 0.5 0 0 ActiveTransform All
        NamedMaterial "metal" Shape "sphere" "float radius" 0.4 AttributeEnd
        AttributeBegin Translate 0 2 0 Shape "disk" "float radius" 0.4 "float alpha" 0.4 AttributeEnd
        Material "dielectric" {glass} Translate 0.7 0.8 0 Shape "sphere" "float radius" 0.8"#
    );
    picture(filter, lens, &world)
}

const F11: &str = r#""spectrum eta" "glass-F11""#;

fn means(scene: &Scene, frozen: &[Frozen], change: impl FnOnce(&mut RenderSettings)) -> Vec<Vec3> {
    let frozen = frozen.to_vec();
    let film = film(scene, |settings| {
        change(settings);
        frozen.into_iter().for_each(|f| settings.freeze(f));
    });
    film.means()
}

/// How far two pictures are from each other in the mean.
fn difference(a: &[Vec3], b: &[Vec3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (*a - *b).abs().max_element()).sum::<f32>() / a.len() as f32
}

/// With every variable held all samples of a pixel are the same one.
#[test]
fn nothing_is_left_to_chance() {
    let scene = variety("mitchell", F11, 0.2);
    let mut all = vec![Frozen::Wavelength(550.0)];
    all.extend(Variable::ALL.map(|variable| Frozen::Variable(variable, MIDDLE)));
    let one = means(&scene, &all, |s| s.spp = 1);
    assert!(one.iter().filter(|p| p.max_element() > 0.0).count() > one.len() / 2);
    assert!(one == means(&scene, &all, |s| (s.spp, s.seed) = (8, 77)));
    // A single one that is free can be seen.
    for free in [Variable::Pixel, Variable::Lens, Variable::Time, Variable::LightPoint, Variable::Alpha] {
        let but_one: Vec<_> =
            all.iter().copied().filter(|f| !matches!(f, Frozen::Variable(v, _) if *v == free)).collect();
        assert!(one != means(&scene, &but_one, |s| s.spp = 8), "{free:?}");
    }
}

/// The pictures in the light of single wavelengths, drawn as those of a picture in all light are, have that for their mean.
#[test]
fn wavelengths_add_up_to_all_light() {
    let scene = variety("box", F11, 0.2);
    let spp = 512;
    let mut settings = RenderSettings { spp, ..RenderSettings::of(&scene) };
    let sampler = Sampler::new(SamplerKind::Independent, spp, 5);
    let (mut rng, mut workspace) = (Rng::new(6), Workspace::default());
    let mut pixel_in_single_wavelengths = |pixel| {
        let sample = |index| {
            settings.wavelength = Some(SampledWavelengths::sample_visible(rng.f32()).lambda()[0]);
            PixelEstimator::new(&scene, &settings).sample(&sampler.at(pixel, index), &mut workspace)
        };
        (0..spp).map(sample).sum::<Vec3>() / spp as f32
    };
    let sum: Vec<_> = scene.film.bounds.pixels().map(&mut pixel_in_single_wavelengths).collect();
    let all = means(&scene, &[], |s| s.spp = spp);
    let (a, b) = (channels(&sum), channels(&all));
    check_tiles("wavelengths", Pair { a: &a, b: &b, width: WIDTH as usize, channels: 3 }, 8, SIGNIFICANCE);
    let blue = means(&scene, &[Frozen::Wavelength(450.0)], |s| s.spp = 1);
    assert!(blue[0].z > 5.0 * blue[0].y.abs(), "one wavelength has a colour: {}", blue[0]);
}

/// Without dispersion glass is that of a constant index, to the bit, and all else is as it was.
#[test]
fn without_dispersion_there_is_one_index() {
    let spectrum = named("glass-F11").unwrap();
    let eta = spectrum.sample(&SampledWavelengths::fixed(Frozen::D_LINE)).lane(0);
    // pbrt's table of this name is that of SF11, in Schott's catalogue n_d = 1.78472.
    assert!((eta - 1.78472).abs() < 1e-4, "{eta}");
    let set = |s: &mut RenderSettings| s.spp = 8;
    let (dispersive, constant) =
        (variety("box", F11, 0.2), variety("box", &format!(r#""float eta" {eta}"#), 0.2));
    let frozen = means(&dispersive, &[Frozen::Dispersion(Frozen::D_LINE)], set);
    assert!(frozen == means(&constant, &[], set));
    assert!(frozen != means(&dispersive, &[], set));
}

/// Held in its middle, a lens is a pinhole.
#[test]
fn without_the_lens_all_is_sharp() {
    let set = |s: &mut RenderSettings| s.spp = 32;
    let (blurred, pinhole) = (variety("box", F11, 0.4), means(&variety("box", F11, 0.0), &[], set));
    let sharp = means(&blurred, &[Frozen::Variable(Variable::Lens, MIDDLE)], set);
    let close = |a: &[Vec3]| {
        let close = |(a, b): (&Vec3, &Vec3)| (*a - *b).abs().max_element() < 1e-3;
        a.iter().zip(&pinhole).filter(|pair| close(*pair)).count() as f64 / pinhole.len() as f64
    };
    // Rounding sends a few samples past outlines.
    let (same, other) = (close(&sharp), close(&means(&blurred, &[], set)));
    assert!(same > 0.9 && other < 0.5, "{same} {other}");
}

/// Held at a moment, what moves stands still where it is then.
#[test]
fn without_time_all_stands_still() {
    let ball = |place: &str| {
        let sky =
            r#"LightSource "infinite" "rgb L" [ 1 1 1 ] Material "diffuse" "rgb reflectance" [ 0 0 0 ]"#;
        picture("box", 0.0, &format!(r#"{sky} {place} Shape "sphere" "float radius" 0.7"#))
    };
    let set = |s: &mut RenderSettings| s.spp = 64;
    let moving = ball("Translate -1 1 0 ActiveTransform EndTime Translate 2 0 0 ActiveTransform All");
    for (moment, x) in [(0.0, -1.0), (0.25, -0.5), (0.75, 0.5)] {
        let held = means(&moving, &[Frozen::Variable(Variable::Time, Vec2::splat(moment))], set);
        let still = means(&ball(&format!("Translate {x} 1 0")), &[], set);
        let (same, other) = (difference(&held, &still), difference(&means(&moving, &[], set), &still));
        assert!(same < 1e-3 && other > 0.05, "{moment}: {same} {other}");
    }
}

/// Held at a place, a pixel is a point: no filter, and no shades at edges.
#[test]
fn without_the_pixels_extent_edges_are_jagged() {
    let half = r#"AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
        Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9.3 0 ] "integer indices" [ 0 1 2 ]"#;
    let set = |s: &mut RenderSettings| s.spp = 16;
    let pictures = ["box", "gaussian", "mitchell", "sinc"].map(|filter| {
        let frozen = [Frozen::Variable(Variable::Pixel, MIDDLE), Frozen::Wavelength(550.0)];
        let scene = picture(filter, 0.0, half);
        let shades = |picture: &[Vec3]| picture.iter().filter(|p| p.y != picture[0].y && p.y != 0.0).count();
        let held = means(&scene, &frozen, set);
        let lit = held.iter().map(|p| p.y).fold(0.0, f32::max);
        assert!(held.iter().all(|p| p.y == 0.0 || p.y == lit) && held.iter().any(|p| p.y == 0.0), "{filter}");
        assert!(shades(&means(&scene, &frozen[1..], set)) > 10, "{filter}");
        held
    });
    assert!(pictures.iter().all(|p| *p == pictures[0]), "the filter does not matter");
}

/// Held, a partly transparent surface is there or not, by its alpha.
#[test]
fn without_chance_alpha_is_a_threshold() {
    let sheet = r#"LightSource "infinite" "rgb L" [ 1 1 1 ] Material "diffuse" "rgb reflectance" [ 0 0 0 ]
        Translate 0 1 0 Shape "disk" "float radius" 9 "float alpha" 0.4"#;
    let scene = picture("box", 0.0, sheet);
    let set = |s: &mut RenderSettings| s.spp = 4;
    let at = |value| means(&scene, &[Frozen::Variable(Variable::Alpha, Vec2::splat(value))], set);
    assert!(at(0.39).iter().all(|p| *p == Vec3::ZERO) && at(0.41).iter().all(|p| p.y > 0.5));
}

/// The moments of a pixel's green in the light of one wavelength where `frozen` is held, over independent samples.
fn samples(scene: &Scene, pixel: UVec2, frozen: &[Frozen], spp: u32) -> Welford {
    let mut settings = RenderSettings { spp, ..RenderSettings::of(scene) };
    settings.sampling = SamplerKind::Independent.into();
    frozen.iter().for_each(|f| settings.freeze(*f));
    let (sampler, mut workspace) = (Sampler::new(settings.sampling, spp, 7), Workspace::default());
    let estimator = PixelEstimator::new(scene, &settings);
    (0..spp).map(|i| f64::from(estimator.sample(&sampler.at(pixel, i), &mut workspace).y)).collect()
}

/// A floor seen from above under `light`, at height 2 over its middle, with a small shade half way up beside it; one bounce.
fn lit_floor(light: &str) -> Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {WIDTH} "integer yresolution" {HEIGHT} PixelFilter "box"
        Integrator "path" "integer maxdepth" 1 LookAt 0 8 0  0 0 0  0 0 1
        Camera "perspective" "float fov" 22 WorldBegin
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 5 5 5 ] Translate 0 2 0 {light} AttributeEnd
        Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
        Shape "bilinearmesh" "point3 P" [ -9 0 9  9 0 9  -9 0 -9  9 0 -9 ]
        Translate 0.5 1 0 Rotate 90 1 0 0 Shape "disk" "float radius" 0.3"#
    ))
}

/// With the point on the light held, a light is a point: its shadows have no half-shade, and it lights what lies
/// free as much as it should.
#[test]
fn without_the_lights_extent_shadows_are_hard() {
    let still = [Frozen::Wavelength(550.0), Frozen::Variable(Variable::Pixel, MIDDLE)];
    let held = [still[0], still[1], Frozen::Variable(Variable::LightPoint, MIDDLE)];
    let lights = [
        (r#"Shape "sphere" "float radius" 0.5"#, 0.5),
        (r#"Rotate 90 1 0 0 Shape "disk" "float radius" 0.5"#, 0.5),
        (r#"Shape "bilinearmesh" "point3 P" [ -0.4 0 -0.4  0.4 0 -0.4  -0.4 0 0.4  0.4 0 0.4 ]"#, 0.45),
    ];
    for (light, size) in lights {
        let scene = lit_floor(light);
        let (mut shades, mut dark, mut bright) = (0, 0, 0);
        for pixel in scene.film.bounds.pixels() {
            let point = samples(&scene, pixel, &held, 8);
            // Nothing else is drawn: one bounce, one light.
            assert!(point.variance() <= 1e-12 * point.mean * point.mean, "{light} {pixel}");
            let whole = samples(&scene, pixel, &still, 256);
            shades += usize::from(whole.variance() > 0.25 * whole.mean * whole.mean);
            dark += usize::from(point.mean == 0.0);
            // Where all of the light is seen, a point of its power is nearly as good: its solid angle is small. The shadow of a point
            // in the middle has radius 0.6 about (±1, 0), as one looks at it.
            let from_middle =
                (pixel.as_vec2() + Vec2::splat(0.5) - Vec2::new(12.0, 8.0)) * (2.0 * 8.0 * 0.194 / 16.0);
            if Vec2::new(from_middle.x.abs() - 1.0, from_middle.y).length() > 0.6 + size + 0.2 {
                bright += 1;
                let ratio = point.mean / whole.mean;
                assert!((ratio - 1.0).abs() < 0.08, "{light} {pixel}: {ratio}");
            }
        }
        assert!(shades > 10 && dark > 5 && bright > 10, "{light}: {shades} {dark} {bright}");
    }
}

/// With directions held in the middle of their lobes, rough metal is a mirror.
#[test]
fn without_the_lobes_extent_metal_is_a_mirror() {
    let metal = |roughness: f64| {
        let world = format!(
            r#"LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
            AttributeBegin Material "diffuse" Shape "bilinearmesh" "point3 P" [ -5 0 5  5 0 5  -5 0 -5  5 0 -5 ] AttributeEnd
            Material "conductor" "float roughness" {roughness} "bool remaproughness" false
            Translate 0 1 0 Shape "sphere" "float radius" 0.9"#
        );
        picture("box", 0.0, &world)
    };
    let still = [Frozen::Wavelength(550.0), Frozen::Variable(Variable::Pixel, MIDDLE)];
    let held = [still[0], still[1], Frozen::Variable(Variable::ScatterDirection, MIDDLE)];
    let (mirror, rough) = (metal(0.0), metal(0.25));
    let set = |s: &mut RenderSettings| s.spp = 64;
    // The mirror's sky is seen at once, the floor lit by a sky that is drawn; the latter is the same in both.
    let (mirrored, sharp, glossy) =
        (means(&mirror, &held, set), means(&rough, &held, set), means(&rough, &still, set));
    let ball = |p: &UVec2| (p.as_vec2() + Vec2::splat(0.5) - Vec2::new(12.0, 8.0)).length() < 3.0;
    let inside: Vec<_> =
        rough.film.bounds.pixels().enumerate().filter(|(_, p)| ball(p)).map(|(i, _)| i).collect();
    let far =
        |a: &[Vec3]| inside.iter().map(|&i| (a[i] - mirrored[i]).abs().max_element()).fold(0.0, f32::max);
    let brightest = inside.iter().map(|&i| mirrored[i].max_element()).fold(0.0, f32::max);
    // Masking takes a little off.
    assert!(
        far(&sharp) < 0.1 * brightest && far(&glossy) > 0.2 * brightest,
        "{} {}",
        far(&sharp),
        far(&glossy)
    );
}
