//! Textures made of textures.

use super::*;
use tenfold_math::{Vec3, vec2};
use tenfold_testkit::Rng;

fn ramp(textures: &mut Textures) -> FloatSlot {
    // The value is u.
    let corners = [0.0, 0.0, 1.0, 1.0];
    FloatSlot::Texture(
        textures.add_float(FloatTexture::Bilerp(Bilerp { mapping: Mapping2::default(), corners })),
    )
}

#[test]
fn numbers_are_scaled_and_mixed() {
    let mut t = Textures::default();
    let u = ramp(&mut t);
    let scaled = Scale { texture: u, scale: FloatSlot::Constant(3.0) };
    let scaled = FloatSlot::Texture(t.add_float(FloatTexture::Scale(scaled)));
    let square = FloatSlot::Texture(t.add_float(FloatTexture::Scale(Scale { texture: u, scale: u })));
    let mix = Mix { textures: [FloatSlot::Constant(10.0), scaled], amount: u };
    let mix = FloatSlot::Texture(t.add_float(FloatTexture::Mix(mix)));
    for x in [0.0, 0.25, 0.5, 1.0] {
        let at = TextureContext::at_uv(vec2(x, 0.7));
        let near =
            |slot: &FloatSlot, want: f32| assert!((t.float(slot, &at) - want).abs() < 1e-5, "{slot:?}");
        near(&u, x);
        near(&scaled, 3.0 * x);
        near(&square, x * x);
        near(&mix, (1.0 - x) * 10.0 + x * 3.0 * x);
    }
}

#[test]
fn directions_choose() {
    let mut t = Textures::default();
    let mix =
        DirectionMix { textures: [FloatSlot::Constant(4.0), FloatSlot::Constant(8.0)], direction: Vec3::Z };
    let mix = FloatSlot::Texture(t.add_float(FloatTexture::DirectionMix(mix)));
    let at = |n: Vec3| TextureContext { n, ..TextureContext::default() };
    assert_eq!(t.float(&mix, &at(Vec3::Z)), 4.0);
    assert_eq!(t.float(&mix, &at(Vec3::NEG_Z)), 4.0);
    assert_eq!(t.float(&mix, &at(Vec3::X)), 8.0);
    assert!((t.float(&mix, &at(Vec3::new(0.0, 0.8, 0.6))) - 5.6).abs() < 1e-6);
}

#[test]
fn spectra_are_scaled_mixed_and_laid_out() {
    let w = SampledWavelengths::sample_visible(0.3);
    let red =
        Spectrum::RgbAlbedo(tenfold_spectrum::RgbAlbedo::new(RgbColorSpace::srgb(), Rgb::new(0.8, 0.1, 0.1)));
    let (red_values, half) = (red.sample(&w), SampledSpectrum::splat(0.5));
    let mut t = Textures::default();
    let u = ramp(&mut t);
    let [red, grey] = [red, Spectrum::Constant(0.5)].map(SpectrumSlot::Constant);
    let scaled = t.add_spectrum(SpectrumTexture::Scale(Scale { texture: red.clone(), scale: u }));
    let mix = t.add_spectrum(SpectrumTexture::Mix(Mix { textures: [red.clone(), grey.clone()], amount: u }));
    let board = Checkerboard {
        board: Board::Squares(Mapping2::Uv { scale: vec2(4.0, 4.0), delta: vec2(0.0, 0.0) }),
        textures: [red, SpectrumSlot::Texture(mix)],
    };
    let board = t.add_spectrum(SpectrumTexture::Checkerboard(board));
    for (x, on_second) in [(0.0, false), (0.2, false), (0.3, true), (0.7, false), (0.9, true)] {
        let at = TextureContext::at_uv(vec2(x, 0.1));
        let near = |id, want: SampledSpectrum| {
            let got = t.spectrum(&SpectrumSlot::Texture(id), &at, &w);
            assert!((got - want).0.abs().max_element() < 1e-6, "{id:?} at {x}");
        };
        let mixed = red_values * (1.0 - x) + half * x;
        near(scaled, red_values * x);
        near(mix, mixed);
        near(board, if on_second { mixed } else { red_values });
    }
    assert_eq!(grey.constant(), Some(&Spectrum::Constant(0.5)));
    assert_eq!(SpectrumSlot::Texture(mix).constant(), None);
}

#[test]
fn a_texture_without_weight_is_not_looked_at() {
    let mut t = Textures::default();
    let infinite = FloatSlot::Constant(f32::INFINITY);
    let zero = FloatSlot::Constant(0.0);
    let scale = t.add_float(FloatTexture::Scale(Scale { texture: infinite, scale: zero }));
    let mix =
        t.add_float(FloatTexture::Mix(Mix { textures: [infinite, zero], amount: FloatSlot::Constant(1.0) }));
    for id in [scale, mix] {
        assert_eq!(t.float(&FloatSlot::Texture(id), &TextureContext::default()), 0.0);
    }
}

/// Where a spectrum is settled, it is what the texture has there; and not only where it is the same everywhere.
#[test]
fn settled_spectra_are_those_of_the_texture() {
    let mut textures = Textures::default();
    let constant = |v: f32| SpectrumSlot::Constant(Spectrum::Constant(v));
    let board = || Board::Squares(Mapping2::default());
    let checks = Checkerboard { board: board(), textures: [constant(0.2), constant(0.7)] };
    let checks = textures.add_spectrum(SpectrumTexture::Checkerboard(checks));
    let checks = SpectrumSlot::Texture(checks);
    let nested = Checkerboard { board: board(), textures: [checks.clone(), constant(0.9)] };
    let nested = SpectrumSlot::Texture(textures.add_spectrum(SpectrumTexture::Checkerboard(nested)));
    let dots = Dots { mapping: Mapping2::default(), inside: constant(0.1), outside: checks.clone() };
    let dots = SpectrumSlot::Texture(textures.add_spectrum(SpectrumTexture::Dots(dots)));
    let w = SampledWavelengths::sample_visible(0.3);
    let mut rng = Rng::new(5);
    for (slot, least, most) in
        [(&constant(0.4), 1000, 1000), (&checks, 700, 950), (&nested, 300, 550), (&dots, 10, 600)]
    {
        let mut settled = 0;
        for _ in 0..1000 {
            // Some see a border.
            let width = if rng.below(4) == 0 { 0.3 } else { 0.0 };
            let footprint = Footprint { dudx: width, dvdy: width, ..Footprint::default() };
            let at = TextureContext { footprint, ..TextureContext::at_uv(rng.vec2() * 8.0) };
            if let Some(spectrum) = textures.settle(slot, &at) {
                assert_eq!(spectrum.sample(&w), textures.spectrum(slot, &at, &w));
                settled += 1;
            }
        }
        assert!((least..=most).contains(&settled), "{slot:?}: {settled}");
    }
}
