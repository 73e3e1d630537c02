//! Compiles the film, the pixel filter and the sampler.

use super::context::{Context, color_space};
use crate::{
    camera::Shutter,
    film::{PixelBounds, Sensor},
    filter::{Filter, Profile},
    scene::{FilmSpec, SamplerSpec},
};
use tenfold_math::{UVec2, Vec2, vec2};
use tenfold_sampling::SamplerKind;
use tenfold_scene::{Diagnostic, Entity, Params};
use tenfold_spectrum::RgbColorSpace;

/// No picture is larger than this on a side.
const LARGEST_SIDE: i32 = 1 << 16;

/// Compiles the film; pbrt-v4's defaults where the scene has none. The exposure time, where the film does not say it,
/// is one: the shutter decides ([`expose`]).
pub(super) fn compile_film(cx: &Context<'_>, entity: Option<&Entity>) -> Option<FilmSpec> {
    let Some(entity) = entity else {
        let resolution = UVec2::new(1280, 720);
        return Some(FilmSpec {
            resolution,
            bounds: PixelBounds::full(resolution),
            sensor: Sensor::cie1931(RgbColorSpace::srgb().xyz_to_rgb(), 1.0, f32::INFINITY),
            color_space: RgbColorSpace::srgb(),
            filename: None,
        });
    };
    match entity.kind.as_str() {
        "rgb" => {}
        kind @ ("gbuffer" | "spectral") => {
            cx.unsupported(entity.kind_span, &format!("film \"{kind}\""));
            return None;
        }
        kind => {
            cx.unknown_kind(entity.kind_span, "film", kind, ["rgb", "gbuffer", "spectral"]);
            return None;
        }
    }
    let params = entity.params("film", cx.diagnostics);
    let resolution = resolution(&params)?;
    let bounds = bounds(cx, &params, resolution);
    let sensor_name = params.one_string("sensor", "cie1931");
    if sensor_name != "cie1931" {
        cx.unsupported(params.span_of("sensor"), &format!("sensor \"{sensor_name}\""));
    }
    if params.one_float("whitebalance", 0.0) != 0.0 {
        cx.unsupported(params.span_of("whitebalance"), "white balance");
    }
    let exposure = params.one_float("exposuretime", 1.0);
    let iso = params.one_float("iso", 100.0);
    let max_component = params.one_float("maxcomponentvalue", f32::INFINITY);
    for (name, value) in [("exposuretime", exposure), ("iso", iso), ("maxcomponentvalue", max_component)] {
        if value <= 0.0 {
            params.error(name, format!("\"{name}\" must be positive, found {value}"));
        }
    }
    let filename = params.string("filename").map(str::to_owned);
    // The diagonal matters to realistic cameras only, and pixels are always written in full precision.
    params.finish(&["diagonal", "savefp16"]);
    let space = color_space(entity.color_space);
    Some(FilmSpec {
        resolution,
        bounds: bounds?,
        sensor: Sensor::cie1931(space.xyz_to_rgb(), exposure * iso / 100.0, max_component),
        color_space: space,
        filename,
    })
}

/// Exposes the film for as long as the shutter is open, as pbrt-v4 does, unless the film says an exposure time itself.
pub(super) fn expose(spec: &mut FilmSpec, entity: Option<&Entity>, shutter: &Shutter) {
    if entity.is_none_or(|e| e.params.get("exposuretime").is_none()) {
        spec.sensor = spec.sensor.exposed(shutter.close - shutter.open);
    }
}

fn resolution(params: &Params<'_>) -> Option<UVec2> {
    let side = |name, default| {
        let n = params.one_int(name, default);
        if (1..=LARGEST_SIDE).contains(&n) {
            return Some(n as u32);
        }
        params.error(name, format!("\"{name}\" must lie between 1 and {LARGEST_SIDE}, found {n}"));
        None
    };
    let (x, y) = (side("xresolution", 1280), side("yresolution", 720));
    Some(UVec2::new(x?, y?))
}

fn bounds(cx: &Context<'_>, params: &Params<'_>, resolution: UVec2) -> Option<PixelBounds> {
    let full = PixelBounds::full(resolution);
    let pixels = params.ints("pixelbounds");
    let crop = params.floats("cropwindow");
    if !pixels.is_empty() && !crop.is_empty() {
        let message = "both pixel bounds and a crop window are given: the crop window counts";
        cx.diagnostics.warning(params.span_of("pixelbounds"), message);
    }
    let bounds = match (pixels, crop) {
        ([], []) => full,
        (_, &[x0, x1, y0, y1]) => crop_window(resolution, [x0, x1, y0, y1]),
        (&[x0, x1, y0, y1], []) => {
            let clamped = |n: i32| n.max(0) as u32;
            let asked = PixelBounds {
                min: UVec2::new(clamped(x0), clamped(y0)),
                max: UVec2::new(clamped(x1), clamped(y1)),
            };
            asked.intersection(&full)
        }
        (_, [_, ..]) => {
            params.error("cropwindow", "a crop window has four numbers: left, right, top, bottom");
            return None;
        }
        _ => {
            params.error("pixelbounds", "pixel bounds are four numbers: left, right, top, bottom");
            return None;
        }
    };
    if bounds.is_empty() {
        let name = if crop.is_empty() { "pixelbounds" } else { "cropwindow" };
        params.error(name, "there is no pixel within these bounds");
        return None;
    }
    Some(bounds)
}

/// The pixels of a crop window given as fractions of width and height: left, right, top, bottom.
pub fn crop_window(resolution: UVec2, [x0, x1, y0, y1]: [f32; 4]) -> PixelBounds {
    let corner =
        |x: f32, y: f32| (resolution.as_vec2() * vec2(x, y).clamp(Vec2::ZERO, Vec2::ONE)).ceil().as_uvec2();
    PixelBounds { min: corner(x0.min(x1), y0.min(y1)), max: corner(x0.max(x1), y0.max(y1)) }
}

/// Compiles the pixel filter; pbrt-v4's default, a Gaussian, where the scene has none.
pub(super) fn compile_filter(cx: &Context<'_>, entity: Option<&Entity>) -> Option<Filter> {
    let gaussian = Profile::Gaussian { sigma: 0.5 };
    let Some(entity) = entity else { return Filter::new(gaussian, Vec2::splat(1.5)) };
    let params = entity.params("filter", cx.diagnostics);
    let (profile, radius) = match entity.kind.as_str() {
        "box" => (Profile::Box, 0.5),
        "triangle" => (Profile::Triangle, 2.0),
        "gaussian" => (Profile::Gaussian { sigma: params.one_float("sigma", 0.5) }, 1.5),
        "mitchell" => {
            let third = 1.0 / 3.0;
            (Profile::Mitchell { b: params.one_float("B", third), c: params.one_float("C", third) }, 2.0)
        }
        "sinc" => (Profile::Sinc { tau: params.one_float("tau", 3.0) }, 4.0),
        kind => {
            let known = ["box", "triangle", "gaussian", "mitchell", "sinc"];
            cx.unknown_kind(entity.kind_span, "filter", kind, known);
            return None;
        }
    };
    let radius = vec2(params.one_float("xradius", radius), params.one_float("yradius", radius));
    params.finish(&[]);
    if radius.min_element() <= 0.0 || !radius.is_finite() {
        params.error("xradius", "the radius of a filter must be positive");
        return None;
    }
    if matches!(profile, Profile::Gaussian { sigma } if sigma <= 0.0 || sigma.is_nan()) {
        params.error("sigma", "the standard deviation of a filter must be positive");
        return None;
    }
    if matches!(profile, Profile::Sinc { tau } if tau <= 0.0 || tau.is_nan()) {
        params.error("tau", "the window of a filter must have a positive number of lobes");
        return None;
    }
    let filter = Filter::new(profile, radius);
    if filter.is_none() {
        let message = format!("a filter \"{}\" of these parameters averages nothing", entity.kind);
        cx.diagnostics.error(entity.kind_span, message);
    }
    filter
}

/// Compiles the sampler; tenfold's default where the scene has none.
pub(super) fn compile_sampler(cx: &Context<'_>, entity: Option<&Entity>) -> SamplerSpec {
    let default = SamplerSpec { kind: SamplerKind::default(), spp: 16, seed: 0 };
    let Some(entity) = entity else { return default };
    let params = entity.params("sampler", cx.diagnostics);
    let Some(mapped) = SamplerKind::from_pbrt(&entity.kind) else {
        let known = SamplerKind::all_names().chain(["pmj02bn"]);
        cx.unknown_kind(entity.kind_span, "sampler", &entity.kind, known);
        return default;
    };
    if let Some(note) = mapped.note {
        cx.diagnostics.push(Diagnostic::note(entity.kind_span, note));
    }
    let count = |name, default| {
        let n = params.one_int(name, default);
        if n < 1 {
            params.error(name, format!("a pixel needs at least one sample, found {n}"));
        }
        n.max(1) as u32
    };
    let spp = if mapped.kind == SamplerKind::Stratified {
        let (x, y) = (count("xsamples", 4), count("ysamples", 4));
        x.checked_mul(y).unwrap_or_else(|| {
            params.error("xsamples", format!("{x} × {y} samples a pixel are too many"));
            1
        })
    } else {
        count("pixelsamples", 16)
    };
    let seed = params.one_int("seed", 0);
    // How samples are randomised is the sampler's own matter here.
    params.finish(&["randomization", "jitter"]);
    SamplerSpec { kind: mapped.kind, spp, seed: seed as u32 as u64 }
}
