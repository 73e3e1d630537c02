//! Spellings of parameters, and typed access.

use crate::{lines, read, read_clean, world_findings};
use tenfold_math::{Vec2, Vec3};
use tenfold_scene::{
    ColorSpace, Diagnostics, FloatSource, ParamType, ParamValues, Params, SourceMap, SpectrumSource,
    SpectrumValue, read_pbrt_str,
};

/// Reads parameters of a shape `s` on line 1 and looks at them; gives the findings of the looking.
fn look(params: &str, at: impl FnOnce(&Params<'_>)) -> Vec<String> {
    let mut sources = SourceMap::new();
    let text = format!("WorldBegin Shape \"s\" {params}");
    let files = crate::Files::default();
    let (description, found) = read_pbrt_str("s", &text, &files, &mut sources);
    assert_eq!(lines(&found, &sources), [""; 0], "{text}");
    let diagnostics = Diagnostics::new();
    at(&description.shapes[0].entity.params("shape", &diagnostics));
    lines(&diagnostics, &sources)
}

#[test]
fn every_type_bracketed_or_not() {
    let found = look(
        r#""float f" 1.5 "float ff" [ 1 2 ] "integer i" -3 "integer ii" [ 1 2 3 ] "bool b" true "bool bb" [ false true ]
        "point2 p2" [ 1 2 ] "vector2 v2" [ 3 4 ] "point3 P" [ 1 2 3 4 5 6 ] "vector3 S" [ 1 0 0 ] "normal N" [ 0 0 1 ]
        "string s" "x" "string ss" [ "a" "b" ] "texture t" "tex" "texture u" [ "tex2" ] "rgb c" [ 1 .5 0 ]"#,
        |p| {
            assert_eq!(p.one_float("f", 0.0), 1.5);
            assert_eq!(p.one_float("absent", 4.0), 4.0);
            assert_eq!(p.floats("ff"), [1.0, 2.0]);
            assert_eq!(p.one_int("i", 0), -3);
            assert_eq!(p.ints("ii"), [1, 2, 3]);
            assert!(p.one_bool("b", false));
            assert_eq!(p.bools("bb"), [false, true]);
            assert_eq!(p.one_point2("p2", Vec2::ZERO), Vec2::new(1.0, 2.0));
            assert_eq!(p.point2s("p2"), [Vec2::new(1.0, 2.0)]);
            assert_eq!(p.one_vector2("v2", Vec2::ZERO), Vec2::new(3.0, 4.0));
            assert_eq!(p.point3s("P"), [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
            assert_eq!(p.one_point3("absent", Vec3::ONE), Vec3::ONE);
            assert_eq!(p.one_vector3("S", Vec3::ZERO), Vec3::X);
            assert_eq!(p.vector3s("S"), [Vec3::X]);
            assert_eq!(p.normals("N"), [Vec3::Z]);
            assert_eq!(p.one_normal("N", Vec3::X), Vec3::Z);
            assert_eq!(p.one_string("s", ""), "x");
            assert_eq!(p.strings("ss"), ["a", "b"]);
            assert_eq!(p.texture("t").unwrap().name, "tex");
            assert_eq!(p.texture("u").unwrap().name, "tex2");
            assert_eq!(p.texture("f"), None);
            assert_eq!(p.one_rgb("c"), Some([1.0, 0.5, 0.0]));
            assert_eq!(p.rgbs("c"), [[1.0, 0.5, 0.0]]);
            assert_eq!(p.floats("absent"), [0.0; 0]);
            p.finish(&[]);
        },
    );
    assert_eq!(found, [""; 0]);
}

#[test]
fn spectra_in_all_four_ways() {
    look(
        r#""spectrum name" "metal-Au-eta" "spectrum list" [ 400 1 500 .5 ] "rgb c" [ 1 2 3 ] "blackbody b" 6500
        "blackbody bb" [ 3000 ] "texture t" "tex" "float f" 2"#,
        |p| {
            let value = |name| p.spectrum(name).unwrap().value;
            assert_eq!(value("name"), SpectrumValue::Named("metal-Au-eta"));
            assert_eq!(value("list"), SpectrumValue::Samples(&[[400.0, 1.0], [500.0, 0.5]]));
            assert_eq!(value("c"), SpectrumValue::Rgb([1.0, 2.0, 3.0]));
            assert_eq!(value("b"), SpectrumValue::Blackbody(6500.0));
            assert_eq!(value("bb"), SpectrumValue::Blackbody(3000.0));
            assert_eq!(p.spectrum("absent"), None);
            assert_eq!(p.spectrum("c").unwrap().color_space, ColorSpace::Srgb);
            assert!(
                matches!(p.spectrum_or_texture("t"), Some(SpectrumSource::Texture(t)) if t.name == "tex")
            );
            assert!(matches!(p.spectrum_or_texture("c"), Some(SpectrumSource::Value(_))));
            assert!(matches!(p.float_or_texture("t"), Some(FloatSource::Texture(t)) if t.name == "tex"));
            assert_eq!(p.float_or_texture("f"), Some(FloatSource::Value(2.0)));
            assert_eq!(p.float_or_texture("absent"), None);
            assert_eq!(p.ty("list"), Some(ParamType::Spectrum));
        },
    );
}

#[test]
fn faulty_lookups_say_place_and_expectation() {
    let found = look(
        r#""integer radius" 3
"float two" [ 1 2 ] "point3 P" [ 1 2 3 4 ] "float none" [ ]
"rgb c" [ 1 -1 0 ] "blackbody b" [ 3000 2 ] "blackbody z" 0 "spectrum odd" [ 400 1 500 ]
"spectrum back" [ 500 1 400 2 ] "string s" "x" "texture t" [ "a" "b" ]"#,
        |p| {
            assert_eq!(p.one_float("radius", 1.0), 1.0);
            assert_eq!(p.one_float("two", 1.0), 1.0);
            assert!(p.point3s("P").is_empty() && p.floats("none").is_empty());
            for name in ["c", "b", "z", "odd", "back", "s"] {
                assert_eq!(p.spectrum(name), None, "{name}");
            }
            assert_eq!(p.texture("t"), None);
            p.missing("indices", ParamType::Integer);
            p.finish(&[]);
        },
    );
    assert_eq!(
        found,
        [
            r#"s:1:22: error: parameter "radius" of shape "s" must be "float", found "integer""#,
            r#"s:2:13: error: parameter "two" of shape "s" needs one number, found 2"#,
            r#"s:2:32: error: parameter "P" of shape "s" needs 3 numbers for each point3, found 4 numbers"#,
            r#"s:2:57: error: parameter "none" of shape "s" has no values"#,
            r#"s:3:9: error: parameter "c" of shape "s" has a negative component"#,
            r#"s:3:34: error: "blackbody b" has two values (pbrt-v4 takes the temperature alone; the factor belongs to "scale")"#,
            r#"s:3:59: error: parameter "z" of shape "s" is not a temperature above 0 K"#,
            r#"s:3:76: error: parameter "odd" of shape "s" needs pairs of wavelength and value, found 3 numbers"#,
            r#"s:4:17: error: parameter "back" of shape "s" has wavelengths that do not increase: 400 after 500 nm"#,
            r#"s:4:33: error: parameter "s" of shape "s" must be "spectrum" or "rgb" or "blackbody", found "string""#,
            r#"s:4:60: error: parameter "t" of shape "s" needs one string, found 2"#,
            r#"s:1:18: error: shape "s" has no parameter "integer indices""#,
        ]
    );
}

#[test]
fn unknown_parameters_are_reported_with_the_nearest_known() {
    let found = look(r#""float raduis" 1 "float extra" 2 "float known" 3"#, |p| {
        p.one_float("radius", 1.0);
        p.one_float("zmin", 1.0);
        p.finish(&["known"]);
    });
    assert_eq!(
        found,
        [
            r#"s:1:22: error: unknown parameter "raduis" of shape "s" (did you mean "radius"?)"#,
            r#"s:1:39: error: unknown parameter "extra" of shape "s""#,
        ]
    );
}

#[test]
fn the_last_of_two_counts_and_defaults_may_go_unused() {
    let d = read_clean(
        r#"WorldBegin Attribute "shape" "float r" 5 "float other" 1 Shape "s" "float r" 1 "float r" 2"#,
    );
    let diagnostics = Diagnostics::new();
    let p = d.shapes[0].entity.params("shape", &diagnostics);
    assert_eq!(p.one_float("r", 0.0), 2.0);
    p.finish(&[]);
    assert!(!diagnostics.has_errors());
}

#[test]
fn strings_have_escapes() {
    look(r#""string s" "a\"b\\c\td\n\'é" "#, |p| assert_eq!(p.one_string("s", ""), "a\"b\\c\td\n'é"));
    let found = world_findings(r#"Shape "s" "string s" "a\qb""#);
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("s:1:35: error: unknown escape"), "{}", found[0]);
}

#[test]
fn old_spellings_are_named() {
    for (old, new) in [("color", "rgb"), ("point", "point3"), ("vector", "vector3"), ("normal3", "normal")] {
        let found = world_findings(&format!("Shape \"s\" \"{old} x\" [ 1 2 3 ] \"float y\" 1"));
        let want = format!("s:1:22: error: unknown parameter type \"{old}\" (pbrt-v4 writes \"{new} x\")");
        assert_eq!(found, [want]);
    }
    let found = world_findings("Shape \"s\" \"flaot x\" 1");
    assert_eq!(found, [r#"s:1:22: error: unknown parameter type "flaot" (did you mean "float"?)"#]);
    let (d, found) = read("WorldBegin Shape \"s\" \"bool b\" \"true\"");
    assert_eq!(found, [r#"s:1:31: warning: the value of "b" is quoted; pbrt-v4 writes true alone"#]);
    assert_eq!(d.shapes[0].entity.params.get("b").unwrap().values, ParamValues::Bools(vec![true]));
}

#[test]
fn declarations_may_hold_blanks() {
    let d = read_clean("WorldBegin Shape \"s\" \" float \t r \" 1");
    assert_eq!(d.shapes[0].entity.params.get("r").unwrap().ty, ParamType::Float);
    let found = world_findings("Shape \"s\" \"float r s\" 1");
    assert_eq!(found, ["s:1:22: warning: `s` after the name of a parameter means nothing"]);
}

#[test]
fn spans_cover_declaration_and_values() {
    let mut sources = SourceMap::new();
    let text = "WorldBegin\nShape \"sphere\" \"float radius\" [ 2 ] # big\nShape \"disk\"";
    let (d, _) = read_pbrt_str("s", text, &crate::Files::default(), &mut sources);
    let entity = &d.shapes[0].entity;
    let param = entity.params.get("radius").unwrap();
    assert_eq!(sources.text(param.span), "\"float radius\"");
    assert_eq!(sources.text(param.value_span), "[ 2 ]");
    assert_eq!(sources.text(entity.kind_span), "\"sphere\"");
    assert_eq!(sources.text(entity.span), "Shape \"sphere\" \"float radius\" [ 2 ]");
    assert_eq!(sources.text(d.shapes[1].entity.span), "Shape \"disk\"");
    assert_eq!(sources.text(d.shapes[1].entity.params.span), "");
}
