//! What every directive does.

use crate::{Files, read, read_clean, read_with};
use tenfold_math::{Motion, Transform, Vec3};
use tenfold_scene::{ColorSpace, OptionValue, ParamValues, TextureValue};

fn near(a: &Transform, b: &Transform) -> bool {
    a.affine().abs_diff_eq(*b.affine(), 1e-5)
}

#[test]
fn options_become_entities() {
    let d = read_clean(
        r#"
        Film "rgb" "integer xresolution" 640 "integer yresolution" [ 480 ]
        Sampler "zsobol" "integer pixelsamples" 16
        Integrator "volpath"
        PixelFilter "gaussian" "float sigma" .5
        Accelerator "bvh"
        Camera "perspective" "float fov" 30
        WorldBegin"#,
    );
    let film = d.film.unwrap();
    assert_eq!(film.kind, "rgb");
    assert_eq!(film.params.get("yresolution").unwrap().values, ParamValues::Integers(vec![480]));
    assert_eq!(d.sampler.unwrap().kind, "zsobol");
    assert_eq!(d.integrator.unwrap().kind, "volpath");
    assert_eq!(d.filter.unwrap().params.get("sigma").unwrap().values, ParamValues::Floats(vec![0.5]));
    assert_eq!(d.accelerator.unwrap().kind, "bvh");
    assert_eq!(d.camera.unwrap().entity.kind, "perspective");
}

#[test]
fn transforms_multiply_from_the_right() {
    let d = read_clean(
        r#"WorldBegin
        Translate 1 2 3 Scale 2 2 4 Rotate 90 0 0 1
        Shape "sphere"
        Identity Shape "sphere"
        Transform [ 1 0 0 0  0 2 0 0  0 0 3 0  4 5 6 1 ] Shape "sphere"
        ConcatTransform [ 1 0 0 0  0 1 0 0  0 0 1 0  1 1 1 1 ] Shape "sphere"
        Identity LookAt 0 2 6  0 0 0  0 1 0 Shape "sphere""#,
    );
    let at = |i: usize, p: [f32; 3]| d.shapes[i].motion.start().point(Vec3::from(p));
    assert!((at(0, [1.0, 0.0, 1.0]) - Vec3::new(1.0, 4.0, 7.0)).length() < 1e-5);
    assert_eq!(at(1, [1.0, 2.0, 3.0]), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(at(2, [1.0, 1.0, 1.0]), Vec3::new(5.0, 7.0, 9.0));
    assert_eq!(at(3, [0.0, 0.0, 0.0]), Vec3::new(5.0, 7.0, 9.0));
    let look = Transform::look_at(Vec3::new(0.0, 2.0, 6.0), Vec3::ZERO, Vec3::Y).unwrap();
    assert_eq!(*d.shapes[4].motion.start(), look);
    assert!(!d.shapes[4].motion.is_moving());
}

#[test]
fn the_camera_gets_the_inverse_and_names_its_system() {
    let d = read_clean(
        r#"TransformTimes 0.25 0.75
        LookAt 0 0 5 0 0 0 0 1 0
        ActiveTransform EndTime Translate 0 0 1
        Camera "perspective"
        WorldBegin
        Shape "sphere"
        CoordSysTransform "camera" Shape "sphere"
        CoordSysTransform "world" Shape "sphere""#,
    );
    let camera = d.camera.unwrap();
    let motion = camera.world_from_camera;
    let [start, end] = motion.keys() else { panic!("{motion:?}") };
    assert_eq!((start.time, end.time), (0.25, 0.75));
    assert!((start.transform.point(Vec3::ZERO) - Vec3::new(0.0, 0.0, 5.0)).length() < 1e-6);
    // The world moves to +z, so the camera moves to -z.
    assert!((end.transform.point(Vec3::ZERO) - Vec3::new(0.0, 0.0, 4.0)).length() < 1e-6);
    // WorldBegin brings back the identity and both transforms; the camera's system has both keys.
    assert_eq!(d.shapes[0].motion, Motion::default());
    let [first, second] = d.shapes[1].motion.keys() else { panic!("{:?}", d.shapes[1].motion) };
    assert!(near(&first.transform, &start.transform) && near(&second.transform, &end.transform));
    assert_eq!(d.shapes[2].motion, Motion::default());
}

#[test]
fn active_transforms_are_saved_and_set_apart() {
    let d = read_clean(
        r#"WorldBegin
        AttributeBegin
            ActiveTransform StartTime Translate 1 0 0
            AttributeBegin ActiveTransform EndTime Translate 0 1 0 Shape "sphere" AttributeEnd
            Translate 1 0 0
            Shape "sphere"
            ActiveTransform All Translate 0 0 1
            Shape "sphere"
        AttributeEnd
        Translate 5 0 0 Shape "sphere""#,
    );
    let keys = |i: usize| {
        let m = &d.shapes[i].motion;
        (m.at(0.0).point(Vec3::ZERO).to_array(), m.at(1.0).point(Vec3::ZERO).to_array())
    };
    assert_eq!(keys(0), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    assert_eq!(keys(1), ([2.0, 0.0, 0.0], [0.0, 0.0, 0.0]));
    assert_eq!(keys(2), ([2.0, 0.0, 1.0], [0.0, 0.0, 1.0]));
    assert_eq!(keys(3), ([5.0, 0.0, 0.0], [5.0, 0.0, 0.0]));
    assert!(d.shapes[0].motion.is_moving());
}

#[test]
fn any_number_of_keys_has_transforms_of_its_own() {
    let d = read_clean(
        r#"TransformTimes [ 0 0.25 1 ]
        ActiveTransform 1 Translate 0 0 -4
        Camera "perspective"
        WorldBegin
        Translate 1 0 0
        ActiveTransform 1 Translate 0 1 0
        ActiveTransform EndTime Translate 0 0 1 CoordinateSystem "here" Shape "sphere"
        ActiveTransform 2 Translate 0 0 1
        ActiveTransform StartTime Translate 0 3 0
        ActiveTransform All Translate 1 0 0 Shape "sphere"
        CoordSysTransform "here" Shape "sphere"
        CoordSysTransform "camera" Shape "sphere""#,
    );
    let keys = |m: &Motion| -> Vec<_> {
        m.keys().iter().map(|k| (k.time, k.transform.point(Vec3::ZERO).to_array())).collect()
    };
    let here = [(0.0, [1.0, 0.0, 0.0]), (0.25, [1.0, 1.0, 0.0]), (1.0, [1.0, 0.0, 1.0])];
    assert_eq!(keys(&d.shapes[0].motion), here);
    assert_eq!(
        keys(&d.shapes[1].motion),
        [(0.0, [2.0, 3.0, 0.0]), (0.25, [2.0, 1.0, 0.0]), (1.0, [2.0, 0.0, 2.0])]
    );
    assert_eq!(keys(&d.shapes[2].motion), here);
    let camera = keys(&d.camera.unwrap().world_from_camera);
    assert_eq!(camera, [(0.0, [0.0; 3]), (0.25, [0.0, 0.0, 4.0]), (1.0, [0.0; 3])]);
    assert_eq!(keys(&d.shapes[3].motion), camera);
}

#[test]
fn two_times_in_brackets_are_those_of_pbrt() {
    let world = r#"WorldBegin ActiveTransform EndTime Translate 1 2 3 Shape "sphere""#;
    let motion = |times: &str| read_clean(&format!("{times} {world}")).shapes[0].motion.clone();
    assert_eq!(motion("TransformTimes 0.2 0.7"), motion("TransformTimes [ 0.2 0.7 ]"));
    assert_eq!(motion(""), motion("TransformTimes 0 1"));
    // Nothing was told apart yet: the number of keys may still change.
    assert_eq!(motion("TransformTimes [ 0 1 2 ] Translate 0 0 0 TransformTimes 0 1"), motion(""));
}

#[test]
fn coordinate_systems_outlive_attribute_scopes() {
    let d = read_clean(
        r#"WorldBegin
        AttributeBegin Translate 1 2 3 CoordinateSystem "here" AttributeEnd
        Translate 9 9 9 CoordSysTransform "here" Shape "sphere""#,
    );
    assert_eq!(d.shapes[0].motion.start().point(Vec3::ZERO), Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn attribute_scopes_save_the_graphics_state() {
    let d = read_clean(
        r#"WorldBegin
        MakeNamedMedium "fog" "string type" "homogeneous"
        AttributeBegin
            Material "conductor" "float roughness" 0.1
            AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
            ReverseOrientation
            MediumInterface "fog" ""
            ColorSpace "rec2020"
            Shape "sphere"
        AttributeEnd
        Shape "disk""#,
    );
    let [inner, outer] = &d.shapes[..] else { panic!() };
    assert_eq!(d.materials[inner.material.index()].entity.kind, "conductor");
    assert_eq!(d.area_lights[inner.area_light.unwrap().index()].kind, "diffuse");
    assert!(inner.reverse_orientation);
    assert_eq!(d.media[inner.media.inside.unwrap().index()].name, "fog");
    assert_eq!(inner.media.outside, None);
    assert_eq!(inner.entity.color_space, ColorSpace::Rec2020);

    assert_eq!(outer.material.index(), 0);
    assert_eq!(d.materials[0].entity.kind, "diffuse");
    assert_eq!(outer.area_light, None);
    assert!(!outer.reverse_orientation && outer.media.inside.is_none());
    assert_eq!(outer.entity.color_space, ColorSpace::Srgb);
}

#[test]
fn reverse_orientation_toggles_and_an_empty_light_ends_emission() {
    let d = read_clean(
        r#"WorldBegin ReverseOrientation ReverseOrientation AreaLightSource "diffuse" Shape "sphere" Shape "sphere"
        AreaLightSource "" Shape "sphere""#,
    );
    assert!(!d.shapes[0].reverse_orientation);
    assert_eq!(d.shapes[0].area_light, d.shapes[1].area_light);
    assert_eq!(d.shapes[2].area_light, None);
    assert_eq!(d.area_lights.len(), 1);
}

#[test]
fn named_materials_may_be_used_before_their_definition() {
    let d = read_clean(
        r#"WorldBegin
        NamedMaterial "gold" Shape "sphere"
        MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta"
        Material "dielectric" Shape "sphere"
        NamedMaterial "gold" Shape "sphere""#,
    );
    let gold = d.material_names["gold"];
    let material = &d.materials[gold.index()];
    assert_eq!((material.name.as_deref(), material.entity.kind.as_str()), (Some("gold"), "conductor"));
    assert!(material.entity.params.get("type").is_none());
    assert!(material.entity.params.get("eta").is_some());
    assert_eq!(d.shapes[0].material, gold);
    assert_eq!(d.materials[d.shapes[1].material.index()].entity.kind, "dielectric");
    assert_eq!(d.shapes[2].material, gold);
}

#[test]
fn media_interfaces_take_one_name_or_two() {
    let d = read_clean(
        r#"MakeNamedMedium "air" "string type" "homogeneous"
        MediumInterface "air" Camera "perspective"
        WorldBegin
        Translate 1 0 0
        MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2
        MediumInterface "smoke" "air" Shape "sphere" LightSource "point"
        MediumInterface "" Shape "sphere" LightSource "point""#,
    );
    let name = |id: Option<tenfold_math::Id<tenfold_scene::MediumEntity>>| {
        id.map(|id| d.media[id.index()].name.as_str())
    };
    assert_eq!(name(d.camera.as_ref().unwrap().medium), Some("air"));
    assert_eq!(
        (name(d.shapes[0].media.inside), name(d.shapes[0].media.outside)),
        (Some("smoke"), Some("air"))
    );
    assert_eq!(name(d.lights[0].medium), Some("air"));
    assert_eq!((name(d.shapes[1].media.inside), name(d.lights[1].medium)), (None, None));
    let smoke = d.media.iter().find(|m| m.name == "smoke").unwrap();
    assert_eq!(smoke.entity.kind, "uniformgrid");
    assert_eq!(smoke.motion.start().point(Vec3::ZERO), Vec3::X);
}

#[test]
fn textures_are_named_by_what_they_give() {
    let d = read_clean(
        r#"WorldBegin
        Texture "t" "float" "constant" "float value" 3
        Scale 2 2 2
        Texture "t" "spectrum" "imagemap" "string filename" "a.png""#,
    );
    assert_eq!((d.textures[0].value, d.textures[0].entity.kind.as_str()), (TextureValue::Float, "constant"));
    assert_eq!(
        (d.textures[1].value, d.textures[1].entity.kind.as_str()),
        (TextureValue::Spectrum, "imagemap")
    );
    assert_eq!(d.textures[1].name, "t");
    assert_eq!(d.textures[1].motion.start().point(Vec3::X), Vec3::new(2.0, 0.0, 0.0));
}

#[test]
fn objects_keep_their_own_transform() {
    let (d, found) = read(
        r#"WorldBegin
        ObjectInstance "tree"
        Translate 1 0 0
        ObjectBegin "tree"
            Translate 0 1 0
            Shape "sphere"
            AttributeBegin ActiveTransform EndTime Translate 0 0 1 Shape "disk" AttributeEnd
            AreaLightSource "diffuse" Shape "disk"
        ObjectEnd
        Shape "cylinder"
        Translate 5 0 0 ActiveTransform EndTime Translate 0 5 0
        ObjectInstance "tree""#,
    );
    let light = "s:8:39: warning: shapes of objects do not emit, in pbrt as here: the light is ignored";
    assert_eq!(found, [light]);
    assert_eq!(d.objects.len(), 1);
    let shapes = &d.objects[0].shapes;
    assert_eq!(shapes[0].motion.start().point(Vec3::ZERO), Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(shapes[1].motion.at(1.0).point(Vec3::ZERO), Vec3::new(1.0, 1.0, 1.0));
    assert_eq!(shapes[2].area_light, None);
    // What is set inside the object ends with it.
    assert_eq!(d.shapes.len(), 1);
    assert_eq!(d.shapes[0].area_light, None);
    assert_eq!(d.shapes[0].motion.start().point(Vec3::ZERO), Vec3::X);
    assert_eq!(d.instances.len(), 2);
    assert!(d.instances.iter().all(|i| i.object.index() == 0));
    assert_eq!(d.instances[0].motion, Motion::default());
    assert_eq!(d.instances[1].motion.at(1.0).point(Vec3::ZERO), Vec3::new(6.0, 5.0, 0.0));
}

#[test]
fn attributes_give_defaults_that_count_less() {
    let d = read_clean(
        r#"WorldBegin
        ColorSpace "aces2065-1"
        Attribute "shape" "float radius" 2 "float zmin" -1
        Attribute "shape" "float zmin" -0.5
        Attribute "light" "rgb L" [ 1 2 3 ]
        ColorSpace "srgb"
        AttributeBegin Attribute "shape" "float radius" 7 Shape "sphere" AttributeEnd
        Shape "sphere" "float radius" 3
        LightSource "infinite""#,
    );
    let float = |i: usize, name: &str| d.shapes[i].entity.params.get(name).map(|p| p.values.clone());
    assert_eq!(float(0, "radius"), Some(ParamValues::Floats(vec![7.0])));
    assert_eq!(float(0, "zmin"), Some(ParamValues::Floats(vec![-0.5])));
    assert_eq!(float(1, "radius"), Some(ParamValues::Floats(vec![3.0])));
    assert_eq!(float(1, "zmin"), Some(ParamValues::Floats(vec![-0.5])));
    // Defaults keep the colour space of the place where they are set.
    let light = &d.lights[0].entity;
    assert_eq!(light.params.get("L").unwrap().color_space, Some(ColorSpace::Aces2065_1));
    assert_eq!(light.color_space, ColorSpace::Srgb);
}

#[test]
fn option_values_have_types() {
    let d = read_clean(
        r#"Option "disable-Pixel_Jitter" true Option "seed" 7 Option "rendercoordsys" "world" WorldBegin
        Option "displacementedgescale" 0.5"#,
    );
    let options: Vec<_> = d.options.iter().map(|o| (o.name.as_str(), o.value.clone())).collect();
    assert_eq!(
        options,
        [
            ("disablepixeljitter", OptionValue::Bool(true)),
            ("seed", OptionValue::Number(7.0)),
            ("rendercoordsys", OptionValue::String("world".to_owned())),
            ("displacementedgescale", OptionValue::Number(0.5)),
        ]
    );
}

#[test]
fn includes_share_the_state_and_imports_do_not() {
    let files = Files::new([
        ("in", r#"Translate 1 0 0 AttributeBegin Shape "sphere""#),
        (
            "im",
            r#"Translate 0 1 0 CoordSysTransform "sys" CoordinateSystem "inner" Shape "disk"
            MakeNamedMaterial "m" "string type" "diffuse" ObjectBegin "o" Shape "sphere" ObjectEnd"#,
        ),
        ("part", r#"Shape "cylinder""#),
        ("tail", r#"Shape "sphere" "float radius""#),
    ]);
    let (d, found) = read_with(
        &files,
        r#"WorldBegin CoordinateSystem "sys"
        Include "in" AttributeEnd Shape "sphere"
        Import "im" Shape "sphere"
        ObjectInstance "o" NamedMaterial "m" Shape "sphere"
        ObjectBegin "p" Import "part" Include "part" ObjectEnd
        Include "tail" 4
        CoordSysTransform "inner""#,
    );
    let missing =
        "s:7:27: warning: coordinate system \"inner\" is not defined: the directive does nothing".to_owned();
    assert_eq!(found, [missing]);
    let x: Vec<_> = d.shapes.iter().map(|s| s.motion.start().point(Vec3::ZERO).to_array()).collect();
    assert_eq!(x, [[1., 0., 0.], [1., 0., 0.], [0., 0., 0.], [1., 0., 0.], [1., 0., 0.], [1., 0., 0.]]);
    assert_eq!(d.objects.iter().map(|o| o.shapes.len()).collect::<Vec<_>>(), [1, 2]);
    // A list of parameters may go on after the file that it begins in.
    assert_eq!(d.shapes[5].entity.params.get("radius").unwrap().values, ParamValues::Floats(vec![4.0]));
}

#[test]
fn comments_blanks_and_joined_tokens() {
    let d = read_clean(
        "# Film \"nothing\"\r\nWorldBegin#no comment here would be part of the word\n"
            .replace("#no comment here would be part of the word", " # one")
            .as_str(),
    );
    assert!(d.film.is_none());
    let d =
        read_clean("WorldBegin\tShape\"sphere\"\"float radius\"[1]\"float zmin\"[-1 # note ] 7\n]\r\n#end");
    assert_eq!(d.shapes[0].entity.params.params.len(), 2);
}

#[test]
fn transform_scopes_are_attribute_scopes_and_deprecated() {
    let (d, found) = read(
        r#"WorldBegin
        TransformBegin Translate 1 0 0 ReverseOrientation TransformEnd
        TransformBegin TransformEnd
        Shape "sphere""#,
    );
    assert_eq!(found.len(), 1);
    assert!(
        found[0].starts_with("s:2:9: warning: TransformBegin and TransformEnd do the same"),
        "{}",
        found[0]
    );
    assert!(!d.shapes[0].reverse_orientation);
}
