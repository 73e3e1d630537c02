//! χ² of the directions of samples against the densities that paths compute.

use super::*;
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Id, Slots, Vec2s, WIDTH};
use tenfold_testkit::Options;
use tenfold_testkit::chi2::sphere_test;

const TESTS: usize = 100;

/// Those that differ where there is no picture on a surface.
const PLAIN: [LightStrategy; 2] = [LightStrategy::UniformArea, ByTexture];

fn check(what: &str, strategies: &[LightStrategy], lights: &Lights, from: &ReferencePoint, seed: u64) {
    strategies.iter().for_each(|&strategy| check_one(what, strategy, lights, from, seed));
}

fn check_one(what: &str, strategy: LightStrategy, lights: &Lights, from: &ReferencePoint, seed: u64) {
    let options = Options {
        samples: 60_000,
        theta_bins: 12,
        phi_bins: 16,
        seed,
        tests: TESTS,
        evaluations: 20_000,
        ..Options::default()
    };
    let sample = |u_choice, u| lights.sample(strategy, from, u_choice, u, &wavelengths()).map(|s| s.wi);
    let pdf = |wi| f64::from(density(strategy, lights, from, wi));
    sphere_test(sample, pdf, &options).check(&format!("{what}, {}", strategy.name()));
}

fn references() -> [ReferencePoint; 3] {
    [
        surface(Vec3::new(0.1, 0.2, 0.0), Vec3::Z),
        surface(Vec3::new(0.8, -0.9, 0.4), Vec3::new(0.6, 0.0, 0.8)),
        ReferencePoint::free(Vec3::new(-0.5, 0.3, -1.0), 0.0),
    ]
}

#[test]
fn area_lights_have_the_density_of_their_samples() {
    let t = Transform::translate(Vec3::new(0.0, 0.0, 1.5)) * Transform::rotate(1.2, Vec3::X).unwrap();
    let shapes = [
        ("sphere", sphere(Vec3::new(0.2, -0.1, 1.2), 0.5)),
        ("disk", disk(1.1, 0.7)),
        ("cylinder", cylinder(t, 0.3)),
        ("patch", patch(ceiling(), &[])),
        ("triangles", triangles(&ceiling(), &[0, 1, 2, 2, 1, 3])),
    ];
    for (seed, (name, shape)) in shapes.into_iter().enumerate() {
        let lights = Lights::build(area(shape, 2.0, false));
        for (i, from) in references().iter().enumerate() {
            check(&format!("{name}, reference {i}"), &PLAIN, &lights, from, seed as u64 * 3 + i as u64);
        }
    }
}

#[test]
fn images_on_area_lights_too() {
    let mirrored = [Vec2::new(1.0, 1.0), Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::ZERO];
    let mut skewed = ceiling();
    skewed[1].x += 0.4;
    skewed[3].x += 0.4;
    let shapes = [
        ("rectangle", patch(ceiling(), &[])),
        ("mirrored", patch(ceiling(), &mirrored)),
        ("parallelogram", patch(skewed, &[])),
        ("disk", disk(1.1, 0.7)),
    ];
    for (seed, (name, shape)) in shapes.into_iter().enumerate() {
        let lights = Lights::build(vec![textured(shape)]);
        for (i, from) in references().iter().enumerate() {
            let seed = 100 + seed as u64 * 3 + i as u64;
            check(&format!("{name}, reference {i}"), &LightStrategy::ALL, &lights, from, seed);
        }
    }
}

#[test]
fn skies_have_the_density_of_their_samples() {
    let uniform = Light::from(UniformInfinite { radiance: constant(1.0) });
    let strategies = [LightStrategy::UniformArea, ByTexture, Complementary];
    for (i, light) in [uniform, image_sky()].into_iter().enumerate() {
        let lights = Lights::build(vec![light]);
        let [flat, inclined, free] = references();
        let seed = 200 + 4 * i as u64;
        for (k, from) in
            [flat, inclined.seen_from(Vec3::Z), flat.seen_from(Vec3::NEG_Z), free].iter().enumerate()
        {
            check(&format!("sky {i}, reference {k}"), &strategies, &lights, from, seed + k as u64);
        }
    }
}

#[test]
fn mixed_scenes_have_the_density_of_their_samples() {
    let mut all = area(sphere(Vec3::new(0.2, -0.1, 1.2), 0.4), 20.0, false);
    all.extend(area(triangles(&ceiling(), &[0, 1, 2, 2, 1, 3]).clone(), 1.0, true));
    all.push(Light::from(UniformInfinite { radiance: constant(0.3) }));
    all.push(image_sky());
    let lights = Lights::build(all);
    for (i, from) in references().iter().enumerate() {
        let strategies = [LightStrategy::UniformArea, ByTexture, Complementary];
        check(&format!("mixed, reference {i}"), &strategies, &lights, from, 300 + i as u64);
    }
}

/// The density of a sample is the one that a path finds which meets the same point by itself.
#[test]
fn densities_agree_sample_by_sample() {
    let mut all = area(sphere(Vec3::new(0.2, -0.1, 1.2), 0.4), 20.0, false);
    all.push(textured(patch(ceiling(), &[])));
    all.extend(area(disk(1.4, 0.6), 3.0, false));
    all.push(image_sky());
    let mut rng = Rng::new(5);
    let each = all.into_iter().flat_map(|l| LightStrategy::ALL.map(|strategy| (strategy, l.clone())));
    for (strategy, light) in each {
        let lights = Lights::build(vec![light]);
        for from in references() {
            let mut off = 0;
            for _ in 0..2000 {
                let (c, u) = (rng.f32(), rng.vec2());
                let Some(s) = lights.sample(strategy, &from, c, u, &wavelengths()) else { continue };
                let pdf = density(strategy, &lights, &from, s.wi);
                // Near the rim of a ball a density by area divides by a cosine of few digits.
                if seen(lights.get(Id::new(0)), &from, s.wi).is_some_and(|hit| hit.n.dot(s.wi).abs() < 0.02) {
                    continue;
                }
                // At edges and between pixels rounding decides; there are few of them.
                off += ((pdf / s.pdf - 1.0).abs() > 2e-3) as u32;
                assert!(!s.delta && s.pdf > 0.0 && s.wi.is_normalized());
            }
            assert!(off <= 6, "{}: {off} of 2000: {:?}", strategy.name(), lights.get(Id::new(0)));
        }
    }
}

#[test]
fn points_side_by_side_see_what_each_sees_by_itself() {
    let mut balls = area(sphere(Vec3::new(0.2, -0.1, 1.2), 0.4), 20.0, false);
    balls.extend(area(sphere(Vec3::new(-0.5, 0.3, -0.9), 0.6), 1.0, true));
    let mut all = balls.clone();
    all.extend(area(patch(ceiling(), &[]), 3.0, false));
    all.extend(area(disk(1.4, 0.6), 3.0, false));
    all.push(textured(patch(ceiling(), &[])));
    let mut rng = Rng::new(21);
    // Most of them far, and one near, which all send as much.
    let mut scattered = Vec::new();
    for size in [0.01f32, 0.01, 0.4, 0.01, 0.01] {
        let at = Vec3::new(0.0, 0.0, 1.0) + 0.5 * rng.direction();
        let corners = [at, at + size * rng.direction(), at + size * rng.direction()];
        scattered.extend(area(triangles(&corners, &[0, 1, 2]), 1e-3 / (size * size), true));
    }
    all.extend(scattered.clone());
    let (mut out, mut counts) = (LightSamples::default(), [0; 2]);
    for (lights, strategy) in
        [&balls[..1], &balls, &all[2..3], &scattered, &all].into_iter().flat_map(|lights| {
            let lights = Lights::build(lights.to_vec());
            LightStrategy::ALL.map(|strategy| (lights.clone(), strategy))
        })
    {
        for round in 0..50 {
            let (mut from, mut u_choice, mut u) = (ReferencePoints::default(), [0.0; WIDTH], Vec2s::ZERO);
            for slot in 0..WIDTH {
                from.set(slot, references()[rng.below(3)]);
                (u_choice[slot], _) = (rng.f32(), u.set(slot, rng.vec2()));
            }
            let (slots, w) = (Slots::first(round % (WIDTH + 1)), wavelengths());
            let lit = lights.samples(strategy, slots, &from, &u_choice, &u, |_| &w, &mut out);
            for slot in slots {
                let point = from.get(slot);
                let alone = lights.sample(strategy, &point, u_choice[slot], u.get(slot), &w);
                counts[usize::from(lit.contains(slot))] += 1;
                assert_eq!(lit.contains(slot), alone.is_some());
                let Some(alone) = alone else { continue };
                let shadow = alone.shadow_ray(&point);
                assert_eq!((out.shadow.get(slot), out.t_max[slot]), (shadow.ray, shadow.t_max));
                assert_eq!((out.wi.get(slot), out.pdf[slot]), (alone.wi, alone.pdf));
                assert_eq!((out.radiance.get(slot), out.delta[slot]), (alone.radiance, alone.delta));
            }
        }
    }
    assert!(counts[0] > 100 && counts[1] > 1000, "{counts:?}");
}

#[test]
fn a_sample_shines_what_a_ray_sees() {
    let lights = Lights::build(vec![textured(patch(ceiling(), &[]))]);
    let from = references()[0];
    let mut rng = Rng::new(9);
    for _ in 0..500 {
        let Some(s) = lights.sample(ByTexture, &from, 0.5, rng.vec2(), &wavelengths()) else { continue };
        let hit = seen(lights.get(Id::new(0)), &from, s.wi).unwrap();
        let emitted = lights.emitted(Id::new(0), &hit, -s.wi, &wavelengths());
        assert!((emitted[0] - s.radiance[0]).abs() <= 1e-3 * s.radiance[0].max(0.1), "{emitted:?} {s:?}");
        let shadow = s.shadow_ray(&from);
        assert!((shadow.ray.direction.normalize() - s.wi).length() < 1e-3 && shadow.t_max < 1.0);
    }
}
