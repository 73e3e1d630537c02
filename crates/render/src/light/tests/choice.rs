//! The choice among many lights.

use super::*;
use tenfold_math::Id;
use tenfold_math::ops;
use tenfold_testkit::Options;
use tenfold_testkit::chi2::counts_test;
use tenfold_testkit::stats::{Welford, t_test_mean};

/// Lights at random places in a box of edge 20, of many kinds and of powers that differ a thousandfold.
fn many(count: usize, seed: u64) -> Vec<Light> {
    let mut rng = Rng::new(seed);
    let mut lights = Vec::new();
    for i in 0..count {
        let p = 20.0 * rng.vec3() - Vec3::splat(10.0);
        let strength = 0.1 * ops::powf(10f32, 3.0 * rng.f32());
        match i % 4 {
            0 => lights.push(Light::from(PointLight { position: p, intensity: constant(strength) })),
            1 => {
                let t =
                    Transform::translate(p) * Transform::rotate(3.0 * rng.f32(), rng.direction()).unwrap();
                lights.push(Light::from(SpotLight::new(&t, constant(strength), 0.4, 0.7)));
            }
            2 => {
                let (a, b) = (0.3 * rng.direction(), 0.3 * rng.direction());
                lights.extend(area(triangles(&[p, p + a, p + b], &[0, 1, 2]), 10.0 * strength, i % 8 == 2));
            }
            _ => lights.extend(area(sphere(p, 0.1), 10.0 * strength, false)),
        }
    }
    lights
}

fn ids(lights: &Lights) -> impl Iterator<Item = Id<Light>> {
    (0..lights.len()).map(Id::new)
}

fn points() -> [ReferencePoint; 4] {
    [
        surface(Vec3::ZERO, Vec3::Z),
        surface(Vec3::new(9.0, -9.0, 4.0), Vec3::new(0.0, 0.6, 0.8)),
        ReferencePoint::free(Vec3::new(-3.0, 2.0, 5.0), 0.0),
        ReferencePoint::free(Vec3::new(100.0, 20.0, 0.0), 0.0),
    ]
}

/// Of lights that shine everywhere something is always chosen.
#[test]
fn probabilities_of_all_lights_sum_to_one() {
    let mut rng = Rng::new(2);
    for count in [1, 2, 8, 9, 30, 1000] {
        let point = |_| {
            let position = rng.vec3();
            Light::from(PointLight { position, intensity: constant(0.01 + rng.f32()) })
        };
        let mut all: Vec<_> = (0..count).map(point).collect();
        for sky in [false, true] {
            if sky {
                all.push(Light::from(UniformInfinite { radiance: constant(0.2) }));
                all.push(Light::from(DistantLight { direction: Vec3::X, irradiance: constant(2.0) }));
            }
            let lights = Lights::build(all.clone());
            for from in points() {
                let sum: f64 = ids(&lights).map(|id| f64::from(lights.pmf(ByTexture, &from, id))).sum();
                assert!((sum - 1.0).abs() < 1e-4, "{count} lights at {:?}: {sum}", from.p);
            }
        }
    }
}

/// How often each light is chosen, and how often none, is what the probabilities say.
#[test]
fn lights_are_chosen_as_often_as_their_probability() {
    let mut all = many(300, 4);
    all.push(Light::from(UniformInfinite { radiance: constant(0.5) }));
    all.push(Light::from(DistantLight { direction: Vec3::Y, irradiance: constant(0.7) }));
    let lights = Lights::build(all);
    let samples = 200_000;
    let [flat, inclined, ..] = points();
    let opaque = [flat.seen_from(Vec3::NEG_Z), inclined.seen_from(Vec3::Z)];
    for (i, from) in points().iter().chain(&opaque).enumerate() {
        let mut rng = Rng::new(10 + i as u64);
        let mut observed = vec![0u64; lights.len() + 1];
        for _ in 0..samples {
            match lights.choose(ByTexture, from, rng.f32()) {
                Some(c) => {
                    observed[c.light] += 1;
                    let pmf = lights.pmf(ByTexture, from, Id::new(c.light));
                    assert!((c.pmf / pmf - 1.0).abs() < 1e-4, "{} {pmf}", c.pmf);
                }
                None => observed[lights.len()] += 1,
            }
        }
        let mut expected: Vec<f64> =
            ids(&lights).map(|id| samples as f64 * f64::from(lights.pmf(ByTexture, from, id))).collect();
        expected.push((samples as f64 - expected.iter().sum::<f64>()).max(0.0));
        let options = Options { tests: points().len() + opaque.len(), ..Options::default() };
        counts_test(&observed, &expected, &options).check(&format!("reference {i}"));
    }
}

/// On an opaque surface lights behind it are not chosen, and those before it as often as if there were no others.
#[test]
fn opaque_surfaces_have_no_use_for_lights_behind_them() {
    let lamp =
        |z: f32| Light::from(PointLight { position: Vec3::new(0.3, 0.2, z), intensity: constant(1.0) });
    let lights = Lights::build(vec![
        lamp(1.0),
        lamp(-1.0),
        Light::from(DistantLight { direction: Vec3::new(0.6, 0.0, 0.8), irradiance: constant(0.1) }),
        Light::from(DistantLight { direction: Vec3::new(0.6, 0.0, -0.8), irradiance: constant(0.1) }),
    ]);
    let from = surface(Vec3::ZERO, Vec3::Z);
    let pmfs = |from: &ReferencePoint| [0, 1, 2, 3].map(|i| lights.pmf(ByTexture, from, Id::new(i)));
    let sheer = pmfs(&from);
    assert!(sheer[0] == sheer[1] && sheer[2] == sheer[3] && sheer[0] + sheer[2] == 0.5, "{sheer:?}");
    let (above, below) = (pmfs(&from.seen_from(Vec3::Z)), pmfs(&from.seen_from(Vec3::NEG_Z)));
    assert!(above[1] == 0.0 && above[3] == 0.0 && (above[0] + above[2] - 1.0).abs() < 1e-6, "{above:?}");
    assert_eq!([above[1], above[0], above[3], above[2]], below);
}

/// Scattered directions are to find even skies: the other lights are chosen as often as if there were none.
#[test]
fn even_skies_are_left_to_scattering() {
    let others = || {
        let distant = DistantLight { direction: Vec3::Y, irradiance: constant(0.7) };
        let mut all = many(20, 6);
        all.extend([Light::from(distant), image_sky()]);
        all
    };
    let sky = Light::from(UniformInfinite { radiance: constant(3.0) });
    let with = Lights::build([vec![sky.clone()], others()].concat());
    let without = Lights::build(others());
    for from in points() {
        let pmf = |lights: &Lights, i| lights.pmf(Complementary, &from, Id::new(i));
        assert_eq!(pmf(&with, 0), 0.0);
        assert_eq!(density(Complementary, &Lights::build(vec![sky.clone()]), &from, Vec3::Z), 0.0);
        (0..without.len()).for_each(|i| assert_eq!(pmf(&with, 1 + i), pmf(&without, i)));
        assert!(with.pmf(ByTexture, &from, Id::new(0)) > 0.0);
    }
    assert_eq!(with.sampled(Complementary), without.sampled(Complementary));
    assert_eq!(with.sampled(ByTexture), without.sampled(ByTexture) + 1);
}

/// Σ of all lights' irradiance (from both sides), and the estimates by choosing one.
struct Comparison {
    exact: f64,
    chosen: Welford,
    uniform: Welford,
}

fn compare(lights: &Lights, from: &ReferencePoint, seed: u64) -> Comparison {
    let mut rng = Rng::new(seed);
    let w = wavelengths();
    let value = |s: LightSample| {
        let cos = if from.n == Vec3::ZERO { 1.0 } else { s.wi.dot(from.n).abs() };
        f64::from(s.radiance[0] * cos / s.pdf)
    };
    let mut exact = 0.0;
    for id in ids(lights) {
        let light = lights.get(id);
        let count = if matches!(light, Light::Area(_)) { 4000 } else { 1 };
        let mean: Welford =
            (0..count).map(|_| light.sample(ByTexture, from, rng.vec2(), &w).map_or(0.0, value)).collect();
        exact += mean.mean;
    }
    let chosen = (0..60_000)
        .map(|_| lights.sample(ByTexture, from, rng.f32(), rng.vec2(), &w).map_or(0.0, value))
        .collect();
    let n = lights.len();
    let uniform = (0..60_000)
        .map(|_| {
            let light = lights.get(Id::new(rng.below(n)));
            light.sample(ByTexture, from, rng.vec2(), &w).map_or(0.0, |s| n as f64 * value(s))
        })
        .collect();
    Comparison { exact, chosen, uniform }
}

#[test]
fn the_total_of_a_thousand_lights_is_unbiased_and_less_noisy() {
    let lights = Lights::build(many(1000, 8));
    for (i, from) in points().iter().enumerate() {
        let c = compare(&lights, from, 30 + i as u64);
        t_test_mean(&c.chosen, c.exact).check(&format!("reference {i}"), 0.01, points().len());
        let gain = c.uniform.variance() / c.chosen.variance();
        println!("reference {i}: variance {gain:.1} times less than by uniform choice");
        assert!(gain > 4.0, "reference {i}: variance {gain} times less");
    }
}

#[test]
fn lights_without_light_are_never_chosen() {
    let dark = Light::from(PointLight { position: Vec3::X, intensity: constant(0.0) });
    let mut all = vec![dark.clone(); 20];
    all.extend(area(sphere(Vec3::Y, 0.5), 0.0, false));
    all.push(Light::from(UniformInfinite { radiance: constant(0.0) }));
    let lights = Lights::build(all.clone());
    assert!(lights.sample(ByTexture, &points()[0], 0.5, Vec2::ZERO, &wavelengths()).is_none());
    all.push(Light::from(PointLight { position: Vec3::Z, intensity: constant(1.0) }));
    let lights = Lights::build(all);
    let id = Id::new(lights.len() - 1);
    assert_eq!(lights.pmf(ByTexture, &points()[0], id), 1.0);
    assert_eq!(lights.sample(ByTexture, &points()[0], 0.999, Vec2::ZERO, &wavelengths()).unwrap().pdf, 1.0);
    assert!(
        Lights::build(Vec::new()).sample(ByTexture, &points()[0], 0.5, Vec2::ZERO, &wavelengths()).is_none()
    );
}

/// Lights in one place, in a line, and a hundred thousand of them.
#[test]
fn degenerate_and_large_sets_build() {
    let at = |f: &dyn Fn(usize) -> Vec3, n: usize| {
        let light = |i| Light::from(PointLight { position: f(i), intensity: constant(1.0) });
        Lights::build((0..n).map(light).collect())
    };
    let from = points()[0];
    for lights in [at(&|_| Vec3::ONE, 1000), at(&|i| Vec3::new(0.0, i as f32, 1.0), 1000)] {
        let sum: f64 = ids(&lights).map(|id| f64::from(lights.pmf(ByTexture, &from, id))).sum();
        assert!((sum - 1.0).abs() < 1e-4);
    }
    let big = Lights::build(many(100_000, 1));
    let mut rng = Rng::new(1);
    let found = (0..10_000).filter(|_| big.choose(ByTexture, &from, rng.f32()).is_some()).count();
    assert!(found > 5_000, "{found}");
}
