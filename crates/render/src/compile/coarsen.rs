use std::sync::Arc;
use tenfold_scene::{Description, Entity, Param, ParamSet, ParamType, ParamValues};

/// Makes the picture of a description coarser, where it has more than `most` pixels, so that it has about as many, and the
/// same shape. A part to be rendered that is given in pixels is forgotten.
pub fn coarsen(description: &mut Description, most: u32) {
    // pbrt's film, where the scene says none; the compile step misses the camera then.
    if let (None, Some(camera)) = (&description.film, &description.camera) {
        let span = camera.entity.span;
        let params = ParamSet { span, params: Vec::new(), defaults: Arc::default() };
        description.film = Some(Entity { kind: "rgb".to_owned(), params, ..camera.entity.clone() });
    }
    let Some(film) = &mut description.film else { return };
    let side = |name: &str, default: i32| match film.params.get(name).map(|p| &p.values) {
        Some(ParamValues::Integers(n)) if n.len() == 1 => n[0],
        _ => default,
    };
    let resolution = [side("xresolution", 1280), side("yresolution", 720)];
    let pixels: f64 = resolution.iter().map(|&n| f64::from(n)).product();
    let factor = (f64::from(most) / pixels).sqrt();
    // What is not a resolution is for the compile step to refuse.
    if resolution.iter().any(|&n| n < 1) || factor >= 1.0 {
        return;
    }
    film.params.params.retain(|p| p.name != "pixelbounds");
    for (name, n) in ["xresolution", "yresolution"].into_iter().zip(resolution) {
        let n = ((f64::from(n) * factor).round() as i32).max(1);
        if let Some(param) = film.params.params.iter_mut().rev().find(|p| p.name == name) {
            param.values = ParamValues::Integers(vec![n]);
            continue;
        }
        film.params.params.push(Param {
            name: name.to_owned(),
            ty: ParamType::Integer,
            values: ParamValues::Integers(vec![n]),
            span: film.span,
            value_span: film.span,
            color_space: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::compile;
    use tenfold_math::UVec2;
    use tenfold_scene::{FileResources, SourceMap, read_pbrt_str};

    fn resolution(film: &str, most: u32) -> UVec2 {
        let text = format!("{film}\nCamera \"perspective\"\nWorldBegin\n");
        let resources = FileResources::below("");
        let (mut description, diagnostics) = read_pbrt_str("a", &text, &resources, &mut SourceMap::new());
        coarsen(&mut description, most);
        let scene = compile(&description, &resources, &diagnostics).unwrap();
        assert!(scene.film.bounds.size() == scene.film.resolution);
        scene.film.resolution
    }

    #[test]
    fn pictures_keep_their_shape() {
        let film = "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 100";
        assert_eq!(resolution(film, 40_000), UVec2::new(400, 100));
        assert_eq!(resolution(film, 10_000), UVec2::new(200, 50));
        assert_eq!(resolution(film, 1), UVec2::new(2, 1));
        let bounds = "Film \"rgb\" \"integer pixelbounds\" [ 3 9 5 7 ]";
        for film in [bounds, ""] {
            assert_eq!(resolution(film, 14_400), UVec2::new(160, 90));
        }
    }
}
