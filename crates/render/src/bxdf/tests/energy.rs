use std::f32::consts::PI;
use tenfold_math::ops;

use tenfold_math::{Vec2, Vec3};
use tenfold_testkit::quadrature::{Tolerance, hemisphere, sphere};
use tenfold_testkit::{Rng, Welford};

use super::*;

const TOLERANCE: Tolerance =
    Tolerance { absolute: 1e-5, relative: 1e-5, pieces: 8, evaluations: 300_000, jumps: false };

/// Mean of `f cos / pdf` over stratified samples of one hero: the albedo in that lane.
fn sampled_albedo(bxdf: &Bxdf<'_>, wo: Vec3, hero: usize, flux: bool) -> Welford {
    let mut rng = Rng::new(11);
    let n = 64;
    let mut albedo = Welford::new();
    for i in 0..n * n {
        let u = Vec2::new((i % n) as f32 + rng.f32(), (i / n) as f32 + rng.f32()) / n as f32;
        let weight = bxdf.sample(wo, rng.f32(), u, hero).map_or(0.0, |s| {
            let radiance = if flux { s.eta * s.eta } else { 1.0 };
            (s.f * (s.wi.z.abs() * radiance) / s.pdf.lane(hero)).lane(hero)
        });
        albedo.add(f64::from(weight));
    }
    albedo
}

#[test]
fn microfacets_cover_the_surface() {
    for (x, y) in [(0.1, 0.1), (0.3, 0.6), (1.0, 1.0)] {
        let d = ggx(x, y);
        let area = hemisphere(&TOLERANCE, |m| f64::from(d.d(m) * m.z));
        assert!((area.value - 1.0).abs() < 1e-3, "{x} {y}: {area:?}");
        for wo in outgoing() {
            // Visible facets project to the area that the surface shows.
            let wo = wo * 1f32.copysign(wo.z);
            let seen = hemisphere(&TOLERANCE, |m| f64::from(d.d(m) * d.g1(wo) * wo.dot(m).max(0.0)));
            assert!((seen.value / f64::from(wo.z) - 1.0).abs() < 1e-3, "{x} {y} {wo}: {seen:?}");
        }
    }
}

/// Heitz 2014, §5.2: all light that meets visible facets is reflected, shadowing by G₁ alone.
#[test]
fn weak_white_furnace() {
    for (x, y) in [(0.2, 0.2), (0.2, 0.7)] {
        let d = ggx(x, y);
        for wo in [direction(10.0, 0.0), direction(60.0, 70.0), direction(80.0, 160.0)] {
            let energy = sphere(&TOLERANCE, |wi| {
                let half = wo + wi;
                if half.length() < 1e-6 || half.z <= 0.0 {
                    return 0.0;
                }
                let m = half.normalize();
                f64::from(d.d(m) * d.g1(wo) / (4.0 * wo.z))
            });
            assert!((energy.value - 1.0).abs() < 2e-3, "{x} {y} {wo}: {energy:?}");
        }
    }
}

#[test]
fn stretched_forms_equal_smiths() {
    let d = ggx(0.2, 0.5);
    let (wo, wi) = (direction(40.0, 20.0), direction(70.0, 250.0));
    assert!((d.g1(wo) - 1.0 / (1.0 + d.lambda(wo))).abs() < 1e-6);
    assert!((d.g2(wo, wi) - 1.0 / (1.0 + d.lambda(wo) + d.lambda(wi))).abs() < 1e-6);
    let m = (wo + wi).normalize();
    let want = d.d(m) * d.g2(wo, wi) / (4.0 * wo.z * wi.z);
    assert!((d.d_g2_over_4_cos_cos(m, wo, wi) / want - 1.0).abs() < 1e-5);
    // tan² θ = Λ's definition for an isotropic surface: (√(1 + α² tan² θ) - 1) / 2.
    let tan = ops::tan(70f32.to_radians());
    let want = 0.5 * ((1.0 + (0.3 * tan).powi(2)).sqrt() - 1.0);
    assert!((ggx(0.3, 0.3).lambda(wi) - want).abs() < 1e-5);
}

#[test]
fn lambertian_albedos() {
    let (r, t) = (0.3, 0.5);
    let reflector = Bxdf::Diffuse(Diffuse::new(splat(r)));
    let sheet = Bxdf::DiffuseTransmission(DiffuseTransmission::new(splat(r), splat(t)));
    for wo in outgoing() {
        let of = |bxdf: &Bxdf<'_>| {
            sphere(&TOLERANCE, |wi| f64::from(bxdf.eval(wo, wi).lane(1) * wi.z.abs())).value
        };
        assert!((of(&reflector) - f64::from(r)).abs() < 1e-4);
        assert!((of(&sheet) - f64::from(r + t)).abs() < 1e-4);
    }
}

#[test]
fn smooth_boundaries_keep_all_energy() {
    let wo = direction(50.0, 0.0);
    for eta in [1.5, 0.7, 1.0] {
        for wo in [wo, -wo] {
            let glass = Bxdf::Dielectric(Dielectric::new(splat(eta), TrowbridgeReitz::SMOOTH));
            let pane = Bxdf::ThinDielectric(ThinDielectric::new(splat(eta)));
            for bxdf in [glass, pane] {
                let (mut flux, mut probability) = (0.0, 0.0);
                for lobe in [0.0, tenfold_math::ONE_MINUS_EPSILON] {
                    let s = bxdf.sample(wo, lobe, Vec2::splat(0.5), 0).unwrap();
                    // Reflection comes first; either may be all there is.
                    if (lobe == 0.0) == s.lobe.is_reflective() {
                        flux += s.f.lane(3) * s.wi.z.abs() * s.eta * s.eta;
                        probability += s.pdf.lane(3);
                    }
                }
                let (flux, probability): (f32, f32) = (flux, probability);
                assert!((flux - 1.0).abs() < 1e-5 && (probability - 1.0).abs() < 1e-5, "{eta} {wo} {flux}");
            }
        }
    }
}

/// The pane's closed form against the sum over its inner reflections.
#[test]
fn pane_sums_its_reflections() {
    let cos = 0.4;
    let r = f64::from(fresnel_dielectric(cos, 1.5));
    let mut sum = r;
    for n in 0..60 {
        sum += (1.0 - r).powi(2) * r * r.powi(2 * n);
    }
    let pane = ThinDielectric::new(splat(1.5));
    assert!((f64::from(pane.reflectance(cos).lane(0)) - sum).abs() < 1e-6);
}

/// Rough glass loses only what single scattering leaves out: nothing as α → 0, never gaining.
#[test]
fn rough_glass_conserves_flux() {
    for theta in [0.0, 40.0, 75.0, 110.0, 160.0] {
        let wo = direction(theta, 20.0);
        let mut least = 1.0f64;
        for alpha in [0.5, 0.2, 0.05, 0.01, 0.002] {
            let glass = Bxdf::Dielectric(Dielectric::new(splat(1.5), ggx(alpha, alpha)));
            let flux = sampled_albedo(&glass, wo, 0, true);
            let bound = 4.0 * flux.standard_error() + 1e-6;
            assert!(flux.mean <= 1.0 + bound, "{theta} {alpha}: {flux:?}");
            least = flux.mean;
        }
        // What is left of the loss at α = 0.002 is below its own size.
        assert!((least - 1.0).abs() < 4e-3, "{theta}: {least}");
    }
}

/// Nothing reflects more than it receives; a perfect rough mirror in the limit all of it.
#[test]
fn albedos_are_below_one() {
    let tables = Tables::new();
    for case in cases(&tables) {
        let flux = matches!(case.bxdf, Bxdf::Dielectric(_));
        for wo in outgoing() {
            for hero in [0, 3] {
                let albedo = sampled_albedo(&case.bxdf, wo, hero, flux);
                let bound = 5.0 * albedo.standard_error() + 1e-4;
                assert!(albedo.mean <= 1.0 + bound, "{}, wo = {wo}: {albedo:?}", case.name);
            }
        }
    }
}

/// Integrals of `eval` equal the means of the samples' weights, the deltas apart.
#[test]
fn albedo_by_quadrature_and_by_sampling_agree() {
    let tables = Tables::new();
    let tolerance =
        Tolerance { absolute: 1e-4, relative: 1e-3, pieces: 8, evaluations: 200_000, ..Tolerance::default() };
    for case in cases(&tables) {
        if matches!(case.bxdf, Bxdf::Layered(_)) || !case.bxdf.lobes().has_density() {
            continue;
        }
        for wo in [direction(20.0, 40.0), direction(130.0, 100.0)] {
            let mut rng = Rng::new(21);
            let mut sampled = Welford::new();
            for _ in 0..20_000 {
                let s = case.bxdf.sample(wo, rng.f32(), rng.vec2(), 1).filter(|s| !s.lobe.is_specular());
                sampled.add(s.map_or(0.0, |s| f64::from(s.f.lane(1) * s.wi.z.abs() / s.pdf.lane(1))));
            }
            let exact = sphere(&tolerance, |wi| f64::from(case.bxdf.eval(wo, wi).lane(1) * wi.z.abs()));
            let bound = 4.5 * sampled.standard_error() + exact.error + 1e-3 * exact.value;
            let difference = (sampled.mean - exact.value).abs();
            assert!(difference <= bound, "{}, wo = {wo}: {sampled:?} {exact:?}", case.name);
        }
    }
}

/// A smooth conductor reflects Fresnel's share, a rough one tends to it.
#[test]
fn conductors_tend_to_the_mirror() {
    let wo = direction(30.0, 0.0);
    let mirror = Bxdf::Conductor(copper(TrowbridgeReitz::SMOOTH));
    let s = mirror.sample(wo, 0.0, Vec2::ZERO, 0).unwrap();
    let rough = Bxdf::Conductor(copper(ggx(0.002, 0.002)));
    for lane in 0..4 {
        let albedo = sampled_albedo(&rough, wo, lane, false);
        assert!((albedo.mean - f64::from(s.f.lane(lane) * s.wi.z)).abs() < 1e-3);
    }
    assert!((s.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-7);
    assert!(
        (rough.eval(wo, s.wi).lane(0) * PI * 0.002f32.powi(2) * 4.0 * wo.z * wo.z / (s.f.lane(0) * wo.z)
            - 1.0)
            .abs()
            < 1e-2
    );
}
