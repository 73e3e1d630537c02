//! Lights as scene files describe them, and what is said about faulty ones.

use super::*;
use crate::light::{LightSample, LightStrategy::ByTexture, Lights};
use std::path::PathBuf;
use tenfold_geometry::{MeshParts, ReferencePoint, Shape, Sphere, SphereParams, TriangleMesh};
use tenfold_image::{Format, WriteOptions};
use tenfold_scene::{Resources, Severity, SourceMap, read_pbrt_str};
use tenfold_spectrum::{Observer, SampledSpectrum, SampledWavelengths};

/// Three images: `wide.exr`, 4 × 2; `square.exr`, 4 × 4, brighter to the right; `broken.exr`, 2 × 2 with an
/// infinite value.
struct Images;

impl Resources for Images {
    fn load(&self, path: &str) -> std::io::Result<Vec<u8>> {
        let image = match path {
            "wide.exr" => Image::from_fn(4, 2, ["R", "G", "B"], |x, _| [x as f32, 1.0, 2.0]),
            "square.exr" => Image::from_fn(4, 4, ["R", "G", "B"], |x, y| [x as f32, y as f32, 1.0]),
            "broken.exr" => Image::from_fn(2, 2, ["R", "G", "B"], |x, _| [1.0 / x as f32; 3]),
            _ => return Err(std::io::ErrorKind::NotFound.into()),
        };
        Ok(image.unwrap().to_bytes(Format::Exr, &WriteOptions::default()).unwrap())
    }

    fn resolve(&self, path: &str) -> PathBuf {
        PathBuf::from(path)
    }
}

struct Compiled {
    lights: Vec<Light>,
    messages: Vec<(Severity, String)>,
}

/// The lights of a scene with `world` after `WorldBegin`; area lights are on unit spheres.
fn compile(world: &str) -> Compiled {
    let mut sources = SourceMap::new();
    let scene = format!("WorldBegin\n{world}");
    let (description, diagnostics) = read_pbrt_str("scene.pbrt", &scene, &Images, &mut sources);
    let cx = &mut Context::new(&diagnostics, &Images);
    let mut lights: Vec<Light> = description.lights.iter().filter_map(|l| compile_light(cx, l)).collect();
    let sphere = Sphere::new(Transform::IDENTITY, false, SphereParams::default()).unwrap();
    let shape = Shape::Sphere(sphere);
    for entity in &description.area_lights {
        lights.extend(compile_area_light(cx, entity).iter().flat_map(|e| e.lights(&shape, false).0));
    }
    let messages = diagnostics.to_vec().into_iter().map(|d| (d.severity, d.plain(&sources))).collect();
    Compiled { lights, messages }
}

/// The one light of a scene without faults.
fn light(world: &str) -> Light {
    let mut compiled = compile(world);
    assert!(compiled.messages.is_empty() && compiled.lights.len() == 1, "{world}: {:?}", compiled.messages);
    compiled.lights.remove(0)
}

/// Integrals over the wavelength of what `f` gives, by steps of a nanometre, against the luminous response.
fn luminance(f: impl Fn(&SampledWavelengths) -> SampledSpectrum) -> f32 {
    let observer = Observer::cie1931();
    (360..=830)
        .map(|nm| {
            let w = SampledWavelengths::fixed(nm as f32);
            observer.to_y(f(&w), &w)
        })
        .sum()
}

fn sample(light: &Light, at: Vec3, u: Vec2, w: &SampledWavelengths) -> Option<LightSample> {
    Lights::build(vec![light.clone()]).sample(ByTexture, &ReferencePoint::free(at, 0.0), 0.5, u, w)
}

/// Luminous radiance or irradiance of the light as seen from `at`.
fn seen(light: &Light, at: Vec3) -> f32 {
    let value = |w: &SampledWavelengths| {
        sample(light, at, Vec2::splat(0.4), w).map_or(SampledSpectrum::ZERO, |s| s.radiance)
    };
    luminance(value)
}

#[track_caller]
fn near(a: f32, b: f32) {
    assert!((a / b - 1.0).abs() < 2e-3, "{a} instead of {b}");
}

#[test]
fn values_have_the_luminance_of_their_numbers() {
    near(seen(&light("LightSource \"point\" \"rgb I\" [ 3 3 3 ]"), Vec3::new(0.0, 0.0, 2.0)), 0.75);
    near(seen(&light("LightSource \"point\""), Vec3::X), 1.0);
    near(seen(&light("LightSource \"point\" \"float scale\" 4 \"blackbody I\" 3000"), Vec3::X), 4.0);
    near(seen(&light("LightSource \"distant\" \"rgb L\" [ 2 2 2 ]"), Vec3::ZERO), 2.0);
    near(seen(&light("LightSource \"infinite\" \"rgb L\" [ 2 2 2 ]"), Vec3::ZERO), 2.0);
    near(seen(&light("LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]"), Vec3::ZERO), 1.0);
    near(seen(&light("AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]"), Vec3::new(0.0, 3.0, 0.0)), 5.0);
    // Of a colour it is the luminance of the colour: 0.2126 for red.
    near(seen(&light("LightSource \"point\" \"rgb I\" [ 1 0 0 ]"), Vec3::X), 0.2126);
}

#[test]
fn power_and_illuminance_are_reached() {
    let power = 30.0;
    let point = light("LightSource \"point\" \"float power\" 30 \"blackbody I\" 4000 \"float scale\" 2");
    near(seen(&point, Vec3::X) * 4.0 * PI, 2.0 * power);
    let spot =
        light("LightSource \"spot\" \"float power\" 30 \"float coneangle\" 40 \"float conedeltaangle\" 20");
    let measure = SpotLight::measure(20f32.to_radians(), 40f32.to_radians());
    near(seen(&spot, Vec3::Z) * measure, power);
    let distant = light("LightSource \"distant\" \"float illuminance\" 12 \"spectrum L\" \"stdillum-A\"");
    near(seen(&distant, Vec3::ZERO), 12.0);
    let sky = light("LightSource \"infinite\" \"float illuminance\" 12");
    near(seen(&sky, Vec3::ZERO) * PI, 12.0);
    // Radiance Φ / (π A) on each side that emits.
    let at = Vec3::new(0.0, 0.0, 4.0);
    let area = light("AreaLightSource \"diffuse\" \"float power\" 30");
    near(seen(&area, at) * PI * 4.0 * PI, power);
    let both = light("AreaLightSource \"diffuse\" \"float power\" 30 \"bool twosided\" true");
    near(seen(&both, at) * PI * 8.0 * PI, power);
}

/// The luminous power of a light at the origin, by its intensity in many directions.
fn luminous_power(light: &Light) -> f32 {
    let n = 48;
    let lights = Lights::build(vec![light.clone()]);
    let value = |w: &SampledWavelengths| {
        let mut sum = SampledSpectrum::ZERO;
        for i in 0..n * n {
            let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            let from = ReferencePoint::free(equal_area_square_to_sphere(st), 0.0);
            sum += lights
                .sample(ByTexture, &from, 0.5, Vec2::ZERO, w)
                .map_or(SampledSpectrum::ZERO, |s| s.radiance);
        }
        sum * (4.0 * PI / (n * n) as f32)
    };
    luminance(value)
}

#[test]
fn images_reach_their_power() {
    let goniometric =
        light("LightSource \"goniometric\" \"string filename\" \"square.exr\" \"float power\" 30");
    // The grid of directions is turned against the pixels.
    assert!((luminous_power(&goniometric) / 30.0 - 1.0).abs() < 0.01, "{}", luminous_power(&goniometric));
    let projection = light(
        "LightSource \"projection\" \"string filename\" \"wide.exr\" \"float power\" 30 \"float fov\" 80",
    );
    // The grid of directions cuts the screen's border.
    assert!((luminous_power(&projection) / 30.0 - 1.0).abs() < 0.05, "{}", luminous_power(&projection));
    // The image's mean luminance on a sphere.
    let area = light("AreaLightSource \"diffuse\" \"string filename\" \"square.exr\" \"float power\" 30");
    let Light::Area(_) = &area else { panic!("{area:?}") };
    let n = 24;
    let mut sum = 0.0;
    for i in 0..n * n {
        // Over the whole surface, which points all around see in equal parts.
        let d = equal_area_square_to_sphere(Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32);
        sum += seen_at(&area, d);
    }
    assert!((sum / (n * n) as f32 * PI * 4.0 * PI / 30.0 - 1.0).abs() < 0.02, "{sum}");
}

/// Luminous radiance of the unit sphere at its point `d`.
fn seen_at(light: &Light, d: Vec3) -> f32 {
    let Light::Area(_) = light else { return 0.0 };
    let from = ReferencePoint::free(d * 1.5, 0.0);
    let sphere = Sphere::new(Transform::IDENTITY, false, SphereParams::default()).unwrap();
    let shape = Shape::Sphere(sphere);
    let ray = from.spawn_ray(-d);
    let hit = shape.primitive(0).intersect(&ray, f32::INFINITY, |_| true).unwrap();
    let hit = shape.primitive(0).interaction(&ray, &hit);
    let lights = Lights::build(vec![light.clone()]);
    luminance(|w| lights.emitted(tenfold_math::Id::new(0), &hit, d, w))
}

#[test]
fn skies_are_turned_and_scaled() {
    let world = "Rotate 90 1 0 0 Scale 2 2 2 LightSource \"infinite\" \"string filename\" \"square.exr\"";
    let sky = light(world);
    let w = SampledWavelengths::fixed(550.0);
    for u in [Vec2::new(0.1, 0.9), Vec2::new(0.6, 0.3), Vec2::new(0.99, 0.5)] {
        let s = sample(&sky, Vec3::ZERO, u, &w).unwrap();
        assert!(s.wi.is_normalized());
    }
    // pbrt-v4's convention for the illuminance of images.
    let given = light("LightSource \"infinite\" \"string filename\" \"square.exr\" \"float illuminance\" 7");
    let plain = light("LightSource \"infinite\" \"string filename\" \"square.exr\"");
    // At the centres of the pixels.
    let n = 4;
    let upper = |light: &Light| {
        let lights = Lights::build(vec![light.clone()]);
        luminance(|w| {
            let mut sum = SampledSpectrum::ZERO;
            for i in 0..n * n {
                let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
                let d = equal_area_square_to_sphere(st);
                sum += lights.escaped(tenfold_math::Id::new(0), d, w) * d.z.max(0.0);
            }
            sum * (4.0 * PI / (n * n) as f32)
        })
    };
    near(upper(&given), 14.0);
    assert!(upper(&plain) > 0.0);
}

#[test]
fn places_and_directions_follow_the_transform() {
    let w = SampledWavelengths::fixed(550.0);
    let distant =
        light("Rotate 90 0 0 1 LightSource \"distant\" \"point3 from\" [ 2 0 0 ] \"point3 to\" [ 1 0 0 ]");
    let s = sample(&distant, Vec3::ZERO, Vec2::ZERO, &w).unwrap();
    assert!((s.wi - Vec3::Y).length() < 1e-5 && s.delta);
    let spot =
        light("Translate 0 1 0 LightSource \"spot\" \"point3 from\" [ 1 0 0 ] \"point3 to\" [ 5 0 0 ]");
    assert!(sample(&spot, Vec3::new(3.0, 1.0, 0.0), Vec2::ZERO, &w).is_some());
    assert!(sample(&spot, Vec3::new(-3.0, 1.0, 0.0), Vec2::ZERO, &w).is_none());
}

/// Each faulty light has one error, which names the fault and its place.
#[test]
fn faults_are_named() {
    let cases = [
        ("LightSource \"pont\"", "2:13: error: unknown light \"pont\" (did you mean \"point\"?)"),
        (
            "LightSource \"point\" \"rgb L\" [ 1 1 1 ]",
            "2:21: error: unknown parameter \"L\" of light \"point\" (did you mean \"I\"?)",
        ),
        (
            "LightSource \"point\" \"float scale\" -1",
            "2:35: error: the scale of a light is not negative, as -1 is",
        ),
        ("LightSource \"spot\" \"point3 to\" [ 0 0 0 ]", "\"from\" and \"to\" are the same point"),
        ("LightSource \"spot\" \"float coneangle\" 200", "2:38: error: a cone's angle"),
        (
            "LightSource \"spot\" \"float conedeltaangle\" 31",
            "the cone's edge lies between 0 and the cone's angle of 30",
        ),
        (
            "LightSource \"infinite\" \"string filename\" \"none.exr\"",
            "2:42: error: cannot read \"none.exr\"",
        ),
        ("LightSource \"infinite\" \"string filename\" \"wide.exr\"", "has 4 × 2 pixels"),
        ("LightSource \"infinite\" \"string filename\" \"broken.exr\"", "not finite in row 0"),
        (
            "LightSource \"infinite\" \"string filename\" \"square.exr\" \"rgb L\" [ 1 1 1 ]",
            "either \"L\" or \"filename\"",
        ),
        ("Scale 1 2 1 LightSource \"infinite\" \"string filename\" \"square.exr\"", "cannot be stretched"),
        (
            "LightSource \"infinite\" \"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]",
            "the portal of an infinite light is not supported yet",
        ),
        ("LightSource \"projection\"", "light \"projection\" has no parameter \"string filename\""),
        (
            "LightSource \"projection\" \"string filename\" \"wide.exr\" \"float fov\" 180",
            "a field of view lies between",
        ),
        ("LightSource \"goniometric\" \"string filename\" \"wide.exr\"", "has 4 × 2 pixels"),
        (
            "AreaLightSource \"difuse\"",
            "2:17: error: unknown area light \"difuse\" (did you mean \"diffuse\"?)",
        ),
        (
            "AreaLightSource \"diffuse\" \"string filename\" \"square.exr\" \"rgb L\" [ 1 1 1 ]",
            "either \"L\" or \"filename\"",
        ),
        ("AreaLightSource \"diffuse\" \"float samples\" 4", "unknown parameter \"samples\""),
        (
            "AreaLightSource \"diffuse\" \"spectrum L\" \"no-such\"",
            "\"no-such\" is neither a known spectrum nor a file",
        ),
    ];
    for (world, expected) in cases {
        let Compiled { lights: _, messages } = compile(world);
        assert_eq!(messages.len(), 1, "{world}: {messages:?}");
        let (severity, message) = &messages[0];
        assert!(*severity == Severity::Error && message.contains(expected), "{world}: {message}");
    }
}

#[test]
fn what_is_ignored_is_said() {
    let cases = [
        ("LightSource \"point\" \"float power\" -1", "\"power\" counts above 0 alone"),
        (
            "ActiveTransform EndTime Translate 1 0 0 LightSource \"point\"",
            "a moving light is not supported yet",
        ),
    ];
    for (world, expected) in cases {
        let Compiled { lights, messages } = compile(world);
        assert_eq!((lights.len(), messages.len()), (1, 1), "{world}: {messages:?}");
        assert!(messages[0].0 == Severity::Warning && messages[0].1.contains(expected), "{:?}", messages[0]);
    }
}

#[test]
fn light_that_cannot_be_seen_is_none() {
    let dark = light("LightSource \"point\" \"spectrum I\" [ 1000 1 2000 1 ]");
    assert!(sample(&dark, Vec3::X, Vec2::ZERO, &SampledWavelengths::fixed(550.0)).is_none());
}

#[test]
fn triangles_that_make_up_rectangles_are_one_light() {
    let quad = |indices: &[u32]| {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)];
        let parts = MeshParts {
            positions: corners.iter().map(|&(x, y)| Vec3::new(x, y, 5.0)).collect(),
            indices: indices.to_vec(),
            ..MeshParts::default()
        };
        Shape::Triangles(Arc::new(TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap()))
    };
    let lights = |parameters: &str, shape: &Shape| {
        let mut sources = SourceMap::new();
        let scene = format!("WorldBegin AreaLightSource \"diffuse\" {parameters} Shape \"sphere\"");
        let (description, diagnostics) = read_pbrt_str("scene.pbrt", &scene, &Images, &mut sources);
        let cx = &mut Context::new(&diagnostics, &Images);
        let (lights, each) =
            compile_area_light(cx, &description.area_lights[0]).unwrap().lights(shape, false);
        (lights.len(), each)
    };
    let pair = quad(&[0, 1, 2, 0, 2, 3]);
    assert_eq!(lights("", &pair), (1, 2));
    assert_eq!(lights("", &quad(&[0, 1, 2])), (1, 1));
    assert_eq!(lights("", &quad(&[0, 1, 2, 0, 3, 2])), (2, 1));
    // The power is that of each triangle.
    assert_eq!(lights("\"float power\" 3", &pair), (2, 1));
}
