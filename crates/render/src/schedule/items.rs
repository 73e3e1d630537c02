use super::{DroppedSample, PixelEstimator, RenderSettings, Statistics, TileOrder};
use crate::{
    film::{Film, PixelBounds},
    integrator::Workspace,
};
use std::{
    num::NonZeroUsize,
    ops::Range,
    sync::atomic::{AtomicBool, AtomicUsize, Ordering},
};
use tenfold_math::UVec2;
use tenfold_sampling::{SampleRoom, Sampler};

/// Samples of a pixel that one work item takes at most.
pub(super) const BLOCK: u32 = 64;

/// Has the threads take all items with indices below `items`, in order, until `work` returns false for one.
pub(super) fn for_each_item(
    threads: Option<NonZeroUsize>,
    items: usize,
    work: &(impl Fn(usize) -> bool + Sync),
) {
    let next = AtomicUsize::new(0);
    let stop = AtomicBool::new(false);
    let take = || {
        while !stop.load(Ordering::Relaxed) {
            let item = next.fetch_add(1, Ordering::Relaxed);
            if item >= items {
                break;
            }
            if !work(item) {
                stop.store(true, Ordering::Relaxed);
            }
        }
    };
    let threads = threads.or_else(|| std::thread::available_parallelism().ok());
    std::thread::scope(|scope| {
        for _ in 1..threads.map_or(1, NonZeroUsize::get) {
            // Where the system gives no more threads, those there are do the work.
            if std::thread::Builder::new().spawn_scoped(scope, take).is_err() {
                break;
            }
        }
        take();
    });
}

/// Takes those samples of every pixel of `tile` that `samples` tells: a sampler, and indices.
pub(super) fn render_item<'a>(
    estimator: &PixelEstimator<'_>,
    tile: PixelBounds,
    samples: impl Fn(UVec2) -> (&'a Sampler, Range<u32>),
) -> (Film, Statistics) {
    let mut film = Film::new(tile);
    let mut statistics = Statistics::default();
    let mut workspace = Workspace::default();
    let mut room = SampleRoom::default();
    for pixel in tile.pixels() {
        let (sampler, indices) = samples(pixel);
        statistics.samples += indices.len() as u64;
        let sum = film.pixel_mut(pixel);
        sampler.for_groups(pixel, indices, &mut room, |group| {
            let rgb = estimator.samples(group, &mut workspace);
            for slot in sum.add_all(&rgb, group.slots()) {
                statistics.drop_sample(DroppedSample { pixel, index: group[slot].index() });
            }
        });
    }
    statistics.rays = workspace.rays;
    (film, statistics)
}

/// The tiles in the order in which they are rendered.
pub(super) fn ordered_tiles(settings: &RenderSettings) -> Vec<PixelBounds> {
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
