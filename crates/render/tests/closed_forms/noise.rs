//! Renders to a target of noise: what they state is true, and their pictures are those of uniform sampling.

use super::combined::everything;
use super::common::{SIGNIFICANCE, luma, scene};
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, Ordering};
use tenfold_render::scene::Scene;
use tenfold_render::schedule::{
    Allocation, NoiseSettings, Render, RenderSettings, Stop, TileOrder, relative_error, render,
};
use tenfold_testkit::{Welford, t_test_mean, t_test_two};

const WIDTH: usize = 24;
const HEIGHT: usize = 16;

/// A floor under a light that is smaller than a pixel and brighter than all else: it is in the picture, and a mirror and a
/// glass ball throw it onto the floor. Half of the picture is nearly free of noise.
fn tiny_bright_light() -> Scene {
    scene(&format!(
        r#"Film "rgb" "integer xresolution" {WIDTH} "integer yresolution" {HEIGHT}
        PixelFilter "box" Integrator "path" "integer maxdepth" 4
        LookAt 0 2 6  0 0.9 0  0 1 0 Camera "perspective" "float fov" 40 WorldBegin
        LightSource "infinite" "rgb L" [ 0.2 0.2 0.2 ]
        AttributeBegin
          Translate 0.6 1.9 0.4
          AreaLightSource "diffuse" "rgb L" [ 2200 2000 1800 ] Shape "sphere" "float radius" 0.02
        AttributeEnd
        Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
        Shape "bilinearmesh" "point3 P" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]
        AttributeBegin
          Translate 1.2 0.6 0 Material "conductor" "float roughness" 0.05 Shape "sphere" "float radius" 0.6
        AttributeEnd"#
    ))
}

fn rendered(scene: &Scene, noise: NoiseSettings, seed: u64) -> Render {
    let settings = RenderSettings { noise: Some(noise), seed, ..RenderSettings::of(scene) };
    let done = render(scene, &settings, &|_| true);
    assert!(done.complete);
    assert_eq!(done.statistics.dropped, 0, "{:?}", done.statistics.first_dropped);
    done
}

fn target(target: f64) -> NoiseSettings {
    NoiseSettings { target: Some(target), ..NoiseSettings::default() }
}

fn luminances(render: &Render) -> Vec<f64> {
    render.film.means().into_iter().map(luma).collect()
}

#[test]
fn threads_tiles_and_orders_do_not_matter() {
    let scene = everything();
    let rendered = |threads: usize, side: u32, order: TileOrder| {
        let mut settings = RenderSettings { noise: Some(target(0.1)), ..RenderSettings::of(&scene) };
        settings.threads = NonZeroUsize::new(threads);
        (settings.tile_side, settings.tile_order) = (side, order);
        render(&scene, &settings, &|_| true)
    };
    let want = rendered(1, 16, TileOrder::Rows);
    let counts = || want.film.sums().iter().map(|sum| sum.samples());
    assert!(counts().max() > counts().min(), "nothing was adapted");
    for (threads, side, order) in [(3, 7, TileOrder::Centre), (2, 64, TileOrder::Reverse)] {
        let other = rendered(threads, side, order);
        assert!(other.film == want.film && other.noise == want.noise, "{threads} threads, tiles of {side}");
    }
}

#[test]
fn limits_are_kept() {
    let scene = tiny_bright_light();
    for (min_spp, max_spp) in [(1, 1), (3, 5), (4, 40), (16, 100), (1, 200), (32, 300)] {
        let limits = NoiseSettings { min_spp, max_spp, ..target(1e-6) };
        let done = rendered(&scene, limits, 1);
        let report = done.noise.unwrap();
        assert_eq!(report.stop, Stop::MostSamples);
        assert!(done.statistics.samples <= u64::from(max_spp) * (WIDTH * HEIGHT) as u64);
        for sum in done.film.sums() {
            assert!((min_spp..=max_spp).contains(&sum.samples()), "{} of {limits:?}", sum.samples());
        }
        // Few samples are no reason to make use of fewer still.
        assert!(
            done.statistics.samples * 10 >= u64::from(max_spp) * (WIDTH * HEIGHT) as u64 * 6,
            "{limits:?}"
        );
    }
    let uniform = NoiseSettings { allocation: Allocation::Uniform, ..target(0.1) };
    let done = rendered(&scene, uniform, 1);
    assert!(done.film.sums().iter().all(|sum| sum.samples() == done.film.sums()[0].samples()));
}

#[test]
fn renders_say_why_they_ended() {
    let scene = tiny_bright_light();
    // One thread alone: with more, all tiles of a round may be under way when it is to end.
    let threads = NonZeroUsize::new(1);
    let stop = |limits| {
        let settings = RenderSettings { noise: Some(limits), threads, ..RenderSettings::of(&scene) };
        render(&scene, &settings, &|_| true).noise.unwrap()
    };
    let reached = stop(target(0.3));
    assert_eq!((reached.stop, reached.target), (Stop::Target, Some(0.3)));
    // One round there is in any case.
    let late = stop(NoiseSettings { time_limit: Some(1e-9), ..NoiseSettings::default() });
    assert!(late.stop == Stop::TimeLimit && late.reached.is_none() && late.standard_errors.is_none());
    let limited = stop(NoiseSettings { time_limit: Some(0.3), ..NoiseSettings::default() });
    assert!(limited.stop == Stop::TimeLimit && limited.reached.unwrap().value > 0.0);

    // Within the second round, and within the picture's.
    let settings = RenderSettings { noise: Some(target(1e-6)), threads, ..RenderSettings::of(&scene) };
    for most in [(WIDTH * HEIGHT * 6) as u64, 100_000] {
        let taken = AtomicU64::new(0);
        let ended = render(&scene, &settings, &|progress| {
            taken.store(progress.done, Ordering::Relaxed);
            progress.done < most
        });
        let report = ended.noise.unwrap();
        assert!(!ended.complete && report.stop == Stop::Interrupted);
        assert_eq!(report.reached.is_some(), most > 10_000);
        // All pixels have whole rounds.
        assert!(ended.film.sums().iter().all(|sum| sum.samples() >= 4));
        assert_eq!(ended.statistics.samples, taken.into_inner());
    }
}

/// Runs of the tests of mean pictures.
const RUNS: u64 = 64;

/// Edge length, in pixels, of the tiles whose means are compared.
const TILE: usize = 4;

/// Moments over many runs of the mean luminances of tiles.
fn tiles(run: impl Fn(u64) -> Vec<f64>) -> Vec<Welford> {
    let mut tiles = vec![Welford::new(); WIDTH / TILE * HEIGHT / TILE];
    for i in 0..RUNS {
        let mut sums = vec![0.0; tiles.len()];
        for (p, value) in run(i).into_iter().enumerate() {
            sums[p / WIDTH / TILE * (WIDTH / TILE) + p % WIDTH / TILE] += value / (TILE * TILE) as f64;
        }
        tiles.iter_mut().zip(sums).for_each(|(tile, sum)| tile.add(sum));
    }
    tiles
}

/// Neither the choice of pixels nor the time to stop shows in the mean picture: the means of tiles over many renders are
/// those of uniform renders whose samples were counted beforehand. An estimator that goes on until it looks good does not
/// stand this test.
#[test]
fn the_mean_picture_is_that_of_uniform_sampling() {
    let scene = tiny_bright_light();
    let counted = |spp, seed| {
        luminances(&render(&scene, &RenderSettings { spp, seed, ..RenderSettings::of(&scene) }, &|_| true))
    };
    let uniform = tiles(|run| counted(96, 2000 + run));
    let differing = |what: &[Welford]| {
        what.iter().zip(&uniform).filter(|(a, b)| !t_test_two(a, b).passes(SIGNIFICANCE, what.len())).count()
    };
    let adaptive = tiles(|run| luminances(&rendered(&scene, target(0.25), 1000 + run)));
    assert_eq!(differing(&adaptive), 0);

    let until_it_looks_good = tiles(|run| {
        let mut pixels = vec![Welford::new(); WIDTH * HEIGHT];
        for round in 1..=64 {
            let values = counted(4, 100 * run + round);
            pixels.iter_mut().zip(values).for_each(|(pixel, value)| pixel.add(value));
            let mean = |of: fn(&Welford) -> f64| pixels.iter().map(of).sum::<f64>() / pixels.len() as f64;
            let brightness = mean(|p| p.mean);
            if round >= 2 && mean(|p| p.variance_of_mean()) <= (0.25 * brightness).powi(2) {
                break;
            }
        }
        pixels.iter().map(|p| p.mean).collect()
    });
    assert!(differing(&until_it_looks_good) > 0);
}

/// The squares of the true error and of the stated one agree in the mean, and the stated intervals hold the truth about as often
/// as they say.
#[test]
fn the_stated_noise_is_the_true_one() {
    let scene = everything();
    let long = RenderSettings { spp: 4096, seed: 99, ..RenderSettings::of(&scene) };
    let reference: Vec<f64> = render(&scene, &long, &|_| true).film.means().into_iter().map(luma).collect();
    let mut difference = Welford::new();
    let mut stated = Welford::new();
    for run in 0..24 {
        let done = rendered(&scene, target(0.1), run);
        let reached = done.noise.as_ref().and_then(|n| n.reached).unwrap();
        let error = relative_error(&luminances(&done), &reference, 24);
        difference.add(error * error - reached.value * reached.value);
        stated.add(reached.value * reached.value);
        let [low, high] = reached.interval.unwrap();
        assert!(low < reached.value && reached.value < high);
    }
    let blunt = difference.standard_error() / stated.mean;
    assert!(blunt < 0.1, "a standard error of {blunt} says little");
    t_test_mean(&difference, 0.0).check("squared error", SIGNIFICANCE, 1);
}
