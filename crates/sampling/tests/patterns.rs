//! N rooks, multi-jittered and Halton points have the strata they promise, exactly, and nothing else in common.

use tenfold_math::{UVec2, Vec2, ops};
use tenfold_sampling::{Dimension, Sampler, SamplerKind, Variable};
use tenfold_testkit::{Options, Rng, Welford, chi2, t_test_mean};

const PIXEL: UVec2 = UVec2::new(123, 45);
const NEW: [SamplerKind; 3] = [SamplerKind::NRooks, SamplerKind::MultiJittered, SamplerKind::Halton];

/// The dimension `i` of ten thousand.
fn dimension(i: usize) -> Dimension {
    let variables = Variable::ALL;
    Dimension::new(variables[i % variables.len()], (i / variables.len()) as u16)
}

fn singles(s: &Sampler, d: Dimension, round: u32) -> impl Iterator<Item = f32> {
    let (s, n) = (*s, s.samples_per_pixel());
    (round * n..(round + 1) * n).map(move |i| s.at(PIXEL, i).get_1d(d))
}

fn pairs(s: &Sampler, d: Dimension, round: u32) -> impl Iterator<Item = Vec2> {
    let (s, n) = (*s, s.samples_per_pixel());
    (round * n..(round + 1) * n).map(move |i| s.at(PIXEL, i).get_2d(d))
}

/// The stratum of `x` among `n`, without any rounding.
fn stratum(x: f32, n: u32) -> u32 {
    (f64::from(x) * f64::from(n)) as u32
}

/// Whether `cells` takes each of `[0, n)` once.
fn each_once(cells: impl Iterator<Item = u32>, n: u32) -> bool {
    let mut seen = vec![false; n as usize];
    let mut total = 0;
    for c in cells {
        total += 1;
        if c >= n || std::mem::replace(&mut seen[c as usize], true) {
            return false;
        }
    }
    total == n
}

fn check_rooks(kind: SamplerKind, n: u32, d: Dimension, round: u32) {
    let s = Sampler::new(kind, n, 9);
    assert!(each_once(singles(&s, d, round).map(|x| stratum(x, n)), n), "{kind:?} {n} {d:?}");
    assert!(each_once(pairs(&s, d, round).map(|p| stratum(p.x, n)), n), "{kind:?} {n} {d:?} x");
    assert!(each_once(pairs(&s, d, round).map(|p| stratum(p.y, n)), n), "{kind:?} {n} {d:?} y");
}

#[test]
fn rooks_have_one_point_in_each_stratum_for_every_count() {
    let mut rng = Rng::new(1);
    for n in 1..=4096 {
        check_rooks(SamplerKind::NRooks, n, dimension(rng.below(10_000)), n % 3);
    }
}

#[test]
fn rooks_have_one_point_in_each_stratum_in_every_dimension() {
    for i in 0..10_000 {
        check_rooks(SamplerKind::NRooks, 61, dimension(i), 0);
    }
    for n in [64, 1000, 4093, 4096] {
        for i in (0..10_000).step_by(101) {
            check_rooks(SamplerKind::NRooks, n, dimension(i), 1);
        }
    }
}

#[test]
fn multi_jittered_pairs_have_a_grid_and_are_rooks() {
    let mut rng = Rng::new(2);
    for n in 1..=4096u32 {
        let s = Sampler::new(SamplerKind::MultiJittered, n, 4);
        let (d, round) = (dimension(rng.below(10_000)), n % 3);
        let root = n.isqrt();
        let divisor = (1..=root).rev().find(|k| n.is_multiple_of(*k)).unwrap();
        if n / divisor <= 2 * divisor {
            check_rooks(SamplerKind::MultiJittered, n, d, round);
            let cell = |p: Vec2| stratum(p.x, divisor) * (n / divisor) + stratum(p.y, n / divisor);
            assert!(each_once(pairs(&s, d, round).map(cell), n), "{n}");
        } else {
            // The last row has gaps; y has all its strata, and no cell two points.
            assert!(each_once(singles(&s, d, round).map(|x| stratum(x, n)), n), "{n}");
            assert!(each_once(pairs(&s, d, round).map(|p| stratum(p.y, n)), n), "{n}");
            let mut cells: Vec<_> =
                pairs(&s, d, round).map(|p| (stratum(p.x, root), stratum(p.y, n) / root)).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), n as usize);
        }
    }
}

#[test]
fn halton_points_have_one_point_in_each_box() {
    for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 1), (2, 2), (4, 2), (3, 3), (5, 3), (4, 4)] {
        let (columns, rows) = (2u32.pow(a), 3u32.pow(b));
        let n = columns * rows;
        let s = Sampler::new(SamplerKind::Halton, n, 6);
        for i in (0..10_000).step_by(997) {
            let cell = |p: Vec2| stratum(p.x, columns) * rows + stratum(p.y, rows);
            assert!(each_once(pairs(&s, dimension(i), 2).map(cell), n), "{columns} × {rows}");
        }
    }
    for k in 0..13 {
        let s = Sampler::new(SamplerKind::Halton, 1 << k, 6);
        let d = Dimension::roulette(k);
        assert!(each_once(singles(&s, d, 0).map(|x| stratum(x, 1 << k)), 1 << k), "{k}");
    }
}

/// A number of a sample: those of several variables, alone and in pairs.
fn number(i: usize, s: &Sampler, index: u32) -> f32 {
    let p = s.at(PIXEL, index);
    match i {
        0 => p.get_1d(Dimension::TIME),
        1 => p.get_2d(Dimension::LENS).x,
        2 => p.get_2d(Dimension::LENS).y,
        3 => p.get_2d(Dimension::light_point(1)).x,
        4 => p.get_2d(Dimension::light_point(1)).y,
        _ => p.get_2d(Dimension::light_point(2)).y,
    }
}

/// Every pair of them, for every kind and some counts.
fn pairs_of_numbers() -> impl Iterator<Item = (SamplerKind, u32, usize, usize)> {
    let counts = |kind| [5u32, 16, 61, 64].map(move |n| (kind, n));
    let combinations = |(kind, n)| (0..6).flat_map(move |b| (0..b).map(move |a| (kind, n, a, b)));
    SamplerKind::ALL.into_iter().flat_map(counts).flat_map(combinations)
}

#[test]
fn variables_are_not_correlated_within_a_round() {
    // Over all samples of a round, the covariance of two numbers is zero in the mean. Rounds of different seeds are independent.
    let tests = pairs_of_numbers().count();
    for (kind, n, a, b) in pairs_of_numbers() {
        let covariance = |seed| {
            let s = Sampler::new(kind, n, seed);
            let product = |i| (f64::from(number(a, &s, i)) - 0.5) * (f64::from(number(b, &s, i)) - 0.5);
            (0..n).map(product).sum::<f64>()
        };
        let values: Welford = (0..u64::from(20_000 / n)).map(covariance).collect();
        t_test_mean(&values, 0.0).check(&format!("{kind:?} {n}: {a}, {b}"), 0.01, tests);
    }
}

#[test]
fn pairs_of_variables_fill_the_square_evenly() {
    // The samples of a round are not free of each other, as χ² demands of what it counts: so of every round one is taken, any.
    let tests = pairs_of_numbers().count();
    for (kind, n, a, b) in pairs_of_numbers() {
        let (rounds, mut rng) = (10_000, Rng::new(3));
        let mut cells = vec![0u64; 256];
        for seed in 0..rounds {
            let (s, i) = (Sampler::new(kind, n, seed), rng.below(n as usize) as u32);
            cells[(stratum(number(a, &s, i), 16) * 16 + stratum(number(b, &s, i), 16)) as usize] += 1;
        }
        let each = rounds as f64 / 256.0;
        chi2::counts_test(&cells, &[each; 256], &Options { tests, ..Options::default() })
            .check(&format!("{kind:?} {n}: {a}, {b}"));
    }
}

#[test]
fn the_orders_of_two_variables_are_unrelated() {
    // Of two samples of a round, the one that is ahead in one variable is as often ahead in another as behind: a permutation that
    // two variables share, in full or in part, would show. One pair of samples of every round, so that the counts are free.
    let tests = pairs_of_numbers().count();
    for (kind, n, a, b) in pairs_of_numbers() {
        let (rounds, mut rng) = (10_000, Rng::new(4));
        let mut cells = [0u64; 4];
        for seed in 0..rounds {
            let s = Sampler::new(kind, n, seed);
            let (i, step) = (rng.below(n as usize) as u32, 1 + rng.below(n as usize - 1) as u32);
            let j = (i + step) % n;
            let ahead = |k| usize::from(number(k, &s, i) < number(k, &s, j));
            cells[2 * ahead(a) + ahead(b)] += 1;
        }
        chi2::counts_test(&cells, &[rounds as f64 / 4.0; 4], &Options { tests, ..Options::default() })
            .check(&format!("{kind:?} {n}: {a}, {b}"));
    }
}

#[test]
fn smooth_integrals_of_two_variables_have_less_variance() {
    // Not a sum of functions of one variable: N rooks keep the part that is none, a grid does not.
    let f = |u: Vec2| f64::from(ops::exp(u.x * u.y) + u.x * u.x - u.y);
    let variance = |kind, n: u32| {
        let estimate = |seed| {
            let s = Sampler::new(kind, n, seed);
            pairs(&s, Dimension::LENS, 0).map(f).sum::<f64>() / f64::from(n)
        };
        (0..2000).map(estimate).collect::<Welford>().variance()
    };
    for n in [4, 16, 37, 64, 256] {
        let independent = variance(SamplerKind::Independent, n);
        let [rooks, multi, halton] = NEW.map(|k| variance(k, n));
        println!("{n}: {independent:.2e} {rooks:.2e} {multi:.2e} {halton:.2e}");
        assert!(rooks * 2.0 < independent && multi * 2.0 < independent && halton * 1.5 < independent, "{n}");
        if n == 256 {
            assert!(multi * 4.0 < rooks && halton * 4.0 < rooks, "{n}");
        }
    }
}
