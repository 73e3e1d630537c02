use tenfold_math::Vec3;
use tenfold_math::ops;
use tenfold_testkit::quadrature::integrate;
use tenfold_testkit::{Welford, t_test_mean};

use super::*;

const R: [f32; 4] = [0.9, 0.6, 0.3, 0.05];

/// Mean and error of walks over seeds, per lane.
fn walked(
    eta: SampledSpectrum,
    distribution: TrowbridgeReitz,
    slab: Slab,
    base: LayeredBase,
    wo: Vec3,
    wi: Vec3,
    walks: u64,
) -> [Welford; 4] {
    let mut sums = [Welford::new(); 4];
    for seed in 0..walks {
        let f = Bxdf::Layered(Layered::new(eta, distribution, slab, base, seed)).eval(wo, wi);
        for (sum, value) in sums.iter_mut().zip(f.to_array()) {
            sum.add(f64::from(value));
        }
    }
    sums
}

/// The closed form against the random walk, over roughness, depth, thickness, dispersion and directions.
#[test]
fn closed_form_is_the_mean_of_walks() {
    let pairs = [
        (direction(20.0, 0.0), direction(50.0, 140.0)),
        (direction(75.0, 30.0), direction(60.0, 200.0)),
        (direction(130.0, 10.0), direction(100.0, 80.0)),
    ];
    let parameters = [
        (splat(1.5), 0.0, 0.0, 0.01, 10),
        (splat(1.5), 0.1, 0.1, 0.01, 10),
        (splat(1.5), 0.4, 0.4, 0.01, 10),
        (splat(1.3), 0.1, 0.6, 0.3, 3),
        (splat(1.8), 0.7, 0.7, 0.1, 1),
        (splat(0.8), 0.3, 0.3, 0.05, 100),
        (dispersive_eta(), 0.2, 0.2, 0.01, 10),
    ];
    let tests = pairs.len() * parameters.len() * 4;
    for (eta, x, y, thickness, max_depth) in parameters {
        let roughness = CoatRoughness::Constant(ggx(x, y));
        let table = CoatTable::new(eta.min_component(), eta.max_component(), roughness, thickness);
        let albedo = SampledSpectrum::new(R);
        let closed = Bxdf::CoatedDiffuse(CoatedDiffuse::new(&table, eta, ggx(x, y), albedo, max_depth));
        let slab = Slab { max_depth, ..slab(thickness, 0.0) };
        let base = LayeredBase::Diffuse(Diffuse::new(albedo));
        for (wo, wi) in pairs {
            let want = closed.eval(wo, wi);
            let walks = walked(eta, ggx(x, y), slab, base, wo, wi, 20_000);
            for lane in 0..4 {
                let what = format!("η {}, α {x} {y}, {wo} {wi}, lane {lane}, {want:?}", eta[lane]);
                t_test_mean(&walks[lane], f64::from(want[lane])).check(&what, 0.01, tests);
                let resolution = walks[lane].standard_error() / f64::from(want[lane]);
                assert!(resolution < 0.03, "{what}: the test resolves {resolution} only");
            }
        }
    }
}

/// Flux transmitted by a smooth coat, and the internal reflectance against the known relation
/// `1 - K = (1 - F̄) / η²` of the external diffuse reflectance F̄ without attenuation.
#[test]
fn smooth_coat_obeys_reciprocity_of_flux() {
    for eta in [1.2, 1.5, 2.0, 0.8] {
        let table = CoatTable::new(eta, eta, CoatRoughness::Constant(TrowbridgeReitz::SMOOTH), 0.0);
        let outside = 2.0 * integrate(0.0, 1.0, |c| c * f64::from(fresnel_dielectric(c as f32, eta)));
        let totals = table.totals(splat(eta), &TrowbridgeReitz::SMOOTH);
        let want = 1.0 - (1.0 - outside) / f64::from(eta * eta);
        assert!((f64::from(totals.inner.lane(0)) - want).abs() < 1e-4, "{eta}: {totals:?} {want}");
        assert!((f64::from(totals.mean_transmitted.lane(0)) - 1.0 + outside).abs() < 1e-4, "{eta}");
    }
}

/// A white base under a clear coat that absorbs nothing returns all light, given enough depth.
#[test]
fn white_coated_furnace() {
    let table = CoatTable::new(1.5, 1.5, CoatRoughness::Constant(TrowbridgeReitz::SMOOTH), 0.0);
    let white = CoatedDiffuse::new(&table, splat(1.5), TrowbridgeReitz::SMOOTH, splat(1.0), 2000);
    let white = Bxdf::CoatedDiffuse(white);
    for theta in [0.0, 45.0, 80.0] {
        let wo = direction(theta, 0.0);
        let mut total = 0.0;
        for i in 0..600 * 600 {
            let u = tenfold_math::Vec2::new((i % 600) as f32 + 0.5, (i / 600) as f32 + 0.5) / 600.0;
            let s = white.sample(wo, tenfold_math::ONE_MINUS_EPSILON, u, 0).unwrap();
            assert!(!s.lobe.is_specular());
            let share = s.pdf.lane(0) * std::f32::consts::PI / s.wi.z;
            total += f64::from(s.f.lane(0) * s.wi.z / s.pdf.lane(0) * share) / 3.6e5;
        }
        let total = total + f64::from(fresnel_dielectric(wo.z, 1.5));
        assert!((total - 1.0).abs() < 1e-3, "{theta}: {total}");
    }
}

/// Tables over α and over the index agree with tables of one value.
#[test]
fn tables_with_axes_agree_with_tables_of_one_value() {
    let axes = CoatTable::new(1.4, 1.6, CoatRoughness::IsotropicUpTo(0.7), 0.02);
    for (eta, alpha) in [(1.43, 0.04), (1.5, 0.21), (1.57, 0.66), (1.6, 0.7)] {
        let distribution = ggx(alpha, alpha);
        let one = CoatTable::new(eta, eta, CoatRoughness::Constant(distribution), 0.02);
        let (a, b) = (axes.totals(splat(eta), &distribution), one.totals(splat(eta), &distribution));
        assert!((a.inner - b.inner).0.abs().max_element() < 2e-3, "{eta} {alpha}: {a:?} {b:?}");
        for theta in [0.0, 30.0, 60.0, 80.0, 88.0] {
            let w = direction(theta, 0.0);
            let (a, b) =
                (axes.fluxes(splat(eta), &distribution, w), one.fluxes(splat(eta), &distribution, w));
            let error = ((a.transmitted - b.transmitted) / b.transmitted).0.abs().max_element();
            assert!(error < 4e-3, "{eta} {alpha} {theta}: {a:?} {b:?}");
        }
    }
}

/// Walks with a medium and with metals are reciprocal in the mean, and the two kinds of connection agree:
/// a smooth coat uses one alone, a nearly smooth one both.
#[test]
fn walks_are_reciprocal() {
    let (a, b) = (direction(25.0, 0.0), direction(55.0, 160.0));
    let diffuse = LayeredBase::Diffuse(Diffuse::new(splat(0.7)));
    let metal = LayeredBase::Conductor(copper(ggx(0.3, 0.3)));
    let mirror = LayeredBase::Conductor(copper(TrowbridgeReitz::SMOOTH));
    for (coat, slab, base) in [
        (ggx(0.3, 0.3), slab(0.5, 0.8), diffuse),
        (ggx(0.0, 0.0), slab(0.5, 0.8), mirror),
        (ggx(0.3, 0.3), slab(0.05, 0.0), metal),
        (ggx(0.0, 0.0), slab(0.05, 0.0), metal),
        (ggx(0.4, 0.4), slab(0.05, 0.0), mirror),
    ] {
        let there = walked(splat(1.5), coat, slab, base, a, b, 60_000);
        let back = walked(splat(1.5), coat, slab, base, b, a, 60_000);
        for lane in [0, 3] {
            let test = tenfold_testkit::t_test_two(&there[lane], &back[lane]);
            test.check(&format!("{coat:?} {slab:?} {base:?}"), 0.01, 10);
        }
    }
}

/// Without a boundary and a medium the slab only attenuates: the base's BSDF times both crossings.
#[test]
fn an_invisible_coat_attenuates() {
    let (wo, wi) = (direction(25.0, 0.0), direction(55.0, 160.0));
    let metal = copper(ggx(0.3, 0.3));
    let layered = Layered::new(splat(1.0), ggx(0.3, 0.3), slab(0.2, 0.0), LayeredBase::Conductor(metal), 1);
    let want = Bxdf::Conductor(metal).eval(wo, wi) * ops::exp(-0.2 / wo.z - 0.2 / wi.z);
    let got = Bxdf::Layered(layered).eval(wo, wi);
    assert!((got - want).0.abs().max_element() < 1e-5, "{got:?} {want:?}");
}

/// The delta of a smooth coat on a mirror against the sum over its reflections.
#[test]
fn smooth_coat_on_a_mirror_sums_its_reflections() {
    let metal = copper(TrowbridgeReitz::SMOOTH);
    let layered =
        Layered::new(splat(1.5), TrowbridgeReitz::SMOOTH, slab(0.1, 0.0), LayeredBase::Conductor(metal), 1);
    let layered = Bxdf::Layered(layered);
    let wo = direction(40.0, 90.0);
    let s = layered.sample(wo, 0.5, tenfold_math::Vec2::ZERO, 0).unwrap();
    assert!(s.lobe.is_specular() && s.pdf == SampledSpectrum::ONE);
    let f = fresnel_dielectric(wo.z, 1.5);
    let cos = (1.0 - (1.0 - wo.z * wo.z) / 2.25).sqrt();
    let pass = ops::exp(-0.2 / cos);
    let base = metal.fresnel(cos);
    let mut want = splat(f);
    for n in 0..5 {
        let step = base * pass;
        let mut term = splat((1.0 - f) * (1.0 - f)) * step;
        for _ in 0..n {
            term *= step * f;
        }
        want += term;
    }
    assert!((s.f * wo.z - want).0.abs().max_element() < 1e-5);
}
