//! Furnaces: bodies under the same radiance from everywhere, whose own radiance follows from what they lose.

use super::common::{FLAT, LAMBDA, check_lanes, fresnel, gauss_legendre, header, radiance, ray, scene};
use std::f64::consts::PI;
use tenfold_math::{Ray, Vec3, vec3};
use tenfold_render::bxdf::{Bsdf, Bxdf, Conductor, Dielectric, TrowbridgeReitz};
use tenfold_render::integrator::DispersionRule::{self, Split, Terminate};
use tenfold_render::scene::Scene;
use tenfold_render::texture::TextureContext;
use tenfold_spectrum::{N, SampledSpectrum, SampledWavelengths, named};
use tenfold_testkit::quadrature::{Tolerance, hemisphere, integrate};

/// Distances from the middle of the unit sphere at which rays pass it.
const IMPACTS: [f32; 5] = [0.0, 0.35, 0.7, 0.9, 0.99];

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::new(LAMBDA, [1.0; N])
}

/// The unit sphere of a material under radiance 1 from everywhere.
fn furnace(material: &str) -> Scene {
    scene(&format!(r#"{} LightSource "infinite" {FLAT} Material {material} Shape "sphere""#, header(1000)))
}

/// A ray that meets the unit sphere at the sine `impact` to its normal.
fn at_impact(impact: f32) -> Ray {
    ray(vec3(0.6 * impact, 0.8 * impact, -3.0), Vec3::Z)
}

/// The cosine to the normal at which [`at_impact`] meets the sphere.
fn cosine(impact: f32) -> f32 {
    (1.0 - impact * impact).sqrt()
}

/// Checks the radiance of a sphere against what `want` says of the cosine to the normal.
#[track_caller]
fn check(what: &str, material: &str, rule: DispersionRule, samples: u32, want: impl Fn(f32) -> [f64; N]) {
    let scene = furnace(material);
    for (i, impact) in IMPACTS.into_iter().enumerate() {
        let got = radiance(&scene, at_impact(impact), rule, samples, i as u64);
        check_lanes(&format!("{what} at {impact}"), &got, want(cosine(impact)), 0.005, IMPACTS.len());
    }
}

/// In a closed room whose walls emit Le and reflect ρ, L = Le + ρ L everywhere and in all directions.
#[test]
fn closed_diffuse_sphere() {
    for (i, albedo) in [0.0, 0.2, 0.5, 0.8, 0.95].into_iter().enumerate() {
        let scene = scene(&format!(
            r#"{} ReverseOrientation AreaLightSource "diffuse" {FLAT}
            Material "diffuse" "spectrum reflectance" [ 300 {albedo} 900 {albedo} ] Shape "sphere""#,
            header(10_000)
        ));
        let inside = ray(vec3(0.3, 0.2, -0.1), vec3(0.5, 0.6, -0.4));
        let got = radiance(&scene, inside, Split, 20_000, i as u64);
        check_lanes(&format!("albedo {albedo}"), &got, [1.0 / (1.0 - albedo); N], 0.005, 5);
    }
}

/// Glass loses nothing: it cannot be seen under light from everywhere, whatever it does to wavelengths.
#[test]
fn smooth_glass_is_invisible() {
    check("glass", r#""dielectric" "float eta" 1.5"#, Split, 200, |_| [1.0; N]);
    for rule in [Split, Terminate] {
        check("dispersive glass", r#""dielectric" "spectrum eta" "glass-F11""#, rule, 200, |_| [1.0; N]);
    }
    check("thin glass", r#""thindielectric" "float eta" 1.5"#, Split, 200, |_| [1.0; N]);
}

/// Inside of glass radiance is n² times that outside (Nicodemus 1963), except along rays that are totally reflected for ever.
#[test]
fn light_within_glass() {
    let glass = named("glass-F11").unwrap();
    let scene = furnace(r#""dielectric" "spectrum eta" "glass-F11""#);
    let want = LAMBDA.map(|l| f64::from(glass.eval(l)).powi(2));
    for (i, direction) in [Vec3::X, Vec3::Y, vec3(1.0, 2.0, -3.0)].into_iter().enumerate() {
        for rule in [Split, Terminate] {
            let got = radiance(&scene, ray(vec3(0.3, 0.2, 0.1), direction), rule, 400, i as u64);
            check_lanes(&format!("toward {direction}"), &got, want, 0.01, 6);
        }
    }
    // At 0.9 of the radius, across: a sine of 0.9 is beyond the critical angle.
    let got = radiance(&scene, ray(vec3(0.9, 0.0, 0.0), Vec3::Y), Split, 50, 0);
    assert!(got.iter().all(|w| w.mean == 0.0));
}

/// Reflected light of the base and, through the sphere, of its other side: with transmission T and reflection R the inside
/// has radiance T / (1 − R), of which T comes out again.
#[test]
fn diffuse_transmission() {
    for (r, t) in [(0.5, 0.5), (0.3, 0.6), (0.0, 1.0)] {
        let material = format!(
            r#""diffusetransmission" "spectrum reflectance" [ 300 {r} 900 {r} ] "spectrum transmittance" [ 300 {t} 900 {t} ]"#
        );
        check(&format!("R {r} T {t}"), &material, Split, 10_000, |_| [r + t * t / (1.0 - r); N]);
    }
}

/// The part of uniform light that is reflected toward a direction: `∫ f cos dω`, in every lane.
fn albedo(f: impl Fn(Vec3) -> SampledSpectrum) -> [f64; N] {
    let tolerance =
        Tolerance { absolute: 1e-5, relative: 1e-5, pieces: 8, evaluations: 300_000, ..Tolerance::default() };
    std::array::from_fn(|lane| hemisphere(&tolerance, |wi| f64::from(f(wi).lane(lane) * wi.z)).value)
}

fn direction(cos: f32) -> Vec3 {
    vec3((1.0 - cos * cos).sqrt(), 0.0, cos)
}

/// A smooth metal shows Fresnel's reflectance, a rough one its directional albedo.
#[test]
fn metal() {
    let index = |part: &str| named(&format!("metal-Cu-{part}")).unwrap().sample(&wavelengths());
    let (eta, k) = (index("eta"), index("k"));
    let metal =
        r#""conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "bool remaproughness" false "#;
    check("smooth copper", metal, Split, 10, |cos| {
        std::array::from_fn(|i| fresnel_conductor(cos.into(), eta.lane(i).into(), k.lane(i).into()))
    });
    for alpha in [0.1, 0.3, 0.7] {
        let bxdf = Bxdf::Conductor(Conductor::new(eta, k, TrowbridgeReitz::new(alpha, alpha)));
        let rough = format!(r#"{metal} "float roughness" {alpha}"#);
        check(&format!("copper of roughness {alpha}"), &rough, Split, 20_000, |cos| {
            albedo(|wi| bxdf.eval(direction(cos), wi))
        });
    }
}

/// Fresnel's reflectance of an absorbing medium of index `eta + i k` (Born and Wolf, *Principles of Optics*, §14.2).
fn fresnel_conductor(cos: f64, eta: f64, k: f64) -> f64 {
    let (c2, s2) = (cos * cos, 1.0 - cos * cos);
    let t0 = eta * eta - k * k - s2;
    let a2b2 = (t0 * t0 + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (a2b2 + t0)).max(0.0).sqrt();
    let s = (a2b2 + c2 - 2.0 * a * cos) / (a2b2 + c2 + 2.0 * a * cos);
    let both = c2 * a2b2 + s2 * s2;
    let p = s * (both - 2.0 * a * cos * s2) / (both + 2.0 * a * cos * s2);
    0.5 * (s + p)
}

/// Of light along the normal, microfacets of a perfect mirror lose what they send below the horizon, and what then is masked: the
/// visible normals have tan²θ = α² u / (1 − u) for uniform u, light leaves at 2θ, and of it G₁ = 1 / (1 + Λ) escapes (Walter et al. 2007;
/// Heitz 2014). Nowhere is anything gained.
#[test]
fn energy_lost_by_single_scattering() {
    for alpha in [0.05, 0.1, 0.3, 0.5, 0.9] {
        let material = format!(
            r#""conductor" "spectrum eta" [ 300 0.001 900 0.001 ] "spectrum k" [ 300 1000 900 1000 ] "bool remaproughness" false
            "float roughness" {alpha}"#
        );
        let scene = furnace(&material);
        // Beyond u = 1 / (1 + α²), where tan²θ = 1, nothing is left.
        let escaping = integrate(0.0, 1.0 / (1.0 + alpha * alpha), |u| {
            let tan = 2.0 * (alpha * (u / (1.0 - u)).sqrt()).atan();
            2.0 / (1.0 + (1.0 + alpha * alpha * tan.tan().powi(2)).sqrt())
        });
        let along = radiance(&scene, at_impact(0.0), Split, 40_000, 8);
        check_lanes(&format!("roughness {alpha}"), &along, [escaping; N], 0.003, 5);
        for impact in [0.5, 0.8, 0.95] {
            let got = radiance(&scene, at_impact(impact), Split, 4000, 7)[0];
            assert!(
                got.mean <= 1.0 + 5.0 * got.standard_error() + 1e-4,
                "roughness {alpha}, {impact}: {got:?}"
            );
        }
    }
}

/// What the scene's own scattering function reflects of uniform light; for coats that have no closed form but their tables.
fn scene_bsdf<'a>(scene: &'a Scene, ray: &Ray) -> (Bsdf<'a>, Vec3) {
    let hit = scene.world.intersect(ray, f32::INFINITY, |_| true).unwrap();
    let surface = scene.world.interaction(ray, &hit);
    let at = TextureContext::at(&surface);
    let material = scene.surfaces[scene.world.geometry(hit.primitive.geometry).user as usize].material;
    let bsdf = scene.materials.bsdf(material, &scene.textures, &surface, &at, &wavelengths(), || 0.5);
    (bsdf.unwrap(), surface.wo)
}

/// A coated sphere reflects no light onto itself: it shows the albedo of its scattering function, and of a smooth coat the mirror image
/// of the sky as well.
#[test]
fn coated_diffuse() {
    for roughness in [0.0, 0.2, 0.5] {
        let scene = furnace(&format!(
            r#""coateddiffuse" "rgb reflectance" [ 0.8 0.5 0.2 ] "float roughness" {roughness} "bool remaproughness" false"#
        ));
        for (i, impact) in IMPACTS.into_iter().enumerate() {
            let ray = at_impact(impact);
            let (bsdf, wo) = scene_bsdf(&scene, &ray);
            let wo = bsdf.frame().to_local(wo);
            let mirrored = if roughness == 0.0 { fresnel(wo.z.into(), 1.5) } else { 0.0 };
            let want = albedo(|wi| bsdf.bxdf().eval(wo, wi)).map(|scattered| scattered + mirrored);
            assert!(want.iter().all(|a| (0.0..=1.0).contains(a)), "{want:?}");
            let got = radiance(&scene, ray, Split, 20_000, i as u64);
            check_lanes(&format!("coat of roughness {roughness} at {impact}"), &got, want, 0.005, 15);
        }
    }
}

/// A white base under a smooth clear coat gives back all light, in the end, but for what the slab takes on every way: at the thickness
/// 0.01 some per cent, as light of a white base crosses it several times.
#[test]
fn white_under_a_clear_coat() {
    let coat = |thickness: f32| {
        let scene = furnace(&format!(
            r#""coateddiffuse" "rgb reflectance" [ 1 1 1 ] "float roughness" 0 "integer maxdepth" 200 "float thickness" {thickness}"#
        ));
        radiance(&scene, at_impact(0.3), Split, 10_000, 3)
    };
    check_lanes("without thickness", &coat(1e-5), [1.0; N], 0.002, 1);
    let thin = coat(0.01)[0].mean;
    assert!((0.85..0.97).contains(&thin), "{thin}");
}

/// The radiance of a sphere of rough glass under uniform light of radiance 1, by an integral equation of one variable.
///
/// A chord meets the sphere at the same angle at both ends. So the radiance `I` that leaves the boundary inward at an angle is what
/// arrives at the boundary from within at that angle, and, with the scattering `f` integrated over the azimuth,
/// `I(μ) = ∫ f(in μ, in μ') I(μ') μ' dμ' + ∫ f(in μ, out μ') μ' dμ'`; what leaves outward follows from `I`.
struct RoughSphere {
    bxdf: Bxdf<'static>,
    nodes: Vec<(f64, f64)>,
    /// `I` at the nodes.
    inward: Vec<[f64; N]>,
}

impl RoughSphere {
    const AZIMUTHS: usize = 96;

    fn new(eta: SampledSpectrum, alpha: f32, nodes: usize) -> Self {
        let bxdf = Bxdf::Dielectric(Dielectric::new(eta, TrowbridgeReitz::new(alpha, alpha)));
        let mut sphere = Self { bxdf, nodes: gauss_legendre(nodes), inward: vec![[1.0; N]; nodes] };
        let rows: Vec<Vec<[f64; N]>> = sphere.nodes.iter().map(|&(mu, _)| sphere.row(-mu, -1.0)).collect();
        let entering: Vec<[f64; N]> =
            sphere.nodes.iter().map(|&(mu, _)| sum(&sphere.row(-mu, 1.0), |_| [1.0; N])).collect();
        for _ in 0..400 {
            let last = sphere.inward.clone();
            for (i, row) in rows.iter().enumerate() {
                let reflected = sum(row, |j| last[j]);
                sphere.inward[i] = std::array::from_fn(|lane| reflected[lane] + entering[i][lane]);
            }
        }
        sphere
    }

    /// For every node μ' on a side, `∫ f(μ, μ') μ' dφ` times the weight of the node.
    fn row(&self, mu: f64, side: f64) -> Vec<[f64; N]> {
        let direction = |mu: f64, phi: f64| {
            let sin = (1.0 - mu * mu).sqrt();
            vec3((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, mu as f32)
        };
        let wo = direction(mu, 0.0);
        let entry = |&(node, weight): &(f64, f64)| {
            let mut sum = [0.0; N];
            for k in 0..Self::AZIMUTHS {
                // Half of the azimuths: the others are mirror images.
                let phi = PI * (k as f64 + 0.5) / Self::AZIMUTHS as f64;
                let f = self.bxdf.eval(wo, direction(side * node, phi));
                let share = 2.0 * PI / Self::AZIMUTHS as f64 * node * weight;
                sum.iter_mut().enumerate().for_each(|(lane, s)| *s += share * f64::from(f.lane(lane)));
            }
            sum
        };
        self.nodes.iter().map(entry).collect()
    }

    /// The radiance that leaves outward at the cosine `mu`.
    fn outward(&self, mu: f64) -> [f64; N] {
        let reflected = sum(&self.row(mu, 1.0), |_| [1.0; N]);
        let through = sum(&self.row(mu, -1.0), |j| self.inward[j]);
        std::array::from_fn(|lane| reflected[lane] + through[lane])
    }
}

fn sum(row: &[[f64; N]], radiance: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let mut total = [0.0; N];
    for (j, entry) in row.iter().enumerate() {
        let l = radiance(j);
        total.iter_mut().enumerate().for_each(|(lane, t)| *t += entry[lane] * l[lane]);
    }
    total
}

#[test]
fn rough_glass() {
    let flat = SampledSpectrum::splat(1.5);
    let f11 = named("glass-F11").unwrap().sample(&wavelengths());
    for (glass, eta, alpha) in [
        (r#""float eta" 1.5"#, flat, 0.3),
        (r#""float eta" 1.5"#, flat, 0.6),
        (r#""spectrum eta" "glass-F11""#, f11, 0.35),
    ] {
        let solved = RoughSphere::new(eta, alpha, 96);
        let material =
            format!(r#""dielectric" {glass} "bool remaproughness" false "float roughness" {alpha}"#);
        let scene = furnace(&material);
        for (i, impact) in [0.0, 0.5, 0.9].into_iter().enumerate() {
            let want = solved.outward(cosine(impact).into());
            // Single scattering loses energy, and never gains any.
            assert!(want.iter().all(|l| (0.3..1.0).contains(l)), "{want:?}");
            let got = radiance(&scene, at_impact(impact), Split, 20_000, i as u64);
            check_lanes(&format!("{material} at {impact}"), &got, want, 0.005, 9);
        }
    }
}

/// Glass that hardly scatters hardly loses anything.
#[test]
fn slightly_rough_glass_is_nearly_invisible() {
    let scene = furnace(r#""dielectric" "float eta" 1.5 "bool remaproughness" false "float roughness" 0.02"#);
    for impact in [0.0, 0.5, 0.8] {
        let got = radiance(&scene, at_impact(impact), Split, 1000, 1)[2];
        let error = 5.0 * got.standard_error() + 1e-3;
        assert!((1.0 - 0.01 - error..1.0 + error).contains(&got.mean), "{impact}: {got:?}");
    }
}

/// A mix of materials shows the weighted mean of what they show.
#[test]
fn mixed_materials() {
    let scene = scene(&format!(
        r#"{} LightSource "infinite" {FLAT}
        MakeNamedMaterial "dark" "string type" "diffuse" "spectrum reflectance" [ 300 0.2 900 0.2 ]
        MakeNamedMaterial "light" "string type" "diffuse" "spectrum reflectance" [ 300 0.8 900 0.8 ]
        Material "mix" "string materials" [ "dark" "light" ] "float amount" 0.25
        Shape "sphere""#,
        header(1000)
    ));
    let got = radiance(&scene, at_impact(0.4), Split, 1000, 1);
    check_lanes("a quarter light", &got, [0.75 * 0.2 + 0.25 * 0.8; N], 0.02, 1);
}
