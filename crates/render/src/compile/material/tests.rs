//! Materials as scene files describe them, and what is said about faulty ones.

use tenfold_scene::{EmbeddedResources, Severity, SourceMap, read_pbrt_str};
use tenfold_spectrum::SampledWavelengths;

use super::*;

/// The last material of a scene, and all messages.
fn compile(materials: &str) -> (Material, Relief, Vec<(Severity, String)>) {
    let scene = format!("WorldBegin\n{materials}");
    let mut sources = SourceMap::new();
    let files = EmbeddedResources::new(&[]);
    let (description, diagnostics) = read_pbrt_str("scene.pbrt", &scene, &files, &mut sources);
    let cx = &mut Context::new(&diagnostics, &files);
    let mut textures = TextureLibrary::new(&description);
    let materials = compile_materials(cx, &description, &mut textures);
    textures.finish(cx);
    assert_eq!(materials.len(), description.materials.len());
    let last = Id::new(materials.len() - 1);
    let messages = diagnostics.to_vec().into_iter().map(|d| (d.severity, d.plain(&sources))).collect();
    (materials.get(last).clone(), materials.relief(last).clone(), messages)
}

fn sound(materials: &str) -> Material {
    let (material, _, messages) = compile(materials);
    assert!(messages.is_empty(), "{materials}: {messages:?}");
    material
}

fn alpha(roughness: &Roughness) -> [f32; 2] {
    let d = roughness.constant().unwrap();
    [d.alpha_x(), d.alpha_y()]
}

fn at_500(slot: &SpectrumSlot) -> f32 {
    slot.constant().unwrap().eval(500.0)
}

#[test]
fn defaults_are_those_of_pbrt() {
    let Material::Diffuse(m) = sound("Material \"diffuse\"") else { panic!() };
    assert_eq!(at_500(&m.reflectance), 0.5);
    let Material::DiffuseTransmission(m) = sound("Material \"diffusetransmission\"") else { panic!() };
    assert_eq!((at_500(&m.reflectance), at_500(&m.transmittance), m.scale), (0.25, 0.25, 1.0));
    let Material::Conductor(m) = sound("Material \"conductor\"") else { panic!() };
    let Metal::Index { eta, k } = &m.metal else { panic!() };
    assert_eq!(eta.constant(), named("metal-Cu-eta").map(quick).as_ref());
    assert_eq!(k.constant(), named("metal-Cu-k").map(quick).as_ref());
    assert_eq!(alpha(&m.roughness), [0.0, 0.0]);
    let Material::Dielectric(m) = sound("Material \"dielectric\"") else { panic!() };
    assert_eq!(m.eta.constant(), Some(1.5));
    let Material::ThinDielectric(m) = sound("Material \"thindielectric\"") else { panic!() };
    assert_eq!(m.eta.constant(), Some(1.5));
    let Material::CoatedDiffuse(m) = sound("Material \"coateddiffuse\"") else { panic!() };
    assert_eq!(at_500(&m.reflectance), 0.5);
    assert_eq!((m.coat.max_depth, m.coat.samples, m.coat.eta.constant()), (10, 1, Some(1.5)));
    assert_eq!(m.coat.thickness, FloatSlot::Constant(0.01));
    assert!(m.coat.is_clear() && m.coat.table.is_some());
    let Material::CoatedConductor(m) = sound("Material \"coatedconductor\"") else { panic!() };
    assert!(matches!(m.metal, Metal::Index { .. }) && m.coat.table.is_none());
    assert!(matches!(sound("Material \"interface\""), Material::Interface));
}

#[test]
fn roughness_is_remapped_unless_told_otherwise() {
    let of = |text: &str| {
        let Material::Conductor(m) = sound(&format!("Material \"conductor\" {text}")) else { panic!() };
        alpha(&m.roughness)
    };
    assert_eq!(of("\"float roughness\" 0.25"), [0.5, 0.5]);
    assert_eq!(of("\"float roughness\" 0.25 \"bool remaproughness\" false"), [0.25, 0.25]);
    assert_eq!(of("\"float uroughness\" 0.04 \"float roughness\" 0.25"), [0.2, 0.5]);
    assert_eq!(of("\"float vroughness\" 0.04 \"float uroughness\" 0.25"), [0.5, 0.2]);
}

#[test]
fn an_index_is_a_number_or_a_spectrum() {
    let of = |text: &str| {
        let Material::Dielectric(m) = sound(&format!("Material \"dielectric\" {text}")) else { panic!() };
        m.eta
    };
    assert_eq!(of("\"float eta\" 1.33").constant(), Some(1.33));
    assert_eq!(of("\"float eta\" 0").constant(), Some(1.0));
    assert_eq!(of("\"spectrum eta\" \"glass-BK7\"").constant(), None);
    // The same at all wavelengths: not dispersive.
    assert_eq!(of("\"spectrum eta\" [ 300 1.4 900 1.4 ]").constant(), Some(1.4));
    assert!((of("\"rgb eta\" [ 1.4 1.4 1.4 ]").constant().unwrap() - 1.4).abs() < 1e-5);
    let [least, largest] = of("\"spectrum eta\" \"glass-BK7\"").range();
    assert!(1.50 < least && least < 1.515 && 1.53 < largest && largest < 1.54);
}

#[test]
fn metals_and_coats_take_their_own_parameters() {
    let text =
        "Material \"coatedconductor\" \"float interface.roughness\" 0.04 \"float conductor.uroughness\" 0.09
        \"float conductor.vroughness\" 0.16 \"float interface.eta\" 1.3 \"float thickness\" 0.5
        \"spectrum conductor.eta\" \"metal-Ag-eta\" \"spectrum conductor.k\" \"metal-Ag-k\"
        \"rgb albedo\" [ 0.5 0.5 0.5 ] \"float g\" 0.3 \"integer maxdepth\" 20 \"integer nsamples\" 4";
    let Material::CoatedConductor(m) = sound(text) else { panic!() };
    assert_eq!((alpha(&m.coat.roughness), alpha(&m.roughness)), ([0.2, 0.2], [0.3, 0.4]));
    assert_eq!((m.coat.eta.constant(), m.coat.max_depth, m.coat.samples), (Some(1.3), 20, 4));
    assert_eq!((m.coat.thickness, m.coat.g), (FloatSlot::Constant(0.5), FloatSlot::Constant(0.3)));
    assert!(!m.coat.is_clear());
    let Metal::Index { eta, .. } = &m.metal else { panic!() };
    assert_eq!(eta.constant(), named("metal-Ag-eta").map(quick).as_ref());
    let text = "Material \"coatedconductor\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]";
    let Material::CoatedConductor(m) = sound(text) else { panic!() };
    assert!(matches!(m.metal, Metal::Reflectance(_)));
}

#[test]
fn coats_have_tables_where_their_parameters_allow() {
    let ramp = "Texture \"ramp\" \"float\" \"bilerp\"\n";
    let has_table = |text: &str| {
        let Material::CoatedDiffuse(m) = sound(&format!("{ramp}Material \"coateddiffuse\" {text}")) else {
            panic!()
        };
        m.coat.table.is_some()
    };
    assert!(has_table("\"float roughness\" 0.1"));
    assert!(has_table("\"texture roughness\" \"ramp\""));
    assert!(!has_table("\"texture uroughness\" \"ramp\""));
    assert!(!has_table("\"texture thickness\" \"ramp\""));
    assert!(!has_table("\"rgb albedo\" [ 0.1 0.1 0.1 ]"));
}

#[test]
fn equal_coats_share_their_table() {
    let scene = "WorldBegin Material \"coateddiffuse\" \"rgb reflectance\" [ 1 0 0 ] \"float roughness\" 0.1
        Material \"coateddiffuse\" \"rgb reflectance\" [ 0 0 1 ] \"float roughness\" 0.1";
    let mut sources = SourceMap::new();
    let files = EmbeddedResources::new(&[]);
    let (description, diagnostics) = read_pbrt_str("scene.pbrt", scene, &files, &mut sources);
    let cx = &mut Context::new(&diagnostics, &files);
    let materials = compile_materials(cx, &description, &mut TextureLibrary::new(&description));
    let n = materials.len();
    let [a, b] = [n - 2, n - 1].map(|i| match materials.get(Id::new(i)) {
        Material::CoatedDiffuse(m) => m.coat.table.clone().unwrap(),
        other => panic!("{other:?}"),
    });
    assert!(Arc::ptr_eq(&a, &b));
}

#[test]
fn mixes_name_materials_before_and_after() {
    let text = "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"b\" \"c\" ] \"float amount\" 0.25
        MakeNamedMaterial \"b\" \"string type\" \"diffuse\"
        MakeNamedMaterial \"c\" \"string type\" \"conductor\"
        Material \"mix\" \"string materials\" [ \"a\" \"b\" ]";
    let Material::Mix(m) = sound(text) else { panic!() };
    assert_eq!(m.amount, FloatSlot::Constant(0.5));
    assert_eq!(m.materials[0].index() + 1, m.materials[1].index());
}

#[test]
fn the_relief_is_a_texture_or_an_image() {
    let (_, relief, messages) = compile(
        "Texture \"ramp\" \"float\" \"bilerp\" Material \"diffuse\" \"texture displacement\" \"ramp\"",
    );
    assert!(messages.is_empty() && matches!(relief, Relief::Displacement(_)));
    let (_, relief, messages) = compile("Material \"diffuse\" \"float displacement\" 2");
    assert!(messages.is_empty() && matches!(relief, Relief::Smooth));
}

#[test]
fn deprecated_names_of_interfaces_are_warned_of() {
    for name in ["", "none"] {
        let (material, _, messages) = compile(&format!("Material \"{name}\""));
        assert!(matches!(material, Material::Interface));
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].0, Severity::Warning);
    }
}

#[test]
fn faults_are_told_with_their_place() {
    for (text, want) in [
        ("Material \"difuse\"", "unknown material \"difuse\" (did you mean \"diffuse\"?)"),
        ("Material \"hair\"", "material \"hair\" is not supported yet"),
        (
            "Material \"measured\" \"string filename\" \"x.bsdf\"",
            "material \"measured\" is not supported yet",
        ),
        ("Material \"subsurface\" \"string name\" \"Skin1\"", "material \"subsurface\" is not supported yet"),
        ("Material \"diffuse\" \"rgb reflectanc\" [ 1 1 1 ]", "did you mean \"reflectance\"?"),
        ("Material \"diffuse\" \"float reflectance\" 1", "must be \"spectrum\" or \"rgb\""),
        ("Material \"diffuse\" \"texture reflectance\" \"nothing\"", "unknown texture \"nothing\""),
        ("Material \"conductor\" \"float roughness\" -0.1", "cannot be negative"),
        ("Material \"conductor\" \"spectrum eta\" \"metal-Xu-eta\"", "did you mean"),
        (
            "Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"spectrum k\" \"metal-Au-k\"",
            "takes either \"reflectance\" or \"eta\" and \"k\", not both",
        ),
        (
            "Material \"dielectric\" \"texture eta\" \"x\"",
            "must be \"float\" or \"spectrum\", found \"texture\"",
        ),
        ("Material \"dielectric\" \"float eta\" -1.5", "cannot be negative"),
        ("Material \"coateddiffuse\" \"integer maxdepth\" 0", "at least 1"),
        ("Material \"coateddiffuse\" \"float thickness\" -1", "cannot be negative"),
        ("Material \"mix\"", "has no parameter \"string materials\""),
        ("Material \"mix\" \"string materials\" [ \"a\" ]", "needs the names of two materials"),
        ("Material \"mix\" \"string materials\" [ \"a\" \"a\" ]", "unknown material \"a\""),
        (
            "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [ \"b\" \"b\" ] MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"a\" ]",
            "contains itself",
        ),
        ("Material \"diffuse\" \"string normalmap\" \"n.png\"", "cannot read \"n.png\""),
    ] {
        let (_, _, messages) = compile(text);
        assert!(!messages.is_empty(), "{text}");
        for (severity, message) in &messages {
            assert_eq!(*severity, Severity::Error, "{message}");
            assert!(message.contains(want), "{message:?} does not say {want:?}");
            assert!(message.starts_with("scene.pbrt:2:"), "{message}");
        }
        // A mix that names the same unknown twice says so twice.
        assert!(messages.len() == 1 || text.contains("\"a\" \"a\" ]"), "{messages:?}");
    }
}

#[test]
fn reflectances_above_one_are_taken_as_one() {
    let (material, _, messages) = compile("Material \"diffuse\" \"rgb reflectance\" [ 2 2 2 ]");
    assert_eq!(messages.len(), 1);
    assert_eq!(messages[0].0, Severity::Warning);
    let Material::Diffuse(m) = material else { panic!() };
    let w = SampledWavelengths::sample_visible(0.1);
    assert!((m.reflectance.constant().unwrap().sample(&w)[0] - 1.0).abs() < 1e-6);
}
