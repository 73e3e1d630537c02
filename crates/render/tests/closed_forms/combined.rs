//! Every effect at once.

use super::common::{Files, SIGNIFICANCE, channels, film, scene_with};
use tenfold_image::{Format, Image, WriteOptions};
use tenfold_render::scene::Scene;
use tenfold_sampling::SamplerKind;
use tenfold_testkit::image::{Pair, check_tiles};

/// A scene with every effect, 24 × 16 pixels.
pub(crate) fn everything() -> Scene {
    let pattern = |x: u32, y: u32| {
        let bright = if (x + y).is_multiple_of(2) { 1.5 } else { 0.2 };
        [bright, 0.8 * bright, 0.3 + 0.1 * y as f32]
    };
    let image = Image::from_fn(6, 4, ["R", "G", "B"], pattern).unwrap();
    let files = Files::one("light.pfm", image.to_bytes(Format::Pfm, &WriteOptions::default()).unwrap());
    scene_with(include_str!("everything.pbrt"), &files)
}

/// How numbers are spread is a matter of noise alone: all samplers agree in the mean.
#[test]
fn samplers_agree_in_the_mean() {
    let scene = everything();
    let picture = |kind: SamplerKind, spp, seed| {
        let film = film(&scene, |s| (s.sampling, s.spp, s.seed) = (kind.into(), spp, seed));
        channels(&film.means())
    };
    let independent = picture(SamplerKind::Independent, 512, 1);
    for (i, kind) in SamplerKind::ALL.into_iter().filter(|k| *k != SamplerKind::Independent).enumerate() {
        let other = picture(kind, 256, 2 + i as u64);
        let pair = Pair { a: &independent, b: &other, width: 24, channels: 3 };
        check_tiles(kind.name(), pair, 8, SIGNIFICANCE);
    }
}

/// Seeds are different pictures of the same mean; and the same seed the same picture.
#[test]
fn seeds() {
    let scene = everything();
    let picture = |seed| film(&scene, |s| s.seed = seed);
    let (a, b) = (picture(1), picture(2));
    assert_eq!(a, picture(1));
    let differing = a.means().iter().zip(b.means()).filter(|(a, b)| **a != *b).count();
    assert!(differing > 300, "{differing}");
}
