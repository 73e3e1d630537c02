//! How a number of samples is best shared out.

/// No share is below this part of the mean share, nor above its inverse: where little is known, little is ventured.
const LEAST_SHARE: f64 = 1.0 / 16.0;

/// The shares of the samples that integrals with these variances of one sample are to get, relative to the mean share:
/// in proportion to the standard deviation, which minimises Σ `variances[i] / n[i]` for a given Σ `n[i]` (Neyman 1934),
/// but within a factor of 16 of their mean. Their own mean is one.
///
/// ```
/// use tenfold_sampling::neyman_shares;
///
/// assert_eq!(neyman_shares(&[4.0, 1.0, 1.0, 16.0]), [1.0, 0.5, 0.5, 2.0]);
/// assert_eq!(neyman_shares(&[0.0, 0.0]), [1.0, 1.0]);
/// ```
pub fn neyman_shares(variances: &[f64]) -> Vec<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let deviations: Vec<f64> = variances.iter().map(|v| v.max(0.0).sqrt()).collect();
    let mean_deviation = mean(&deviations);
    if !(mean_deviation > 0.0 && mean_deviation.is_finite()) {
        return vec![1.0; variances.len()];
    }
    let bounded: Vec<f64> = deviations
        .iter()
        .map(|deviation| (deviation / mean_deviation).clamp(LEAST_SHARE, 1.0 / LEAST_SHARE))
        .collect();
    let mean_share = mean(&bounded);
    bounded.iter().map(|share| share / mean_share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ v/n for a mean of one sample each.
    fn error(variances: &[f64], shares: &[f64]) -> f64 {
        variances.iter().zip(shares).map(|(v, n)| v / n).sum()
    }

    #[test]
    fn no_small_change_of_the_shares_makes_the_error_smaller() {
        let variances = [0.3, 1.0, 2.5, 0.9, 4.0];
        let shares = neyman_shares(&variances);
        assert!((shares.iter().sum::<f64>() - 5.0).abs() < 1e-12);
        let best = error(&variances, &shares);
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            let mut other = shares.clone();
            other[i] += 0.01;
            other[j] -= 0.01;
            assert!(error(&variances, &other) > best, "{i} {j}");
        }
        // (Σ √v)² / n, the least there is.
        let least = variances.iter().map(|v| v.sqrt()).sum::<f64>().powi(2) / 5.0;
        assert!((best - least).abs() < 1e-12);
        assert!(error(&variances, &[1.0; 5]) > best);
    }

    #[test]
    fn shares_are_bounded_and_never_vanish() {
        let mut variances = vec![1e-12; 1000];
        variances[7] = 1e6;
        let shares = neyman_shares(&variances);
        assert!(shares[7] / shares[8] <= 256.0 + 1e-9 && shares.iter().all(|&n| n > 0.0));
        assert!((shares.iter().sum::<f64>() - 1000.0).abs() < 1e-9);
        assert_eq!(neyman_shares(&[]), Vec::<f64>::new());
        assert_eq!(neyman_shares(&[f64::INFINITY, 1.0]), [1.0, 1.0]);
    }
}
