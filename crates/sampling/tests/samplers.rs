//! Samplers: uniform, stratified as they promise, independent where they must be, and pure.

use std::collections::HashMap;
use tenfold_math::ops;
use tenfold_math::{Slots, UVec2, Vec2};
use tenfold_sampling::{Dimension, PixelSample, SampleRoom, Sampler, SamplerKind, Variable};
use tenfold_testkit::{Options, Rng, Welford, chi2, t_test_mean};

const KINDS: usize = SamplerKind::ALL.len();
const COUNTS: [u32; 11] = [1, 2, 3, 4, 7, 8, 16, 32, 37, 64, 100];

fn options(tests: usize) -> Options {
    Options { tests, ..Options::default() }
}

fn samplers(seed: u64) -> impl Iterator<Item = Sampler> {
    SamplerKind::ALL.into_iter().flat_map(move |kind| COUNTS.map(|n| Sampler::new(kind, n, seed)))
}

fn round(sampler: &Sampler, pixel: UVec2, round: u32) -> impl Iterator<Item = PixelSample<'_>> {
    let n = sampler.samples_per_pixel();
    (round * n..(round + 1) * n).map(move |i| sampler.at(pixel, i))
}

fn cell(x: f32, n: u32) -> usize {
    (x * n as f32) as usize
}

/// Unrelated pixels: a pattern that spans neighbours is not at work between them.
fn scattered(i: u32) -> UVec2 {
    let mut rng = Rng::new(u64::from(i));
    UVec2::new(rng.u32() % 10_000, rng.u32() % 10_000)
}

/// Counts pairs of numbers, one pair from each of many seeds so that the pairs are independent, on a 16 × 16 grid.
fn check_pairs(what: &str, tests: usize, mut pair: impl FnMut(u32) -> (f32, f32)) {
    let n = 20_000;
    let mut counts = vec![0u64; 256];
    for seed in 0..n {
        let (x, y) = pair(seed);
        assert!((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y), "{what}: {x} {y}");
        counts[cell(x, 16) * 16 + cell(y, 16)] += 1;
    }
    chi2::counts_test(&counts, &[f64::from(n) / 256.0; 256], &options(tests)).check(what);
}

#[test]
fn every_number_is_uniform_over_seeds() {
    for kind in SamplerKind::ALL {
        for n in COUNTS {
            for index in [0, n - 1, n + n / 2] {
                let sampler = |seed: u32| Sampler::new(kind, n, u64::from(seed));
                let pixel = UVec2::new(13, 7);
                let tests = 2 * 3 * KINDS * COUNTS.len();
                let what = format!("{kind:?} {n} {index}");
                check_pairs(&what, tests, |seed| {
                    sampler(seed).at(pixel, index).get_2d(Dimension::LENS).into()
                });
                // The number of one dimension, and what is left of it sixteen times finer.
                check_pairs(&what, tests, |seed| {
                    let x = sampler(seed).at(pixel, index).get_1d(Dimension::TIME);
                    (x, (16.0 * x).fract())
                });
            }
        }
    }
}

#[test]
fn numbers_are_uniform_over_a_picture() {
    // One sample of each pixel, any of its round: where pixels are independent, so are the counts; the blue-noise pattern
    // fits better than chance, and χ² is small. It must never be large.
    for s in samplers(3) {
        let mut rng = Rng::new(4);
        let mut one = vec![0u64; 256];
        let mut two = vec![0u64; 256];
        let side = 96;
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let p = s.at(UVec2::new(x, y), rng.below(s.samples_per_pixel() as usize) as u32);
            one[cell(p.get_1d(Dimension::roulette(2)), 256)] += 1;
            let u = p.get_2d(Dimension::light_point(1));
            two[cell(u.x, 16) * 16 + cell(u.y, 16)] += 1;
        }
        for counts in [one, two] {
            let what = format!("{:?} {}", s.plan().uniform_kind(), s.samples_per_pixel());
            let each = f64::from(side * side) / 256.0;
            chi2::counts_test(&counts, &[each; 256], &options(2 * KINDS * COUNTS.len())).check(&what);
        }
    }
}

#[test]
fn rounds_are_alike_and_independent() {
    // The errors that two rounds of a pixel make are uncorrelated, and of one size: variances of 4000 normal values are within
    // 20 % of each other (nine standard deviations; those here have shorter tails, or are means of many).
    let f = |u: Vec2| f64::from(u.x * u.x + ops::sin(3.0 * u.y)) - (2.0 - ops::cos(3f64)) / 3.0;
    for kind in SamplerKind::ALL {
        for n in [1, 4, 7, 16, 37] {
            let [mut first, mut later, mut product] = [Welford::new(); 3];
            for seed in 0..4000 {
                let s = Sampler::new(kind, n, seed);
                let error = |k| {
                    round(&s, UVec2::new(5, 6), k).map(|p| f(p.get_2d(Dimension::LENS))).sum::<f64>()
                        / f64::from(n)
                };
                let (a, b) = (error(0), error(1000));
                first.add(a);
                later.add(b);
                product.add(a * b);
            }
            let what = format!("{kind:?} {n}");
            t_test_mean(&product, 0.0).check(&what, 0.01, KINDS * 5);
            let ratio = later.variance() / first.variance();
            assert!((0.8..1.25).contains(&ratio), "{what}: {ratio}");
        }
    }
}

#[test]
fn dimensions_pixels_rounds_and_seeds_are_independent() {
    let (d, e) = (Dimension::scatter_direction(1), Dimension::scatter_direction(2));
    let pixel = UVec2::new(100, 50);
    for kind in SamplerKind::ALL {
        for n in [1, 4, 7, 16, 32] {
            let check = |what: &str, pair: &mut dyn FnMut(u32, &Sampler) -> (f32, f32)| {
                let what = format!("{what}, {kind:?} {n}");
                check_pairs(&what, KINDS * 5 * 11, |seed| {
                    pair(seed, &Sampler::new(kind, n, u64::from(seed)))
                });
            };
            check("bounces", &mut |_, s| {
                let p = s.at(pixel, 0);
                (p.get_1d(d), p.get_1d(e))
            });
            check("variables", &mut |_, s| {
                let p = s.at(pixel, n - 1);
                (p.get_1d(Dimension::LENS), p.get_1d(Dimension::TIME))
            });
            check("pairs of bounces, x", &mut |_, s| {
                let p = s.at(pixel, 0);
                (p.get_2d(d).x, p.get_2d(e).x)
            });
            check("pairs of bounces, y", &mut |_, s| {
                let p = s.at(pixel, 0);
                (p.get_2d(d).y, p.get_2d(e).y)
            });
            check("pairs of bounces, x and y", &mut |_, s| {
                let p = s.at(pixel, 0);
                (p.get_2d(d).x, p.get_2d(e).y)
            });
            check("rounds", &mut |_, s| (s.at(pixel, 0).get_1d(d), s.at(pixel, n).get_1d(d)));
            check("rounds, y", &mut |_, s| (s.at(pixel, 0).get_2d(d).y, s.at(pixel, 3 * n).get_2d(d).y));
            check("far pixels", &mut |i, s| (s.at(pixel, 0).get_1d(d), s.at(scattered(i), 0).get_2d(e).x));
            check("seeds", &mut |i, s| {
                let other = Sampler::new(kind, n, u64::from(i) + (1 << 40));
                (s.at(pixel, 0).get_1d(d), other.at(pixel, 0).get_1d(d))
            });
            check("neighbouring seeds", &mut |i, _| {
                let at = |seed: u32| Sampler::new(kind, n, u64::from(seed)).at(pixel, 0).get_2d(d).y;
                (at(2 * i), at(2 * i + 1))
            });
            check("hash", &mut |_, s| {
                let p = s.at(pixel, 0);
                (p.get_1d(d), (p.hash(d) >> 40) as f32 / (1 << 24) as f32)
            });
        }
    }
}

#[test]
fn sobol_pairs_of_a_pixel_are_nets() {
    // A (0, m, 2)-net: each of the 2ᵐ-fold elementary intervals of every shape holds one point.
    for kind in [SamplerKind::PaddedSobol, SamplerKind::ZSobol] {
        for m in 0..9 {
            let n = 1 << m;
            let s = Sampler::new(kind, n, 11);
            for i in 0..20 {
                let dimension = Dimension::light_point(i as u16);
                let points: Vec<Vec2> = round(&s, scattered(i), i % 3).map(|p| p.get_2d(dimension)).collect();
                for a in 0..=m {
                    let (columns, rows) = (1 << a, n >> a);
                    let mut seen = vec![false; n as usize];
                    for p in &points {
                        let k = cell(p.x, columns) * rows as usize + cell(p.y, rows);
                        assert!(!std::mem::replace(&mut seen[k], true), "{kind:?} {n}: {columns} × {rows}");
                    }
                }
                let mut seen = vec![false; n as usize];
                for p in round(&s, scattered(i), 0) {
                    let k = cell(p.get_1d(Dimension::roulette(i as u16)), n);
                    assert!(!std::mem::replace(&mut seen[k], true));
                }
            }
        }
    }
}

#[test]
fn z_order_spreads_samples_over_blocks_of_pixels() {
    // Aligned squares of 2ᵏ × 2ᵏ pixels: all samples of such a block form a net, too.
    for (k, n) in [(1, 1), (1, 2), (1, 4), (1, 8), (1, 16), (2, 1), (2, 4), (2, 8), (3, 1), (3, 16)] {
        let s = Sampler::new(SamplerKind::ZSobol, n, 5);
        for i in 0..20 {
            let origin = scattered(i) >> k << k;
            let total = n << (2 * k);
            for a in 0..=total.trailing_zeros() {
                let (columns, rows) = (1 << a, total >> a);
                let mut seen = vec![false; total as usize];
                for y in 0..1 << k {
                    for x in 0..1 << k {
                        for p in round(&s, origin + UVec2::new(x, y), 0) {
                            let u = p.get_2d(Dimension::scatter_direction(i as u16));
                            let c = cell(u.x, columns) * rows as usize + cell(u.y, rows);
                            assert!(!std::mem::replace(&mut seen[c], true), "{k} {n}: {columns} × {rows}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn prefixes_of_a_round_are_spread_too() {
    // The first 4ʲ samples of a round, 64 at least where there are more, are a net: stopping early, or a count that is no power of
    // two, keeps most of the gain.
    for kind in [SamplerKind::PaddedSobol, SamplerKind::ZSobol] {
        for (n, part) in [(16u32, 16), (64, 64), (100, 64), (256, 64), (256, 256), (1000, 256), (1024, 64)] {
            let s = Sampler::new(kind, n, 3);
            let mut seen = vec![false; part as usize];
            let side = 1 << (u32::ilog2(part) / 2);
            for p in round(&s, UVec2::new(9, 2), 0).take(part as usize) {
                let u = p.get_2d(Dimension::LENS);
                let k = cell(u.x, side) * side as usize + cell(u.y, side);
                assert!(!std::mem::replace(&mut seen[k], true), "{kind:?} {n}: {part}");
            }
        }
    }
}

#[test]
fn stratified_samples_have_one_stratum_each() {
    for n in [1u32, 2, 3, 7, 8, 12, 16, 37, 64, 97, 100, 1000] {
        let s = Sampler::new(SamplerKind::Stratified, n, 8);
        let pixel = UVec2::new(3, 4);
        let mut values: Vec<f32> = round(&s, pixel, 1).map(|p| p.get_1d(Dimension::TIME)).collect();
        values.sort_by(f32::total_cmp);
        for (i, x) in values.iter().enumerate() {
            let place = f64::from(*x) * f64::from(n) - i as f64;
            assert!((-1e-4..1.0 + 1e-4).contains(&place), "{n}: {i} {x}");
        }
        // In two dimensions the rows are strata of y, each with as many samples as it is high.
        let points: Vec<Vec2> = round(&s, pixel, 0).map(|p| p.get_2d(Dimension::LENS)).collect();
        let grid = |a: u32, b: u32| {
            let mut seen = HashMap::new();
            points.iter().for_each(|p| *seen.entry((cell(p.x, a), cell(p.y, b))).or_insert(0) += 1);
            assert!(seen.len() == n as usize, "{n}");
        };
        match n {
            8 => grid(4, 2),
            12 => grid(4, 3),
            16 => grid(4, 4),
            64 => grid(8, 8),
            100 => grid(10, 10),
            _ => {}
        }
    }
}

#[test]
fn numbers_are_pure() {
    for s in samplers(77) {
        let mut table = HashMap::new();
        let dimensions: Vec<Dimension> =
            Variable::ALL.iter().flat_map(|&v| [0, 1, 5].map(|b| Dimension::new(v, b))).collect();
        let ask = |x: u32, index: u32, d: Dimension| {
            let again = Sampler::new(*s.plan(), s.samples_per_pixel(), 77);
            let p = again.at(UVec2::new(x, 900), index);
            (p.get_1d(d).to_bits(), p.get_2d(d).to_array().map(f32::to_bits), p.hash(d))
        };
        for x in [0, 70_000] {
            for index in [0, 1, 1000, u32::MAX] {
                let p = s.at(UVec2::new(x, 900), index);
                assert_eq!((p.pixel(), p.index()), (UVec2::new(x, 900), index));
                for &d in &dimensions {
                    let two = p.get_2d(d).to_array().map(f32::to_bits);
                    table.insert((x, index, d), (p.get_1d(d).to_bits(), two, p.hash(d)));
                }
            }
        }
        for ((x, index, d), value) in table {
            assert_eq!(ask(x, index, d), value);
        }
    }
}

#[test]
fn numbers_never_change() {
    // Pictures depend on them: a change here is a change of every picture.
    let bits = |kind| {
        let sampler = Sampler::new(kind, 16, 1);
        let p = sampler.at(UVec2::new(17, 42), 5);
        let u = p.get_2d(Dimension::light_point(1));
        [p.get_1d(Dimension::TIME), u.x, u.y].map(|x| (x * (1 << 24) as f32) as u32)
    };
    let known = [
        [9_491_982, 6_478_519, 3_128_878],
        [14_224_737, 14_202_542, 782_219],
        [12_637_594, 2_845_775, 3_862_346],
        [151_688, 700_693, 15_572_080],
        [14_224_736, 3_550_635, 4_389_858],
        [14_224_736, 5_647_787, 3_341_282],
        [862_696, 7_412_397, 12_046_135],
    ];
    assert_eq!(SamplerKind::ALL.map(bits), known);
}

#[test]
fn estimates_are_unbiased_and_better_than_chance() {
    // ∫ of a smooth function of two numbers; every count, every kind: the mean over seeds is right, and its variance below the
    // independent one's, by far where there is a net.
    let f = |u: Vec2| f64::from(u.x * u.x + ops::sin(3.0 * u.y));
    let exact = 1.0 / 3.0 + (1.0 - ops::cos(3f64)) / 3.0;
    let variance = |kind, n: u32| {
        let estimate = |seed: u64| {
            let s = Sampler::new(kind, n, seed);
            round(&s, UVec2::new(5, 6), 0).map(|p| f(p.get_2d(Dimension::LENS))).sum::<f64>() / f64::from(n)
        };
        let w: Welford = (0..2000).map(estimate).collect();
        t_test_mean(&w, exact).check(&format!("{kind:?} {n}"), 0.01, KINDS * 6);
        w.variance()
    };
    for n in [4, 7, 16, 32, 50, 64] {
        let [independent, stratified, z, padded, rooks, multi, halton] =
            SamplerKind::ALL.map(|k| variance(k, n));
        println!(
            "{n}: {independent:.2e} {stratified:.2e} {z:.2e} {padded:.2e} {rooks:.2e} {multi:.2e} {halton:.2e}"
        );
        // Jitter in 2 × 2 strata gains least; nets of a power of two gain most.
        let [jitter, net] = [if n < 8 { 1.4 } else { 2.0 }, if n.is_power_of_two() { 4.0 } else { 2.0 }];
        assert!(
            stratified * jitter < independent && z * net < independent && padded * net < independent,
            "{n}"
        );
        // The function is a sum of functions of one variable, which N rooks integrate best.
        assert!(rooks * 4.0 < independent && multi * 2.0 < independent && halton * 2.0 < independent, "{n}");
    }
}

#[test]
fn z_order_gives_neighbours_different_errors() {
    // The error of a 2 × 2 block of pixels together is far below half that of a pixel, which it would be by chance.
    let f = |u: Vec2| f64::from(u.x * u.x + ops::sin(3.0 * u.y)) - (2.0 - ops::cos(3f64)) / 3.0;
    let variance = |kind| {
        let mut block = Welford::new();
        for i in 0..4000u32 {
            let s = Sampler::new(kind, 4, u64::from(i));
            let origin = UVec2::new(64, 32);
            let pixels = [UVec2::ZERO, UVec2::X, UVec2::Y, UVec2::ONE];
            let sums =
                pixels.map(|p| round(&s, origin + p, 0).map(|p| f(p.get_2d(Dimension::LENS))).sum::<f64>());
            block.add(sums.iter().sum::<f64>());
        }
        block.variance()
    };
    let (z, padded) = (variance(SamplerKind::ZSobol), variance(SamplerKind::PaddedSobol));
    assert!(z * 4.0 < padded, "{z} {padded}");
}

#[test]
fn samples_taken_in_turn_have_the_numbers_of_each_alone() {
    // One room for all: what it held of other samplers, pixels, rounds and blocks must not be seen.
    let mut room = SampleRoom::default();
    for s in samplers(5).chain(samplers(6)) {
        let n = s.samples_per_pixel();
        for (pixel, indices) in [
            (UVec2::new(3, 4), 0..n),
            (UVec2::new(3, 5), 0..n),
            (UVec2::new(3, 5), n / 2..2 * n + 1),
            (UVec2::new(70_000, 1), 1..n.min(20)),
        ] {
            let mut next = indices.start;
            s.for_groups(pixel, indices.clone(), &mut room, |group| {
                for d in [0, 1, 7, 8, 300].iter().flat_map(|&b| Variable::ALL.map(|v| Dimension::new(v, b))) {
                    // Asked for all of them before or after each of them.
                    let asked = (d.bounce % 2 == 1).then(|| group.get_2d(group.slots(), d));
                    for (sample, index) in group.iter().zip(next..) {
                        let alone = s.at(pixel, index);
                        assert_eq!((sample.pixel(), sample.index()), (pixel, index));
                        assert_eq!(sample.get_1d(d), alone.get_1d(d), "{s:?} {d:?}");
                        assert_eq!(sample.get_2d(d), alone.get_2d(d), "{s:?} {d:?}");
                        assert_eq!(sample.hash(d), alone.hash(d), "{s:?} {d:?}");
                    }
                    let all = asked.unwrap_or_else(|| group.get_2d(group.slots(), d));
                    let (some, few) = (group.slots().keep(|slot| slot % 3 == 2), Slots::first(1));
                    for (slot, sample) in group.iter().enumerate() {
                        assert_eq!(all.get(slot), sample.get_2d(d), "{s:?} {d:?}");
                        for slots in [group.slots(), some, few].into_iter().filter(|s| s.contains(slot)) {
                            assert_eq!(group.get_1d(slots, d)[slot], sample.get_1d(d), "{s:?} {d:?}");
                        }
                    }
                }
                next += group.len() as u32;
            });
            assert_eq!(next, indices.end.max(indices.start));
        }
    }
}
