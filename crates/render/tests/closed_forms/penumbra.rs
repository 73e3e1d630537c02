//! Irradiance from lights partly behind a straight edge, against Lambert's formula and one-dimensional quadratures.

use super::common::{FLAT, Files, LAMBDA, check_lanes, clip, header, radiance, ray, scene, scene_with};
use std::f64::consts::PI;
use tenfold_image::{Format, Image, WriteOptions};
use tenfold_math::{DVec3, vec3};
use tenfold_render::integrator::DispersionRule::Split;
use tenfold_render::scene::Scene;
use tenfold_spectrum::{N, RgbColorSpace, Spectrum, photometric};
use tenfold_testkit::quadrature::{Tolerance, integrate, rectangle};

/// A plane of albedo ½ at z = 0 that faces up.
const PLANE: &str = r#"Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ]
    Shape "bilinearmesh" "point3 P" [ -50 -50 0  50 -50 0  -50 50 0  50 50 0 ] "#;

/// A straight edge: a black half-plane at z = 1 that covers `normal · p < offset`.
#[derive(Copy, Clone)]
struct Edge {
    normal: [f64; 2],
    offset: f64,
}

impl Edge {
    fn new(angle: f64, offset: f64) -> Self {
        Self { normal: [-angle.sin(), angle.cos()], offset }
    }

    fn shape(&self) -> String {
        let [nx, ny] = self.normal;
        let at = |along: f64, off: f64| {
            let across = self.offset - off;
            format!("{} {} 1 ", ny * along + nx * across, -nx * along + ny * across)
        };
        format!(
            r#"Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ]
            Shape "bilinearmesh" "point3 P" [ {} {} {} {} ]"#,
            at(-30.0, 0.0),
            at(30.0, 0.0),
            at(-30.0, 30.0),
            at(30.0, 30.0)
        )
    }

    fn distance(&self, p: [f64; 2]) -> f64 {
        self.normal[0] * p[0] + self.normal[1] * p[1] - self.offset
    }

    /// The point of the plane z = 0, nearest to the z axis, from which a point at `height` that is `across` from the axis, along
    /// the edge's normal, is just seen.
    fn shadow_of(&self, height: f64, across: f64) -> [f64; 2] {
        // The edge is at z = 1: the line through it and the point meets z = 0 here.
        let d = (self.offset * height - across) / (height - 1.0);
        [self.normal[0] * d, self.normal[1] * d]
    }
}

/// Reflected radiance of the plane at `p`, from 0.4 above it.
fn at_plane(scene: &Scene, p: [f64; 2], values: u32, seed: u64) -> [tenfold_testkit::Welford; N] {
    let direction = vec3(0.05, -0.1, -1.0);
    let origin = vec3(p[0] as f32, p[1] as f32, 0.0) - 0.4 * direction;
    radiance(scene, ray(origin, direction), Split, values, seed)
}

/// Reflected radiance of the plane under the irradiance `e`.
fn reflected(e: f64) -> [f64; N] {
    [0.5 / PI * e; N]
}

/// Irradiance at `p`, on z = 0, from a polygon at `height` of radiance 1: Lambert's formula, ½ Σ Γᵢ · n.
fn lambert(polygon: &[[f64; 2]], height: f64, p: [f64; 2]) -> f64 {
    let at = |i: usize| {
        let [x, y] = polygon[i % polygon.len()];
        DVec3::new(x - p[0], y - p[1], height).normalize()
    };
    let edge = |i: usize| {
        let (a, b) = (at(i), at(i + 1));
        let cross = a.cross(b);
        a.dot(b).clamp(-1.0, 1.0).acos() * cross.z / cross.length().max(1e-300)
    };
    0.5 * (0..polygon.len()).map(edge).sum::<f64>().abs()
}

const HEIGHT: f64 = 2.0;
const LIGHT: [[f64; 2]; 4] = [[-0.5, -0.35], [0.5, -0.35], [0.5, 0.35], [-0.5, 0.35]];

/// The rectangle [`LIGHT`] facing down, as a shape.
const LIGHT_SHAPES: [&str; 2] = [
    r#"Shape "bilinearmesh" "point3 P" [ -0.5 0.35 2  0.5 0.35 2  -0.5 -0.35 2  0.5 -0.35 2 ]"#,
    r#"Shape "trianglemesh" "point3 P" [ -0.5 -0.35 2  -0.5 0.35 2  0.5 0.35 2  0.5 -0.35 2 ] "integer indices" [ 0 1 2 0 2 3 ]"#,
];

#[test]
fn rectangular_light_behind_an_edge() {
    for (s, light) in LIGHT_SHAPES.into_iter().enumerate() {
        for (a, edge) in [Edge::new(0.0, 0.1), Edge::new(0.6, -0.05)].into_iter().enumerate() {
            let scene = scene(&format!(
                r#"{} AttributeBegin AreaLightSource "diffuse" {FLAT} {light} AttributeEnd {PLANE} {}"#,
                header(1),
                edge.shape()
            ));
            // From full shadow to full light.
            for i in 0..9 {
                let across = 0.7 * (f64::from(i) / 4.0 - 1.0);
                let p = edge.shadow_of(HEIGHT, across);
                // Of the segment from p to q, at height 2, the point at height 1 is the middle.
                let offset = 2.0 * edge.offset - edge.normal[0] * p[0] - edge.normal[1] * p[1];
                let seen = clip(&LIGHT, edge.normal, offset);
                let want = reflected(if seen.is_empty() { 0.0 } else { lambert(&seen, HEIGHT, p) });
                let got = at_plane(&scene, p, 10_000, (10 * s + a) as u64);
                let share = want[0] / reflected(lambert(&LIGHT, HEIGHT, p))[0];
                // Of few samples that see the light the mean is neither sure nor normal.
                if share == 0.0 || share > 0.02 {
                    check_lanes(&format!("shape {s}, edge {a}, place {i}"), &got, want, 0.05, 36);
                }
            }
        }
    }
}

/// Where nothing is in the way sampling by solid angle leaves no noise but that of the cosine: far and near, and at the very wall.
#[test]
fn rectangular_light_in_full_view() {
    for (s, light) in LIGHT_SHAPES.into_iter().enumerate() {
        let scene = scene(&format!(
            r#"{} AttributeBegin AreaLightSource "diffuse" {FLAT} {light} AttributeEnd {PLANE}"#,
            header(1)
        ));
        for (i, p) in [[0.0, 0.0], [0.4, -0.3], [1.0, 2.0], [9.0, -5.0], [30.0, 1.0]].into_iter().enumerate()
        {
            let got = at_plane(&scene, p, 500, i as u64);
            let want = reflected(lambert(&LIGHT, HEIGHT, p));
            check_lanes(&format!("shape {s} from {p:?}"), &got, want, 0.01, 10);
        }
    }
}

/// Irradiance on a surface with normal `n` from the part of a sphere of radiance 1, of centre `centre` (relative to the surface)
/// and radius `radius`, that lies on the side of the plane through the surface point to which `side` points: `∫ n·ω dω`. The azimuths
/// that are seen at each angle from the sphere's middle are an arc, over which the integral is elementary.
fn sphere_irradiance(centre: DVec3, radius: f64, n: DVec3, side: DVec3) -> f64 {
    let axis = centre.normalize();
    let sin_max = radius / centre.length();
    let across = side - axis * side.dot(axis);
    let x = if across.length() > 1e-12 { across.normalize() } else { axis.any_orthonormal_vector() };
    let (side_x, side_z) = (side.dot(x), side.dot(axis));
    let (nx, nz) = (n.dot(x), n.dot(axis));
    // With r = sin θ: dω = r dr dφ / cos θ; and r = sin_max · sin t, which smooths the ends.
    let ring = |t: f64| {
        let r = sin_max * t.sin();
        let cos = (1.0 - r * r).sqrt();
        let limit = if side_x * r == 0.0 {
            if side_z > 0.0 { PI } else { 0.0 }
        } else {
            (-side_z * cos / (side_x * r)).clamp(-1.0, 1.0).acos()
        };
        (2.0 * nx * r * limit.sin() + 2.0 * nz * cos * limit) * r / cos * sin_max * t.cos()
    };
    // The arc begins where the rim of the side is met.
    let kink = (side_z / (side_x * side_x + side_z * side_z).sqrt()).abs() / sin_max;
    let middle = kink.min(1.0).asin();
    integrate(0.0, middle, ring) + integrate(middle, PI / 2.0, ring)
}

/// The whole sphere over the horizon: `π sin²α cos θ`.
#[test]
fn spherical_light_in_full_view() {
    let scene = scene(&format!(
        r#"{} AttributeBegin AreaLightSource "diffuse" {FLAT} Translate 0.2 0.1 2 Shape "sphere" "float radius" 0.6 AttributeEnd
        {PLANE}"#,
        header(1)
    ));
    for (i, p) in [[0.2, 0.1], [0.0, 1.5], [-3.0, 1.0], [5.0, 2.0]].into_iter().enumerate() {
        let to = DVec3::new(0.2 - p[0], 0.1 - p[1], 2.0);
        let e = PI * 0.36 / to.length_squared() * to.normalize().z;
        let quadrature = sphere_irradiance(to, 0.6, DVec3::Z, DVec3::Z);
        assert!((quadrature / e - 1.0).abs() < 1e-6, "{quadrature} {e}");
        check_lanes(&format!("from {p:?}"), &at_plane(&scene, p, 500, i as u64), reflected(e), 0.01, 4);
    }
}

/// The sphere partly behind an edge, and partly below the horizon of the plane that it lights.
#[test]
fn spherical_light_behind_an_edge_and_at_the_horizon() {
    let (centre, radius) = (DVec3::new(0.0, 0.0, 2.5), 0.6);
    let edge = Edge::new(0.4, 0.05);
    let behind = scene(&format!(
        r#"{} AttributeBegin AreaLightSource "diffuse" {FLAT} Translate 0 0 2.5 Shape "sphere" "float radius" 0.6 AttributeEnd
        {PLANE} {}"#,
        header(1),
        edge.shape()
    ));
    for i in 0..7 {
        let p = edge.shadow_of(2.5, 0.5 * (f64::from(i) / 3.0 - 1.0));
        // The plane through p and the edge.
        let side = DVec3::new(edge.normal[0], edge.normal[1], edge.distance(p));
        let to = centre - DVec3::new(p[0], p[1], 0.0);
        let want = reflected(sphere_irradiance(to, radius, DVec3::Z, side));
        check_lanes(&format!("place {i}"), &at_plane(&behind, p, 10_000, 5), want, 0.05, 10);
    }

    let low = scene(&format!(
        r#"{} AttributeBegin AreaLightSource "diffuse" {FLAT} Translate 0 0 0.2 Shape "sphere" "float radius" 0.6 AttributeEnd
        {PLANE}"#,
        header(1)
    ));
    for (i, x) in [0.8, 1.2, 3.0].into_iter().enumerate() {
        let to = DVec3::new(-x, 0.3, 0.2);
        let want = reflected(sphere_irradiance(to, radius, DVec3::Z, DVec3::Z));
        check_lanes(&format!("low from {x}"), &at_plane(&low, [x, -0.3], 6000, i as u64), want, 0.01, 10);
    }
}

/// Pixels of a grey picture, rows from the top, and their bilinear interpolation with v running up.
const PICTURE: [[f64; 3]; 2] = [[0.1, 3.0, 0.5], [1.0, 0.2, 6.0]];

fn picture(u: f64, v: f64) -> f64 {
    let weights = |x: f64, n: usize| {
        let x = (x * n as f64 - 0.5).clamp(0.0, n as f64 - 1.0);
        let i = (x.floor() as usize).min(n - 2);
        (i, x - i as f64)
    };
    let ((i, fx), (j, fy)) = (weights(u, 3), weights(1.0 - v, 2));
    let row = |j: usize| PICTURE[j][i] * (1.0 - fx) + PICTURE[j][i + 1] * fx;
    row(j) * (1.0 - fy) + row(j + 1) * fy
}

#[test]
fn textured_light() {
    let image = Image::from_fn(3, 2, ["Y"], |x, y| [PICTURE[y as usize][x as usize] as f32]).unwrap();
    let files = Files::one("light.pfm", image.to_bytes(Format::Pfm, &WriteOptions::default()).unwrap());
    let edge = Edge::new(0.3, 0.1);
    let lit = |blocker: &str| {
        scene_with(
            &format!(
                r#"{} AttributeBegin AreaLightSource "diffuse" "string filename" "light.pfm" "float scale" 3
                Shape "bilinearmesh" "point3 P" [ -0.5 0.35 2  0.5 0.35 2  -0.5 -0.35 2  0.5 -0.35 2 ]
                "point2 uv" [ 0 0  1 0  0 1  1 1 ] AttributeEnd {PLANE} {blocker}"#,
                header(1)
            ),
            &files,
        )
    };
    // A picture's white is that of its colour space, at 1 where the light's scale is 1.
    let white = RgbColorSpace::srgb().illuminant();
    let unit = 3.0 / photometric(&Spectrum::Dense(white.clone()));
    let tolerance = Tolerance {
        absolute: 1e-5,
        relative: 1e-5,
        pieces: 12,
        evaluations: 2_000_000,
        ..Tolerance::default()
    };
    let irradiance = |p: [f64; 2], seen: &dyn Fn([f64; 2]) -> bool| {
        rectangle([0.0, 0.0], [1.0, 1.0], &tolerance, |u, v| {
            let q = [-0.5 + u, 0.35 - 0.7 * v];
            let to = DVec3::new(q[0] - p[0], q[1] - p[1], HEIGHT);
            let geometry = HEIGHT * HEIGHT / to.length_squared().powi(2);
            if seen(q) { 0.7 * picture(u, v) * geometry } else { 0.0 }
        })
        .value
    };
    let want = |e: f64| {
        let l = reflected(e)[0];
        LAMBDA.map(|lambda| l * f64::from(unit * white.eval(lambda)))
    };
    let places = [[0.0, 0.0], [0.5, -0.4], [-2.0, 1.0], [0.2, 6.0]];
    let open = lit("");
    for (i, p) in places.into_iter().enumerate() {
        let got = at_plane(&open, p, 5000, i as u64);
        check_lanes(&format!("from {p:?}"), &got, want(irradiance(p, &|_| true)), 0.01, 8);
    }
    let half = lit(&edge.shape());
    for i in 0..4u32 {
        let p = edge.shadow_of(HEIGHT, 0.3 * (f64::from(i) / 1.5 - 1.0));
        let seen = |q: [f64; 2]| edge.distance([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]) > 0.0;
        let got = at_plane(&half, p, 10_000, 20 + u64::from(i));
        check_lanes(&format!("behind the edge, place {i}"), &got, want(irradiance(p, &seen)), 0.03, 8);
    }
}
