use tenfold_math::ops;

/// The power law `error = c · nˢ` that comes nearest to points on logarithmic axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PowerLaw {
    /// The slope `s`: −½ is that of independent samples.
    pub slope: f64,
    /// The standard error of the slope, from the spread of the points about the line; NaN of two points.
    pub standard_error: f64,
}

impl PowerLaw {
    /// Fits the line of least squares through (ln n, ln error). Points that are not positive are left out; `None`
    /// where fewer than two remain.
    pub fn fit(points: impl IntoIterator<Item = [f64; 2]>) -> Option<Self> {
        let positive = points.into_iter().filter(|p| p.iter().all(|v| *v > 0.0 && v.is_finite()));
        let points: Vec<[f64; 2]> = positive.map(|p| p.map(ops::ln)).collect();
        let n = points.len() as f64;
        let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / n;
        let (x, y) = (mean(0), mean(1));
        let sxx: f64 = points.iter().map(|p| (p[0] - x) * (p[0] - x)).sum();
        let sxy: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
        if points.len() < 2 || sxx == 0.0 {
            return None;
        }
        let slope = sxy / sxx;
        let residual = |p: &[f64; 2]| p[1] - y - slope * (p[0] - x);
        let squares: f64 = points.iter().map(|p| residual(p) * residual(p)).sum();
        Some(Self { slope, standard_error: (squares / (n - 2.0) / sxx).sqrt() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_slopes_are_found() {
        let law =
            |s: f64| PowerLaw::fit((1..9).map(|n| [n.into(), 3.0 * ops::powf(f64::from(n), s)])).unwrap();
        for s in [-0.5, -1.5, 0.0, 2.0] {
            assert!((law(s).slope - s).abs() < 1e-12 && law(s).standard_error < 1e-12);
        }
        // Worked out by hand: y = 0, 1, 0 at x = 0, 1, 2 (in logarithms) has slope 0 and residuals -1/3, 2/3, -1/3.
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]].map(|p: [f64; 2]| p.map(ops::exp));
        let fit = PowerLaw::fit(points).unwrap();
        assert!(fit.slope.abs() < 1e-12 && (fit.standard_error - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn points_that_say_nothing_give_no_line() {
        assert_eq!(PowerLaw::fit([[1.0, 1.0]]), None);
        assert_eq!(PowerLaw::fit([[1.0, 1.0], [2.0, 0.0]]), None);
        assert_eq!(PowerLaw::fit([[2.0, 1.0], [2.0, 3.0]]), None);
        assert!(PowerLaw::fit([[1.0, 1.0], [2.0, 0.5], [4.0, f64::NAN]]).unwrap().standard_error.is_nan());
    }
}
