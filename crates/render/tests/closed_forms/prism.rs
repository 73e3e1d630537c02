//! A prism spreads light into the directions of Snell's law, with the indices of the glass makers' catalogues.

use super::common::{check_mean, fresnel, header, scene, traced};
use tenfold_math::{DVec3, Ray, UVec2, Vec2, Vec3};
use tenfold_render::bxdf::Lobe;
use tenfold_render::integrator::{DispersionRule, PathTracer, Sample, Strategies};
use tenfold_render::scene::Scene;
use tenfold_render::texture::TextureContext;
use tenfold_sampling::{Sampler, SamplerKind};
use tenfold_spectrum::SampledWavelengths;
use tenfold_testkit::Welford;

/// Fraunhofer's lines C, d and F, in nm.
const LINES: [f64; 3] = [656.2725, 587.5618, 486.1327];

/// A glass, its indices at [`LINES`] from Schott's data sheets (N-BK7 517642, N-SF11 785257), and angles of incidence, in
/// degrees, at which light passes a prism of 60°.
const GLASSES: [(&str, [f64; 3], [f64; 4]); 2] = [
    ("glass-BK7", [1.51432, 1.51680, 1.52238], [40.0, 49.32, 60.0, 75.0]),
    ("glass-F11", [1.77596, 1.78472, 1.80651], [57.0, 63.17, 70.0, 80.0]),
];

/// The refracting angle.
const APEX: f64 = std::f64::consts::FRAC_PI_3;

/// Deviation of light that meets a prism of index `n` at `incidence` (Born and Wolf, *Principles of Optics*, §4.7.2).
fn deviation(n: f64, incidence: f64) -> f64 {
    let inside = (incidence.sin() / n).asin();
    let exit = (n * (APEX - inside).sin()).asin();
    incidence + exit - APEX
}

/// An equilateral prism along y with its edge up, and another shape or light.
fn prism(glass: &str, more: &str) -> Scene {
    let h = 3f64.sqrt();
    scene(&format!(
        r#"{} Material "dielectric" "spectrum eta" "{glass}"
        Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  0 -1 {h}  -1 1 0  1 1 0  0 1 {h} ]
        "integer indices" [ 0 1 2  3 5 4  0 4 1  0 3 4  1 4 5  1 5 2  2 5 3  2 3 0 ] {more}"#,
        header(40)
    ))
}

/// The direction in the plane y = 0 at `angle` over x.
fn at_angle(angle: f64) -> DVec3 {
    DVec3::new(angle.cos(), 0.0, angle.sin())
}

/// Light toward the middle of the left face, at `incidence` to its normal, from below.
fn incoming(incidence: f64) -> Ray {
    let direction = at_angle(incidence - APEX / 2.0);
    let face = DVec3::new(-0.5, 0.1, 0.5 * 3f64.sqrt());
    Ray::new((face - 0.7 * direction).as_vec3(), direction.as_vec3(), 0.0)
}

/// The ray that is refracted where `ray` meets the world.
fn refracted(scene: &Scene, ray: &Ray, wavelengths: &SampledWavelengths) -> Ray {
    let hit = scene.world.intersect(ray, f32::INFINITY, |_| true).unwrap();
    let surface = scene.world.interaction(ray, &hit);
    let at = TextureContext::at(&surface);
    let material = scene.surfaces[scene.world.geometry(hit.primitive.geometry).user as usize].material;
    let bsdf = scene.materials.bsdf(material, &scene.textures, &surface, &at, wavelengths, || 0.5).unwrap();
    let scattered = bsdf.sample(surface.wo, 0.999_999, Vec2::splat(0.5), 0).unwrap();
    assert!(scattered.lobe.contains(Lobe::TRANSMISSION | Lobe::SPECULAR));
    surface.spawn_ray(scattered.wi)
}

/// The angle between two directions, in radians, without loss of precision at small ones.
fn angle(a: Vec3, b: Vec3) -> f64 {
    let (a, b) = (a.as_dvec3().normalize(), b.as_dvec3().normalize());
    a.cross(b).length().atan2(a.dot(b))
}

#[test]
fn deviation_at_the_fraunhofer_lines() {
    for (glass, indices, incidences) in GLASSES {
        let scene = prism(glass, "");
        for degrees in incidences {
            let incoming = incoming(degrees.to_radians());
            let found = LINES.map(|line| {
                let wavelengths = SampledWavelengths::fixed(line as f32);
                let inside = refracted(&scene, &incoming, &wavelengths);
                let outside = refracted(&scene, &inside, &wavelengths);
                // Out again, toward the base.
                assert!(scene.world.intersect(&outside, f32::INFINITY, |_| true).is_none());
                assert!(outside.direction.z < incoming.direction.z && outside.direction.y.abs() < 1e-6);
                angle(incoming.direction, outside.direction)
            });
            for ((line, n), found) in LINES.into_iter().zip(indices).zip(found) {
                let want = deviation(n, degrees.to_radians());
                assert!(
                    (found - want).abs() < 1e-4,
                    "{glass}, {degrees}°, {line} nm: {found} instead of {want}"
                );
            }
            // Blue is bent most, by much more than the tolerance.
            assert!(found[0] + 1e-3 < found[1] && found[1] + 1e-3 < found[2], "{found:?}");
        }
    }
}

/// Where deviation is least light passes symmetrically: n = sin((A + δ) / 2) / sin(A / 2), by which indices are measured.
#[test]
fn least_deviation_gives_the_index() {
    for (glass, indices, _) in GLASSES {
        let scene = prism(glass, "");
        for (line, n) in LINES.into_iter().zip(indices) {
            let wavelengths = SampledWavelengths::fixed(line as f32);
            let deviation = |incidence: f64| {
                let ray = incoming(incidence);
                let inside = refracted(&scene, &ray, &wavelengths);
                angle(ray.direction, refracted(&scene, &inside, &wavelengths).direction)
            };
            let middle = (n * 0.5).asin();
            let least = (-20..=20).map(|i| deviation(middle + 0.002 * f64::from(i))).fold(f64::MAX, f64::min);
            let measured = (0.5 * (APEX + least)).sin() / (0.5 * APEX).sin();
            assert!((measured - n).abs() < 3e-5, "{glass}, {line} nm: {measured} instead of {n}");
        }
    }
}

/// The tracer sees a far slit through the prism, 2·10⁻⁴ rad wide, where Snell's law has it, as bright as Fresnel's formulas say, and
/// beside that place nothing.
#[test]
fn a_slit_is_seen_where_it_is() {
    const FAR: f64 = 100.0;
    for (glass, indices, [_, _, degrees, _]) in GLASSES {
        let incidence = f64::to_radians(degrees);
        let incoming = incoming(incidence);
        for (line, n) in LINES.into_iter().zip(indices) {
            let inside = (incidence.sin() / n).asin();
            let exit_angle = incidence - APEX / 2.0 - deviation(n, incidence);
            // Where the ray leaves the right face: z = √3 (1 − x).
            let within = at_angle(inside - APEX / 2.0);
            let start = DVec3::new(-0.5, 0.1, 0.5 * 3f64.sqrt());
            let t = (3f64.sqrt() * (1.0 - start.x) - start.z) / (within.z + 3f64.sqrt() * within.x);
            let leaves = start + t * within;
            for off in [-3e-4, 0.0, 3e-4] {
                let middle = leaves + FAR * at_angle(exit_angle + off);
                let up = at_angle(exit_angle + off + std::f64::consts::FRAC_PI_2) * (1e-4 * FAR);
                let corner = |y: f64, s: f64| {
                    let p = middle + s * up + DVec3::Y * y;
                    format!("{} {} {} ", p.x, p.y, p.z)
                };
                let slit = format!(
                    r#"AreaLightSource "diffuse" "spectrum L" [ 300 1 900 1 ] "float scale" 106.856895 "bool twosided" true
                    Shape "bilinearmesh" "point3 P" [ {} {} {} {} ]"#,
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(-1.0, 1.0),
                    corner(1.0, 1.0)
                );
                let scene = prism(glass, &slit);
                let tracer = PathTracer::new(&scene, DispersionRule::Split, Strategies::default(), 1);
                let sampler = Sampler::new(SamplerKind::Independent, 1, 4);
                let wavelengths = SampledWavelengths::fixed(line as f32);
                let seen: Welford = (0..4000)
                    .map(|i| {
                        let sample = sampler.at(UVec2::ZERO, i);
                        let l = traced(&tracer, incoming, Sample::new(&sample, wavelengths));
                        f64::from(l.average())
                    })
                    .collect();
                let what = format!("{glass}, {line} nm, {off} rad beside");
                if off == 0.0 {
                    let first = 1.0 - fresnel(incidence.cos(), n);
                    let second = 1.0 - fresnel((APEX - inside).cos(), 1.0 / n);
                    check_mean(&what, &seen, first * second, 0.03, 6);
                } else {
                    assert_eq!(seen.mean, 0.0, "{what}");
                }
            }
        }
    }
}
