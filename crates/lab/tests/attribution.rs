//! Noise attribution on scenes in which one variable alone is noisy, and its errors.

use tenfold_lab::attribution::{Attribution, BLOCKS, Group, attribute, page, pick_freeze::Share, work_of};
use tenfold_lab::{Interrupted, Work};
use tenfold_math::Vec2;
use tenfold_render::{compile::compile, scene::Scene, schedule::RenderSettings};
use tenfold_sampling::{Draw, Variable};
use tenfold_scene::{FileResources, SourceMap, read_pbrt_str};
use tenfold_testkit::{special::student_p, stats::sidak};

/// With which probability right shares fail the test of doubling.
const SIGNIFICANCE: f64 = 1e-4;

fn scene(text: &str) -> Scene {
    let files = FileResources::below("");
    let mut sources = SourceMap::new();
    let (description, diagnostics) = read_pbrt_str("test.pbrt", text, &files, &mut sources);
    let scene = compile(&description, &files, &diagnostics);
    let told: Vec<String> = diagnostics.to_vec().iter().map(|d| d.plain(&sources)).collect();
    assert!(!diagnostics.has_errors(), "{}", told.join("\n"));
    scene.unwrap_or_else(|| panic!("no scene: {}", told.join("\n")))
}

/// A small picture seen from (0, 0, 10) toward the origin, with more of the camera, a depth and a world.
fn small(fov: f64, camera: &str, max_depth: u32, world: &str) -> Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" 8 "integer yresolution" 8 PixelFilter "box" Sampler "zsobol"
        Integrator "path" "integer maxdepth" {max_depth} LookAt 0 0 10 0 0 0 0 1 0
        Camera "perspective" "float fov" {fov} {camera} WorldBegin {world}"#
    ))
}

fn attribution(scene: &Scene, spp: u32, seed: u64) -> Attribution {
    let settings = RenderSettings { spp, seed, ..RenderSettings::of(scene) };
    attribute(scene, &settings, &mut Work::new(work_of(&settings), &|_| true)).unwrap()
}

/// A quad parallel to the picture, one-sided, that faces `toward` the camera (+1) or away from it (−1).
fn quad([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64, toward: i32) -> String {
    let indices = if toward > 0 { "0 1 2 0 2 3" } else { "0 2 1 0 3 2" };
    format!(
        r#"Shape "trianglemesh" "integer indices" [ {indices} ]
        "point3 P" [ {x0} {y0} {z} {x1} {y0} {z} {x1} {y1} {z} {x0} {y1} {z} ] "#
    )
}

/// Upright glowing strips, half as wide as they are apart.
fn strips(apart: f64, z: f64) -> String {
    let reach = (4.0 / apart) as i32;
    let glow = r#"AttributeBegin AreaLightSource "diffuse" Material "diffuse" "rgb reflectance" [ 0 0 0 ] "#;
    let strips: String = (-reach..=reach)
        .map(|i| f64::from(i) * apart)
        .map(|x| quad([x - 0.25 * apart, x + 0.25 * apart], [-4.0, 4.0], z, 1))
        .collect();
    format!("{glow}{strips} AttributeEnd ")
}

/// A scene and the one variable that makes it noisy.
fn built() -> Vec<(Group, Scene)> {
    let grey = r#"Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ] "#;
    let floor = quad([-4.0, 4.0], [-4.0, 4.0], 0.0, 1);
    // Strips many to the pixel.
    let pixel = small(10.0, "", 0, &strips(0.02, 0.0));
    // Strips far wider than a pixel, and far narrower than the lens sees them.
    let lens = small(0.5, r#""float lensradius" 1 "float focaldistance" 5"#, 0, &strips(0.8, 0.0));
    // Strips that pass by.
    let moving = "ActiveTransform EndTime Translate 1.6 0 0 ActiveTransform All ";
    let time = small(
        0.5,
        "",
        1,
        &format!(
            r#"LightSource "infinite" AttributeBegin {moving} Material "diffuse" "rgb reflectance" [ 0 0 0 ] {} AttributeEnd"#,
            (-8..=8)
                .map(|i| quad([0.8 * f64::from(i), 0.8 * f64::from(i) + 0.4], [-4.0, 4.0], 0.0, 1))
                .collect::<String>()
        ),
    );
    // A far light behind a fence: every point of the floor sees some of it.
    let fence: String =
        (-10..=10).map(|i| 0.05 * f64::from(i)).map(|x| quad([x, x + 0.025], [-4.0, 4.0], 1.0, 1)).collect();
    let lamp = quad([19.0, 21.0], [-1.0, 1.0], 20.0, -1);
    let light = small(
        0.1,
        "",
        1,
        &format!(
            r#"{grey}{floor} AttributeBegin Material "diffuse" "rgb reflectance" [ 0 0 0 ] Translate 1 0 0 {fence} AttributeEnd
        AttributeBegin AreaLightSource "diffuse" {lamp} AttributeEnd"#
        ),
    );
    // A lamp that shines away from the floor, into a mirror: light samples find nothing. Nothing is absorbed, so that roulette
    // ends no path.
    let scatter = small(
        1.0,
        "",
        2,
        &format!(
            r#"Material "diffuse" "rgb reflectance" [ 1 1 1 ] {floor}
        AttributeBegin Material "conductor" "float roughness" 0 "rgb reflectance" [ 1 1 1 ] {} AttributeEnd
        AttributeBegin AreaLightSource "diffuse" {} AttributeEnd"#,
            quad([-60.0, 60.0], [1.0, 60.0], 4.0, -1),
            quad([-3.0, 3.0], [2.0, 5.0], 1.0, 1)
        ),
    );
    // A single line of the spectrum.
    let wavelength = small(1.0, "", 0, r#"LightSource "infinite" "spectrum L" [ 549 0 550 1 560 1 561 0 ]"#);
    vec![
        (Group::Pixel, pixel),
        (Group::Lens, lens),
        (Group::Time, time),
        (Group::Light, light),
        (Group::Scatter, scatter),
        (Group::Wavelength, wavelength),
    ]
}

#[test]
fn the_only_noisy_variable_gets_the_blame() {
    for (culprit, scene) in built() {
        let found = attribution(&scene, 64, 1);
        let i = found.groups.iter().position(|&g| g == culprit);
        let i = i.unwrap_or_else(|| panic!("{culprit:?} makes no difference"));
        let (first, total) = (found.totals.first_order(i), found.totals.total(i));
        println!("{:12} first {first:?} total {total:?} noise {:.3}", culprit.name(), found.noise().value);
        assert!(first.value - 3.0 * first.error > 0.9, "{culprit:?}: {first:?}");
        assert!(total.value - 3.0 * total.error > 0.9, "{culprit:?}: {total:?}");
        for (j, &other) in found.groups.iter().enumerate().filter(|&(j, _)| j != i) {
            let share = found.totals.first_order(j);
            assert!(share.value < 0.1, "{other:?} beside {culprit:?}: {share:?}");
        }
        // All of the picture has the colour of the one.
        let culprits = found.culprits();
        let of_culprit = culprits.iter().filter(|&&c| c == Some(i)).count();
        assert!(of_culprit * 10 > 9 * culprits.len(), "{culprit:?}: {culprits:?}");
    }
}

/// A bit of everything: lens, motion, gloss, a lamp and its light by way of a wall.
fn mixed() -> Scene {
    let lamp = quad([-2.0, -0.5], [1.0, 2.0], 3.0, -1);
    let (floor, wall) = (quad([-3.0, 3.0], [-3.0, 3.0], 0.0, 1), quad([1.2, 3.0], [-3.0, 3.0], 0.3, 1));
    small(
        16.0,
        r#""float lensradius" 0.15 "float focaldistance" 9"#,
        4,
        &format!(
            r#"LightSource "infinite" "rgb L" [ 0.05 0.05 0.1 ]
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 8 7 ] {lamp} AttributeEnd
        AttributeBegin Material "conductor" "float roughness" 0.2 {floor} AttributeEnd
        AttributeBegin Material "diffuse" "rgb reflectance" [ 0.7 0.3 0.2 ] {wall} AttributeEnd
        AttributeBegin ActiveTransform EndTime Translate 0 1 0 ActiveTransform All
        Material "diffuse" "rgb reflectance" [ 0.2 0.3 0.7 ] Translate -0.3 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd"#
        ),
    )
}

#[test]
fn doubling_the_samples_leaves_the_shares_within_their_errors() {
    let scene = mixed();
    let (once, twice) = (attribution(&scene, 64, 1), attribution(&scene, 128, 2));
    assert_eq!(once.groups, twice.groups);
    let shares = |a: &Attribution| {
        let groups = 0..a.groups.len();
        let of_groups = groups.flat_map(|i| [a.totals.first_order(i), a.totals.total(i)]);
        of_groups.chain([a.totals.interactions(), a.noise()]).collect::<Vec<Share>>()
    };
    let pairs: Vec<_> = shares(&once).into_iter().zip(shares(&twice)).collect();
    let level = sidak(SIGNIFICANCE, pairs.len());
    let (mut errors_once, mut errors_twice) = (0.0, 0.0);
    for (a, b) in pairs {
        // Able to fail.
        assert!(a.error < 0.05 && b.error < 0.05, "{a:?} {b:?}");
        // Welch 1947, each error with one degree of freedom less than there are blocks.
        let [va, vb] = [a, b].map(|s| s.error * s.error);
        let dof = (va + vb).powi(2) / (va * va + vb * vb) * (BLOCKS - 1) as f64;
        let p = student_p((a.value - b.value) / (va + vb).sqrt(), dof);
        println!("{:.4} ± {:.4}   {:.4} ± {:.4}   p = {p:.3}", a.value, a.error, b.value, b.error);
        assert!(p > level, "{a:?} is not {b:?}");
        errors_once += va;
        errors_twice += vb;
    }
    // Half the squared errors, but for chance.
    assert!((0.25..0.9).contains(&(errors_twice / errors_once)), "{}", errors_twice / errors_once);
    // Nothing is noisy alone here.
    assert!((0..once.groups.len()).all(|i| once.totals.first_order(i).value < 0.9));
    assert!(once.groups.len() >= 6, "{:?}", once.groups);
}

#[test]
fn shares_do_not_depend_on_threads_and_held_variables_have_none() {
    let scene = mixed();
    let found = attribution(&scene, 16, 3);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = pool.install(|| attribution(&scene, 16, 3));
    assert_eq!((&found.totals, &found.noise, &found.parts), (&alone.totals, &alone.noise, &alone.parts));

    let mut settings = RenderSettings { spp: 16, ..RenderSettings::of(&scene) };
    settings.sampling.set(Variable::Lens, Draw::Held(Vec2::splat(0.5)));
    let held = attribute(&scene, &settings, &mut Work::new(0, &|_| true)).unwrap();
    assert!(found.groups.contains(&Group::Lens) && !held.groups.contains(&Group::Lens));
}

#[test]
fn what_has_no_noise_is_said_to_have_none() {
    let scene = small(1.0, "", 0, "");
    let found = attribution(&scene, 16, 0);
    assert!(found.groups.is_empty() && found.noise().value == 0.0);
    let html = page("nothing", &found).html("nothing");
    assert!(html.contains("There is no noise"));
    let interrupted = attribute(&scene, &RenderSettings::of(&scene), &mut Work::new(1, &|_| false));
    assert_eq!(interrupted.unwrap_err(), Interrupted);
}
