//! Who gets how many samples in the next stage, and whether it is the last.

use super::{
    Allocation, NoiseSettings, Stop,
    knowledge::Knowledge,
    noise::{box_mean, mean},
};
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
    let level_of = |p: usize, level: i32, rounds: u32| {
        let least = ceil_log2(limits.min_spp.div_ceil(rounds));
        bounded(level + offsets[p], least, limits.max_spp.saturating_sub(knowledge.spent_on(p)) / rounds)
    };
    let pixels = variances.len() as f64;
    let aim = limits.target.map(|target| (AIM * target) * (AIM * target));
    let mut best: Option<Best> = None;
    let mut end = Stop::MostSamples;
    'search: for level in 0..=i32::from(HIGHEST_LEVEL) {
        let mut grows = false;
        for rounds in PICTURE_ROUNDS {
            let (mut samples, mut variance, mut levels) = (0, 0.0, 0);
            for (p, relative) in variances.iter().enumerate() {
                let level_of_pixel = level_of(p, level, rounds);
                let n = u64::from(rounds) << level_of_pixel;
                grows |= level_of(p, i32::MAX / 2, rounds) > level_of_pixel;
                levels += u64::from(level_of_pixel);
                samples += n;
                variance += relative / n as f64;
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
    let levels = (0..variances.len()).map(|p| level_of(p, level, rounds)).collect();
    Some(Plan { levels, rounds, end: Some(end), later: 0 })
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
