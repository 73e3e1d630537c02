//! Moments, Student's tests and the correction for many tests.

use crate::special::student_p;
use tenfold_math::ops;

/// Running mean and variance (Welford 1962; merged as in Chan, Golub and LeVeque 1983).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Welford {
    /// How many values were added.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    /// The sum of their squared deviations from it.
    pub squares: f64,
}

impl Welford {
    /// No values yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one value.
    pub fn add(&mut self, x: f64) {
        self.count += 1;
        let delta = x - self.mean;
        self.mean += delta / self.count as f64;
        self.squares += delta * (x - self.mean);
    }

    /// Adds all values of `other`.
    pub fn merge(&mut self, other: &Self) {
        let count = self.count + other.count;
        if count == 0 {
            return;
        }
        let delta = other.mean - self.mean;
        let share = other.count as f64 / count as f64;
        self.squares += other.squares + delta * delta * self.count as f64 * share;
        self.mean += delta * share;
        self.count = count;
    }

    /// Unbiased variance of one value; zero below two values.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.squares / (self.count - 1) as f64 }
    }

    /// Variance of the mean, for independent values.
    pub fn variance_of_mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.variance() / self.count as f64 }
    }

    /// Standard error of the mean, for independent values.
    pub fn standard_error(&self) -> f64 {
        self.variance_of_mean().sqrt()
    }
}

impl FromIterator<f64> for Welford {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut w = Self::new();
        values.into_iter().for_each(|x| w.add(x));
        w
    }
}

/// The outcome of a two-sided Student's test.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TTest {
    /// The difference of the means, first minus second.
    pub difference: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Degrees of freedom.
    pub dof: f64,
    /// Probability of a difference at least so large where the true means agree.
    pub p: f64,
}

impl TTest {
    /// Whether the means agree at the `significance` of one test among `tests` (Šidák).
    pub fn passes(&self, significance: f64, tests: usize) -> bool {
        self.p >= sidak(significance, tests)
    }

    /// Panics with the numbers where the means do not agree.
    #[track_caller]
    pub fn check(&self, what: &str, significance: f64, tests: usize) {
        assert!(self.passes(significance, tests), "{what}: the means differ: {self:?}");
    }

    fn new(difference: f64, variance: f64, dof: f64) -> Self {
        let standard_error = variance.sqrt();
        let p = if difference == 0.0 {
            1.0
        } else if standard_error > 0.0 && dof > 0.0 {
            student_p(difference / standard_error, dof)
        } else {
            // Unequal constants, or a single value: nothing supports that they agree.
            0.0
        };
        Self { difference, standard_error, dof, p }
    }
}

/// Tests the mean of independent values against a known one.
pub fn t_test_mean(values: &Welford, mean: f64) -> TTest {
    TTest::new(values.mean - mean, values.variance_of_mean(), values.count.saturating_sub(1) as f64)
}

/// Tests the means of two independent sets of values with unequal variances (Welch 1947).
pub fn t_test_two(a: &Welford, b: &Welford) -> TTest {
    let (va, vb) = (a.variance_of_mean(), b.variance_of_mean());
    let spread = |v: f64, n: u64| if n < 2 { 0.0 } else { v * v / (n - 1) as f64 };
    let denominator = spread(va, a.count) + spread(vb, b.count);
    let dof = if denominator > 0.0 { (va + vb) * (va + vb) / denominator } else { 0.0 };
    TTest::new(a.mean - b.mean, va + vb, dof)
}

/// The significance of each of `tests` independent tests that gives all of them together `significance` (Šidák 1967).
pub fn sidak(significance: f64, tests: usize) -> f64 {
    -ops::exp_m1(ops::ln_1p(-significance) / tests.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    #[test]
    fn moments_merge_exactly_enough() {
        let mut rng = Rng::new(5);
        let values: Vec<f64> = (0..1000).map(|_| 1e3 + rng.f64()).collect();
        let all: Welford = values.iter().copied().collect();
        let mut merged: Welford = values[..300].iter().copied().collect();
        merged.merge(&values[300..].iter().copied().collect());
        merged.merge(&Welford::new());
        assert!((merged.mean - all.mean).abs() < 1e-10 && (merged.variance() - all.variance()).abs() < 1e-10);
        assert!((all.variance() - 1.0 / 12.0).abs() < 5e-3);
    }

    #[test]
    fn p_values_of_true_hypotheses_are_uniform_and_false_ones_are_rejected() {
        let mut rng = Rng::new(9);
        let mut small = 0;
        for _ in 0..1000 {
            let a: Welford = (0..20).map(|_| rng.f64()).collect();
            let b: Welford = (0..30).map(|_| 0.25 + 0.5 * rng.f64()).collect();
            small += i32::from(t_test_two(&a, &b).p < 0.1);
            assert!(!t_test_mean(&a, 1.0).passes(0.01, 1));
        }
        // Binomial(1000, 0.1): 100 ± 4.5 standard deviations.
        assert!((57..=143).contains(&small), "{small}");
    }

    #[test]
    fn sidak_undoes_many_tests() {
        let one = sidak(0.01, 50);
        assert!((1.0 - (1.0 - one).powi(50) - 0.01).abs() < 1e-12 && sidak(0.01, 1) - 0.01 < 1e-15);
    }
}
