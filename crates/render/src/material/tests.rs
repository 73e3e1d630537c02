//! Materials at a point against what they are made of.

use super::*;
use crate::bxdf::Lobe;
use crate::texture::{Bilerp, Fbm, FloatTexture, Mapping2, Mapping3};
use std::sync::Arc;
use tenfold_geometry::{InstanceId, PrimitiveId, Shading};
use tenfold_image::Image;
use tenfold_math::ops;
use tenfold_math::{Frame, Vec2, Vec3, vec2, vec3};
use tenfold_spectrum::{Spectrum, named};

/// The plane z = 0 with p = (u, v, 0) seen from above.
fn plane() -> SurfaceInteraction {
    let shading = Shading { n: Vec3::Z, dpdu: Vec3::X, dpdv: Vec3::Y, dndu: Vec3::ZERO, dndv: Vec3::ZERO };
    SurfaceInteraction {
        p: vec3(0.3, 0.6, 0.0),
        p_error: Vec3::ZERO,
        n: Vec3::Z,
        uv: vec2(0.3, 0.6),
        param: vec2(0.3, 0.6),
        dpdu: Vec3::X,
        dpdv: Vec3::Y,
        shading,
        wo: vec3(0.6, 0.0, 0.8),
        time: 0.0,
        primitive: PrimitiveId { geometry: Id::new(0), index: 0 },
        instance: InstanceId::NONE,
        face_index: 0,
    }
}

fn waves() -> SampledWavelengths {
    SampledWavelengths::sample_visible(0.37)
}

fn grey(v: f32) -> SpectrumSlot {
    SpectrumSlot::Constant(Spectrum::Constant(v))
}

fn smooth() -> Roughness {
    Roughness::Constant(TrowbridgeReitz::SMOOTH)
}

fn clear_coat(table: Option<Arc<crate::bxdf::CoatTable>>) -> Coat {
    Coat {
        eta: Eta::new(Spectrum::Constant(1.5)),
        roughness: Roughness::new(FloatSlot::Constant(0.3), FloatSlot::Constant(0.3), false),
        thickness: FloatSlot::Constant(0.01),
        albedo: grey(0.0),
        g: FloatSlot::Constant(0.0),
        max_depth: 10,
        samples: 1,
        table,
    }
}

/// Evaluates one material on the plane.
fn with_bsdf<R>(
    material: Material,
    relief: Relief,
    textures: &Textures,
    f: impl FnOnce(Bsdf<'_>) -> R,
) -> Option<R> {
    let mut materials = Materials::default();
    let id = materials.add(material, relief);
    let surface = plane();
    let at = TextureContext::at(&surface);
    materials.bsdf(id, textures, &surface, &at, &waves(), || 0.5).map(f)
}

#[test]
fn diffuse_reflectance_is_limited_to_one() {
    let wi = vec3(0.0, 0.6, 0.8);
    for (r, want) in [(0.5, 0.5), (1.7, 1.0), (-1.0, 0.0)] {
        let material = Material::Diffuse(Diffuse { reflectance: grey(r) });
        let f =
            with_bsdf(material, Relief::Smooth, &Textures::default(), |b| b.eval(plane().wo, wi)).unwrap();
        assert!((f[2] - want * std::f32::consts::FRAC_1_PI).abs() < 1e-6);
    }
}

#[test]
fn transmission_is_scaled_before_it_is_limited() {
    let material = Material::DiffuseTransmission(DiffuseTransmission {
        reflectance: grey(0.25),
        transmittance: grey(0.7),
        scale: 2.0,
    });
    let (up, down) = (vec3(0.0, 0.6, 0.8), vec3(0.0, 0.6, -0.8));
    let [r, t] = with_bsdf(material, Relief::Smooth, &Textures::default(), |b| {
        [up, down].map(|wi| b.eval(plane().wo, wi)[0] * std::f32::consts::PI)
    })
    .unwrap();
    assert!((r - 0.5).abs() < 1e-6 && (t - 1.0).abs() < 1e-6);
}

#[test]
fn a_metal_by_its_reflectance_reflects_that_much_at_normal_incidence() {
    let material =
        Material::Conductor(Conductor { metal: Metal::Reflectance(grey(0.7)), roughness: smooth() });
    let sample = with_bsdf(material, Relief::Smooth, &Textures::default(), |b| {
        b.sample(Vec3::Z, 0.5, Vec2::splat(0.5), 0)
    });
    let sample = sample.flatten().unwrap();
    assert!((sample.f[0] - 0.7).abs() < 1e-5, "{sample:?}");
    assert!(sample.lobe.is_specular());
}

#[test]
fn glass_disperses_only_if_its_index_varies() {
    let refract = |eta: Spectrum| {
        let material = Material::Dielectric(Dielectric { eta: Eta::new(eta), roughness: smooth() });
        // Fresnel reflection at 37° is below 10 %: this number chooses to refract.
        with_bsdf(material, Relief::Smooth, &Textures::default(), |b| {
            b.sample(plane().wo, 0.9, Vec2::splat(0.5), 1)
        })
        .flatten()
        .unwrap()
    };
    let plain = refract(Spectrum::Constant(1.5));
    assert!(plain.lobe.contains(Lobe::TRANSMISSION) && !plain.dispersive);
    // Snell: sin 36.87° = 0.6.
    assert!((plain.wi - vec3(-0.4, 0.0, -(0.84f32.sqrt()))).length() < 1e-5);
    let flint = refract(named("glass-F11").unwrap());
    assert!(flint.dispersive);
    let eta = Eta::new(named("glass-F11").unwrap()).sample(&waves())[1];
    assert!((flint.wi.x + 0.6 / eta).abs() < 1e-5, "{flint:?} {eta}");
}

#[test]
fn interfaces_have_no_scattering() {
    assert!(with_bsdf(Material::Interface, Relief::Smooth, &Textures::default(), |_| ()).is_none());
}

#[test]
fn mixes_choose_by_their_amount() {
    let mut textures = Textures::default();
    let ramp = Bilerp { mapping: Mapping2::default(), corners: [0.0, 0.0, 1.0, 1.0] };
    let ramp = FloatSlot::Texture(textures.add_float(FloatTexture::Bilerp(ramp)));
    let mut materials = Materials::default();
    let parts = [0.0f32, 0.5, 1.0]
        .map(|r| materials.add(Material::Diffuse(Diffuse { reflectance: grey(r) }), Relief::Smooth));
    let inner = Mix { materials: [parts[1], parts[2]], amount: FloatSlot::Constant(0.25) };
    let inner = materials.add(Material::Mix(inner), Relief::Smooth);
    let outer =
        materials.add(Material::Mix(Mix { materials: [parts[0], inner], amount: ramp }), Relief::Smooth);
    let surface = plane();
    let share = |u: f32| {
        let at = TextureContext { uv: vec2(u, 0.0), ..TextureContext::at(&surface) };
        let mut counts = [0; 3];
        let n = 4000;
        for i in 0..n {
            let u_mix = || (i as f32 + 0.5) / n as f32;
            let id = materials.resolve(outer, &textures, &at, u_mix);
            counts[parts.iter().position(|p| *p == id).unwrap()] += 1;
        }
        counts.map(|c| c as f32 / n as f32)
    };
    assert_eq!(share(0.0), [1.0, 0.0, 0.0]);
    for u in [0.4, 1.0] {
        let got = share(u);
        for (got, want) in got.iter().zip([1.0 - u, u * 0.75, u * 0.25]) {
            assert!((got - want).abs() < 1e-3, "{got:?}, not {want}");
        }
    }
    // A number is asked for only where it is needed.
    let at = TextureContext { uv: vec2(0.0, 0.0), ..TextureContext::at(&surface) };
    assert_eq!(materials.resolve(outer, &textures, &at, || unreachable!()), parts[0]);
}

#[test]
fn bumps_tilt_the_normal_against_the_slope() {
    let mut textures = Textures::default();
    let slope = 0.5;
    let ramp = Bilerp { mapping: Mapping2::default(), corners: [0.0, 0.0, slope, slope] };
    let ramp = FloatSlot::Texture(textures.add_float(FloatTexture::Bilerp(ramp)));
    let material = || Material::Diffuse(Diffuse { reflectance: grey(0.5) });
    let frame = with_bsdf(material(), Relief::Displacement(ramp), &textures, |b| *b.frame()).unwrap();
    // The surface z = u / 2.
    assert!((frame.z - vec3(-slope, 0.0, 1.0).normalize()).length() < 1e-3, "{frame:?}");
    assert!((frame.x - vec3(1.0, 0.0, slope).normalize()).length() < 1e-3, "{frame:?}");
    let flat = with_bsdf(material(), Relief::Smooth, &textures, |b| *b.frame()).unwrap();
    assert_eq!((flat.x, flat.z), (Vec3::X, Vec3::Z));
}

#[test]
fn bumps_agree_with_the_normal_of_the_displaced_surface() {
    // A solid texture, so that the displaced point is what counts.
    let mut textures = Textures::default();
    let waves = Fbm { mapping: Mapping3::default(), octaves: 1, omega: 0.5 };
    let height = FloatSlot::Texture(textures.add_float(FloatTexture::Fbm(waves)));
    let h = |x: f32, y: f32| textures.float(&height, &TextureContext::at_point(vec3(x, y, 0.0)));
    let (p, d) = (plane().p, 1e-3);
    let dhdx = (h(p.x + d, p.y) - h(p.x - d, p.y)) / (2.0 * d);
    let dhdy = (h(p.x, p.y + d) - h(p.x, p.y - d)) / (2.0 * d);
    let want = vec3(-dhdx, -dhdy, 1.0).normalize();
    let surface = plane();
    let frame = Relief::Displacement(height).frame(&textures, &surface, &TextureContext::at(&surface));
    assert!((frame.z - want).length() < 5e-3, "{frame:?}, not {want}");
}

#[test]
fn normal_maps_turn_the_frame() {
    let n = vec3(0.6, 0.0, 0.8);
    let c = 0.5 * (n + Vec3::ONE);
    let image = Arc::new(Image::from_f32(1, 1, ["R", "G", "B"], c.to_array().to_vec()).unwrap());
    let surface = plane();
    let at = TextureContext::at(&surface);
    let frame = Relief::NormalMap(image.clone()).frame(&Textures::default(), &surface, &at);
    assert!((frame.z - n).length() < 1e-5, "{frame:?}");
    assert!((frame.x - vec3(0.8, 0.0, -0.6)).length() < 1e-5, "{frame:?}");
    // A degenerate map leaves the shape's own frame.
    let none = Arc::new(Image::from_f32(1, 1, ["R", "G", "B"], vec![0.5; 3]).unwrap());
    let frame = Relief::NormalMap(none).frame(&Textures::default(), &surface, &at);
    assert_eq!(frame, Frame::from_z_and_tangent(Vec3::Z, Vec3::X));
}

#[test]
fn coats_use_their_table_or_random_walks() {
    let table = Arc::new(crate::bxdf::CoatTable::new(
        1.5,
        1.5,
        crate::bxdf::CoatRoughness::Constant(TrowbridgeReitz::new(0.3, 0.3)),
        0.01,
    ));
    let of = |table: Option<_>| {
        let coat = CoatedDiffuse { reflectance: grey(0.5), coat: clear_coat(table) };
        let mut materials = Materials::default();
        let id = materials.add(Material::CoatedDiffuse(coat), Relief::Smooth);
        let wi = vec3(-0.28, 0.0, 0.96);
        let n = 20_000;
        let mut sum = 0.0f64;
        let mut surface = plane();
        let mut is_table = false;
        for i in 0..n {
            // Random walks take their numbers from the point.
            surface.p.z = i as f32;
            let at = TextureContext::at(&surface);
            let bsdf = materials.bsdf(id, &Textures::default(), &surface, &at, &waves(), || 0.0).unwrap();
            is_table = matches!(bsdf.bxdf(), Bxdf::CoatedDiffuse(_));
            sum += f64::from(bsdf.eval(surface.wo, wi)[0]);
        }
        (sum / f64::from(n), is_table)
    };
    let (closed, tabulated) = of(Some(table));
    let (walked, tabulated_too) = of(None);
    assert!(tabulated && !tabulated_too);
    assert!((walked / closed - 1.0).abs() < 0.02, "{walked} {closed}");
}

#[test]
fn a_coated_mirror_sums_its_reflections() {
    let metal = Metal::Reflectance(grey(0.6));
    let coat = Coat { roughness: smooth(), ..clear_coat(None) };
    let material = Material::CoatedConductor(CoatedConductor { metal, roughness: smooth(), coat });
    let sample = with_bsdf(material, Relief::Smooth, &Textures::default(), |b| {
        b.sample(Vec3::Z, 0.5, Vec2::splat(0.5), 0)
    });
    let sample = sample.flatten().unwrap();
    // At normal incidence: the coat reflects 0.04, the metal seen from inside it r (its index over that of the coat's
    // 1.5), and light crosses the slab of optical thickness 0.01 twice between the two.
    let (eta, k2) = (1.0 / 1.5f32, 4.0 * 0.6 / 0.4 / 2.25);
    let r = ((eta - 1.0).powi(2) + k2) / ((eta + 1.0).powi(2) + k2) * ops::exp(-0.02f32);
    let want = 0.04 + 0.96 * 0.96 * r / (1.0 - 0.04 * r);
    assert!(sample.lobe.is_specular());
    assert!((sample.f[0] / sample.pdf[0] - want).abs() < 1e-4, "{sample:?}, not {want}");
}

#[test]
fn footprints_are_solved_for_on_any_parametrisation() {
    let surface = SurfaceInteraction { dpdu: vec3(2.0, 0.0, 0.0), dpdv: vec3(1.0, 3.0, 0.0), ..plane() };
    let (dpdx, dpdy) = (0.5 * surface.dpdu - 0.25 * surface.dpdv, 0.1 * surface.dpdv + 7.0 * Vec3::Z);
    let at = TextureContext::with_differentials(&surface, dpdx, dpdy);
    let f = at.footprint;
    let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{f:?}");
    near(f.dudx, 0.5);
    near(f.dvdx, -0.25);
    near(f.dudy, 0.0);
    near(f.dvdy, 0.1);
    assert_eq!((f.dpdx, f.dpdy), (dpdx, dpdy));
    // No parametrisation, no footprint.
    let surface = SurfaceInteraction { dpdv: Vec3::ZERO, ..surface };
    let f = TextureContext::with_differentials(&surface, dpdx, dpdy).footprint;
    assert_eq!([f.dudx, f.dudy, f.dvdx, f.dvdy], [0.0; 4]);
}
