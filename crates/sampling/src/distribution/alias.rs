use super::{DiscreteSample, sanitize};
use tenfold_math::ONE_MINUS_EPSILON;

/// Choices in proportion to a table of weights, in constant time (Walker 1977, built as by Vose 1991).
#[derive(Clone, Debug, PartialEq)]
pub struct AliasTable {
    bins: Vec<Bin>,
    total: f64,
}

#[derive(Copy, Clone, Debug, PartialEq)]
struct Bin {
    /// Share of the bin that is its own; the rest is the alias's.
    own: f32,
    alias: u32,
    pmf: f32,
}

impl AliasTable {
    /// For any number of weights below 2³²; negative ones, infinite ones and NaN count as zero, and where all are zero
    /// all are equally likely.
    pub fn new(weights: &[f32]) -> Self {
        let n = weights.len();
        let total: f64 = weights.iter().map(|&w| f64::from(sanitize(w))).sum();
        let pmf = |w: f32| if total > 0.0 { f64::from(sanitize(w)) / total } else { 1.0 / n as f64 };
        let mut bins: Vec<Bin> = weights
            .iter()
            .enumerate()
            .map(|(i, &w)| Bin { own: 1.0, alias: i as u32, pmf: pmf(w) as f32 })
            .collect();

        // Shares in units of a bin: what is short of one is filled up from what is above it.
        let mut share: Vec<f64> = weights.iter().map(|&w| pmf(w) * n as f64).collect();
        let (mut under, mut over): (Vec<usize>, Vec<usize>) = (0..n).rev().partition(|&i| share[i] < 1.0);
        while let (Some(&u), Some(&o)) = (under.last(), over.last()) {
            under.pop();
            bins[u].own = share[u] as f32;
            bins[u].alias = o as u32;
            share[o] -= 1.0 - share[u];
            if share[o] < 1.0 {
                over.pop();
                under.push(o);
            }
        }
        // Rounding may leave some of either kind, all within rounding of one; but what has no weight must not be chosen.
        if let Some(likely) = (0..n).max_by(|&i, &j| bins[i].pmf.total_cmp(&bins[j].pmf)) {
            for i in under.into_iter().chain(over) {
                if bins[i].pmf == 0.0 {
                    bins[i].own = 0.0;
                    bins[i].alias = likely as u32;
                }
            }
        }
        Self { bins, total }
    }

    /// How many choices there are.
    pub fn len(&self) -> usize {
        self.bins.len()
    }

    /// Whether there is nothing to choose.
    pub fn is_empty(&self) -> bool {
        self.bins.is_empty()
    }

    /// The sum of the weights.
    pub fn total(&self) -> f32 {
        self.total as f32
    }

    /// The probability of a choice; zero beyond the table.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.bins.get(index).map_or(0.0, |b| b.pmf)
    }

    /// A choice; `None` of an empty table.
    #[inline]
    pub fn sample(&self, u: f32) -> Option<DiscreteSample> {
        let scaled = f64::from(u) * self.bins.len() as f64;
        let cell = (scaled as usize).min(self.bins.len().checked_sub(1)?);
        let bin = self.bins[cell];
        let (v, own) = (scaled - cell as f64, f64::from(bin.own));
        let (index, remapped) =
            if v < own { (cell, v / own) } else { (bin.alias as usize, (v - own) / (1.0 - own)) };
        let remapped = (remapped as f32).clamp(0.0, ONE_MINUS_EPSILON);
        Some(DiscreteSample { index, pmf: self.bins[index].pmf, remapped })
    }
}
