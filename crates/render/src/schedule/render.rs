use super::{DroppedSample, PixelEstimator, RenderSettings, Statistics, TileOrder};
use crate::{
    film::{Film, PixelBounds},
    integrator::Workspace,
    scene::Scene,
};
use std::{
    num::NonZeroUsize,
    sync::{
        Mutex,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    time::Instant,
};
use tenfold_sampling::Sampler;

/// Samples of a pixel that one work item takes.
const BLOCK: u32 = 64;

/// How far a render is.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Progress {
    /// Samples taken.
    pub done: u64,
    /// Samples to take.
    pub total: u64,
    /// Seconds since the start.
    pub seconds: f64,
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
}

/// Renders `scene`. Each finished piece of work is told to `observe`, from any thread, which returns whether to go
/// on.
pub fn render(
    scene: &Scene,
    settings: &RenderSettings,
    observe: &(dyn Fn(Progress) -> bool + Sync),
) -> Render {
    let start = Instant::now();
    let tiles = ordered_tiles(settings);
    let blocks = settings.spp.div_ceil(BLOCK).max(1) as usize;
    let items = tiles.len() * blocks;
    let total = settings.bounds.area() as u64 * settings.spp as u64;

    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let shared = Mutex::new((Film::new(settings.bounds), Statistics::default()));
    let sampler = Sampler::new(settings.sampling, settings.spp, settings.seed);
    let estimator = PixelEstimator::new(scene, settings);
    let work = || {
        while !stop.load(Ordering::Relaxed) {
            let item = next.fetch_add(1, Ordering::Relaxed);
            if item >= items {
                break;
            }
            // All tiles get their first block before any gets its second: the whole picture refines together.
            let tile = tiles[item % tiles.len()];
            let first = (item / tiles.len()) as u32 * BLOCK;
            let last = first.saturating_add(BLOCK).min(settings.spp);
            let (film, statistics) = render_item(&estimator, &sampler, tile, first..last);
            let mut shared = shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            shared.0.merge(&film);
            shared.1.merge(statistics);
            let done = shared.1.samples;
            drop(shared);
            if !observe(Progress { done, total, seconds: start.elapsed().as_secs_f64() }) {
                stop.store(true, Ordering::Relaxed);
            }
        }
    };
    let threads = settings.threads.or_else(|| std::thread::available_parallelism().ok());
    std::thread::scope(|scope| {
        for _ in 1..threads.map_or(1, NonZeroUsize::get) {
            // Where the system gives no more threads, those there are do the work.
            if std::thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });

    let (film, mut statistics) = shared.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    statistics.seconds = start.elapsed().as_secs_f64();
    Render { film, complete: statistics.samples == total, statistics }
}

/// Takes the samples with indices in `indices` of every pixel of `tile`.
fn render_item(
    estimator: &PixelEstimator<'_>,
    sampler: &Sampler,
    tile: PixelBounds,
    indices: std::ops::Range<u32>,
) -> (Film, Statistics) {
    let mut film = Film::new(tile);
    let mut statistics = Statistics::default();
    let mut workspace = Workspace::default();
    for pixel in tile.pixels() {
        let sum = film.pixel_mut(pixel);
        for index in indices.clone() {
            let rgb = estimator.sample(&sampler.at(pixel, index), &mut workspace);
            if !sum.add(rgb) {
                statistics.drop_sample(DroppedSample { pixel, index });
            }
        }
    }
    statistics.rays = workspace.rays;
    statistics.samples = tile.area() as u64 * indices.len() as u64;
    (film, statistics)
}

/// The tiles in the order in which they are rendered.
fn ordered_tiles(settings: &RenderSettings) -> Vec<PixelBounds> {
    let mut tiles = settings.bounds.tiles(settings.tile_side.max(1));
    match settings.tile_order {
        TileOrder::Rows => {}
        TileOrder::Reverse => tiles.reverse(),
        TileOrder::Centre => {
            let middle = settings.bounds.min.as_vec2() + 0.5 * settings.bounds.size().as_vec2();
            let distance = |t: &PixelBounds| (0.5 * (t.min + t.max).as_vec2()).distance_squared(middle);
            tiles.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        }
    }
    tiles
}
