//! Compiles the integrator, and speaks up about settings that mean something to pbrt alone.

use super::context::Context;
use tenfold_scene::{Description, Diagnostic};

/// pbrt-v4's integrators.
const KNOWN: [&str; 12] = [
    "ambientocclusion",
    "bdpt",
    "function",
    "lightpath",
    "mlt",
    "path",
    "randomwalk",
    "simplepath",
    "simplevolpath",
    "sppm",
    "volpath",
    "ao",
];

/// What the path tracer is told.
pub(super) struct IntegratorSpec {
    pub(super) max_depth: u16,
}

/// Compiles the integrator: tenfold traces paths, whatever algorithm a file names, where the picture is the same.
pub(super) fn compile_integrator(cx: &Context<'_>, description: &Description) -> IntegratorSpec {
    check_media(cx, description);
    let Some(entity) = &description.integrator else { return IntegratorSpec { max_depth: 5 } };
    let params = entity.params("integrator", cx.diagnostics);
    match entity.kind.as_str() {
        "path" | "volpath" => {}
        "ambientocclusion" | "ao" | "function" => {
            cx.unsupported(entity.kind_span, &format!("integrator \"{}\"", entity.kind));
        }
        kind if KNOWN.contains(&kind) => {
            let message = format!("integrator \"{kind}\": tenfold traces paths instead, to the same picture");
            cx.diagnostics.push(Diagnostic::note(entity.kind_span, message));
        }
        kind => cx.unknown_kind(entity.kind_span, "integrator", kind, KNOWN),
    }
    let max_depth = params.one_int("maxdepth", 5);
    if max_depth < 0 {
        params.error("maxdepth", format!("the depth must not be negative, found {max_depth}"));
    }
    if max_depth > u16::MAX.into() {
        let message = format!("paths meet {} surfaces at most", u16::MAX);
        cx.diagnostics.push(Diagnostic::note(params.span_of("maxdepth"), message));
    }
    if params.one_bool("regularize", false) {
        let message = "tenfold does not regularise paths: the picture is the unbiased one";
        cx.diagnostics.warning(params.span_of("regularize"), message);
    }
    let how_pbrt_samples = [
        "lightsampler",
        "samplelights",
        "samplebsdf",
        "visualizestrategies",
        "visualizeweights",
        "mutationsperpixel",
        "bootstrapsamples",
        "chains",
        "largestepprobability",
        "sigma",
        "photonsperiteration",
        "radius",
        "seed",
    ];
    params.finish(&how_pbrt_samples);
    IntegratorSpec { max_depth: max_depth.clamp(0, u16::MAX.into()) as u16 }
}

/// Participating media are ignored by pbrt's `path`, too; anything else would be a wrong picture.
fn check_media(cx: &Context<'_>, description: &Description) {
    let integrator = description.integrator.as_ref().map_or("volpath", |e| e.kind.as_str());
    if matches!(integrator, "path" | "simplepath") {
        return;
    }
    for medium in &description.media {
        cx.unsupported(
            medium.entity.span,
            &format!("medium \"{}\" of type \"{}\"", medium.name, medium.entity.kind),
        );
    }
}

/// Options and accelerators say how pbrt works; those that would change the picture are pointed out.
pub(super) fn check_options(cx: &Context<'_>, description: &Description) {
    for option in &description.options {
        let message = format!("tenfold has no option \"{}\": it is left out", option.name);
        cx.diagnostics.push(Diagnostic::note(option.span, message));
    }
    if let Some(entity) = &description.accelerator {
        let known = ["bvh", "kdtree"];
        if !known.contains(&entity.kind.as_str()) {
            cx.unknown_kind(entity.kind_span, "accelerator", &entity.kind, known);
        }
    }
}
