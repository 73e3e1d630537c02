//! Shares of variance against functions whose shares are known, and the estimators against each other.

use tenfold_lab::attribution::pick_freeze::{Evaluations, Share, Totals};
use tenfold_math::ops;
use tenfold_testkit::{Rng, Welford, special::student_p, stats::sidak};

/// With which probability a right estimator fails a test.
const SIGNIFICANCE: f64 = 1e-4;
const BLOCKS: usize = 16;

/// An integrand over the unit cube with its shares.
struct Known {
    f: fn(&[f64]) -> f64,
    variance: f64,
    first: Vec<f64>,
    total: Vec<f64>,
}

/// Ishigami and Homma 1990: sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ over [−π, π]³.
fn ishigami() -> Known {
    let pi = std::f64::consts::PI;
    let (a, b) = (7.0, 0.1);
    let v1 = 0.5 * (1.0 + b * pi.powi(4) / 5.0).powi(2);
    let v2 = a * a / 8.0;
    let v13 = 8.0 * b * b * pi.powi(8) / 225.0;
    let v = v1 + v2 + v13;
    Known {
        f: |x| {
            let x: Vec<f64> = x.iter().map(|u| (2.0 * u - 1.0) * std::f64::consts::PI).collect();
            let s = ops::sin(x[0]);
            s + 7.0 * ops::sin(x[1]).powi(2) + 0.1 * x[2].powi(4) * s
        },
        variance: v,
        first: vec![v1 / v, v2 / v, 0.0],
        total: vec![(v1 + v13) / v, v2 / v, v13 / v],
    }
}

const G: [f64; 4] = [0.0, 1.0, 4.5, 9.0];

/// Sobol's g-function: ∏ (|4x − 2| + a)/(1 + a).
fn g_function() -> Known {
    let v: Vec<f64> = G.iter().map(|a| 1.0 / (3.0 * (1.0 + a).powi(2))).collect();
    let variance = v.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
    Known {
        f: |x| x.iter().zip(G).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product(),
        variance,
        first: v.iter().map(|v| v / variance).collect(),
        total: v.iter().map(|v| v * (1.0 + variance) / (1.0 + v) / variance).collect(),
    }
}

impl Known {
    /// f at A, at B, and at A with each variable from B.
    fn evaluate(&self, rng: &mut Rng) -> (f64, f64, Vec<f64>) {
        let n = self.first.len();
        let mut point = || (0..n).map(|_| rng.f64()).collect::<Vec<f64>>();
        let (a, b) = (point(), point());
        let mixed = (0..n).map(|i| {
            let mut x = a.clone();
            x[i] = b[i];
            (self.f)(&x)
        });
        ((self.f)(&a), (self.f)(&b), mixed.collect())
    }

    fn estimate(&self, samples: usize, rng: &mut Rng) -> Totals {
        let n = self.first.len();
        let mut evaluations = Evaluations::new(n, BLOCKS);
        for sample in 0..samples {
            let (a, b, mixed) = self.evaluate(rng);
            evaluations.add(sample % BLOCKS, a, b, &mixed);
        }
        let mut totals = Totals::new(n, BLOCKS);
        totals.add(&evaluations, 1.0);
        totals
    }
}

#[test]
fn shares_of_known_functions_are_met_within_their_errors() {
    for (seed, known) in [ishigami(), g_function()].into_iter().enumerate() {
        let n = known.first.len();
        let totals = known.estimate(1 << 17, &mut Rng::new(seed as u64));
        let interactions = 1.0 - known.first.iter().sum::<f64>();
        let mut pairs: Vec<(Share, f64)> =
            vec![(totals.variance(), known.variance), (totals.interactions(), interactions)];
        for i in 0..n {
            pairs.push((totals.first_order(i), known.first[i]));
            pairs.push((totals.total(i), known.total[i]));
        }
        let level = sidak(SIGNIFICANCE / 2.0, pairs.len());
        for (share, truth) in pairs {
            // Able to fail: errors are small beside the shares.
            assert!(share.error < 0.012 * known.variance.max(1.0), "{share:?}");
            let p = student_p((share.value - truth) / share.error, (BLOCKS - 1) as f64);
            assert!(p > level, "{share:?} is not {truth}: p = {p:.1e}");
        }
    }
}

#[test]
fn stated_errors_are_the_true_ones() {
    let known = g_function();
    let mut rng = Rng::new(11);
    let (mut first, mut total) = (Welford::new(), Welford::new());
    let (mut stated_first, mut stated_total) = (Welford::new(), Welford::new());
    for _ in 0..256 {
        let totals = known.estimate(1024, &mut rng);
        let (f, t) = (totals.first_order(1), totals.total(1));
        first.add(f.value);
        total.add(t.value);
        stated_first.add(f.error * f.error);
        stated_total.add(t.error * t.error);
    }
    // The ratio of the mean of 256 estimates with 15 degrees of freedom to one with 255: its relative standard error is below 0.11.
    for (true_error, stated) in [(first, stated_first), (total, stated_total)] {
        let ratio = stated.mean / true_error.variance();
        assert!((0.6..1.6).contains(&ratio), "{ratio}");
    }
}

#[test]
fn shares_of_many_integrals_are_weighted_means() {
    // Where one integral varies with its first variable alone and another with its second, weights decide.
    let mut totals = Totals::new(2, BLOCKS);
    let mut rng = Rng::new(3);
    for (variable, weight) in [(0, 3.0), (1, 1.0)] {
        for _ in 0..500 {
            let mut evaluations = Evaluations::new(2, BLOCKS);
            for sample in 0..32 {
                let (a, b) = ([rng.f64(), rng.f64()], [rng.f64(), rng.f64()]);
                let f = |x: [f64; 2]| 5.0 + x[variable];
                evaluations.add(sample % BLOCKS, f(a), f(b), &[f([b[0], a[1]]), f([a[0], b[1]])]);
            }
            totals.add(&evaluations, weight);
        }
    }
    for (group, truth) in [(0, 0.75), (1, 0.25)] {
        for share in [totals.first_order(group), totals.total(group)] {
            assert!((share.value - truth).abs() < 4.5 * share.error && share.error < 0.02, "{share:?}");
        }
    }
    assert!((totals.variance().value / (2000.0 / 12.0) - 1.0).abs() < 0.02);
}

#[test]
fn integrals_that_do_not_vary_blame_nothing() {
    let mut evaluations = Evaluations::new(1, BLOCKS);
    (0..32).for_each(|i| evaluations.add(i % BLOCKS, 2.0, 2.0, &[2.0]));
    let mut totals = Totals::new(1, BLOCKS);
    totals.add(&evaluations, 1.0);
    assert_eq!((totals.first_order(0).value, totals.total(0).value), (0.0, 0.0));
    assert_eq!(Totals::new(0, BLOCKS).variance().value, 0.0);
}

/// Estimates of a first-order and a total share by the published formulae, from the same evaluations.
mod published {
    /// Means over rows of a function of (a, b, ab).
    fn mean(rows: &[[f64; 3]], f: impl Fn(f64, f64, f64) -> f64) -> f64 {
        rows.iter().map(|&[a, b, ab]| f(a, b, ab)).sum::<f64>() / rows.len() as f64
    }

    /// Variance from A and B, as is usual.
    fn variance(rows: &[[f64; 3]]) -> f64 {
        let m = mean(rows, |a, b, _| 0.5 * (a + b));
        mean(rows, |a, b, _| 0.5 * (a * a + b * b)) - m * m
    }

    /// Sobol' 1993: E[f(B) f(ABᵢ)] − m².
    pub(super) fn sobol(rows: &[[f64; 3]]) -> f64 {
        let m = mean(rows, |a, b, _| 0.5 * (a + b));
        (mean(rows, |_, b, ab| b * ab) - m * m) / variance(rows)
    }

    /// Saltelli et al. 2010: E[f(B)(f(ABᵢ) − f(A))].
    pub(super) fn saltelli(rows: &[[f64; 3]]) -> f64 {
        mean(rows, |a, b, ab| b * (ab - a)) / variance(rows)
    }

    /// Jansen 1999: V − E[(f(B) − f(ABᵢ))²]/2.
    pub(super) fn jansen(rows: &[[f64; 3]]) -> f64 {
        1.0 - 0.5 * mean(rows, |_, b, ab| (b - ab) * (b - ab)) / variance(rows)
    }

    /// Homma and Saltelli 1996: V − (E[f(A) f(ABᵢ)] − m²).
    pub(super) fn homma_total(rows: &[[f64; 3]]) -> f64 {
        let m = mean(rows, |a, b, _| 0.5 * (a + b));
        1.0 - (mean(rows, |a, _, ab| a * ab) - m * m) / variance(rows)
    }

    /// Sobol' 2007: E[f(A)(f(A) − f(ABᵢ))].
    pub(super) fn sobol_total(rows: &[[f64; 3]]) -> f64 {
        mean(rows, |a, _, ab| a * (a - ab)) / variance(rows)
    }

    /// Jansen 1999: E[(f(A) − f(ABᵢ))²]/2.
    pub(super) fn jansen_total(rows: &[[f64; 3]]) -> f64 {
        0.5 * mean(rows, |a, _, ab| (a - ab) * (a - ab)) / variance(rows)
    }
}

#[test]
fn the_estimators_taken_have_the_least_errors_of_those_published() {
    const RUNS: usize = 400;
    const SAMPLES: usize = 256;
    let mut rng = Rng::new(23);
    let mut report = String::new();
    for (name, known) in [("ishigami", ishigami()), ("g", g_function())] {
        let n = known.first.len();
        // Per variable and estimator the sum of squared errors.
        let (mut first, mut total) = (vec![[0.0; 4]; n], vec![[0.0; 4]; n]);
        for _ in 0..RUNS {
            let mut evaluations = Evaluations::new(n, BLOCKS);
            let mut rows = vec![Vec::new(); n];
            for sample in 0..SAMPLES {
                let (a, b, mixed) = known.evaluate(&mut rng);
                evaluations.add(sample % BLOCKS, a, b, &mixed);
                rows.iter_mut().zip(mixed).for_each(|(rows, ab)| rows.push([a, b, ab]));
            }
            let mut totals = Totals::new(n, BLOCKS);
            totals.add(&evaluations, 1.0);
            for i in 0..n {
                use published::*;
                let r = &rows[i];
                let of_first = [totals.first_order(i).value, sobol(r), saltelli(r), jansen(r)];
                let of_total = [totals.total(i).value, homma_total(r), sobol_total(r), jansen_total(r)];
                for k in 0..4 {
                    first[i][k] += (of_first[k] - known.first[i]).powi(2) / RUNS as f64;
                    total[i][k] += (of_total[k] - known.total[i]).powi(2) / RUNS as f64;
                }
            }
        }
        for i in 0..n {
            let rms = |e: [f64; 4]| e.map(f64::sqrt);
            let (f, t) = (rms(first[i]), rms(total[i]));
            report += &format!("{name} x{} first {f:.4?} total {t:.4?}\n", i + 1);
        }
        // Over all variables of a function.
        for errors in [&first, &total] {
            let sum = |k: usize| errors.iter().map(|e| e[k]).sum::<f64>();
            for k in 1..4 {
                assert!(sum(0) < 1.1 * sum(k), "{name}: estimator {k} is better\n{report}");
            }
        }
    }
    println!("{report}");
}
