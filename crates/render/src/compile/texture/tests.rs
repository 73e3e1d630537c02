//! Textures as scene files describe them, and what is said about faulty ones.

use std::path::PathBuf;

use tenfold_image::{Format, Image, WriteOptions};
use tenfold_math::vec2;
use tenfold_scene::{Resources, Severity, SourceMap, read_pbrt_str};
use tenfold_spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};

use super::*;
use crate::texture::TextureContext;

/// One image, `grey.png`: 2 × 2, codes 0 and 51 above 102 and 255.
struct OneImage;

impl Resources for OneImage {
    fn load(&self, path: &str) -> std::io::Result<Vec<u8>> {
        if path != "grey.png" {
            return Err(std::io::ErrorKind::NotFound.into());
        }
        let codes = vec![0, 51, 102, 255];
        let image = Image::from_u8(2, 2, ["Y"], codes, ColorEncoding::Srgb).unwrap();
        Ok(image.to_bytes(Format::Png, &WriteOptions::default()).unwrap())
    }

    fn resolve(&self, path: &str) -> PathBuf {
        PathBuf::from(path)
    }
}

/// The textures of a scene, the slot of the texture `t` (of numbers and as a reflectance), and all messages.
struct Compiled {
    textures: Textures,
    float: Option<FloatSlot>,
    spectrum: Option<SpectrumSlot>,
    messages: Vec<(Severity, String)>,
}

fn compile(textures: &str) -> Compiled {
    let scene = format!(
        "WorldBegin\n{textures}\nMaterial \"dielectric\" \"texture roughness\" \"t\" \
         Material \"diffuse\" \"texture reflectance\" \"t\""
    );
    let mut sources = SourceMap::new();
    let (description, diagnostics) = read_pbrt_str("scene.pbrt", &scene, &OneImage, &mut sources);
    let cx = &mut Context::new(&diagnostics, &OneImage);
    let mut library = TextureLibrary::new(&description);
    let slot_of = |i: usize| description.materials[i].entity.params("material", &diagnostics);
    let has = |value| library.by_name.contains_key(&(value, "t"));
    let (is_float, is_spectrum) = (has(TextureValue::Float), has(TextureValue::Spectrum));
    let count = description.materials.len();
    let float = is_float.then(|| library.float(cx, &slot_of(count - 2), "roughness")).flatten();
    let albedo = SpectrumRole::Albedo;
    let spectrum =
        is_spectrum.then(|| library.spectrum(cx, &slot_of(count - 1), "reflectance", albedo)).flatten();
    let textures = library.finish(cx);
    let messages = diagnostics.to_vec().into_iter().map(|d| (d.severity, d.plain(&sources))).collect();
    Compiled { textures, float, spectrum, messages }
}

/// Compiles what must have no faults.
fn sound(textures: &str) -> Compiled {
    let compiled = compile(textures);
    assert!(compiled.messages.is_empty(), "{textures}: {:?}", compiled.messages);
    compiled
}

/// The one message about a faulty scene.
fn fault(textures: &str) -> String {
    let compiled = compile(textures);
    let [(severity, message)] = &compiled.messages[..] else { panic!("{textures}: {:?}", compiled.messages) };
    assert_eq!(*severity, Severity::Error, "{message}");
    message.clone()
}

impl Compiled {
    fn float(&self, u: f32, v: f32) -> f32 {
        self.textures.float(self.float.as_ref().unwrap(), &TextureContext::at_uv(vec2(u, v)))
    }

    fn spectrum(&self, u: f32, v: f32) -> SampledSpectrum {
        let at = TextureContext::at_uv(vec2(u, v));
        self.textures.spectrum(self.spectrum.as_ref().unwrap(), &at, &waves())
    }
}

fn waves() -> SampledWavelengths {
    SampledWavelengths::sample_visible(0.6)
}

fn red(scale: f32) -> SampledSpectrum {
    let rgb = Rgb::new(0.8 * scale, 0.1 * scale, 0.1 * scale);
    tenfold_spectrum::RgbAlbedo::new(RgbColorSpace::srgb(), rgb).sample(&waves())
}

#[test]
fn constants_are_folded() {
    assert_eq!(sound("Texture \"t\" \"float\" \"constant\"").float, Some(FloatSlot::Constant(1.0)));
    assert_eq!(
        sound("Texture \"t\" \"float\" \"constant\" \"float value\" 0.25").float,
        Some(FloatSlot::Constant(0.25))
    );
    let text = "Texture \"a\" \"float\" \"constant\" \"float value\" 0.5
        Texture \"t\" \"float\" \"scale\" \"texture tex\" \"a\" \"float scale\" 3";
    assert_eq!(sound(text).float, Some(FloatSlot::Constant(1.5)));
    let text = "Texture \"a\" \"float\" \"constant\" \"float value\" 1
        Texture \"t\" \"float\" \"mix\" \"float tex1\" 7 \"float tex2\" 9 \"texture amount\" \"a\"";
    assert_eq!(sound(text).float, Some(FloatSlot::Constant(9.0)));
    let t = sound("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 0.8 0.1 0.1 ]");
    assert_eq!(t.spectrum(0.0, 0.0), red(1.0));
    assert!(t.spectrum.unwrap().constant().is_some());
}

#[test]
fn defaults_are_those_of_pbrt() {
    let at = |text: &str, u, v| sound(&format!("Texture \"t\" \"float\" {text}")).float(u, v);
    assert_eq!(at("\"checkerboard\"", 0.5, 0.5), 1.0);
    assert_eq!(at("\"checkerboard\"", 1.5, 0.5), 0.0);
    assert_eq!(at("\"checkerboard\" \"float uscale\" 4 \"float udelta\" 1", 0.3, 0.5), 1.0);
    assert_eq!(at("\"mix\"", 0.0, 0.0), 0.5);
    assert_eq!(at("\"bilerp\"", 0.25, 0.75), 0.75);
    assert_eq!(at("\"directionmix\" \"vector3 dir\" [ 0 0 2 ]", 0.0, 0.0), 0.0);
    assert_eq!(at("\"directionmix\"", 0.0, 0.0), 1.0);
    assert_eq!(at("\"fbm\"", 0.0, 0.0), 0.0);
}

#[test]
fn dots_are_exchanged_as_in_pbrt() {
    // The cell around the origin holds a dot or none; the share of dots tells which value they have.
    let t = sound("Texture \"t\" \"float\" \"dots\" \"float inside\" 0.75 \"float outside\" 0.25");
    let n = 200;
    let mut sum = 0.0;
    for i in 0..n * n {
        sum += t.float((i % n) as f32 * 0.1, (i / n) as f32 * 0.1);
    }
    let mean = sum / (n * n) as f32;
    // Half of the cells hold a dot, of area 0.385: dots fill a fifth.
    assert!((mean - (0.75 - 0.5 * 0.19)).abs() < 0.05, "{mean}");
}

#[test]
fn mappings_follow_the_transform() {
    let text = "AttributeBegin Translate 0 0 5 Scale 2 2 2
        Texture \"t\" \"float\" \"bilerp\" \"string mapping\" \"planar\" \"vector3 v1\" [ 0 0 1 ] \"float vdelta\" 3
        \"float v00\" 0 \"float v10\" 1 \"float v01\" 0 \"float v11\" 1
        AttributeEnd";
    let t = sound(text);
    let at = TextureContext::at_point(Vec3::new(0.0, 0.0, 6.0));
    assert!((t.textures.float(&t.float.unwrap(), &at) - 0.5).abs() < 1e-6);
    for mapping in ["spherical", "cylindrical"] {
        sound(&format!("Texture \"t\" \"float\" \"checkerboard\" \"string mapping\" \"{mapping}\""));
    }
    sound("Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 3");
}

#[test]
fn spectra_are_made_of_spectra_and_numbers() {
    let text = "Texture \"ramp\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 1 \"float v11\" 1
        Texture \"red\" \"spectrum\" \"constant\" \"rgb value\" [ 0.8 0.1 0.1 ]
        Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"red\" \"spectrum tex2\" [ 300 0.5 900 0.5 ]
            \"texture amount\" \"ramp\"";
    let t = sound(text);
    for u in [0.0, 0.3, 1.0] {
        let want = red(1.0) * (1.0 - u) + SampledSpectrum::splat(0.5) * u;
        assert!((t.spectrum(u, 0.2) - want).0.abs().max_element() < 1e-6);
    }
    let text = "Texture \"ramp\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 1 \"float v11\" 1
        Texture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [ 0.8 0.1 0.1 ] \"texture scale\" \"ramp\"";
    assert!((sound(text).spectrum(0.25, 0.0) - red(1.0) * 0.25).0.abs().max_element() < 1e-6);
}

#[test]
fn a_texture_plays_several_roles() {
    let scene = "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.png\"
        Material \"diffuse\" \"texture reflectance\" \"t\"";
    let mut sources = SourceMap::new();
    let (description, diagnostics) = read_pbrt_str("scene.pbrt", scene, &OneImage, &mut sources);
    let cx = &mut Context::new(&diagnostics, &OneImage);
    let mut library = TextureLibrary::new(&description);
    let params = description.materials.last().unwrap().entity.params("material", &diagnostics);
    let roles = [SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant];
    let slots = roles.map(|role| library.spectrum(cx, &params, "reflectance", role).unwrap());
    let again = library.spectrum(cx, &params, "reflectance", SpectrumRole::Albedo).unwrap();
    assert_eq!(slots[0], again);
    let textures = library.finish(cx);
    let at = TextureContext::at_uv(vec2(0.75, 0.25));
    let values = slots.map(|slot| textures.spectrum(&slot, &at, &waves()));
    let white = RgbColorSpace::srgb().illuminant().sample(&waves());
    for (got, want) in values.iter().zip([SampledSpectrum::ONE, SampledSpectrum::ONE, white]) {
        assert!((*got - want).0.abs().max_element() < 1e-4 * want.max_component(), "{got:?}, not {want:?}");
    }
    assert!(!diagnostics.has_errors());
}

#[test]
fn image_maps_decode_wrap_scale_and_invert() {
    let at = |text: &str, u, v| {
        sound(&format!("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"grey.png\" {text}"))
            .float(u, v)
    };
    let srgb = tenfold_image::srgb_to_linear;
    let near = |got: f32, want: f32| assert!((got - want).abs() < 1e-5, "{got}, not {want}");
    near(at("", 0.25, 0.25), srgb(0.4));
    near(at("\"string encoding\" \"linear\"", 0.25, 0.25), 0.4);
    near(at("\"string encoding\" \"sRGB\"", 0.75, 0.75), srgb(0.2));
    near(at("\"string encoding\" \"gamma 2\"", 0.75, 0.75), 0.04);
    near(at("\"string encoding\" \"linear\" \"float scale\" 2 \"bool invert\" true", 0.25, 0.25), 0.2);
    near(at("\"string encoding\" \"linear\" \"string wrap\" \"clamp\"", 2.0, -1.0), 1.0);
    near(at("\"string encoding\" \"linear\" \"string wrap\" \"black\"", 2.0, -1.0), 0.0);
    near(at("\"string encoding\" \"linear\" \"string wrap\" \"repeat\"", 2.75, -0.75), 1.0);
    near(at("\"string encoding\" \"linear\" \"string filter\" \"point\"", 0.45, 0.45), 0.4);
    near(
        at("\"string encoding\" \"linear\" \"string filter\" \"EWA\" \"float maxanisotropy\" 4", 0.5, 0.5),
        0.4,
    );
}

#[test]
fn scaled_images_are_scaled_before_they_become_spectra() {
    let text = "Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.png\" \"string encoding\" \"linear\"
        Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"i\" \"float scale\" 3";
    let t = sound(text);
    // 0.4 · 3 is no reflectance: it counts as 1.
    assert!((t.spectrum(0.25, 0.25)[0] - 1.0).abs() < 1e-5);
    assert!((t.spectrum(0.75, 0.75)[0] - 0.6).abs() < 1e-5);
}

#[test]
fn faults_are_told_with_their_place() {
    for (text, want) in [
        (
            "Texture \"t\" \"float\" \"chekerboard\"",
            "unknown texture \"chekerboard\" (did you mean \"checkerboard\"?)",
        ),
        ("Texture \"t\" \"float\" \"ptex\"", "texture \"ptex\" is not supported yet"),
        ("Texture \"t\" \"float\" \"marble\"", "give spectra, not numbers"),
        ("Texture \"t\" \"spectrum\" \"fbm\"", "give numbers, not spectra"),
        ("Texture \"t\" \"float\" \"constant\" \"float valeu\" 1", "did you mean \"value\"?"),
        ("Texture \"t\" \"float\" \"constant\" \"string value\" \"x\"", "must be \"float\""),
        ("Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 4", "2 or 3 dimensions, not 4"),
        (
            "Texture \"t\" \"float\" \"checkerboard\" \"string mapping\" \"sperical\"",
            "did you mean \"spherical\"?",
        ),
        ("Texture \"t\" \"float\" \"fbm\" \"integer octaves\" -1", "between 0 and 64"),
        ("Texture \"t\" \"float\" \"imagemap\"", "has no parameter \"string filename\""),
        ("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"gray.png\"", "cannot read \"gray.png\""),
        (
            "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"grey.png\" \"string wrap\" \"mirror\"",
            "unknown wrap \"mirror\" (it can be repeat, black, clamp, octahedralsphere)",
        ),
        (
            "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"grey.png\" \"string filter\" \"bilinaer\"",
            "unknown filter \"bilinaer\" (did you mean \"bilinear\"?)",
        ),
        (
            "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"grey.png\" \"string encoding\" \"gamma x\"",
            "unknown encoding \"gamma x\"",
        ),
        ("Texture \"t\" \"float\" \"scale\" \"texture tex\" \"t\"", "texture \"t\" refers to itself"),
        (
            "Texture \"checks\" \"float\" \"checkerboard\" Texture \"t\" \"float\" \"scale\" \"texture tex\" \"cheks\"",
            "unknown texture \"cheks\" (did you mean \"checks\"?)",
        ),
        (
            "Texture \"a\" \"spectrum\" \"checkerboard\" Texture \"t\" \"float\" \"scale\" \"texture tex\" \"a\"",
            "parameter \"tex\" of texture \"scale\" wants a texture of numbers, but \"a\" gives spectra",
        ),
        (
            "Texture \"a\" \"float\" \"checkerboard\" Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"a\"",
            "parameter \"tex\" of texture \"scale\" wants a texture of spectra, but \"a\" gives numbers",
        ),
        // Nobody uses this one.
        ("Texture \"unused\" \"spectrum\" \"constant\" \"float value\" 1", "must be \"spectrum\" or \"rgb\""),
        ("Texture \"t\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 0 0 ]", "has no length"),
    ] {
        let message = fault(text);
        assert!(message.contains(want), "{message:?} does not say {want:?}");
        assert!(message.starts_with("scene.pbrt:2:"), "{message}");
    }
}

#[test]
fn rings_and_towers_of_textures_are_refused() {
    let ring = "Texture \"t\" \"float\" \"scale\" \"texture tex\" \"b\"
        Texture \"b\" \"float\" \"mix\" \"texture amount\" \"t\"";
    assert!(fault(ring).contains("refers to itself"));
    let mut tower = String::from("Texture \"0\" \"float\" \"checkerboard\"\n");
    for i in 1..=200 {
        tower += &format!("Texture \"{i}\" \"float\" \"mix\" \"texture tex1\" \"{}\"\n", i - 1);
    }
    tower += "Texture \"t\" \"float\" \"mix\" \"texture tex1\" \"200\"";
    assert!(fault(&tower).contains("more than 64 deep"));
}

#[test]
fn reflectances_above_one_are_warned_of() {
    let t = compile("Texture \"t\" \"spectrum\" \"constant\" \"spectrum value\" [ 300 1.5 900 1.5 ]");
    assert_eq!(t.messages.len(), 1);
    assert_eq!(t.messages[0].0, Severity::Warning);
}

#[test]
fn quick_spectra_are_the_same_spectra() {
    for name in ["metal-Au-eta", "metal-Cu-k", "glass-BK7", "stdillum-D65"] {
        let slow = tenfold_spectrum::named(name).unwrap();
        let fast = quick(slow.clone());
        for i in 0..=4700 {
            let lambda = 360.0 + 0.1 * i as f32;
            let (a, b) = (slow.eval(lambda), fast.eval(lambda));
            assert!((a - b).abs() < 5e-3 * a, "{name} at {lambda} nm: {a} {b}");
        }
    }
    // A feature finer than the grid, and one beyond its ends.
    for points in
        [vec![[300.0, 1.0], [500.0, 1.0], [500.5, 9.0], [501.0, 1.0]], vec![[400.0, 1.0], [700.0, 1.0]]]
    {
        let line = PiecewiseLinear::from_points(points).unwrap();
        assert_eq!(quick(Spectrum::PiecewiseLinear(line.clone())), Spectrum::PiecewiseLinear(line));
    }
}
