//! Experiments from what they look at to their pages.

use tenfold_lab::{
    Page, Work,
    convergence::{self, Convergence, Curve, Integral, Options, Variant, of_integral, of_scene},
    portrait,
};
use tenfold_render::{
    compile::compile,
    integrator::{CombineStrategy, Strategies},
    schedule::{Progress, RenderSettings},
};
use tenfold_sampling::{SamplePlan, SamplerKind};
use tenfold_scene::{FileResources, SourceMap, read_pbrt_str};

/// A floor under a lamp, which is out of sight: the few pixels at its edge would decide alone.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 12 "integer yresolution" 9
Sampler "zsobol" "integer pixelsamples" 3
LookAt 0 1.5 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
  Shape "trianglemesh" "point3 P" [ -0.4 3 -0.4  0.4 3 -0.4  0.4 3 0.4  -0.4 3 0.4 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
Shape "bilinearmesh" "point3 P" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]
"#;

fn go_on(progress: Progress) -> bool {
    assert!(progress.done <= progress.total, "more was done than was to be done");
    true
}

/// Parses a page, to see that it is well-formed, and its numbers, to see that they are the experiment's.
fn check(page: &Page, html_parts: &[&str]) {
    let html = page.html("page");
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(&html, options).unwrap();
    for part in html_parts {
        assert!(html.contains(part), "{part}");
    }
    assert!(!html.contains("NaN"));
}

/// The lines of a CSV file of a page, without the first.
fn csv(page: &Page, name: &str) -> Vec<Vec<String>> {
    let directory = tempfile::tempdir().unwrap();
    page.write(&directory.path().join("page.html")).unwrap();
    let text = std::fs::read_to_string(directory.path().join(name)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn integrals(kinds: &[SamplerKind], counts: &[u32]) -> Vec<Convergence> {
    let options = Options { counts: counts.to_vec(), seeds: 3, seed: 3, reference: 16 };
    let plans: Vec<(String, SamplePlan)> = kinds.iter().map(|k| (k.name().to_owned(), (*k).into())).collect();
    let work = |_: &Integral| convergence::work_of_integral(plans.len(), &options);
    let mut work = Work::new(Integral::ALL.iter().map(work).sum(), &go_on);
    Integral::ALL.iter().map(|i| of_integral(i, &plans, &options, &mut work).unwrap()).collect()
}

#[test]
fn integrals_converge_as_theory_says() {
    use SamplerKind::{Independent, NRooks, Stratified, ZSobol};
    for result in integrals(&[Independent, Stratified, NRooks, ZSobol], &[1, 4, 7, 16, 64]) {
        let [independent, others @ ..] = &result.curves[..] else { panic!() };
        // The error of independent samples is the deviation over √N, at each N within five standard errors: of 20 tests
        // one fails by chance in 10⁵.
        let first = &independent.points[0];
        for p in &independent.points {
            let expected = first.error / f64::from(p.samples).sqrt();
            let error =
                (p.standard_error.powi(2) + first.standard_error.powi(2) / f64::from(p.samples)).sqrt();
            assert!((p.error - expected).abs() < 5.0 * error, "{}: {p:?} {expected}", result.subject);
        }
        for curve in others {
            let better = |n: u32| (independent.at(n).unwrap().error, curve.at(n).unwrap().error);
            let (plain, stratified) = better(64);
            assert!(stratified < 0.97 * plain, "{} {}: {plain} {stratified}", result.subject, curve.name);
        }
        // Stratified in both axes, the error of what is smooth falls with N⁻¹ (Cook, Porter and Carpenter's jitter).
        let slope = |curve: &Curve| curve.by_samples.unwrap().slope;
        if result.subject == "integral:smooth-2d" {
            assert!((slope(&others[0]) + 1.0).abs() < 0.1 && slope(&others[2]) < -1.2);
        }
    }
}

#[test]
fn pages_of_convergence_hold_its_numbers() {
    let results = integrals(&[SamplerKind::Independent, SamplerKind::ZSobol], &[1, 3]);
    let page = convergence::page(&results);
    check(&page, &["integral:smooth-2d", "samples per pixel", "time (s)", "slope −½", "page-slopes.csv"]);
    let rows = csv(&page, "page.csv");
    let points = results.iter().flat_map(|r| r.curves.iter().flat_map(|c| &c.points));
    assert_eq!(rows.len(), points.clone().count());
    for (row, p) in rows.iter().zip(points) {
        let numbers: Vec<f64> = row[2..].iter().map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers, [p.samples.into(), p.error, p.standard_error, p.seconds]);
    }
}

#[test]
fn scenes_converge_to_a_reference_of_their_own() {
    let resources = FileResources::below("");
    let (description, diagnostics) = read_pbrt_str("lamp", SCENE, &resources, &mut SourceMap::new());
    let scene = compile(&description, &resources, &diagnostics).unwrap();
    let usual = RenderSettings::of(&scene);
    let strategies = Strategies { combine: CombineStrategy::BsdfOnly, ..Strategies::default() };
    let settings = RenderSettings { sampling: SamplerKind::Independent.into(), ..usual.clone() };
    let variants = [
        Variant { name: "independent".to_owned(), settings: settings.clone() },
        Variant { name: "bsdf-only".to_owned(), settings: RenderSettings { strategies, ..settings } },
        Variant { name: "zsobol".to_owned(), settings: usual.clone() },
    ];
    let options = Options { counts: vec![1, 4, 16], seeds: 4, seed: 5, reference: 16 };
    let total = convergence::work_of_scene(usual.bounds, variants.len(), &options);
    assert_eq!(total, 12 * 9 * (3 * 4 * 21 + 256));
    let run = |observe: &(dyn Fn(Progress) -> bool + Sync)| {
        of_scene("lamp", &scene, &usual, &variants, &options, &mut Work::new(total, observe))
    };
    let result = run(&go_on).unwrap();
    let error = |curve: usize, samples| result.curves[curve].at(samples).unwrap().error;
    // Sampling a lamp by chance directions is far worse than sampling it, and more samples are better.
    let errors = [error(0, 16), error(1, 16), error(2, 16)];
    assert!(errors[1] > 3.0 * errors[0] && errors[2] < errors[0], "{errors:?}");
    let fewer = [error(0, 1), error(0, 4), error(2, 1)];
    assert!(
        errors[0] < 0.4 * fewer[0] && errors[0] < 0.7 * fewer[1] && errors[2] < 0.4 * fewer[2],
        "{fewer:?} {errors:?}"
    );
    let page = convergence::page(std::slice::from_ref(&result));
    check(&page, &["Convergence of lamp", "<img", "12 × 9 pixels"]);
    assert!(result.curves.iter().all(|c| c.picture.as_ref().is_some_and(|(n, p)| *n == 16 && p.width == 12)));

    let again = run(&go_on).unwrap();
    let errors =
        |r: &Convergence| -> Vec<f64> { r.curves.iter().flat_map(|c| &c.points).map(|p| p.error).collect() };
    assert_eq!(errors(&result), errors(&again), "the same numbers every time");
    assert!(run(&|p| p.done < total / 2).is_err());
}

#[test]
fn pages_of_portraits_hold_their_numbers() {
    let options = portrait::Options { samples: 10, seeds: 2, seed: 0 };
    let mut work = Work::new(portrait::work(&options), &go_on);
    let looks = portrait::portrait("n-rooks", &SamplerKind::NRooks.into(), &options, &mut work).unwrap();
    let page = portrait::page(&looks);
    check(&page, &["Portrait of n-rooks", "star discrepancy", "light-point x", "100.0"]);
    let rows = csv(&page, "page.csv");
    let points: Vec<_> = looks.views.iter().flat_map(|v| &v.points).collect();
    assert_eq!((rows.len(), points.len()), (40, 40));
    // A name of an axis holds a comma.
    for (row, p) in rows.iter().zip(points) {
        let numbers: Vec<f64> = row[row.len() - 2..].iter().map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers, [p.x, p.y]);
    }
    assert_eq!(csv(&page, "page-discrepancy.csv").len(), 2 * looks.discrepancies.len());
}
