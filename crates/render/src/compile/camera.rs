//! Compiles the camera, its shutter and its lens.

use super::context::Context;
use crate::camera::{Camera, Projection, ScreenWindow, Shutter, ShutterCurve, ThinLens};
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
    let curve = shutter_curve(cx, params);
    if open == close {
        params.error("shutterclose", "the shutter closes as it opens: the picture would be black");
        return None;
    }
    if close < open {
        let message = "the shutter closes before it opens: the two times are swapped";
        cx.diagnostics.warning(params.span_of("shutterclose"), message);
        return Some(Shutter { open: close, close: open, curve: curve? });
    }
    Some(Shutter { open, close, curve: curve? })
}

/// How the shutter opens and closes, which pbrt-v4 does not know: by name, or as a table.
fn shutter_curve(cx: &Context<'_>, params: &Params<'_>) -> Option<ShutterCurve> {
    const NAMES: [&str; 3] = ["box", "triangle", "trapezoid"];
    let name = params.one_string("shutter", "box");
    if params.has("shuttercurve") {
        if params.has("shutter") {
            params.error("shuttercurve", "\"shuttercurve\" and \"shutter\" both say how the shutter opens");
        }
        let table = params.floats("shuttercurve").as_chunks();
        let curve = ShutterCurve::table(table.0).filter(|_| table.1.is_empty());
        if curve.is_none() {
            let message = "expected pairs of a fraction of the shutter's interval, rising from 0 to 1 at most, and a weight, \
                none of which is negative and some are not zero";
            params.error("shuttercurve", message);
        }
        return curve;
    }
    match name {
        "box" => Some(ShutterCurve::Box),
        "triangle" => ShutterCurve::trapezoid(0.5, 0.5),
        "trapezoid" => {
            let [opening, closing] =
                ["shutteropening", "shutterclosing"].map(|name| params.one_float(name, 0.25));
            let curve = ShutterCurve::trapezoid(opening, closing);
            if curve.is_none() {
                let message = format!(
                    "the shutter opens over {opening} of its interval and closes over {closing}: fractions that together are at most 1"
                );
                params.error("shutteropening", message);
            }
            curve
        }
        name => {
            cx.unknown_kind(params.span_of("shutter"), "shutter", name, NAMES);
            None
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;
    use tenfold_scene::{Resources, SourceMap, read_pbrt_str};

    struct Nothing;

    impl Resources for Nothing {
        fn load(&self, _: &str) -> std::io::Result<Vec<u8>> {
            Err(std::io::ErrorKind::NotFound.into())
        }

        fn resolve(&self, path: &str) -> PathBuf {
            PathBuf::from(path)
        }
    }

    /// The curve of a camera with these parameters, and what is said about them.
    fn curve(parameters: &str) -> (Option<ShutterCurve>, Vec<String>) {
        let mut sources = SourceMap::new();
        let text = format!("Camera \"perspective\" {parameters} WorldBegin");
        let (description, diagnostics) = read_pbrt_str("s", &text, &Nothing, &mut sources);
        let cx = Context::new(&diagnostics, &Nothing);
        let camera = compile_camera(&cx, &description.camera.unwrap(), UVec2::new(4, 3));
        let said = diagnostics.to_vec().iter().map(|d| d.plain(&sources)).collect();
        (camera.map(|camera| camera.shutter.curve), said)
    }

    #[test]
    fn curves_have_names_or_tables() {
        let trapezoid = |opening, closing| ShutterCurve::trapezoid(opening, closing).unwrap();
        for (parameters, want) in [
            ("", ShutterCurve::Box),
            (r#""string shutter" "box""#, ShutterCurve::Box),
            (r#""string shutter" "triangle""#, trapezoid(0.5, 0.5)),
            (r#""string shutter" "trapezoid""#, trapezoid(0.25, 0.25)),
            (r#""string shutter" "trapezoid" "float shutterclosing" 0.5"#, trapezoid(0.25, 0.5)),
            (
                r#""float shuttercurve" [ 0 0 0.5 2 1 0 ]"#,
                ShutterCurve::table(&[[0.0, 0.0], [0.5, 2.0], [1.0, 0.0]]).unwrap(),
            ),
        ] {
            assert_eq!(curve(parameters), (Some(want), vec![]), "{parameters}");
        }
    }

    #[test]
    fn faulty_curves_are_told() {
        for (parameters, part) in [
            (
                r#""string shutter" "tringle""#,
                "error: unknown shutter \"tringle\" (did you mean \"triangle\"?)",
            ),
            (
                r#""string shutter" "trapezoid" "float shutteropening" 0.8"#,
                "error: the shutter opens over 0.8",
            ),
            (r#""float shutteropening" 0.8"#, "error: unknown parameter \"shutteropening\""),
            (r#""float shuttercurve" [ 0 1 2 1 ]"#, "error: expected pairs of a fraction"),
            (r#""float shuttercurve" [ 0 1 1 ]"#, "error: expected pairs of a fraction"),
            (r#""float shuttercurve" [ 0 1 1 1 ] "string shutter" "box""#, "both say how the shutter opens"),
        ] {
            let (_, said) = curve(parameters);
            assert!(
                said.len() == 1 && said[0].starts_with("s:1:") && said[0].contains(part),
                "{parameters}: {said:?}"
            );
        }
    }
}
