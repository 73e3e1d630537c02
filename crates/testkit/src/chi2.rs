//! χ² tests of samples against their density (Pearson 1900; for directions as in Subr and Arvo 2007).
//!
//! The domain is cut into cells; the counts of samples in each are compared with the integrals of the density, which
//! adaptive quadrature finds. Samples that are `None` must occur as often as the density falls short of one.

use crate::quadrature::{self, Integral, Tolerance};
use crate::rng::Rng;
use crate::special::chi_squared_p;
use crate::stats::sidak;
use std::f64::consts::TAU;
use std::fmt::Write;
use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3};

/// How a test is made. The defaults suit a density without peaks far narrower than a cell.
#[derive(Copy, Clone, Debug)]
pub struct Options {
    /// How many samples are drawn.
    pub samples: usize,
    /// Cells in cos θ; or in x for the square and the interval.
    pub theta_bins: usize,
    /// Cells in azimuth; or in y for the square.
    pub phi_bins: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Of how many tests this is one: each is made stricter so that all together have the `significance` (Šidák).
    pub tests: usize,
    /// Probability that a right sampler fails.
    pub significance: f64,
    /// Cells that expect fewer samples are pooled.
    pub pool_below: f64,
    /// Evaluations of the density in one cell after which the quadrature makes do.
    pub evaluations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            samples: 100_000,
            theta_bins: 16,
            phi_bins: 32,
            seed: 1,
            tests: 1,
            significance: 0.01,
            pool_below: 5.0,
            evaluations: 200_000,
        }
    }
}

/// The outcome of a χ² test.
#[derive(Clone, Debug)]
pub struct ChiSquared {
    /// Probability of a statistic at least so large, were the samples distributed as the density says.
    pub p: f64,
    /// Σ (observed − expected)² / expected.
    pub statistic: f64,
    /// Degrees of freedom: cells after pooling, less one.
    pub dof: usize,
    /// Whether p reaches the corrected significance, and the density was a density.
    pub passed: bool,
    /// What a reader needs to see why it failed.
    pub report: String,
}

impl ChiSquared {
    /// Panics with the report where the test failed.
    #[track_caller]
    pub fn check(&self, what: &str) {
        assert!(self.passed, "{what}: {}", self.report);
    }
}

/// Tests unit directions `sample(lobe, point)`, made of uniform numbers, against `pdf` per steradian, over the whole sphere.
pub fn sphere_test(
    mut sample: impl FnMut(f32, Vec2) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f64,
    options: &Options,
) -> ChiSquared {
    let (nt, np) = (options.theta_bins.max(1), options.phi_bins.max(1));
    let bounds = |i: usize, j: usize| {
        let z = |i: usize| 2.0 * i as f64 / nt as f64 - 1.0;
        let phi = |j: usize| TAU * j as f64 / np as f64;
        ([z(i), phi(j)], [z(i + 1), phi(j + 1)])
    };
    let draw = |lobe, u| {
        sample(lobe, u).map(|d| {
            let phi = ops::atan2(f64::from(d.y), f64::from(d.x)) / TAU;
            [0.5 * (f64::from(d.z) + 1.0), if phi < 0.0 { phi + 1.0 } else { phi }]
        })
    };
    let integrate = |i, j, tolerance: &Tolerance| {
        let (low, high) = bounds(i, j);
        quadrature::directions(low, high, tolerance, &pdf)
    };
    grid_test(draw, integrate, ["cos θ", "φ"], |i, j| bounds(i, j).0, nt, np, options)
}

/// Tests points `sample(point)` of the rectangle from `low` to `high` against `pdf` per unit of area.
pub fn rectangle_test(
    low: Vec2,
    high: Vec2,
    mut sample: impl FnMut(Vec2) -> Option<Vec2>,
    pdf: impl Fn(Vec2) -> f64,
    options: &Options,
) -> ChiSquared {
    let (nx, ny) = (options.theta_bins.max(1), options.phi_bins.max(1));
    let (low, size) = (low.as_dvec2(), (high - low).as_dvec2());
    let corner =
        |i: usize, j: usize| [low.x + size.x * i as f64 / nx as f64, low.y + size.y * j as f64 / ny as f64];
    let draw = |_, u| {
        sample(u).map(|p| {
            let q = (p.as_dvec2() - low) / size;
            [q.x, q.y]
        })
    };
    let integrate = |i, j, tolerance: &Tolerance| {
        let f = |x: f64, y: f64| pdf(Vec2::new(x as f32, y as f32));
        quadrature::rectangle(corner(i, j), corner(i + 1, j + 1), tolerance, f)
    };
    grid_test(draw, integrate, ["x", "y"], corner, nx, ny, options)
}

/// Tests points of the unit square, as [`rectangle_test`].
pub fn square_test(
    sample: impl FnMut(Vec2) -> Option<Vec2>,
    pdf: impl Fn(Vec2) -> f64,
    options: &Options,
) -> ChiSquared {
    rectangle_test(Vec2::ZERO, Vec2::ONE, sample, pdf, options)
}

/// Tests numbers `sample(u)` of `[low, high]`, in `theta_bins · phi_bins` cells, against `pdf` per unit of length.
pub fn interval_test(
    low: f32,
    high: f32,
    mut sample: impl FnMut(f32) -> Option<f32>,
    pdf: impl Fn(f32) -> f64,
    options: &Options,
) -> ChiSquared {
    let n = (options.theta_bins * options.phi_bins).max(1);
    let (low, size) = (f64::from(low), f64::from(high) - f64::from(low));
    let edge = |i: usize| low + size * i as f64 / n as f64;
    let draw = |u, _| sample(u).map(|x| [(f64::from(x) - low) / size, 0.0]);
    let integrate = |i, _, tolerance: &Tolerance| {
        quadrature::interval(edge(i), edge(i + 1), tolerance, |x| pdf(x as f32))
    };
    grid_test(draw, integrate, ["x", "–"], |i, _| [edge(i), 0.0], n, 1, options)
}

/// Tests observed against expected counts; both have a last cell for what lies outside, if there is such a thing.
/// The expected counts need not be whole, and sum to those observed.
pub fn counts_test(observed: &[u64], expected: &[f64], options: &Options) -> ChiSquared {
    judge(observed, expected, |i| format!("cell {i}"), options)
}

/// Draws, counts on a grid of `nx × ny` cells with samples mapped to the unit square, integrates and judges.
fn grid_test(
    mut draw: impl FnMut(f32, Vec2) -> Option<[f64; 2]>,
    integrate: impl Fn(usize, usize, &Tolerance) -> Integral,
    names: [&str; 2],
    corner: impl Fn(usize, usize) -> [f64; 2],
    nx: usize,
    ny: usize,
    options: &Options,
) -> ChiSquared {
    let mut rng = Rng::new(options.seed);
    let mut observed = vec![0u64; nx * ny + 1];
    let mut strays = 0u64;
    for _ in 0..options.samples {
        let (lobe, u) = (rng.f32(), rng.vec2());
        match draw(lobe, u) {
            None => observed[nx * ny] += 1,
            Some(p) => {
                // A sample just outside by rounding belongs to the nearest cell; one farther out or NaN is a fault.
                if !p.iter().all(|x| (-1e-5..=1.0 + 1e-5).contains(x)) {
                    strays += 1;
                }
                let cell = |x: f64, n: usize| ((x * n as f64).max(0.0) as usize).min(n - 1);
                observed[cell(p[1], ny) * nx + cell(p[0], nx)] += 1;
            }
        }
    }

    let n = options.samples as f64;
    let mut tolerance = Tolerance {
        absolute: 0.02 / n,
        relative: 1e-3,
        pieces: if ny > 1 { 2 } else { 4 },
        evaluations: options.evaluations,
        jumps: true,
    };
    let mut expected = Vec::with_capacity(observed.len());
    let mut error = 0.0;
    for (k, &count) in observed[..nx * ny].iter().enumerate() {
        tolerance.pieces = if ny > 1 { 2 } else { 4 };
        let mut integral = integrate(k % nx, k / nx, &tolerance);
        // Far from what was counted: the quadrature may have stepped over a peak or a corner. Look more closely,
        // which brings the integral nearer to the truth, whichever that is.
        let value = n * integral.value;
        if (count as f64 - value).abs() > 3.0 * value.max(1.0).sqrt() + 3.0 {
            tolerance.pieces = if ny > 1 { 24 } else { 500 };
            integral = integrate(k % nx, k / nx, &tolerance);
        }
        expected.push(n * integral.value);
        error += n * integral.error;
    }
    let inside: f64 = expected.iter().sum();
    // The missing mass is known to within the error of the quadrature only.
    let missing = (observed[nx * ny] as f64).max(n - inside - error).min(n - inside + error);
    expected.push(missing.max(0.0));

    let name = |k: usize| {
        if k == nx * ny {
            "no sample".to_owned()
        } else {
            let [x, y] = corner(k % nx, k / nx);
            format!("{} ≥ {x:.4}, {} ≥ {y:.4}", names[0], names[1])
        }
    };
    let mut result = judge(&observed, &expected, name, options);
    if !inside.is_finite() || inside - error > n * (1.0 + 1e-3) {
        result.passed = false;
        result.report = format!("the density integrates to {}\n{}", inside / n, result.report);
    }
    if strays > 0 {
        result.passed = false;
        result.report =
            format!("{strays} samples lie outside the domain or are not numbers\n{}", result.report);
    }
    result
}

fn judge(
    observed: &[u64],
    expected: &[f64],
    name: impl Fn(usize) -> String,
    options: &Options,
) -> ChiSquared {
    assert_eq!(observed.len(), expected.len(), "as many counts as expectations");
    let total: u64 = observed.iter().sum();
    let mut order: Vec<usize> = (0..observed.len()).collect();
    order.sort_by(|&i, &j| expected[i].total_cmp(&expected[j]));

    let (mut statistic, mut cells) = (0.0, 0usize);
    let mut contributions = Vec::new();
    let (mut pooled_observed, mut pooled_expected, mut pool_open) = (0u64, 0.0, false);
    let (mut impossible, mut faulty) = (0u64, false);
    for &i in &order {
        faulty |= !expected[i].is_finite() || expected[i] < -options.pool_below;
        if expected[i] < 1e-6 {
            impossible += observed[i];
        }
        if expected[i] < options.pool_below || (pool_open && pooled_expected < options.pool_below) {
            pooled_observed += observed[i];
            pooled_expected += expected[i];
            pool_open = true;
            continue;
        }
        let difference = observed[i] as f64 - expected[i];
        let contribution = difference * difference / expected[i];
        contributions.push((contribution, i));
        statistic += contribution;
        cells += 1;
    }
    if pool_open && pooled_expected >= 1e-3 {
        let difference = pooled_observed as f64 - pooled_expected;
        statistic += difference * difference / pooled_expected.max(0.5);
        cells += 1;
    }

    let dof = cells.saturating_sub(1);
    let p = if dof == 0 { 1.0 } else { chi_squared_p(statistic, dof as f64) };
    let limit = sidak(options.significance, options.tests);
    // Rounding carries a sample over the edge of the support now and then.
    let allowed = 1 + total / 100_000;
    let passed = p >= limit && statistic.is_finite() && !faulty && impossible <= allowed;

    let mut report = String::new();
    let mut line = |text: String| {
        let _ = writeln!(report, "{text}");
    };
    line(format!(
        "χ² = {statistic:.2}, {dof} degrees of freedom, p = {p:.3e} (limit {limit:.3e}), {total} samples"
    ));
    if impossible > allowed {
        line(format!("{impossible} samples fell where none can be"));
    }
    if faulty {
        line("an expected count is negative or not finite".to_owned());
    }
    line(format!("pooled cells: observed {pooled_observed}, expected {pooled_expected:.2}"));
    contributions.sort_by(|a, b| b.0.total_cmp(&a.0));
    for &(contribution, i) in contributions.iter().take(12) {
        let (o, e) = (observed[i], expected[i]);
        line(format!("{}: observed {o}, expected {e:.2}, adds {contribution:.2}", name(i)));
    }
    ChiSquared { p, statistic, dof, passed, report }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_1_PI, PI};

    fn cosine(u: Vec2) -> Vec3 {
        let (r, phi) = (u.x.sqrt(), u.y * TAU as f32);
        Vec3::new(r * ops::cos(phi), r * ops::sin(phi), (1.0 - u.x).sqrt())
    }

    fn cosine_pdf(d: Vec3) -> f64 {
        f64::from(d.z).max(0.0) * FRAC_1_PI
    }

    #[test]
    fn a_right_sampler_passes() {
        sphere_test(|_, u| Some(cosine(u)), cosine_pdf, &Options::default()).check("cosine");
        let uniform = |u: Vec2| {
            let z = 1.0 - 2.0 * u.x;
            let (s, c) = ops::sin_cos(u.y * TAU as f32);
            let r = (1.0 - z * z).max(0.0).sqrt();
            Some(Vec3::new(r * c, r * s, z))
        };
        sphere_test(|_, u| uniform(u), |_| 0.25 / PI, &Options::default()).check("uniform");
    }

    #[test]
    fn wrong_samplers_fail() {
        let o = Options::default();
        let tilted = |u: Vec2| Some((cosine(u) + Vec3::new(0.02, 0.0, 0.0)).normalize());
        assert!(!sphere_test(|_, u| tilted(u), cosine_pdf, &o).passed);
        assert!(!sphere_test(|_, u| Some(cosine(u)), |d| 1.02 * cosine_pdf(d), &o).passed);
        assert!(!sphere_test(|_, u| Some(cosine(u)), |_| 0.25 / PI, &o).passed);
        // Below the horizon, where the density is zero.
        let leaky = |lobe: f32, u| Some(if lobe < 1e-3 { -cosine(u) } else { cosine(u) });
        assert!(!sphere_test(leaky, cosine_pdf, &o).passed);
        assert!(!sphere_test(|_, _| Some(Vec3::NAN), cosine_pdf, &o).passed);
    }

    #[test]
    fn missing_samples_must_match_missing_density() {
        let o = Options::default();
        let some = |share: f32| move |lobe: f32, u: Vec2| (lobe < share).then(|| cosine(u));
        sphere_test(some(0.7), |d| 0.7 * cosine_pdf(d), &o).check("70 %");
        assert!(!sphere_test(some(0.72), |d| 0.7 * cosine_pdf(d), &o).passed);
        assert!(!sphere_test(some(0.99), cosine_pdf, &o).passed);
    }

    #[test]
    fn narrow_peaks_are_found() {
        // A cone of half a degree around an oblique axis.
        let cos_max = ops::cos(0.5f64.to_radians());
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let frame = tenfold_math::Frame::from_z(axis);
        let sample = |u: Vec2| {
            let z = 1.0 - f64::from(u.x) * (1.0 - cos_max);
            let (s, c) = ops::sin_cos(f64::from(u.y) * TAU);
            let r = (1.0 - z * z).sqrt();
            Some(frame.to_world(Vec3::new((r * c) as f32, (r * s) as f32, z as f32)))
        };
        let limit = 2.0 * (ops::sin(0.25f64.to_radians()));
        let pdf = |d: Vec3| {
            if f64::from((d - axis).length()) < limit { 1.0 / (TAU * (1.0 - cos_max)) } else { 0.0 }
        };
        sphere_test(|_, u| sample(u), pdf, &Options::default()).check("cone");
    }

    #[test]
    fn sides_parallel_to_the_cells_are_found() {
        // Where a density ends next to the side of a cell, between it and the rule's outermost node.
        let o = Options { samples: 20_000, tests: 100, ..Options::default() };
        for i in 0..100u8 {
            let low = f32::from(i) / 120.0;
            let high = low + 0.01 + 0.1 * f32::from(i % 7) / 7.0;
            let sample = |u: Vec2| Some(Vec2::new(u.x, low + u.y * (high - low)));
            let pdf = |p: Vec2| if p.y >= low && p.y < high { 1.0 / f64::from(high - low) } else { 0.0 };
            square_test(sample, pdf, &o).check(&format!("{low} to {high}"));
        }
    }

    #[test]
    fn intervals_and_squares() {
        let o = Options { tests: 4, ..Options::default() };
        let sqrt = |u: f32| Some(2.0 * u.sqrt());
        interval_test(0.0, 2.0, sqrt, |x| 0.5 * f64::from(x), &o).check("linear");
        assert!(!interval_test(0.0, 2.0, sqrt, |_| 0.5, &o).passed);
        square_test(|u| Some(Vec2::new(u.x.sqrt(), u.y)), |p| 2.0 * f64::from(p.x), &o).check("wedge");
        assert!(!square_test(|u| Some(Vec2::new(u.x.sqrt(), u.y)), |p| 2.0 * f64::from(p.y), &o).passed);
    }

    #[test]
    fn p_is_uniform_where_the_hypothesis_holds() {
        let o = Options { samples: 2000, theta_bins: 4, phi_bins: 4, ..Options::default() };
        let small =
            (0..400).filter(|&seed| square_test(Some, |_| 1.0, &Options { seed, ..o }).p < 0.2).count();
        // Binomial(400, 0.2): 80 ± 4 standard deviations.
        assert!((48..=112).contains(&small), "{small}");
    }
}
