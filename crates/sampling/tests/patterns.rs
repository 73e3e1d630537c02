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

#[test]
fn variables_are_not_correlated_within_a_round() {
    // Over all samples of a round: the covariance of two numbers is zero in the mean, and their cells are filled evenly.
    let lens = Dimension::LENS;
    let (one, two) = (Dimension::light_point(1), Dimension::light_point(2));
    let number = |i: usize, s: &Sampler, index: u32| {
        let p = s.at(PIXEL, index);
        match i {
            0 => p.get_1d(Dimension::TIME),
            1 => p.get_2d(lens).x,
            2 => p.get_2d(lens).y,
            3 => p.get_2d(one).x,
            4 => p.get_2d(one).y,
            _ => p.get_2d(two).y,
        }
    };
    let combinations: Vec<(usize, usize)> = (0..6).flat_map(|j| (0..j).map(move |i| (i, j))).collect();
    let tests = NEW.len() * 4 * combinations.len();
    for kind in NEW {
        for n in [5u32, 16, 61, 64] {
            let rounds = 40_000 / n;
            for &(a, b) in &combinations {
                let mut cells = vec![0u64; 256];
                let mut covariance = Welford::new();
                for seed in 0..rounds {
                    let s = Sampler::new(kind, n, u64::from(seed));
                    let mut sum = 0.0;
                    for i in 0..n {
                        let (x, y) = (number(a, &s, i), number(b, &s, i));
                        cells[(stratum(x, 16) * 16 + stratum(y, 16)) as usize] += 1;
                        sum += (f64::from(x) - 0.5) * (f64::from(y) - 0.5);
                    }
                    covariance.add(sum);
                }
                let what = format!("{kind:?} {n}: {a}, {b}");
                t_test_mean(&covariance, 0.0).check(&what, 0.01, tests);
                if kind == SamplerKind::MultiJittered && matches!((a, b), (1, 2) | (3, 4)) {
                    // Within a pair the samples of a round are not free of each other: they share fine strata.
                    continue;
                }
                let each = f64::from(rounds * n) / 256.0;
                chi2::counts_test(&cells, &[each; 256], &Options { tests, ..Options::default() })
                    .check(&what);
            }
        }
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
