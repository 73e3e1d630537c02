use tenfold_math::{Vec2, Vec3};
use tenfold_testkit::chi2::{Options, sphere_test};

use super::*;

/// Tests every lane as the hero where they differ, else one. Deltas count as no sample.
fn check(case: &Case<'_>, wo: Vec3, options: &Options) {
    let heroes = if case.name.contains("dispersive") { [0, 3].as_slice() } else { &[1] };
    for &hero in heroes {
        let sample = |lobe: f32, u: Vec2| {
            let s = case.bxdf.sample(wo, lobe, u, hero)?;
            (!s.lobe.is_specular()).then_some(s.wi)
        };
        let pdf = |wi: Vec3| f64::from(case.bxdf.pdf(wo, wi).lane(hero));
        sphere_test(sample, pdf, options).check(&format!("{}, wo = {wo}, hero {hero}", case.name));
    }
}

#[test]
fn directions_are_distributed_as_their_density_says() {
    let tables = Tables::new();
    let cases = cases(&tables);
    let directions =
        [direction(0.0, 0.0), direction(65.0, 200.0), direction(86.0, 110.0), direction(140.0, 300.0)];
    let options = Options {
        samples: 30_000,
        theta_bins: 12,
        phi_bins: 16,
        tests: cases.len() * directions.len() * 2,
        evaluations: 20_000,
        ..Options::default()
    };
    for case in cases.iter().filter(|c| c.bxdf.lobes().has_density()) {
        for &wo in &directions {
            check(case, wo, &options);
        }
    }
}

#[test]
fn visible_normals_are_distributed_as_their_density_says() {
    let parameters = [(0.05, 0.05), (0.3, 0.3), (0.1, 0.7), (1.0, 0.4)];
    let directions = outgoing();
    let options = Options { tests: parameters.len() * directions.len(), ..Options::default() };
    for (x, y) in parameters {
        let d = ggx(x, y);
        for &wo in &directions {
            // Only normals of the side of wo, turned to it, are visible.
            let pdf = |m: Vec3| {
                let seen = m.z * wo.z > 0.0 && wo.dot(m) > 0.0;
                if seen { f64::from(d.visible_pdf(wo, m)) } else { 0.0 }
            };
            let sample = |_, u| Some(d.sample_visible(wo, u));
            sphere_test(sample, pdf, &options).check(&format!("α = {x} {y}, wo = {wo}"));
        }
    }
}
