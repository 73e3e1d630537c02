//! Directions that are not chosen by the scattering function.

use tenfold_math::{Frame, Vec2, Vec3};
use tenfold_testkit::chi2::{Options, sphere_test};
use tenfold_testkit::stats::{Welford, t_test_two};
use tenfold_testkit::{Rng, TTest};

use super::*;

const STRATEGIES: [ScatterStrategy; 2] = [ScatterStrategy::Uniform, ScatterStrategy::Cosine];

/// All kinds of lobes with a density, alone and beside deltas, without peaks that such strategies hardly find.
const NAMES: [&str; 13] = [
    "diffuse",
    "diffuse transmission",
    "diffuse transmission alone",
    "conductor 0.3 0.3",
    "dielectric 0.3 0.3 1.5",
    "dielectric 0.3 0.3 0.7",
    "dielectric 0.3 0.3 dispersive",
    "coated diffuse smooth",
    "coated diffuse rough",
    "coated diffuse dispersive",
    "layered smooth diffuse with a medium",
    "layered smooth on rough",
    "layered rough on rough",
];

fn directions() -> [Vec3; 3] {
    [direction(20.0, 50.0), direction(75.0, 200.0), direction(130.0, 300.0)]
}

fn named<'a>(cases: &'a [Case<'a>]) -> impl Iterator<Item = &'a Case<'a>> {
    NAMES.iter().map(|name| cases.iter().find(|case| case.name == *name).unwrap())
}

fn bsdf<'a>(case: &Case<'a>, strategy: ScatterStrategy) -> Bsdf<'a> {
    let mut bsdf = Bsdf::new(Frame::from_z(Vec3::Z), case.bxdf);
    bsdf.set_strategy(strategy);
    bsdf
}

#[test]
fn directions_are_distributed_as_their_density_says() {
    let tables = Tables::new();
    let cases = cases(&tables);
    let options = Options {
        samples: 20_000,
        theta_bins: 8,
        phi_bins: 8,
        tests: NAMES.len() * STRATEGIES.len() * directions().len(),
        evaluations: 5_000,
        ..Options::default()
    };
    for case in named(&cases) {
        for strategy in STRATEGIES {
            let bsdf = bsdf(case, strategy);
            for wo in directions() {
                let sample = |lobe: f32, u: Vec2| {
                    let s = bsdf.sample(wo, lobe, u, 1)?;
                    (!s.lobe.is_specular()).then_some(s.wi)
                };
                let pdf = |wi: Vec3| f64::from(bsdf.pdf(wo, wi).lane(1));
                let what = format!("{}, {}, wo = {wo}", case.name, strategy.name());
                sphere_test(sample, pdf, &options).check(&what);
            }
        }
    }
}

/// All lanes have the same density, that of the direction; values are those of the scattering function.
#[test]
fn samples_agree_with_value_and_density() {
    let tables = Tables::new();
    let mut rng = Rng::new(3);
    for case in cases(&tables) {
        for strategy in STRATEGIES {
            let bsdf = bsdf(&case, strategy);
            for wo in outgoing() {
                for _ in 0..100 {
                    let (lobe, u, hero) = (rng.f32(), rng.vec2(), (rng.f32() * 4.0) as usize);
                    let Some(s) = bsdf.sample(wo, lobe, u, hero) else { continue };
                    let what = format!("{}, {}, wo = {wo}, {s:?}", case.name, strategy.name());
                    assert_eq!(s.lobe.is_reflective(), wo.z * s.wi.z > 0.0, "{what}");
                    assert_ne!(s.lobe.is_specular(), s.lobe.has_density(), "{what}");
                    if s.lobe.is_specular() {
                        let own = case.bxdf.sample(wo, lobe, u, hero).unwrap();
                        assert!(own.lobe == s.lobe && own.pdf == s.pdf && own.f == s.f, "{what}");
                        continue;
                    }
                    assert_eq!(s.pdf, splat(s.pdf.lane(0)), "{what}");
                    let value = bsdf.eval_and_pdf(wo, s.wi);
                    assert_eq!((value.f, value.pdf), (s.f, s.pdf), "{what}");
                    assert_eq!((bsdf.eval(wo, s.wi), bsdf.pdf(wo, s.wi)), (s.f, s.pdf), "{what}");
                    assert_eq!(s.f, case.bxdf.eval(wo, s.wi), "{what}");
                    if s.lobe.is_transmissive()
                        && let Some(own) = case.bxdf.sample(wo, 0.999, Vec2::splat(0.5), hero)
                        && own.lobe.is_transmissive()
                    {
                        assert_eq!(s.eta, own.eta, "{what}");
                    }
                }
            }
        }
    }
}

/// `f cos / pdf` in one lane over independent samples: its mean is the albedo, deltas and all.
fn albedo(bsdf: &Bsdf<'_>, wo: Vec3, seed: u64, wrong: f32) -> Welford {
    let mut rng = Rng::new(seed);
    let weight = |rng: &mut Rng| {
        let s = bsdf.sample(wo, rng.f32(), rng.vec2(), 1)?;
        let wrong = if s.lobe.is_specular() { 1.0 } else { wrong };
        Some((s.f * s.wi.z.abs() / (s.pdf * wrong)).lane(1))
    };
    (0..40_000).map(|_| f64::from(weight(&mut rng).unwrap_or(0.0))).collect()
}

/// Every strategy finds the same albedo, at the significance of 10⁻⁴ for all together; with a density a tenth too large, which the
/// tests must be able to tell, none would.
#[test]
fn albedos_agree() {
    let tables = Tables::new();
    let cases = cases(&tables);
    let tests = NAMES.len() * STRATEGIES.len() * directions().len();
    let passes = |t: &TTest| t.passes(1e-4, tests);
    let (mut seed, mut seen) = (0, 0);
    for case in named(&cases) {
        for wo in directions() {
            let want = albedo(&bsdf(case, ScatterStrategy::Bsdf), wo, 1000 + seed, 1.0);
            for strategy in STRATEGIES {
                seed += 1;
                let bsdf = bsdf(case, strategy);
                let what = format!("{}, {}, wo = {wo}", case.name, strategy.name());
                let right = t_test_two(&albedo(&bsdf, wo, seed, 1.0), &want);
                assert!(passes(&right), "{what}: {right:?}");
                seen += usize::from(!passes(&t_test_two(&albedo(&bsdf, wo, seed, 1.1), &want)));
            }
        }
    }
    // Where most of the light is in a delta, or next to nothing is scattered, a tenth of the rest is less than the noise.
    assert!(4 * seen > 3 * tests, "a wrong density is seen in {seen} of {tests} cases only");
}
