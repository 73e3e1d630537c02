//! Special functions of statistics, in double precision.

use tenfold_math::ops;

/// `ln Γ(x)` for `x > 0`: Stirling's series after shifting `x` above 12 (Abramowitz and Stegun 6.1.41);
/// absolute error below 1e-13 for moderate `x`.
pub fn ln_gamma(x: f64) -> f64 {
    let (mut x, mut shift) = (x, 0.0);
    while x < 12.0 {
        shift += ops::ln(x);
        x += 1.0;
    }
    let i = 1.0 / (x * x);
    let series =
        (1.0 / 12.0 + i * (-1.0 / 360.0 + i * (1.0 / 1260.0 + i * (-1.0 / 1680.0 + i / 1188.0)))) / x;
    (x - 0.5) * ops::ln(x) - x + 0.5 * ops::ln(std::f64::consts::TAU) + series - shift
}

/// The regularised upper incomplete gamma function `Q(a, x) = Γ(a, x) / Γ(a)`, by the series of
/// Abramowitz and Stegun 6.5.29 below `a + 1` and the continued fraction 6.5.31 above it.
pub fn gamma_q(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    if !x.is_finite() {
        return 0.0;
    }
    let scale = ops::exp(a * ops::ln(x) - x - ln_gamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        for _ in 0..100_000 {
            n += 1.0;
            term *= x / n;
            sum += term;
            if term < sum * 1e-16 {
                break;
            }
        }
        (1.0 - scale * sum).clamp(0.0, 1.0)
    } else {
        let fraction = continued_fraction(|n| {
            let n = n as f64;
            if n == 0.0 { (1.0, x + 1.0 - a) } else { (-n * (n - a), x + 2.0 * n + 1.0 - a) }
        });
        (scale * fraction).clamp(0.0, 1.0)
    }
}

/// The regularised incomplete beta function `I_x(a, b)`, by the continued fraction of
/// Abramowitz and Stegun 26.5.8.
pub fn beta_i(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta_i(b, a, 1.0 - x);
    }
    let scale =
        ops::exp(a * ops::ln(x) + b * ops::ln(1.0 - x) + ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b)) / a;
    let fraction = continued_fraction(|n| {
        let m = (n / 2) as f64;
        let numerator = if n == 0 {
            1.0
        } else if n % 2 == 0 {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        (numerator, 1.0)
    });
    (scale * fraction).clamp(0.0, 1.0)
}

/// `a0 / (b0 + a1 / (b1 + ...))` with `(a, b) = term(n)`, by Lentz's method (Lentz 1976).
fn continued_fraction(term: impl Fn(u32) -> (f64, f64)) -> f64 {
    const TINY: f64 = 1e-300;
    let guard = |x: f64| if x.abs() < TINY { TINY } else { x };
    let (mut value, mut c, mut d) = (TINY, TINY, 0.0);
    for n in 0..100_000 {
        let (a, b) = term(n);
        d = 1.0 / guard(b + a * d);
        c = guard(b + a / c);
        value *= c * d;
        if (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

/// Probability that a χ² variable with `dof` degrees of freedom exceeds `statistic`.
pub fn chi_squared_p(statistic: f64, dof: f64) -> f64 {
    gamma_q(0.5 * dof, 0.5 * statistic)
}

/// Two-sided p-value of Student's `t` with `dof` degrees of freedom (Abramowitz and Stegun 26.7.1 and 26.5.27).
pub fn student_p(t: f64, dof: f64) -> f64 {
    if t.is_nan() { 0.0 } else { beta_i(0.5 * dof, 0.5, dof / (dof + t * t)) }
}

/// Distribution function of the standard normal, from the incomplete gamma function.
pub fn normal_cdf(x: f64) -> f64 {
    let tail = 0.5 * gamma_q(0.5, 0.5 * x * x);
    if x > 0.0 { 1.0 - tail } else { tail }
}

/// The `x` with `normal_cdf(x) = p`, by bisection; infinite at 0 and 1.
pub fn normal_quantile(p: f64) -> f64 {
    if p <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if p >= 1.0 {
        return f64::INFINITY;
    }
    // The lower half keeps its relative precision, so the upper one is mirrored.
    if p > 0.5 {
        return -normal_quantile(1.0 - p);
    }
    let (mut low, mut high) = (-39.0, 0.0);
    while high - low > 1e-14 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if normal_cdf(middle) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-10 * b.abs().max(1.0), "{a} {b}");
    }

    #[test]
    fn gamma_matches_factorials_and_the_half() {
        close(ln_gamma(11.0), ops::ln(3_628_800f64));
        close(ln_gamma(0.5), 0.5 * ops::ln(std::f64::consts::PI));
    }

    #[test]
    fn tails_match_their_closed_forms() {
        // χ² with two degrees of freedom is exponential; Student's t with one is Cauchy's.
        for x in [0.1, 1.0, 3.0, 20.0, 200.0] {
            close(chi_squared_p(x, 2.0) / ops::exp(-0.5 * x), 1.0);
            close(student_p(x, 1.0), 1.0 - 2.0 / std::f64::consts::PI * ops::atan(x));
            close(student_p(x, 2.0), 1.0 - x / (2.0 + x * x).sqrt());
        }
        // Q(a, x) for integer a is Poisson's distribution function.
        let poisson: f64 = (0..5)
            .map(|k| ops::exp(-3f64 + f64::from(k) * ops::ln(3f64) - ln_gamma(f64::from(k) + 1.0)))
            .sum();
        close(gamma_q(5.0, 3.0), poisson);
        close(
            gamma_q(5.0, 9.0)
                / (0..5)
                    .map(|k| ops::exp(-9f64 + f64::from(k) * ops::ln(9f64) - ln_gamma(f64::from(k) + 1.0)))
                    .sum::<f64>(),
            1.0,
        );
    }

    #[test]
    fn normal_quantiles_are_the_tabulated_ones() {
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-10);
        assert!((normal_quantile(0.001) + 3.090_232_306_167_814).abs() < 1e-10);
        close(normal_cdf(normal_quantile(1e-9)) / 1e-9, 1.0);
    }
}
