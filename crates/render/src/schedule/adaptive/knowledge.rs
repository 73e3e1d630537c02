use super::{
    noise::{brightness, relative},
    plan::Plan,
    stage::Stage,
};
use tenfold_math::ops;

/// By how much faster than the number of samples in a round the variance of its mean is taken to fall at most: as a power of
/// that number. Well-spread samples of a smooth integrand reach 2 (Owen 1997), pictures hardly more than this.
const LARGEST_GAIN: f64 = 0.3;

/// That power before anything is known, and the octaves of growth of the rounds that it counts as much as.
const PRESUMED_GAIN: f64 = 0.1;
const PRESUMED_OCTAVES: f64 = 2.0;

/// What the stages so far have taught: it steers the next one, and has no part in the picture.
#[derive(Clone, Debug)]
pub(super) struct Knowledge {
    width: usize,
    /// Samples of the last stage.
    last: u64,
    /// The relative standard error of the squared noise of the last stage.
    doubt: f64,
    /// Mean over the pixels of the level of the rounds.
    level: f64,
    /// Octaves by which rounds have grown from what was known to the next stage, added up.
    octaves: f64,
    /// By how many octaves the variances of the latter were below those predicted without a gain.
    gained: f64,
    pixels: Vec<PixelKnowledge>,
}

#[derive(Copy, Clone, Debug, Default)]
struct PixelKnowledge {
    /// Samples taken.
    spent: u32,
    /// Sum over the stages of samples times mean luminance.
    luminance: f64,
    /// Sum over the stages of samples times the variance of one sample.
    variance: f64,
    /// Sum over the stages of samples times level.
    level: f64,
}

impl Knowledge {
    /// Nothing known of `pixels` pixels in rows of `width`.
    pub(super) fn new(pixels: usize, width: usize) -> Self {
        Self {
            width,
            last: 0,
            doubt: 0.0,
            level: 0.0,
            octaves: 0.0,
            gained: 0.0,
            pixels: vec![PixelKnowledge::default(); pixels],
        }
    }

    /// After a stage of `spent` samples of every pixel in rows of `width`, with mean luminance 1 and these variances of one
    /// sample.
    #[cfg(test)]
    pub(super) fn of(width: usize, variances: &[f64], spent: u32) -> Self {
        let n = f64::from(spent);
        let level = ops::log2(n / 4.0);
        let pixel =
            |variance: &f64| PixelKnowledge { spent, luminance: n, variance: n * variance, level: n * level };
        let last = u64::from(spent) * variances.len() as u64;
        Self { last, level, pixels: variances.iter().map(pixel).collect(), ..Self::new(0, width) }
    }

    /// Learns from a stage that has been done in full.
    pub(super) fn add(&mut self, plan: &Plan, stage: &Stage) {
        let moments = stage.moments();
        let variances = moments.variances().unwrap_or_else(|| vec![0.0; self.pixels.len()]);
        if self.last > 0 {
            self.learn_gain(plan, &variances);
        }
        self.last = plan.samples();
        self.doubt = stage.noise().and_then(|noise| noise.doubt()).unwrap_or(0.0);
        for (p, (luminance, variance)) in moments.luminance().into_iter().zip(variances).enumerate() {
            let n = plan.samples_of(p);
            let pixel = &mut self.pixels[p];
            pixel.spent = pixel.spent.saturating_add(n);
            pixel.luminance += f64::from(n) * luminance;
            pixel.variance += f64::from(n) * (f64::from(n) * variance);
            pixel.level += f64::from(n) * f64::from(plan.levels[p]);
        }
        self.level = self.pixels.iter().map(|p| p.level / f64::from(p.spent.max(1))).sum::<f64>()
            / self.pixels.len().max(1) as f64;
    }

    /// Compares the variances of a stage with what was predicted.
    fn learn_gain(&mut self, plan: &Plan, variances: &[f64]) {
        let found = relative(variances, &self.brightness()).into_iter().sum::<f64>();
        let predicted = self.relative_variances().into_iter().enumerate();
        let predicted = predicted.map(|(p, v)| v / f64::from(plan.samples_of(p))).sum::<f64>();
        let gained = ops::log2(predicted / found);
        if gained.is_finite() {
            self.octaves += plan.mean_level() - self.level;
            self.gained += gained;
        }
    }

    /// The relative standard error of what is known of the variances altogether.
    pub(super) fn doubt(&self) -> f64 {
        self.doubt
    }

    /// The part of the variance that is expected of a stage with this mean level, of what follows from the variances
    /// of single samples: larger rounds are spread better.
    pub(super) fn gain(&self, level: f64) -> f64 {
        let gained = self.gained + PRESUMED_GAIN * PRESUMED_OCTAVES;
        let exponent = (gained / (self.octaves.max(0.0) + PRESUMED_OCTAVES)).clamp(0.0, LARGEST_GAIN);
        ops::exp2(-exponent * (level - self.level).max(0.0))
    }

    /// Pixels in a row.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Samples taken of all pixels.
    pub(super) fn spent(&self) -> u64 {
        self.pixels.iter().map(|p| u64::from(p.spent)).sum()
    }

    /// Samples taken of a pixel.
    pub(super) fn spent_on(&self, pixel: usize) -> u32 {
        self.pixels[pixel].spent
    }

    /// Samples of the last stage.
    pub(super) fn last(&self) -> u64 {
        self.last
    }

    /// The variance of the luminance of one sample of each pixel, relative to the squared local brightness.
    pub(super) fn relative_variances(&self) -> Vec<f64> {
        relative(&self.mean(|p| p.variance), &self.brightness())
    }

    fn brightness(&self) -> Vec<f64> {
        brightness(&self.mean(|p| p.luminance), self.width)
    }

    /// A mean over the samples, of every pixel.
    fn mean(&self, of: impl Fn(&PixelKnowledge) -> f64) -> Vec<f64> {
        self.pixels.iter().map(|p| of(p) / f64::from(p.spent.max(1))).collect()
    }
}
