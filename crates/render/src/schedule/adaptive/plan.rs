//! Who gets how many samples in the next stage, and whether it is the last.

use super::{
    Allocation, NoiseSettings, Stop,
    knowledge::Knowledge,
    noise::{box_mean, mean},
};
use std::collections::BTreeMap;
use tenfold_math::ops;
use tenfold_sampling::neyman_shares;

/// Rounds of the stages that look around.
const SCOUTING_ROUNDS: u32 = 4;

/// Rounds of the picture: with that many rounds of a power of two, all counts of samples are within 9 % of one.
const PICTURE_ROUNDS: std::ops::Range<u32> = 6..12;

/// The picture is rendered when it takes at most this many times the samples of the scouting: that takes a sixteenth to
/// an eighth of them, then.
const REACH: f64 = 16.0;

/// The part of the target that is aimed at: the plan is made from an estimate.
const AIM: f64 = 0.97;

/// The part of the time left that is made use of: rounds that are not done in time are lost.
const PUNCTUALITY: f64 = 0.95;

/// Samples of a pixel in a round are at most 2 to this power.
const HIGHEST_LEVEL: u8 = 24;

/// How far around a pixel errors are averaged to tell its share of the samples: windows of 5 × 5 pixels.
const SMOOTHING: usize = 2;

/// A stage: independently scrambled rounds, with 2 to the power of its level samples for each pixel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    /// The level of each pixel.
    pub(super) levels: Vec<u8>,
    /// How often.
    pub(super) rounds: u32,
    /// Where it is the picture and not scouting: why it is not larger.
    pub(super) end: Option<Stop>,
    /// Samples expected of later stages.
    pub(super) later: u64,
}

/// What comes after a stage.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Next {
    /// Another stage.
    Stage(Plan),
    /// Nothing: there is no time for more than there is.
    Stop,
}

impl Plan {
    /// The first stage, which treats all pixels alike. It is the picture where no more is allowed than that takes.
    pub(super) fn first(limits: &NoiseSettings, pixels: usize) -> Self {
        let level = ceil_log2(limits.min_spp.div_ceil(SCOUTING_ROUNDS));
        let pilot = SCOUTING_ROUNDS.saturating_mul(1 << level);
        if limits.max_spp >= (2 * PICTURE_ROUNDS.end).max(pilot.saturating_mul(2)) {
            let later = 8 * u64::from(pilot) * pixels as u64;
            return Self { levels: vec![level; pixels], rounds: SCOUTING_ROUNDS, end: None, later };
        }
        let most = limits.max_spp.max(1);
        let samples = |rounds: u32| rounds << (most / rounds).ilog2();
        let rounds =
            (SCOUTING_ROUNDS.min(most)..PICTURE_ROUNDS.end.min(most + 1)).rev().max_by_key(|&r| samples(r));
        let rounds = rounds.unwrap_or(1);
        let level = (most / rounds).ilog2() as u8;
        Self { levels: vec![level; pixels], rounds, end: Some(Stop::MostSamples), later: 0 }
    }

    /// The stage after those of `knowledge`. `affordable` is how many samples a pixel there is time for.
    pub(super) fn next(knowledge: &Knowledge, limits: &NoiseSettings, affordable: Option<f64>) -> Next {
        let variances = knowledge.relative_variances();
        let offsets = match limits.allocation {
            Allocation::Uniform => vec![0; variances.len()],
            Allocation::Adaptive => level_offsets(&variances, knowledge.width()),
        };
        let affordable = affordable.map(|spp| PUNCTUALITY * spp);
        let Some(picture) = picture(knowledge, limits, &variances, &offsets, affordable) else {
            return Next::Stop;
        };
        let pixels = variances.len() as f64;
        let (spent, needed) = (knowledge.spent() as f64 / pixels, picture.samples() as f64 / pixels);
        if needed <= REACH * spent {
            // A picture that the time makes smaller than the last stage is not worth its while.
            let worth = picture.end != Some(Stop::TimeLimit) || needed > knowledge.last() as f64 / pixels;
            return if worth { Next::Stage(picture) } else { Next::Stop };
        }
        // As many as all stages before.
        let level = ops::log2(spent / f64::from(SCOUTING_ROUNDS)).round() as i32;
        let levels = offsets
            .iter()
            .enumerate()
            // At least half of what a pixel may have is left to the picture.
            .map(|(p, offset)| {
                let left = (limits.max_spp / 2).saturating_sub(knowledge.spent_on(p)) / SCOUTING_ROUNDS;
                bounded(level + offset, 0, left)
            })
            .collect();
        Next::Stage(Self { levels, rounds: SCOUTING_ROUNDS, end: None, later: picture.samples() })
    }

    /// Samples of a pixel.
    pub(super) fn samples_of(&self, pixel: usize) -> u32 {
        self.rounds << self.levels[pixel]
    }

    /// The mean level.
    pub(super) fn mean_level(&self) -> f64 {
        self.levels.iter().map(|&level| f64::from(level)).sum::<f64>() / self.levels.len().max(1) as f64
    }

    /// Samples of all pixels.
    pub(super) fn samples(&self) -> u64 {
        self.levels.iter().map(|&level| u64::from(self.rounds) << level).sum()
    }
}

/// The smallest stage that is expected to reach the target, or else the best that may be.
fn picture(
    knowledge: &Knowledge,
    limits: &NoiseSettings,
    variances: &[f64],
    offsets: &[i32],
    affordable: Option<f64>,
) -> Option<Plan> {
    struct Best {
        level: i32,
        rounds: u32,
        variance: f64,
    }
    let level_of = |kind: Kind, level: i32, rounds: u32| {
        let least = ceil_log2(limits.min_spp.div_ceil(rounds));
        bounded(level.saturating_add(kind.offset), least, limits.max_spp.saturating_sub(kind.spent) / rounds)
    };
    let kind_of = |p: usize| Kind { offset: offsets[p], spent: knowledge.spent_on(p) };
    // Pixels are of few kinds, and there are many plans to compare.
    let mut kinds = BTreeMap::<Kind, (u64, f64)>::new();
    for (p, variance) in variances.iter().enumerate() {
        let (count, sum) = kinds.entry(kind_of(p)).or_default();
        *count += 1;
        *sum += variance;
    }
    let pixels = variances.len() as f64;
    let aim = limits.target.map(|target| (AIM * target) * (AIM * target));
    let mut best: Option<Best> = None;
    let mut end = Stop::MostSamples;
    'search: for level in 0..=i32::from(HIGHEST_LEVEL) {
        let mut grows = false;
        for rounds in PICTURE_ROUNDS {
            let (mut samples, mut variance, mut levels) = (0, 0.0, 0);
            for (&kind, (count, sum)) in &kinds {
                let level_of_kind = level_of(kind, level, rounds);
                let n = u64::from(rounds) << level_of_kind;
                grows |= level_of(kind, i32::MAX, rounds) > level_of_kind;
                levels += count * u64::from(level_of_kind);
                samples += count * n;
                variance += sum / n as f64;
            }
            if affordable.is_some_and(|most| samples as f64 > most * pixels) {
                end = Stop::TimeLimit;
                break 'search;
            }
            // What is known with doubt had better be planned for with a reserve.
            let prediction = knowledge.gain(levels as f64 / pixels) * (1.0 + knowledge.doubt());
            let variance = variance / pixels * prediction;
            if best.as_ref().is_none_or(|best| variance < best.variance) {
                best = Some(Best { level, rounds, variance });
            }
            if aim.is_some_and(|aim| variance <= aim) {
                end = Stop::Target;
                break 'search;
            }
        }
        if !grows {
            break;
        }
    }
    let Best { level, rounds, .. } = best?;
    let levels = (0..variances.len()).map(|p| level_of(kind_of(p), level, rounds)).collect();
    Some(Plan { levels, rounds, end: Some(end), later: 0 })
}

/// What decides over the samples of a pixel, the scale of the plan aside.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    /// By how many levels it differs from the average pixel.
    offset: i32,
    /// Samples taken.
    spent: u32,
}

/// By how many levels each pixel differs from the average one.
fn level_offsets(variances: &[f64], width: usize) -> Vec<i32> {
    let mut smooth = box_mean(variances, width, SMOOTHING);
    // Few rounds tell little: part of the error may be anywhere.
    let anywhere = 0.1 * mean(&smooth);
    smooth.iter_mut().for_each(|v| *v = 0.9 * *v + anywhere);
    neyman_shares(&smooth).into_iter().map(|share| ops::log2(share).round() as i32).collect()
}

/// A level from `least` on, of a round of `most` samples at most.
fn bounded(level: i32, least: u8, most: u32) -> u8 {
    let highest = most.checked_ilog2().unwrap_or(0).min(HIGHEST_LEVEL.into()) as i32;
    level.max(least.into()).clamp(0, highest) as u8
}

/// The level of rounds of at least `n` samples.
fn ceil_log2(n: u32) -> u8 {
    (n.max(1).next_power_of_two().ilog2() as u8).min(HIGHEST_LEVEL)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 32;

    fn target(target: f64) -> NoiseSettings {
        NoiseSettings { target: Some(target), ..NoiseSettings::default() }
    }

    /// A picture of mean luminance 1, whose samples have these variances.
    fn known(variance: impl Fn(usize) -> f64, spent: u32) -> Knowledge {
        Knowledge::of(SIDE, &(0..SIDE * SIDE).map(variance).collect::<Vec<_>>(), spent)
    }

    fn stage(next: Next) -> Plan {
        match next {
            Next::Stage(plan) => plan,
            Next::Stop => panic!("no stage"),
        }
    }

    #[test]
    fn the_picture_has_the_samples_that_the_target_needs() {
        // Relative variance 1 / 1.01² of a sample.
        let knowledge = known(|_| 1.0, 64);
        for wanted in [0.1, 0.05, 0.04] {
            let plan = stage(Plan::next(&knowledge, &target(wanted), None));
            let needed = 1.0 / (1.01 * wanted * AIM).powi(2);
            let n = f64::from(plan.samples_of(0));
            assert_eq!(plan.end, Some(Stop::Target));
            // Steps of a sixth at most; larger rounds are presumed to gain a little.
            assert!((0.7 * needed..1.18 * needed).contains(&n), "{n} for {needed}");
            assert!(plan.levels.iter().all(|l| *l == plan.levels[0]));
        }
    }

    #[test]
    fn targets_far_away_are_scouted_for_first() {
        let plan = stage(Plan::next(&known(|_| 1.0, 64), &target(0.001), None));
        assert_eq!((plan.end, plan.samples()), (None, 64 * (SIDE * SIDE) as u64));
        assert!(plan.later > plan.samples());
    }

    #[test]
    fn samples_go_where_the_error_is() {
        let half = |p: usize| if p % SIDE < SIDE / 2 { 0.01 } else { 1.0 };
        let plan = stage(Plan::next(&known(half, 64), &target(0.05), None));
        let (calm, noisy) = (plan.samples_of(SIDE * 8 + 2), plan.samples_of(SIDE * 8 + SIDE - 3));
        // √(0.9 · 1 + 0.1 · 0.505) / √(0.9 · 0.01 + 0.1 · 0.505) = 4, to powers of two.
        assert_eq!(noisy, 4 * calm);
        let uniform = NoiseSettings { allocation: Allocation::Uniform, ..target(0.05) };
        let all_alike = stage(Plan::next(&known(half, 64), &uniform, None));
        assert!(all_alike.samples() > plan.samples());
    }

    #[test]
    fn time_and_most_samples_bound_the_picture() {
        let knowledge = known(|_| 1.0, 64);
        let plan = stage(Plan::next(&knowledge, &target(0.01), Some(500.0)));
        assert_eq!(plan.end, Some(Stop::TimeLimit));
        assert!((400..=475).contains(&plan.samples_of(0)));
        // Less than there is already.
        assert_eq!(Plan::next(&knowledge, &target(0.01), Some(40.0)), Next::Stop);
        let limits = NoiseSettings { max_spp: 1000, ..target(0.01) };
        let plan = stage(Plan::next(&knowledge, &limits, None));
        assert_eq!((plan.end, plan.samples_of(0)), (Some(Stop::MostSamples), 7 * 128));
    }

    #[test]
    fn first_stages_keep_to_small_limits() {
        for (min_spp, max_spp, samples, is_picture) in [
            (16, 1000, 16, false),
            (10, 1000, 16, false),
            (1, 1, 1, true),
            (1, 7, 7, true),
            (16, 30, 28, true),
        ] {
            let plan = Plan::first(&NoiseSettings { min_spp, max_spp, ..target(0.1) }, 4);
            assert_eq!((plan.samples(), plan.end.is_some()), (4 * samples, is_picture), "{max_spp}");
        }
    }
}
