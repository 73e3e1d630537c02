//! Irradiance, estimated from samples, against closed forms.

use super::*;
use std::f32::consts::PI;
use tenfold_math::ops;
use tenfold_math::{Id, equal_area_square_to_sphere};
use tenfold_testkit::stats::{Welford, t_test_mean};

const TESTS: usize = 40;

/// Estimates of the irradiance at `from`, one a sample.
fn estimate(lights: &Lights, from: &ReferencePoint, samples: usize, seed: u64) -> Welford {
    let mut rng = Rng::new(seed);
    (0..samples)
        .map(|_| {
            let (c, u) = (rng.f32(), rng.vec2());
            lights.sample(ByTexture, from, c, u, &wavelengths()).map_or(0.0, |s| {
                let cos = s.wi.dot(from.n).max(0.0);
                f64::from(s.radiance[0] * cos / s.pdf)
            })
        })
        .collect()
}

/// The irradiance of one light that needs no chance.
fn exact(light: Light, from: &ReferencePoint) -> f32 {
    let lights = Lights::build(vec![light]);
    lights.sample(ByTexture, from, 0.3, Vec2::splat(0.4), &wavelengths()).map_or(0.0, |s| {
        assert!(s.delta && s.pdf == 1.0);
        s.radiance[0] * s.wi.dot(from.n).max(0.0)
    })
}

#[test]
fn points_spots_and_distant_lights() {
    let from = surface(Vec3::new(1.0, 0.0, 0.0), Vec3::Z);
    let position = Vec3::new(1.0, 3.0, 4.0);
    let point = Light::from(PointLight { position, intensity: constant(5.0) });
    assert!((exact(point, &from) - 5.0 / 25.0 * 0.8).abs() < 1e-6);

    let distant =
        Light::from(DistantLight { direction: Vec3::new(0.6, 0.0, 0.8), irradiance: constant(2.0) });
    assert!((exact(distant, &from) - 1.6).abs() < 1e-6);

    // A spot at height 2 that looks down: seen under θ from its axis, E = I(θ) cos θ / (2 / cos θ)².
    let down = Transform::translate(Vec3::new(0.0, 0.0, 2.0)) * Transform::rotate(PI, Vec3::X).unwrap();
    let (start, end) = (0.3f32, 0.6f32);
    for (theta, share) in [(0.0, 1.0), (0.29, 1.0), (0.61, 0.0), (1.0, 0.0)] {
        let from = surface(Vec3::new(2.0 * ops::tan(theta), 0.0, 0.0), Vec3::Z);
        let spot = Light::from(SpotLight::new(&down, constant(3.0), start, end));
        let expected = 3.0 * share * ops::cos(theta).powi(3) / 4.0;
        assert!((exact(spot, &from) - expected).abs() < 1e-5, "{theta}");
    }
    // Half way between the cosines the step is one half.
    let theta = ops::acos(0.5 * (ops::cos(start) + ops::cos(end)));
    let from = surface(Vec3::new(0.0, 2.0 * ops::tan(theta), 0.0), Vec3::Z);
    let spot = Light::from(SpotLight::new(&down, constant(3.0), start, end));
    assert!((exact(spot, &from) - 1.5 * ops::cos(theta).powi(3) / 4.0).abs() < 1e-5);
}

/// The power of lights at a point: ∫ of the intensity over the directions.
#[test]
fn power_of_lights_at_a_point() {
    let power = |light: Light| {
        let lights = Lights::build(vec![light]);
        let n = 256;
        let mut sum = 0.0f64;
        for i in 0..n * n {
            let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            let from = ReferencePoint::free(equal_area_square_to_sphere(st), 0.0);
            let w = wavelengths();
            sum += lights
                .sample(ByTexture, &from, 0.5, Vec2::splat(0.5), &w)
                .map_or(0.0, |s| f64::from(s.radiance[0]));
        }
        (sum * 4.0 * std::f64::consts::PI / (n * n) as f64) as f32
    };
    let near = |a: f32, b: f32, tolerance: f32| assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
    let t = Transform::rotate(0.4, Vec3::new(1.0, 1.0, 0.0)).unwrap();
    near(power(Light::from(SpotLight::new(&t, constant(1.0), 0.5, 0.9))), SpotLight::measure(0.5, 0.9), 1e-3);

    let image = Image::from_fn(6, 4, ["R", "G", "B"], |x, y| [(1 + x * y) as f32; 3]).unwrap();
    let screen = Screen::new(6, 4, 1.2);
    let radiance = RadianceImage::new(&image, RgbColorSpace::srgb());
    let white = RgbColorSpace::srgb().illuminant().eval(550.0);
    let projection = Light::from(ProjectionLight::new(&t, screen, radiance, 2.0));
    near(power(projection), 2.0 * white * screen.measure(&image).x, 1e-2);

    let factors: Vec<f32> = (0..64).map(|i| (i % 7) as f32).collect();
    let mean = factors.iter().sum::<f32>() / 64.0;
    let goniometric = Light::from(GoniometricLight::new(&t, constant(1.5), factors, 8));
    near(power(goniometric), 1.5 * mean * 4.0 * PI, 1e-2);
}

/// A projector throws the top of its image up and the first column to the left as seen from behind it.
#[test]
fn projections_are_upright() {
    let image = Image::from_fn(2, 2, ["R", "G", "B"], |x, y| [(1 + x + 2 * y) as f32; 3]).unwrap();
    let radiance = RadianceImage::new(&image, RgbColorSpace::srgb());
    let light = ProjectionLight::new(&Transform::IDENTITY, Screen::new(2, 2, 1.0), radiance, 1.0);
    let at = |x: f32, y: f32| {
        let p = Vec3::new(x, y, 1.0);
        let s = light.sample(&ReferencePoint::free(p, 0.0), &wavelengths())?;
        Some(s.radiance[0] * p.length_squared() / RgbColorSpace::srgb().illuminant().eval(550.0))
    };
    for (x, y, value) in [(-0.2, 0.2, 1.0), (0.2, 0.2, 2.0), (-0.2, -0.2, 3.0), (0.2, -0.2, 4.0)] {
        assert!((at(x, y).unwrap() - value).abs() < 1e-3);
    }
    assert!(at(0.6, 0.0).is_none() && at(0.0, -0.6).is_none());
}

fn check(what: &str, lights: Vec<Light>, from: &ReferencePoint, expected: f32, seed: u64) {
    let estimates = estimate(&Lights::build(lights), from, 20_000, seed);
    let relative = estimates.standard_error() / f64::from(expected);
    assert!(relative < 0.02, "{what}: too noisy to say ({relative})");
    if relative < 1e-5 {
        assert!((estimates.mean / f64::from(expected) - 1.0).abs() < 1e-4, "{what}: {}", estimates.mean);
    } else {
        t_test_mean(&estimates, f64::from(expected)).check(what, 0.01, TESTS);
    }
}

/// Irradiance from a polygon of radiance 1, all above the horizon (Lambert 1760): ½ Σ Θᵢ Γᵢ·n.
fn lambert(polygon: &[Vec3], from: &ReferencePoint) -> f32 {
    let corners: Vec<_> = polygon.iter().map(|p| (*p - from.p).as_dvec3().normalize()).collect();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let sum: f64 =
        edges.map(|(a, b)| a.angle_between(*b) * a.cross(*b).normalize().dot(from.n.as_dvec3())).sum();
    (0.5 * sum.abs()) as f32
}

#[test]
fn area_lights_make_their_form_factors() {
    let tilted = surface(Vec3::new(0.3, -0.2, 0.1), Vec3::new(0.36, 0.48, 0.8));
    let flat = surface(Vec3::ZERO, Vec3::Z);

    // The sphere: π L (r / d)² cos θ.
    let centre = Vec3::new(0.5, 0.2, 2.0);
    let d = centre - tilted.p;
    let expected = 3.0 * PI * (0.4f32 / d.length()).powi(2) * d.normalize().dot(tilted.n);
    check("sphere", area(sphere(centre, 0.4), 3.0, false), &tilted, expected, 1);
    check("sphere from inside", area(sphere(Vec3::ZERO, 2.0), 3.0, true), &flat, 3.0 * PI, 2);

    // The coaxial disk: π L r² / (r² + d²).
    let expected = PI * 2.0 * 0.49 / (0.49 + 1.21);
    check("disk", area(disk(1.1, 0.7), 2.0, false), &flat, expected, 3);

    let [a, b, c, e] = ceiling();
    for (i, from) in [flat, tilted].iter().enumerate() {
        let expected = 2.0 * lambert(&[a, b, e, c], from);
        check("patch", area(patch(ceiling(), &[]), 2.0, false), from, expected, 4 + i as u64);
        let pair = triangles(&ceiling(), &[0, 1, 2, 2, 1, 3]);
        check("triangles", area(pair, 2.0, false), from, expected, 6 + i as u64);
    }
    // The side that does not emit.
    let above = surface(Vec3::new(0.0, 0.0, 2.0), Vec3::NEG_Z);
    assert_eq!(estimate(&Lights::build(area(patch(ceiling(), &[]), 2.0, false)), &above, 100, 8).mean, 0.0);
    check(
        "both sides",
        area(patch(ceiling(), &[]), 2.0, true),
        &above,
        2.0 * lambert(&[a, b, e, c], &above),
        9,
    );
}

#[test]
fn a_tube_has_the_irradiance_of_its_outline() {
    // Far away the tube is a rectangle 2 r × 2.
    let t = Transform::translate(Vec3::new(0.0, 0.0, 40.0)) * Transform::rotate(PI / 2.0, Vec3::X).unwrap();
    let from = surface(Vec3::ZERO, Vec3::Z);
    let tube = cylinder(t, 0.1);
    let height = tube.primitive(0).area() / (2.0 * PI * 0.1);
    check("tube", area(tube, 500.0, false), &from, 500.0 * 0.2 * height / 1600.0, 10);
}

#[test]
fn skies_light_what_lies_below_them() {
    let from = surface(Vec3::ZERO, Vec3::new(0.6, 0.0, -0.8));
    check("uniform", vec![Light::from(UniformInfinite { radiance: constant(2.0) })], &from, 2.0 * PI, 11);

    let lights = Lights::build(vec![image_sky()]);
    // The sum over many directions of the map, which the pixels divide evenly.
    let n = 512;
    let mut expected = 0.0f64;
    for i in 0..n * n {
        let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
        let d = equal_area_square_to_sphere(st);
        let l = lights.escaped(Id::new(0), d, &wavelengths())[0];
        expected += f64::from(l * d.dot(from.n).max(0.0)) * 4.0 * std::f64::consts::PI / (n * n) as f64;
    }
    let estimates = estimate(&lights, &from, 100_000, 12);
    // The quadrature cuts pixels along the sun's border.
    assert!((estimates.mean / expected - 1.0).abs() < 0.02, "{} {expected}", estimates.mean);
    assert!(estimates.standard_error() / expected < 0.005);
}

/// The mean of a pixel-wise constant sky does not depend on how it is turned.
#[test]
fn skies_keep_their_mean() {
    let lights = Lights::build(vec![image_sky()]);
    let image = sky();
    let w = wavelengths();
    let spectra = RadianceImage::new(&image, RgbColorSpace::srgb());
    let pixels = (0..256).map(|i| f64::from(spectra.pixel([i % 16, i / 16], &w)[0]));
    let mean = 0.5 * pixels.sum::<f64>() / 256.0;
    let mut rng = Rng::new(4);
    let from = ReferencePoint::free(Vec3::ZERO, 0.0);
    let estimates: Welford = (0..50_000)
        .map(|_| {
            let s = lights.sample(ByTexture, &from, 0.5, rng.vec2(), &w).unwrap();
            f64::from(s.radiance[0] / s.pdf) / (4.0 * std::f64::consts::PI)
        })
        .collect();
    t_test_mean(&estimates, mean).check("mean of the sky", 0.01, TESTS);
}

/// Choosing points by the image too is right, and pays.
#[test]
fn images_on_rectangles_are_less_noisy() {
    let from = surface(Vec3::new(0.2, 0.1, -2.0), Vec3::Z);
    let light = textured(patch(ceiling(), &[]));
    let Light::Area(by_both) = &light else { unreachable!() };
    let mut rng = Rng::new(21);
    let primitive = by_both.primitive();
    let plain: Welford = (0..40_000)
        .map(|_| {
            let s = primitive.sample_from(&from, rng.vec2()).unwrap();
            let wi = (s.p - from.p).normalize();
            let l = by_both.emitted(s.n, s.uv, -wi, &wavelengths())[0];
            f64::from(l * wi.dot(from.n) / s.pdf)
        })
        .collect();
    let both = estimate(&Lights::build(vec![light.clone()]), &from, 40_000, 22);
    tenfold_testkit::stats::t_test_two(&plain, &both).check("both strategies", 0.01, TESTS);
    println!("variance {:.3e} by both, {:.3e} by solid angle", both.variance(), plain.variance());
    assert!(both.variance() < 0.25 * plain.variance(), "{} {}", both.variance(), plain.variance());
}
