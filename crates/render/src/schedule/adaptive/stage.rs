use super::{
    NoiseSettings, Stop,
    moments::RoundMoments,
    noise::{Noise, brightness},
    plan::Plan,
};
use crate::{
    film::{Film, PixelBounds},
    scene::Scene,
    schedule::{
        PixelEstimator, Progress, RenderSettings, Statistics,
        items::{BLOCK, for_each_item, ordered_tiles, render_item},
    },
};
use std::{sync::Mutex, time::Instant};
use tenfold_sampling::{Sampler, hash};

/// The rounds of one stage that all pixels have.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    film: Film,
    moments: RoundMoments,
}

impl Stage {
    /// A stage without any rounds so far.
    pub(super) fn new(scene: &Scene, settings: &RenderSettings) -> Self {
        let luminance = scene.film.color_space.luminance_vector().0;
        Self {
            film: Film::new(settings.bounds),
            moments: RoundMoments::new(settings.bounds.area(), luminance),
        }
    }

    /// How the rounds differ.
    pub(super) fn moments(&self) -> &RoundMoments {
        &self.moments
    }

    /// The mean of the rounds as a picture.
    pub(super) fn into_film(self) -> Film {
        self.film
    }

    /// The noise of that picture; unknown below two rounds.
    pub(super) fn noise(&self) -> Option<Noise> {
        let width = self.film.bounds().size().x as usize;
        let variances = self.moments.variances()?;
        let differences = self.moments.differences();
        let brightness = brightness(&self.moments.luminance(), width);
        Some(Noise::estimate(&variances, differences.as_deref(), &brightness, width))
    }
}

/// What the threads make together of a round.
struct Shared {
    film: Film,
    statistics: Statistics,
    /// How many items are done.
    items: usize,
    stop: Option<Stop>,
}

/// Takes stages, and keeps count.
pub(super) struct Stages<'a> {
    scene: &'a Scene,
    settings: &'a RenderSettings,
    limits: &'a NoiseSettings,
    observe: &'a (dyn Fn(Progress) -> bool + Sync),
    estimator: PixelEstimator<'a>,
    tiles: Vec<PixelBounds>,
    start: Instant,
    statistics: Statistics,
    /// How many stages have been begun.
    count: u64,
    /// Samples a second in the last stage.
    rate: f64,
}

impl<'a> Stages<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        settings: &'a RenderSettings,
        limits: &'a NoiseSettings,
        observe: &'a (dyn Fn(Progress) -> bool + Sync),
    ) -> Self {
        Self {
            scene,
            settings,
            limits,
            observe,
            estimator: PixelEstimator::new(scene, settings),
            tiles: ordered_tiles(settings),
            start: Instant::now(),
            statistics: Statistics::default(),
            count: 0,
            rate: 0.0,
        }
    }

    /// Takes a stage, as many whole rounds of it as time and observer allow, and tells why there are not all.
    /// `before` is the picture until then.
    pub(super) fn take(&mut self, plan: &Plan, before: Option<&Stage>) -> (Stage, Option<Stop>) {
        let (start, done) = (self.start.elapsed().as_secs_f64(), self.statistics.samples);
        let total = done + plan.samples() + plan.later;
        // Stages are independent of each other, as seeds are.
        let seed = hash::combine(self.settings.seed, self.count);
        self.count += 1;
        let highest = plan.levels.iter().copied().max().unwrap_or(0);
        let samplers: Vec<Sampler> =
            (0..=highest).map(|level| Sampler::new(self.settings.sampling, 1 << level, seed)).collect();
        let mut stage = Stage::new(self.scene, self.settings);
        let mut noise = before.and_then(Stage::noise);
        for round in 0..plan.rounds {
            let progress = Progress {
                total,
                noise: noise.map(|n| n.value),
                target: self.limits.target,
                ..Progress::default()
            };
            // Without a single round there would be no picture.
            let hurry = before.is_some() || round > 0;
            match self.round(plan, round, &samplers, progress, hurry) {
                Ok(film) => {
                    stage.film.merge(&film);
                    stage.moments.add(&film);
                }
                Err(stop) => return (stage, Some(stop)),
            }
            noise = stage.noise().or(noise);
        }
        let seconds = self.start.elapsed().as_secs_f64() - start;
        self.rate = (self.statistics.samples - done) as f64 / seconds.max(1e-6);
        (stage, None)
    }

    /// Takes one round of all pixels.
    fn round(
        &mut self,
        plan: &Plan,
        round: u32,
        samplers: &[Sampler],
        progress: Progress,
        hurry: bool,
    ) -> Result<Film, Stop> {
        let bounds = self.settings.bounds;
        let blocks = samplers.last().map_or(1, Sampler::samples_per_pixel).div_ceil(BLOCK) as usize;
        let items = self.tiles.len() * blocks;
        let statistics = std::mem::take(&mut self.statistics);
        let shared = Mutex::new(Shared { film: Film::new(bounds), statistics, items: 0, stop: None });
        let lock = || shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        for_each_item(self.settings.threads, items, &|item| {
            let tile = self.tiles[item % self.tiles.len()];
            let first = (item / self.tiles.len()) as u32 * BLOCK;
            let (film, statistics) = render_item(&self.estimator, tile, |pixel| {
                let level = plan.levels[bounds.index(pixel)];
                let (count, offset) = (1 << level, round << level);
                (
                    &samplers[usize::from(level)],
                    offset + first.min(count)..offset + (first + BLOCK).min(count),
                )
            });
            let mut shared = lock();
            shared.film.merge(&film);
            shared.statistics.merge(statistics);
            shared.items += 1;
            let done = shared.statistics.samples;
            drop(shared);
            let seconds = self.start.elapsed().as_secs_f64();
            let stop = if !(self.observe)(Progress { done, seconds, ..progress }) {
                Some(Stop::Interrupted)
            } else {
                self.limits.time_limit.filter(|limit| hurry && seconds > *limit).map(|_| Stop::TimeLimit)
            };
            if stop.is_some() {
                lock().stop = stop;
            }
            stop.is_none()
        });
        let shared = shared.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        self.statistics = shared.statistics;
        match shared.stop {
            Some(stop) if shared.items < items => Err(stop),
            _ => Ok(shared.film),
        }
    }

    /// Samples a pixel that there is time for, where time is limited.
    pub(super) fn affordable_spp(&self) -> Option<f64> {
        let left = self.limits.time_limit? - self.start.elapsed().as_secs_f64();
        Some(self.rate * left.max(0.0) / self.settings.bounds.area().max(1) as f64)
    }

    /// What all stages took.
    pub(super) fn finish(self) -> Statistics {
        Statistics { seconds: self.start.elapsed().as_secs_f64(), ..self.statistics }
    }
}
