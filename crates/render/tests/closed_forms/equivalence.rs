//! One picture, bit for bit, however its work is divided.

use super::combined::everything;
use super::common::{film, scene};
use std::num::NonZeroUsize;
use tenfold_math::UVec2;
use tenfold_render::film::{Film, PixelBounds};
use tenfold_render::integrator::Workspace;
use tenfold_render::scene::Scene;
use tenfold_render::schedule::{PixelEstimator, RenderSettings, TileOrder};
use tenfold_sampling::{SampleRoom, Sampler};

/// More samples than one piece of work takes.
const SPP: u32 = 70;

#[test]
fn threads_tiles_and_orders_do_not_matter() {
    let scene = everything();
    let rendered = |threads: usize, side: u32, order: TileOrder| {
        film(&scene, |s| {
            (s.spp, s.threads, s.tile_side, s.tile_order) = (SPP, NonZeroUsize::new(threads), side, order);
        })
    };
    let want = rendered(1, 16, TileOrder::Rows);
    assert_eq!(want.samples(), u64::from(SPP) * 24 * 16);
    for (threads, side, order) in [
        (2, 1, TileOrder::Centre),
        (3, 7, TileOrder::Reverse),
        (2, 16, TileOrder::Centre),
        (1, 64, TileOrder::Reverse),
        (3, 64, TileOrder::Rows),
    ] {
        assert!(rendered(threads, side, order) == want, "{threads} threads, tiles of {side}, {order:?}");
    }
}

#[test]
fn parts_make_up_the_whole() {
    let scene = everything();
    let part = |min: [u32; 2], max: [u32; 2]| {
        let bounds = PixelBounds { min: UVec2::from_array(min), max: UVec2::from_array(max) };
        film(&scene, |s| s.bounds = bounds)
    };
    let whole = part([0, 0], [24, 16]);
    let mut merged = Film::new(scene.film.bounds);
    for (min, max) in [([0, 0], [11, 16]), ([11, 0], [24, 5]), ([11, 5], [24, 16])] {
        merged.merge(&part(min, max));
    }
    assert!(merged == whole);
    // A pixel by itself is that of the whole picture.
    for pixel in [[0, 0], [7, 9], [23, 15]] {
        let alone = part(pixel, pixel.map(|c| c + 1));
        let pixel = UVec2::from_array(pixel);
        assert_eq!(alone.pixel(pixel), whole.pixel(pixel));
    }
}

/// Whichever samples are traced together, each is what it is alone.
#[test]
fn company_does_not_matter() {
    // With a hierarchy, and with so few primitives that there is none.
    let scenes = [everything(), scene(include_str!("few.pbrt"))];
    scenes.iter().for_each(all_samples_are_what_they_are_alone);
}

fn all_samples_are_what_they_are_alone(scene: &Scene) {
    let settings = RenderSettings { spp: SPP, ..RenderSettings::of(scene) };
    let estimator = PixelEstimator::new(scene, &settings);
    let sampler = Sampler::new(settings.sampling, SPP, 3);
    let (mut room, mut workspace) = (SampleRoom::default(), Workspace::default());
    for pixel in scene.film.bounds.pixels().step_by(7) {
        for indices in [0..SPP, 5..12, 30..31] {
            sampler.for_groups(pixel, indices, &mut room, |group| {
                let together = estimator.samples(group, &mut workspace);
                for (slot, sample) in group.iter().enumerate() {
                    let alone = estimator.sample(&sampler.at(pixel, sample.index()), &mut workspace);
                    assert_eq!(together.get(slot), alone, "{pixel}, sample {}", sample.index());
                }
            });
        }
    }
}
