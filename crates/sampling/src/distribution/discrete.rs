use tenfold_math::ONE_MINUS_EPSILON;

/// A choice among weighted things.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct DiscreteSample {
    /// Which one.
    pub index: usize,
    /// The probability it had.
    pub pmf: f32,
    /// A number as uniform in `[0, 1)` as the one spent, for another use.
    pub remapped: f32,
}

/// Chooses in proportion to `weights`, none negative, in one pass; `None` where all are zero.
#[inline]
pub fn sample_discrete(weights: &[f32], u: f32) -> Option<DiscreteSample> {
    let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let target = f64::from(u) * total;
    let (mut sum, mut chosen) = (0.0, None);
    for (index, &w) in weights.iter().enumerate() {
        if w > 0.0 {
            chosen = Some((index, f64::from(w), sum));
            sum += f64::from(w);
            if target < sum {
                break;
            }
        }
    }
    chosen.map(|(index, weight, before)| DiscreteSample {
        index,
        pmf: (weight / total) as f32,
        remapped: (((target - before) / weight) as f32).clamp(0.0, ONE_MINUS_EPSILON),
    })
}
