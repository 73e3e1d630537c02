//! How evenly points cover the unit square.

use tenfold_math::DVec2;

/// The star discrepancy of points in the unit square: the largest difference, over all rectangles with a corner at the origin,
/// between the share of the points in it and its area. 0 would be perfect, and none is below about 1/(2N).
///
/// Exact, in O(N² log N): the supremum is that over the corners of the grid that the points' coordinates and 1 make, of the open
/// and of the closed rectangle (Niederreiter 1972; for two dimensions De Clerck 1986).
pub fn star(points: &[DVec2]) -> f64 {
    if points.is_empty() {
        return 1.0;
    }
    let n = points.len() as f64;
    let mut by_x = points.to_vec();
    by_x.sort_by(|a, b| a.x.total_cmp(&b.x));
    // The heights of the points left of the edge, rising.
    let mut left: Vec<f64> = Vec::with_capacity(points.len());
    let mut worst = 0.0f64;
    let mut i = 0;
    while i <= by_x.len() {
        let edge = by_x.get(i).map_or(1.0, |p| p.x);
        // Open at the edge: the points left of it, below each height, are fewer than the area asks.
        for (below, &y) in left.iter().chain(std::iter::once(&1.0)).enumerate() {
            // Of equal heights, the first has the fewest below.
            worst = worst.max(edge * y - below as f64 / n);
        }
        let same = by_x[i..].iter().take_while(|p| p.x == edge).count();
        for p in &by_x[i..i + same] {
            let at = left.partition_point(|&y| y < p.y);
            left.insert(at, p.y);
        }
        // Closed: the points up to it, up to each height, are more.
        for (below, &y) in left.iter().enumerate() {
            worst = worst.max((below + 1) as f64 / n - edge * y);
        }
        // The heights between the last point and 1 see all points left of the edge, and less area.
        i += same.max(1);
    }
    worst
}

/// The L2 star discrepancy of points in the unit square: the root mean square of that difference over all rectangles.
/// Warnock 1972's formula.
pub fn l2_star(points: &[DVec2]) -> f64 {
    let n = points.len() as f64;
    if points.is_empty() {
        return 1.0 / 3.0;
    }
    let single: f64 = points.iter().map(|p| (1.0 - p.x * p.x) * (1.0 - p.y * p.y)).sum();
    let mut pairs = 0.0;
    for (i, a) in points.iter().enumerate() {
        pairs += (1.0 - a.x) * (1.0 - a.y);
        for b in &points[..i] {
            pairs += 2.0 * (1.0 - a.x.max(b.x)) * (1.0 - a.y.max(b.y));
        }
    }
    // The square is (1/3)² - 2/N Σ Π (1 - x²)/2 + 1/N² ΣΣ Π (1 - max).
    (1.0 / 9.0 - single / (2.0 * n) + pairs / (n * n)).max(0.0).sqrt()
}

/// The mean of the squared L2 star discrepancy of independent points: (2⁻² − 3⁻²) / N.
pub fn l2_star_of_independent(n: usize) -> f64 {
    ((0.25 - 1.0 / 9.0) / n as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::UVec2;
    use tenfold_sampling::{Dimension, Sampler, SamplerKind};

    fn van_der_corput(mut i: u32) -> f64 {
        let (mut x, mut digit) = (0.0, 0.5);
        while i > 0 {
            x += f64::from(i & 1) * digit;
            digit /= 2.0;
            i >>= 1;
        }
        x
    }

    fn hammersley(bits: u32) -> Vec<DVec2> {
        let n = 1 << bits;
        (0..n).map(|i| DVec2::new(f64::from(i) / f64::from(n), van_der_corput(i))).collect()
    }

    fn independent(n: u32, seed: u64) -> Vec<DVec2> {
        let sampler = Sampler::new(SamplerKind::Independent, n, seed);
        (0..n).map(|i| sampler.at(UVec2::ZERO, i).get_2d(Dimension::LENS).as_dvec2()).collect()
    }

    /// By definition, at all corners that can matter.
    fn slow_star(points: &[DVec2]) -> f64 {
        let n = points.len() as f64;
        let xs: Vec<f64> = points.iter().map(|p| p.x).chain([1.0]).collect();
        let ys: Vec<f64> = points.iter().map(|p| p.y).chain([1.0]).collect();
        let mut worst = 0.0f64;
        for &x in &xs {
            for &y in &ys {
                let open = points.iter().filter(|p| p.x < x && p.y < y).count() as f64 / n;
                let closed = points.iter().filter(|p| p.x <= x && p.y <= y).count() as f64 / n;
                worst = worst.max(x * y - open).max(closed - x * y);
            }
        }
        worst
    }

    #[test]
    fn known_discrepancies_are_found() {
        // One point in the middle: the closed square up to it has 1 and area ¼.
        assert_eq!(star(&[DVec2::new(0.5, 0.5)]), 0.75);
        assert_eq!(star(&[]), 1.0);
        // A regular grid of the centres of k × k cells: 1 − (1 − 1/2k)² at the centre of the last cell.
        for k in [1u32, 2, 5, 8] {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(k);
            let grid: Vec<DVec2> = (0..k * k).map(|i| DVec2::new(at(i % k), at(i / k))).collect();
            let expected = 1.0 - (1.0 - 0.5 / f64::from(k)) * (1.0 - 0.5 / f64::from(k));
            assert!((star(&grid) - expected).abs() < 1e-12, "{k}: {} {expected}", star(&grid));
        }
        // Hammersley points of van der Corput's sequence: N·D = m/3 + 13/9 − (−1)^m 4/(9 · 2^m) (Halton and Zaremba 1969).
        for m in 2..9 {
            let n = f64::from(1 << m);
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            let expected = (f64::from(m) / 3.0 + 13.0 / 9.0 - sign * 4.0 / (9.0 * n)) / n;
            assert!(
                (star(&hammersley(m)) - expected).abs() < 1e-12,
                "{m}: {} {expected}",
                star(&hammersley(m))
            );
        }
    }

    #[test]
    fn it_is_the_definition() {
        for (n, seed) in [(1, 1), (2, 2), (7, 3), (30, 4), (61, 5)] {
            let points = independent(n, seed);
            assert!((star(&points) - slow_star(&points)).abs() < 1e-12, "{n}");
            // Points that share coordinates, too, and some at the edges.
            let coarse: Vec<DVec2> = points.iter().map(|p| (*p * 4.0).round() / 4.0).collect();
            assert!((star(&coarse) - slow_star(&coarse)).abs() < 1e-12, "{n}");
        }
    }

    #[test]
    fn the_mean_square_is_its_integral() {
        let points = independent(9, 3);
        // Midpoints of a fine grid of corners.
        let (k, mut sum) = (800, 0.0);
        for i in 0..k * k {
            let corner =
                DVec2::new((f64::from(i % k) + 0.5) / f64::from(k), (f64::from(i / k) + 0.5) / f64::from(k));
            let inside = points.iter().filter(|p| p.x < corner.x && p.y < corner.y).count() as f64 / 9.0;
            sum += (inside - corner.x * corner.y) * (inside - corner.x * corner.y);
        }
        let integral = (sum / f64::from(k * k)).sqrt();
        assert!((l2_star(&points) / integral - 1.0).abs() < 2e-3, "{} {integral}", l2_star(&points));
        assert!((l2_star(&[]) - 1.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn independent_points_have_the_mean_that_theory_says() {
        let runs = 2000;
        let squares: Vec<f64> = (0..runs).map(|seed| l2_star(&independent(16, seed)).powi(2)).collect();
        let mean = squares.iter().sum::<f64>() / runs as f64;
        let variance = squares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / (runs - 1) as f64;
        let expected = l2_star_of_independent(16).powi(2);
        // Four standard errors.
        assert!((mean - expected).abs() < 4.0 * (variance / runs as f64).sqrt(), "{mean} {expected}");
    }
}
