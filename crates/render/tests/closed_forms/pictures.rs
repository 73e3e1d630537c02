//! Whole pictures against converged ones by pbrt-v4, tile by tile: see `references/README.md`.

use super::common::{SIGNIFICANCE, film, nearer, scene};
use std::num::NonZeroUsize;
use tenfold_image::{Format, Image};
use tenfold_math::{UVec2, Vec3};
use tenfold_render::film::PixelBounds;
use tenfold_testkit::Welford;
use tenfold_testkit::stats::t_test_mean;

/// Pixels on a side of a tile.
const TILE: u32 = 8;

/// Samples a pixel of the references.
const REFERENCE_SPP: f64 = 1024.0;

/// Renders, of a sample a pixel each, by which the noise is known.
const SEEDS: u64 = 32;

/// Compares a scene's picture with the tiles of its reference, and with its mean. What differs is noise, of either picture, which is
/// measured on the rendered one and taken to be alike; or at most `tolerance`, relative to the tile and a twentieth of the picture's mean.
fn check(name: &str, text: &str, reference: &[u8], tolerance: f64) {
    let scene = scene(text);
    let reference = Image::read_bytes(reference, Some(Format::Pfm), None).unwrap();
    let size = scene.film.resolution / TILE;
    assert_eq!((size.x, size.y), reference.resolution(), "{name}");
    let mut tiles = vec![[Welford::new(); 3]; (size.x * size.y) as usize];
    let mut whole = [Welford::new(); 3];
    for seed in 0..SEEDS {
        let film = film(&scene, |s| (s.spp, s.seed, s.threads) = (1, seed, NonZeroUsize::new(2)));
        let mut sum = Vec3::ZERO;
        for (i, moments) in tiles.iter_mut().enumerate() {
            let min = UVec2::new(i as u32 % size.x, i as u32 / size.x) * TILE;
            let tile = PixelBounds { min, max: min + TILE };
            let mean = tile.pixels().map(|p| film.pixel(p).mean()).sum::<Vec3>() / (TILE * TILE) as f32;
            (0..3).for_each(|c| moments[c].add(f64::from(mean[c])));
            sum += mean;
        }
        (0..3).for_each(|c| whole[c].add(f64::from(sum[c]) / tiles.len() as f64));
    }
    let mean = (0..3).map(|c| reference.mean(c)).sum::<f64>() / 3.0;
    let check = |what: &str, got: &Welford, want: f64, slack: f64, tests: usize| {
        let both = Welford { squares: got.squares * (1.0 + SEEDS as f64 / REFERENCE_SPP), ..*got };
        let test = t_test_mean(&nearer(&both, want, slack), want);
        let error = both.standard_error();
        assert!(
            test.passes(SIGNIFICANCE, tests),
            "{name}: {what} is {} ± {error} instead of {want}",
            got.mean
        );
    };
    for c in 0..3 {
        check(&format!("channel {c}"), &whole[c], reference.mean(c), 0.003 * mean, 3);
        for (i, moments) in tiles.iter().enumerate() {
            let (x, y) = (i as u32 % size.x, i as u32 / size.x);
            let want = f64::from(reference.rgb(x, y)[c]);
            // Where hardly any sample found light its mean is not normal: such a tile is dark, and that is all to say.
            let rare = moments[c].variance() > 4.0 * moments[c].mean.powi(2) || moments[c].mean == 0.0;
            let slack = if rare { 0.05 * mean } else { tolerance * (want + 0.05 * mean) };
            check(&format!("channel {c} of tile {x}, {y}"), &moments[c], want, slack, 3 * tiles.len());
        }
    }
}

macro_rules! pictures {
    ($($name:ident $file:literal $tolerance:literal),* $(,)?) => {
        $(#[test]
        fn $name() {
            let text = include_str!(concat!("references/", $file, ".pbrt"));
            let reference = include_bytes!(concat!("references/", $file, ".pfm"));
            check($file, text, reference, $tolerance);
        })*
    };
}

pictures! {
    soft_shadow "soft-shadow" 0.01,
    glossy "glossy" 0.02,
    motion_blur "motion-blur" 0.01,
    depth_of_field "depth-of-field" 0.02,
    cornell_box "cornell" 0.01,
}
