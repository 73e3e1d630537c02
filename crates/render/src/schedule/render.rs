use super::{
    PixelEstimator, RenderSettings, Statistics,
    adaptive::{self, NoiseReport},
    items::{BLOCK, for_each_item, ordered_tiles, render_item},
};
use crate::{film::Film, scene::Scene};
use std::{sync::Mutex, time::Instant};
use tenfold_sampling::Sampler;

/// How far a render is.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// Samples taken.
    pub done: u64,
    /// Samples to take: those foreseen, where that is found out on the way.
    pub total: u64,
    /// Seconds since the start.
    pub seconds: f64,
    /// Noise of the picture so far, where it is known (see [`NoiseReport::reached`]).
    pub noise: Option<f64>,
    /// Noise to reach, where the samples depend on it.
    pub target: Option<f64>,
}

/// A finished render.
#[derive(Debug)]
pub struct Render {
    /// What the pixels have received.
    pub film: Film,
    /// What it took.
    pub statistics: Statistics,
    /// Whether all samples were taken; false where the observer ended the render.
    pub complete: bool,
    /// The noise of the picture, where the settings had it measured.
    pub noise: Option<NoiseReport>,
}

/// Renders `scene`. Each finished piece of work is told to `observe`, from any thread, which returns whether to go
/// on.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    observe: &(dyn Fn(Progress) -> bool + Sync),
) -> Render {
    if let Some(limits) = &settings.noise {
        return adaptive::render(scene, settings, limits, observe);
    }
    let start = Instant::now();
    let tiles = ordered_tiles(settings);
    let blocks = settings.spp.div_ceil(BLOCK).max(1) as usize;
    let total = settings.bounds.area() as u64 * settings.spp as u64;
    let shared = Mutex::new((Film::new(settings.bounds), Statistics::default()));
    let sampler = Sampler::new(settings.sampling, settings.spp, settings.seed);
    let estimator = PixelEstimator::new(scene, settings);
    for_each_item(settings.threads, tiles.len() * blocks, &|item| {
        // All tiles get their first block before any gets its second: the whole picture refines together.
        let tile = tiles[item % tiles.len()];
        let first = (item / tiles.len()) as u32 * BLOCK;
        let last = first.saturating_add(BLOCK).min(settings.spp);
        let (film, statistics) = render_item(&estimator, tile, |_| (&sampler, first..last));
        let mut shared = shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        shared.0.merge(&film);
        shared.1.merge(statistics);
        let done = shared.1.samples;
        drop(shared);
        observe(Progress { done, total, seconds: start.elapsed().as_secs_f64(), ..Progress::default() })
    });
    let (film, mut statistics) = shared.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    statistics.seconds = start.elapsed().as_secs_f64();
    Render { film, complete: statistics.samples == total, statistics, noise: None }
}
