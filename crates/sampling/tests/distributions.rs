//! Tabulated distributions against their densities (χ²), their inverses, and broken tables.

use tenfold_math::{ONE_MINUS_EPSILON, Vec2, vec2};
use tenfold_sampling::{
    AliasTable, PiecewiseConstant1D, PiecewiseConstant2D, PiecewiseLinear1D, sample_discrete,
};
use tenfold_testkit::{Options, Rng, chi2};

fn options() -> Options {
    Options { tests: 30, ..Options::default() }
}

#[test]
fn one_dimension() {
    let o = Options { theta_bins: 15, phi_bins: 8, ..options() };
    for f in [
        vec![1.0],
        vec![0.0, 3.0, 0.0, 1.0, 0.0],
        vec![0.0; 3],
        vec![],
        (0..40).map(|i| (i * i % 7) as f32).collect(),
    ] {
        for (min, max) in [(0.0, 1.0), (-2.0, 6.0), (360.0, 830.0)] {
            let d = PiecewiseConstant1D::with_range(&f, min, max);
            let o = Options { seed: 5, ..o };
            chi2::interval_test(min, max, |u| Some(d.sample(u).x), |x| f64::from(d.pdf(x)), &o)
                .check(&format!("{f:?}"));
            let total: f32 = (0..d.len()).map(|i| d.pmf(i)).sum();
            assert!((total - 1.0).abs() < 1e-5);
            let mean = f.iter().sum::<f32>() / f.len().max(1) as f32;
            assert!((d.integral() - mean * (max - min)).abs() < 1e-4 * d.integral().max(1.0));
            let mut rng = Rng::new(1);
            for u in (0..500).map(|_| rng.f32()).chain([0.0, 0.5, ONE_MINUS_EPSILON]) {
                let s = d.sample(u);
                assert!(
                    s.pdf > 0.0 && s.pdf == d.pdf_of_cell(s.cell) && d.cell_of(u) == s.cell,
                    "{f:?} {u}: {s:?}"
                );
                assert!((d.invert(s.x).unwrap() - u).abs() < 1e-4 && (0.0..1.0).contains(&s.offset));
            }
            assert_eq!((d.pdf(min - 0.1), d.pdf(max + 0.1), d.invert(max + 0.1)), (0.0, 0.0, None));
            assert_eq!(d.pdf(f32::NAN), 0.0);
        }
    }
}

#[test]
fn lines_from_point_to_point() {
    let o = Options { theta_bins: 15, phi_bins: 8, seed: 6, ..options() };
    for points in [
        vec![[0.0, 1.0], [1.0, 1.0]],
        vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]],
        vec![[0.0, 0.0], [0.2, 3.0], [0.2, 1.0], [0.7, 2.0], [0.9, 0.0], [1.0, 0.0]],
        vec![[0.0, 0.0], [0.3, 0.0], [0.3, 5.0], [0.31, 0.0], [0.6, 0.0], [1.0, 2.0]],
        vec![[-2.0, 0.0], [-2.0, 1e30], [6.0, 3e30]],
    ] {
        let d = PiecewiseLinear1D::new(&points).unwrap();
        let (min, max) = (points[0][0], points[points.len() - 1][0]);
        chi2::interval_test(min, max, |u| Some(d.sample(u)), |x| f64::from(d.pdf(x)), &o)
            .check(&format!("{points:?}"));
        let [from, to] = d.support();
        let mut rng = Rng::new(1);
        let mut u: Vec<_> = (0..500).map(|_| rng.f32()).chain([0.0, 0.5, ONE_MINUS_EPSILON]).collect();
        u.sort_by(f32::total_cmp);
        for pair in u.windows(2) {
            let x = d.sample(pair[0]);
            assert!(x <= d.sample(pair[1]) && (from..=to).contains(&x), "{points:?} {pair:?}");
            assert!((d.invert(x).unwrap() - pair[0]).abs() < 1e-4, "{points:?} {x}");
        }
        assert_eq!((d.pdf(min - 0.1), d.pdf(max + 0.1), d.invert(max + 0.1)), (0.0, 0.0, None));
    }
    for nothing in [vec![], vec![[0.0, 1.0]], vec![[0.0, 0.0], [1.0, 0.0]], vec![[1.0, 1.0], [0.0, 1.0]]] {
        assert_eq!(PiecewiseLinear1D::new(&nothing), None);
    }
}

#[test]
fn faulty_values_count_as_zero() {
    let d = PiecewiseConstant1D::new(&[f32::NAN, 1.0, -3.0, f32::INFINITY, 1.0]);
    assert_eq!(d, PiecewiseConstant1D::new(&[0.0, 1.0, 0.0, 0.0, 1.0]));
    let t = AliasTable::new(&[f32::NAN, 1.0, -3.0, f32::INFINITY, 1.0]);
    assert_eq!((t.pmf(0), t.pmf(1), t.pmf(3)), (0.0, 0.5, 0.0));
}

#[test]
fn huge_and_tiny_values() {
    for scale in [1e-38f32, 1e-20, 1e37] {
        let f = [scale, 2.0 * scale, scale];
        let (d, t) = (PiecewiseConstant1D::new(&f), AliasTable::new(&f));
        assert!((d.pdf(0.5) - 1.5).abs() < 1e-3 && (t.pmf(1) - 0.5).abs() < 1e-3);
        let p = PiecewiseConstant2D::new(&f, 3);
        assert!((p.pdf(vec2(0.5, 0.5)) - 1.5).abs() < 1e-3);
    }
    // One cell in a million, and the last cells empty.
    let mut f = vec![0.0; 1 << 20];
    f[123_456] = 1e-3;
    let d = PiecewiseConstant1D::new(&f);
    for u in [0.0, 0.3, ONE_MINUS_EPSILON] {
        assert_eq!((d.sample(u).cell, d.sample(u).pdf), (123_456, (1 << 20) as f32));
    }
}

#[test]
fn two_dimensions() {
    let picture: Vec<f32> =
        (0..12 * 9).map(|i| if i % 12 == 3 || i / 12 == 4 { 0.0 } else { (i * 31 % 11) as f32 }).collect();
    let mut sun = vec![0.01; 64 * 32];
    sun[1000] = 1000.0;
    for (f, width) in [(picture, 12), (sun, 64), (vec![0.0; 6], 2), (vec![], 0), (vec![1.0, 2.0], 0)] {
        for (min, max) in [(Vec2::ZERO, Vec2::ONE), (vec2(-1.0, 2.0), vec2(3.0, 2.5))] {
            let d = PiecewiseConstant2D::with_range(&f, width, min, max);
            let o = Options { theta_bins: 24, phi_bins: 18, ..options() };
            chi2::rectangle_test(min, max, |u| Some(d.sample(u).point), |p| f64::from(d.pdf(p)), &o)
                .check("table");
            let mut rng = Rng::new(2);
            for u in (0..1000).map(|_| rng.vec2()).chain([Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON)]) {
                let s = d.sample(u);
                assert!(s.pdf > 0.0 && s.pdf == d.pdf_of_cell(s.cell), "{u}: {s:?}");
                // A point at the border of a cell may fall to its neighbour, another row with another inverse along x.
                if s.offset.min_element() > 1e-3 && s.offset.max_element() < 0.999 {
                    assert_eq!(d.pdf(s.point), s.pdf);
                    assert!((d.invert(s.point).unwrap() - u).abs().max_element() < 1e-3, "{u}: {s:?}");
                }
            }
            assert_eq!((d.pdf(max + Vec2::splat(0.1)), d.invert(min - Vec2::X)), (0.0, None));
        }
    }
}

#[test]
fn integrals_are_means_times_areas() {
    let d = PiecewiseConstant2D::with_range(&[1.0, 2.0, 3.0, 4.0], 2, Vec2::ZERO, vec2(2.0, 3.0));
    assert!((d.integral() - 15.0).abs() < 1e-5);
    assert_eq!(d.size(), [2, 2]);
    assert_eq!(PiecewiseConstant2D::new(&[0.0; 4], 2).integral(), 0.0);
}

#[test]
fn discrete_choices() {
    for weights in
        [vec![1.0f32], vec![0.0, 1.0, 2.0, 0.0, 5.0, 0.0], (0..100).map(|i| (i % 13) as f32).collect()]
    {
        let table = AliasTable::new(&weights);
        let total: f32 = weights.iter().sum();
        assert!((table.total() - total).abs() < 1e-3 && table.len() == weights.len());
        for alias in [false, true] {
            let n = 100_000u32;
            let mut rng = Rng::new(7);
            let mut counts = vec![0u64; weights.len()];
            let mut bins = [0u64; 20];
            for _ in 0..n {
                let u = rng.f32();
                let s = if alias { table.sample(u) } else { sample_discrete(&weights, u) }.unwrap();
                assert!((s.pmf - weights[s.index] / total).abs() < 1e-6 && s.pmf > 0.0);
                assert!((0.0..1.0).contains(&s.remapped));
                counts[s.index] += 1;
                bins[(s.remapped * 20.0) as usize] += 1;
            }
            let expected: Vec<f64> = weights.iter().map(|w| f64::from(n) * f64::from(w / total)).collect();
            chi2::counts_test(&counts, &expected, &options()).check("choices");
            chi2::counts_test(&bins, &[f64::from(n) / 20.0; 20], &options())
                .check("what is left of the number");
        }
    }
}

#[test]
fn nothing_to_choose() {
    assert_eq!(AliasTable::new(&[]).sample(0.5), None);
    assert_eq!(sample_discrete(&[], 0.5), None);
    assert_eq!(sample_discrete(&[0.0, 0.0], 0.5), None);
    assert!(AliasTable::new(&[]).is_empty());
    let even = AliasTable::new(&[0.0, 0.0]);
    assert_eq!((even.pmf(0), even.pmf(1), even.pmf(2)), (0.5, 0.5, 0.0));
    // What has no weight is never chosen, not even at the ends.
    for u in [0.0, ONE_MINUS_EPSILON] {
        assert_eq!(sample_discrete(&[0.0, 1.0, 0.0], u).unwrap().index, 1);
        assert_eq!(AliasTable::new(&[0.0, 1.0, 0.0]).sample(u).unwrap().index, 1);
    }
}
