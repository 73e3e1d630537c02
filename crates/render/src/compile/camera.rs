//! Compiles the camera, its shutter and its lens.

use super::context::Context;
use crate::camera::{Camera, Projection, ScreenWindow, Shutter, ThinLens};
use tenfold_math::{UVec2, vec2};
use tenfold_scene::{CameraEntity, Params};

/// pbrt-v4's cameras.
const KNOWN: [&str; 4] = ["perspective", "orthographic", "realistic", "spherical"];

/// Compiles the camera of a picture of `resolution` pixels.
pub(super) fn compile_camera(cx: &Context<'_>, camera: &CameraEntity, resolution: UVec2) -> Option<Camera> {
    let entity = &camera.entity;
    let params = entity.params("camera", cx.diagnostics);
    let shutter = shutter(cx, &params);
    let aspect = params.one_float("frameaspectratio", resolution.x as f32 / resolution.y as f32);
    let window = screen_window(&params, aspect)?;
    let radius = params.one_float("lensradius", 0.0);
    let focal_distance = params.one_float("focaldistance", 1e6);
    if radius < 0.0 {
        params.error("lensradius", "the radius of the lens must not be negative");
        return None;
    }
    if focal_distance <= 0.0 {
        params.error("focaldistance", "the focal distance must be positive");
        return None;
    }
    let projection = match entity.kind.as_str() {
        "perspective" => {
            let fov = params.one_float("fov", 90.0);
            if !(fov > 0.0 && fov < 180.0) {
                params.error(
                    "fov",
                    format!("the field of view must lie between 0 and 180 degrees, found {fov}"),
                );
                return None;
            }
            Projection::perspective(fov.to_radians(), window)
        }
        "orthographic" => Projection::orthographic(window),
        kind if KNOWN.contains(&kind) => {
            cx.unsupported(entity.kind_span, &format!("camera \"{kind}\""));
            return None;
        }
        kind => {
            cx.unknown_kind(entity.kind_span, "camera", kind, KNOWN);
            return None;
        }
    };
    params.finish(&[]);
    Some(Camera {
        world_from_camera: camera.world_from_camera.clone(),
        projection,
        lens: (radius > 0.0).then_some(ThinLens { radius, focal_distance }),
        shutter: shutter?,
        resolution,
    })
}

fn shutter(cx: &Context<'_>, params: &Params<'_>) -> Option<Shutter> {
    let (open, close) = (params.one_float("shutteropen", 0.0), params.one_float("shutterclose", 1.0));
    if open == close {
        params.error("shutterclose", "the shutter closes as it opens: the picture would be black");
        return None;
    }
    if close < open {
        let message = "the shutter closes before it opens: the two times are swapped";
        cx.diagnostics.warning(params.span_of("shutterclose"), message);
        return Some(Shutter { open: close, close: open });
    }
    Some(Shutter { open, close })
}

fn screen_window(params: &Params<'_>, aspect: f32) -> Option<ScreenWindow> {
    match *params.floats("screenwindow") {
        [] if aspect > 0.0 && aspect.is_finite() => Some(ScreenWindow::for_aspect(aspect)),
        [] => {
            params.error("frameaspectratio", "the aspect ratio must be positive");
            None
        }
        [x0, x1, y0, y1] if x0 < x1 && y0 < y1 => Some(ScreenWindow { min: vec2(x0, y0), max: vec2(x1, y1) }),
        _ => {
            params.error(
                "screenwindow",
                "expected four numbers, left and right, bottom and top, in rising order",
            );
            None
        }
    }
}
