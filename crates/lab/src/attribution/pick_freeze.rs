//! Shares of variance by pick and freeze.
//!
//! Of an integrand f of independent variables take two independent samples A and B, and for each group of variables i the
//! sample ABᵢ: A with the variables of i from B. Then (B, ABᵢ) share the variables of i alone, and (A, ABᵢ) share all others. The
//! covariance of a pair is the variance of what the shared variables say of f (Sobol' 1993; Saltelli et al. 2010):
//!
//! - the **first-order** share of i is the correlation of (B, ABᵢ): the part of the variance that goes where i is known;
//! - the **total** share of i is one minus the correlation of (A, ABᵢ): the part that stays where all others are known.
//!
//! Of the estimators of a correlation r this takes the one that Janon et al. (2014) show to be of least asymptotic variance, which takes
//! mean and variance from both members of the pair. With s = (b + c)/2 and d = (b − c)/2, whose mean is zero,
//! cov = var s − E d² and var = var s + E d², both without bias: E d² is the estimator of Jansen (1999).
//!
//! To r(B, ABᵢ) and r(A, ABᵢ) alike r(A, B), which is zero but for chance, is the control variate, each with the other as its
//! coefficient: the first-order share is r(B, ABᵢ) − r(A, ABᵢ) r(A, B). Where i matters little, ABᵢ is nearly A, and this is the difference that Saltelli et
//! al. (2010) take. The test `sobol_indices` sets the errors of all these beside each other.

/// Sums over pairs (b, c) of equally distributed values.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
struct Sums {
    count: f64,
    half_sum: f64,
    half_sum_squared: f64,
    half_difference_squared: f64,
}

impl Sums {
    #[inline]
    fn add(&mut self, b: f64, c: f64) {
        let (s, d) = (0.5 * (b + c), 0.5 * (b - c));
        self.count += 1.0;
        self.half_sum += s;
        self.half_sum_squared += s * s;
        self.half_difference_squared += d * d;
    }

    fn plus(&self, sign: f64, other: &Self) -> Self {
        Self {
            count: self.count + sign * other.count,
            half_sum: self.half_sum + sign * other.half_sum,
            half_sum_squared: self.half_sum_squared + sign * other.half_sum_squared,
            half_difference_squared: self.half_difference_squared + sign * other.half_difference_squared,
        }
    }

    fn moments(&self) -> Moments {
        if self.count < 2.0 {
            return Moments::default();
        }
        let of_s = (self.half_sum_squared - self.half_sum * self.half_sum / self.count) / (self.count - 1.0);
        let of_d = self.half_difference_squared / self.count;
        Moments { covariance: of_s - of_d, variance: of_s + of_d }
    }
}

/// Unbiased estimates of the second moments of pairs.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
struct Moments {
    /// Of the one with the other.
    covariance: f64,
    /// Of either.
    variance: f64,
}

impl Moments {
    /// `None` where nothing varies.
    fn correlation(&self) -> Option<f64> {
        (self.variance > 0.0).then(|| self.covariance / self.variance)
    }

    fn add(&mut self, other: Self, weight: f64) {
        self.covariance += weight * other.covariance;
        self.variance += weight * other.variance;
    }
}

/// The pair (A, B).
const NOTHING_SHARED: usize = 0;

/// The pair (B, ABᵢ).
fn sharing(group: usize) -> usize {
    1 + 2 * group
}

/// The pair (A, ABᵢ).
fn sharing_others(group: usize) -> usize {
    2 + 2 * group
}

/// The evaluations of one integral (a pixel's), in blocks of samples that are independent of each other.
#[derive(Clone, Debug)]
pub struct Evaluations {
    blocks: usize,
    /// The pair that shares nothing, then for each group the pair that shares it and the pair that shares all others: for each the
    /// blocks.
    sums: Vec<Sums>,
}

impl Evaluations {
    /// None yet, of `groups` groups of variables.
    pub fn new(groups: usize, blocks: usize) -> Self {
        Self { blocks, sums: vec![Sums::default(); (1 + 2 * groups) * blocks] }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.sums.fill(Sums::default());
    }

    /// Adds to `block` the values at A, at B, and at A with each group from B.
    ///
    /// # Panics
    /// Where `block` is none of those asked for, or `mixed` has not one value a group.
    #[inline]
    pub fn add(&mut self, block: usize, a: f64, b: f64, mixed: &[f64]) {
        assert!(block < self.blocks && (1 + 2 * mixed.len()) * self.blocks == self.sums.len());
        self.sums[block].add(a, b);
        for (pairs, &ab) in self.sums[self.blocks..].chunks_exact_mut(2 * self.blocks).zip(mixed) {
            pairs[block].add(b, ab);
            pairs[self.blocks + block].add(a, ab);
        }
    }

    /// The variance.
    pub fn variance(&self) -> f64 {
        let pairs = self.sums.len() / self.blocks;
        (0..pairs).map(|pair| self.all_blocks(pair).moments().variance).sum::<f64>() / pairs as f64
    }

    /// The part of the variance that remains where all but `group` is known.
    pub fn total_part(&self, group: usize) -> f64 {
        let moments = self.all_blocks(sharing_others(group)).moments();
        moments.variance - moments.covariance
    }

    fn blocks_of(&self, pair: usize) -> &[Sums] {
        &self.sums[pair * self.blocks..][..self.blocks]
    }

    fn all_blocks(&self, pair: usize) -> Sums {
        self.blocks_of(pair).iter().fold(Sums::default(), |all, s| all.plus(1.0, s))
    }
}

/// Moments summed over many integrals (the pixels of a picture), each with its weight: all samples, and all but those of
/// one block, for the errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Totals {
    blocks: usize,
    /// For each pair: of all samples, then without each block.
    moments: Vec<Moments>,
}

impl Totals {
    /// Nothing yet.
    pub fn new(groups: usize, blocks: usize) -> Self {
        Self { blocks, moments: vec![Moments::default(); (1 + 2 * groups) * (1 + blocks)] }
    }

    /// Adds one integral's evaluations with a weight.
    pub fn add(&mut self, evaluations: &Evaluations, weight: f64) {
        debug_assert_eq!(self.blocks, evaluations.blocks);
        for (pair, moments) in self.moments.chunks_exact_mut(1 + self.blocks).enumerate() {
            let all = evaluations.all_blocks(pair);
            moments[0].add(all.moments(), weight);
            for (without, block) in moments[1..].iter_mut().zip(evaluations.blocks_of(pair)) {
                without.add(all.plus(-1.0, block).moments(), weight);
            }
        }
    }

    /// Adds other integrals.
    pub fn merge(&mut self, other: &Self) {
        self.moments.iter_mut().zip(&other.moments).for_each(|(m, o)| m.add(*o, 1.0));
    }

    /// Number of groups.
    pub fn groups(&self) -> usize {
        (self.moments.len() / (1 + self.blocks) - 1) / 2
    }

    /// The share of `group` by itself.
    pub fn first_order(&self, group: usize) -> Share {
        self.jackknife(|set| self.first_order_of(group, set))
    }

    /// The share of `group` in all it takes part in.
    pub fn total(&self, group: usize) -> Share {
        self.jackknife(|set| self.total_of(group, set))
    }

    /// What no group is to blame for by itself: one minus all first-order shares.
    pub fn interactions(&self) -> Share {
        self.jackknife(|set| {
            1.0 - (0..self.groups()).map(|group| self.first_order_of(group, set)).sum::<f64>()
        })
    }

    /// The weighted sum of the variances.
    pub fn variance(&self) -> Share {
        let pairs = 1 + 2 * self.groups();
        self.jackknife(|set| (0..pairs).map(|p| self.moments(p, set).variance).sum::<f64>() / pairs as f64)
    }

    fn first_order_of(&self, group: usize, set: usize) -> f64 {
        let r = |pair| self.moments(pair, set).correlation().unwrap_or(0.0);
        r(sharing(group)) - r(sharing_others(group)) * r(NOTHING_SHARED)
    }

    fn total_of(&self, group: usize, set: usize) -> f64 {
        let r = |pair| self.moments(pair, set).correlation();
        let chance = self.first_order_of(group, set) * r(NOTHING_SHARED).unwrap_or(0.0);
        1.0 - (r(sharing_others(group)).unwrap_or(1.0) - chance)
    }

    /// Of `pair`, of all samples (0) or without a block (1 and up).
    fn moments(&self, pair: usize, set: usize) -> Moments {
        self.moments[pair * (1 + self.blocks) + set]
    }

    /// The estimate from all blocks, with the error that its change tells of where each is left out in turn
    /// (Tukey 1958).
    fn jackknife(&self, estimate: impl Fn(usize) -> f64) -> Share {
        let n = self.blocks as f64;
        let without: Vec<f64> = (1..=self.blocks).map(&estimate).collect();
        let mean = without.iter().sum::<f64>() / n;
        let squares: f64 = without.iter().map(|x| (x - mean) * (x - mean)).sum();
        Share { value: estimate(0), error: ((n - 1.0) / n * squares).sqrt() }
    }
}

/// A number between zero and one, but for its error.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Share {
    /// The estimate.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}
