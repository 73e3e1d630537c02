//! Every sampler of every shape: χ² tests against its density in the parameter square, agreement of sample and pdf,
//! areas and solid angles against closed forms.

use super::common::*;
use std::f32::consts::{PI, TAU};
use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::ops;
use tenfold_math::{Frame, Ray, Slots, Transform, Vec2, Vec2s, Vec3, WIDTH};
use tenfold_sampling::warp::invert_uniform_triangle;
use tenfold_testkit::{Options, Rng, chi2};

/// A smooth map of the unit square to a shape: the point there with the area that a unit of the square becomes, and
/// back from a sample.
struct Chart<'a> {
    at: Box<dyn Fn(Vec2) -> (SurfacePoint, f64) + 'a>,
    back: Box<dyn Fn(&ShapeSample) -> Vec2 + 'a>,
}

/// The chart's area element by differences.
fn area_element(p: impl Fn(Vec2) -> Vec3, s: Vec2) -> f64 {
    let h = 1e-3;
    let step = |d: Vec2| {
        let (a, b) = ((s - h * d).clamp(Vec2::ZERO, Vec2::ONE), (s + h * d).clamp(Vec2::ZERO, Vec2::ONE));
        (p(b) - p(a)) / (b - a).length()
    };
    f64::from(step(Vec2::X).cross(step(Vec2::Y)).length())
}

/// Tests `sample_area` and, from each reference point, `sample_from`.
fn check(name: &str, shape: &Shape, chart: &Chart<'_>, references: &[ReferencePoint]) {
    let primitive = shape.primitive(0);
    let options = Options {
        samples: 40_000,
        theta_bins: 12,
        phi_bins: 12,
        tests: 120,
        evaluations: 3000,
        ..Options::default()
    };
    chi2::square_test(
        |u| primitive.sample_area(u).map(|s| (chart.back)(&s)),
        |s| {
            let (point, area) = (chart.at)(s);
            f64::from(primitive.pdf_area(&point)) * area
        },
        &options,
    )
    .check(&format!("{name} by area"));
    let mut rng = Rng::new(99);
    let close = |a: f32, b: f32| (a - b).abs() <= 2e-3 * a.max(b);
    for _ in 0..200 {
        let Some(s) = primitive.sample_area(rng.vec2()) else { continue };
        let pdf = primitive.pdf_area(&s.surface_point());
        assert!(close(s.pdf, pdf), "{name}: {s:?} has pdf {pdf}");
        assert!((s.n.length() - 1.0).abs() < 1e-5);
    }
    for (i, reference) in references.iter().enumerate() {
        chi2::square_test(
            |u| primitive.sample_from(reference, u).map(|s| (chart.back)(&s)),
            |s| {
                let (point, area) = (chart.at)(s);
                let d = (point.p - reference.p).as_dvec3();
                let solid_angle = area * d.normalize().dot(point.n.as_dvec3()).abs() / d.length_squared();
                f64::from(primitive.pdf_from_point(reference, &point)) * solid_angle
            },
            &options,
        )
        .check(&format!("{name} from {i}"));
        for _ in 0..300 {
            let Some(s) = primitive.sample_from(reference, rng.vec2()) else { continue };
            let pdf = primitive.pdf_from_point(reference, &s.surface_point());
            assert!(close(s.pdf, pdf), "{name} from {i}: {s:?} has pdf {pdf}");
            // Where the point is the first one in its direction, the direction has its density.
            let wi = (s.p - reference.p).normalize();
            let ray = reference.spawn_ray(wi);
            let hit = primitive.intersect(&ray, f32::INFINITY, |_| true);
            let grazing = s.n.dot(wi).abs() < 0.02;
            let surface = hit.map(|hit| primitive.interaction(&ray, &hit));
            if let Some(surface) = surface.filter(|h| !grazing && h.p.distance(s.p) < 2e-3) {
                assert!(surface.n.dot(s.n) > 0.99, "{name}: sampled {s:?}, hit {surface:?}");
                assert!((surface.uv - s.uv).length() < 0.02, "{name}: sampled {s:?}, hit {surface:?}");
                let pdf = primitive.pdf_from(reference, wi);
                assert!((s.pdf - pdf).abs() < 0.02 * pdf, "{name} from {i}: {s:?} in direction {pdf}");
            }
        }
    }
}

/// Points around the middle of a shape: free ones, and ones on surfaces of all inclinations.
fn references(rng: &mut Rng, centre: Vec3, distances: &[f32]) -> Vec<ReferencePoint> {
    distances
        .iter()
        .enumerate()
        .map(|(i, d)| {
            let mut r = ReferencePoint::free(centre + *d * rng.direction(), 0.0);
            if i % 2 == 1 {
                r.n = rng.direction();
                r.ns = (r.n + 0.1 * rng.direction()).normalize();
                r.one_sided = i % 4 == 3;
            }
            r
        })
        .collect()
}

fn one_triangle(p: [Vec3; 3]) -> Shape {
    let parts = MeshParts { positions: p.to_vec(), indices: vec![0, 1, 2], ..MeshParts::default() };
    Shape::Triangles(Arc::new(TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap()))
}

fn one_patch(p: [Vec3; 4]) -> Shape {
    let parts = MeshParts { positions: p.to_vec(), indices: vec![0, 1, 2, 3], ..MeshParts::default() };
    Shape::Patches(Arc::new(BilinearMesh::new(parts, &Transform::IDENTITY, false).unwrap()))
}

#[test]
fn triangles_are_sampled_by_their_density() {
    let mut rng = Rng::new(1);
    for (k, size) in [1.0, 1.0, 0.05, 3.0].into_iter().enumerate() {
        let p = [(); 3].map(|()| in_box(&mut rng, size));
        let shape = one_triangle(p);
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        let area = 0.5 * f64::from(n.length());
        let chart = Chart {
            at: Box::new(|s| {
                let b = tenfold_sampling::warp::sample_uniform_triangle(s);
                let point = b.x * p[0] + b.y * p[1] + b.z * p[2];
                (SurfacePoint { p: point, n: n.normalize(), param: Vec2::new(b.y, b.z) }, area)
            }),
            back: Box::new(|s| {
                invert_uniform_triangle(Vec3::new(1.0 - s.param.x - s.param.y, s.param.x, s.param.y))
            }),
        };
        let centre = (p[0] + p[1] + p[2]) / 3.0;
        let distances = [0.7 * size, 1.0, 1.2, 3.0, 30.0];
        check(&format!("triangle {k}"), &shape, &chart, &references(&mut rng, centre, &distances));
    }
}

#[test]
fn patches_are_sampled_by_their_density() {
    let mut rng = Rng::new(2);
    for k in 0..5 {
        let (origin, frame) = (in_box(&mut rng, 1.0), Frame::from_z(rng.direction()));
        let (eu, ev) = (frame.x * in_range(&mut rng, 0.5, 2.0), frame.y * in_range(&mut rng, 0.2, 1.0));
        let mut p = [origin, origin + eu, origin + ev, origin + eu + ev];
        if k >= 3 {
            p = p.map(|p| p + in_box(&mut rng, 0.25));
        }
        let shape = one_patch(p);
        let Primitive::Patch(patch) = shape.primitive(0) else { unreachable!() };
        assert_eq!(patch.rectangle().is_some(), k < 3);
        let position = move |s: Vec2| {
            (p[0] * (1.0 - s.x) + p[1] * s.x) * (1.0 - s.y) + (p[2] * (1.0 - s.x) + p[3] * s.x) * s.y
        };
        let chart = Chart {
            at: Box::new(move |s| {
                let du = (p[1] - p[0]) * (1.0 - s.y) + (p[3] - p[2]) * s.y;
                let dv = (p[2] - p[0]) * (1.0 - s.x) + (p[3] - p[1]) * s.x;
                let n = du.cross(dv);
                (SurfacePoint { p: position(s), n: n.normalize(), param: s }, f64::from(n.length()))
            }),
            back: Box::new(|s| s.param),
        };
        let distances = [0.5, 0.8, 1.5, 3.0, 200.0];
        check(
            &format!("patch {k}"),
            &shape,
            &chart,
            &references(&mut rng, position(Vec2::splat(0.5)), &distances),
        );
    }
}

/// The chart of a quadric by its object-space map `at`, whose outward normal is `n`.
#[test]
fn rectangles_have_the_normals_of_their_patches() {
    let positions = vec![Vec3::ZERO, 2.0 * Vec3::X, Vec3::Y, Vec3::new(2.0, 1.0, 0.0)];
    let indices = vec![0, 1, 2, 3];
    let up = Some(vec![Vec3::new(0.1, 0.0, 1.0); 4]);
    let down = Some(vec![Vec3::new(0.1, 0.0, -1.0); 4]);
    let mixed = Some(vec![Vec3::Z, Vec3::Z, Vec3::Z, Vec3::NEG_Z]);
    let from = ReferencePoint::free(Vec3::new(0.3, 0.2, 1.0), 0.0);
    for (normals, reverse, n) in [
        (None, false, Some(Vec3::Z)),
        (None, true, Some(Vec3::NEG_Z)),
        (up, false, Some(Vec3::Z)),
        (down, false, Some(Vec3::NEG_Z)),
        (mixed, false, None),
    ] {
        let parts = MeshParts {
            positions: positions.clone(),
            indices: indices.clone(),
            normals,
            uvs: Some([0.5, 1.0].map(|v| [Vec2::new(0.0, v), Vec2::new(0.5, v)]).concat()),
            ..MeshParts::default()
        };
        let mesh = Arc::new(BilinearMesh::new(parts, &Transform::IDENTITY, reverse).unwrap());
        let shape = Shape::Patches(mesh);
        let rectangle = shape.primitive(0).rectangle();
        assert_eq!(rectangle.is_some(), n.is_some());
        let (Some(rectangle), Some(n)) = (rectangle, n) else { continue };
        for u in [Vec2::new(0.2, 0.7), Vec2::new(0.9, 0.1)] {
            let s = rectangle.sample_from(&from, u).unwrap();
            let place = (s.p / Vec3::new(2.0, 1.0, 1.0)).truncate();
            assert_eq!(s.n, n);
            assert!(s.param.distance(place) < 1e-6, "{s:?}");
            assert!((s.uv - (0.5 * s.param + Vec2::new(0.0, 0.5))).length() < 1e-6, "{s:?}");
            assert_eq!(Some(s), shape.primitive(0).sample_from(&from, u));
        }
    }
}

fn quadric_chart<'a>(
    t: Transform,
    flip: bool,
    at: impl Fn(Vec2) -> Vec3 + Copy + 'a,
    n: impl Fn(Vec2) -> Vec3 + 'a,
    back: impl Fn(Vec3) -> Vec2 + 'a,
) -> Chart<'a> {
    Chart {
        at: Box::new(move |s| {
            let outward = t.normal(n(s)).normalize();
            let normal = if flip { -outward } else { outward };
            let point = SurfacePoint { p: t.point(at(s)), n: normal, param: Vec2::ZERO };
            (point, area_element(|s| t.point(at(s)), s))
        }),
        back: Box::new(move |s| back(t.inverse().point(s.p))),
    }
}

fn azimuth(p: Vec3) -> f32 {
    let phi = ops::atan2(p.y, p.x);
    if phi < 0.0 { phi + TAU } else { phi }
}

#[test]
fn disks_are_sampled_by_their_density() {
    let mut rng = Rng::new(3);
    for k in 0..4 {
        let t = if k % 2 == 0 { random_similarity(&mut rng, 1.0) } else { random_transform(&mut rng, 1.0) };
        let params = DiskParams {
            height: 0.3,
            radius: 0.8,
            inner_radius: if k >= 2 { 0.3 } else { 0.0 },
            phi_max: if k >= 2 { 4.0 } else { TAU },
        };
        let shape = Shape::Disk(Disk::new(t, false, params).unwrap());
        let (r0, r1, phi_max) = (params.inner_radius, params.radius, params.phi_max);
        let at = move |s: Vec2| {
            let (r, phi) = ((r0 * r0 + s.x * (r1 * r1 - r0 * r0)).sqrt(), s.y * phi_max);
            Vec3::new(r * ops::cos(phi), r * ops::sin(phi), 0.3)
        };
        let back = move |p: Vec3| {
            let r2 = p.truncate().length_squared();
            Vec2::new((r2 - r0 * r0) / (r1 * r1 - r0 * r0), azimuth(p) / phi_max)
        };
        // The root at the middle spoils differences: give the area exactly.
        let area = f64::from(shape.primitive(0).area());
        let inner = quadric_chart(t, t.swaps_handedness(), at, |_| Vec3::Z, back);
        let chart = Chart { at: Box::new(move |s| ((inner.at)(s).0, area)), back: inner.back };
        let centre = t.point(Vec3::new(0.0, 0.0, 0.3));
        check(&format!("disk {k}"), &shape, &chart, &references(&mut rng, centre, &[0.5, 1.0, 3.0]));
    }
}

#[test]
fn cylinders_are_sampled_by_their_density() {
    let mut rng = Rng::new(4);
    for k in 0..4 {
        let t = if k % 2 == 0 { random_similarity(&mut rng, 1.0) } else { random_transform(&mut rng, 1.0) };
        let phi_max = if k >= 2 { 4.0 } else { TAU };
        let params = CylinderParams { radius: 0.6, z_min: -0.4, z_max: 0.9, phi_max };
        let reverse = k == 3;
        let shape = Shape::Cylinder(Cylinder::new(t, reverse, params).unwrap());
        let at = move |s: Vec2| {
            let phi = s.y * phi_max;
            Vec3::new(0.6 * ops::cos(phi), 0.6 * ops::sin(phi), -0.4 + s.x * 1.3)
        };
        let normal = move |s: Vec2| Vec3::new(at(s).x, at(s).y, 0.0);
        let back = move |p: Vec3| Vec2::new((p.z + 0.4) / 1.3, azimuth(p) / phi_max);
        let chart = quadric_chart(t, reverse ^ t.swaps_handedness(), at, normal, back);
        let centre = t.point(Vec3::new(0.0, 0.0, 0.2));
        check(&format!("cylinder {k}"), &shape, &chart, &references(&mut rng, centre, &[2.0, 3.0]));
    }
}

#[test]
fn partial_and_squashed_spheres_are_sampled_by_their_density() {
    let mut rng = Rng::new(5);
    for k in 0..4 {
        let t = if k % 2 == 0 { random_similarity(&mut rng, 1.0) } else { random_transform(&mut rng, 1.0) };
        let (z_min, z_max, phi_max) = if k >= 2 { (-0.3, 0.5, 4.0) } else { (-0.7, 0.69, TAU) };
        let params = SphereParams { radius: 0.7, z_min, z_max, phi_max };
        let shape = Shape::Sphere(Sphere::new(t, false, params).unwrap());
        let at = move |s: Vec2| {
            let z = z_min + s.x * (z_max - z_min);
            let (r, phi) = ((0.49 - z * z).max(0.0).sqrt(), s.y * phi_max);
            Vec3::new(r * ops::cos(phi), r * ops::sin(phi), z)
        };
        let back = move |p: Vec3| Vec2::new((p.z - z_min) / (z_max - z_min), azimuth(p) / phi_max);
        let area = f64::from(shape.primitive(0).area());
        let inner = quadric_chart(t, t.swaps_handedness(), at, at, back);
        let chart = if k % 2 == 0 {
            // Archimedes: heights have equal areas; differences fail at the pole.
            Chart { at: Box::new(move |s| ((inner.at)(s).0, area)), back: inner.back }
        } else {
            // The area of a squashed sphere varies by the normal.
            let object_area = f64::from(phi_max * 0.7 * (z_max - z_min));
            let det = t.affine().matrix3.determinant().abs();
            let element = move |s| object_area * f64::from(det * t.normal(at(s) / 0.7).length());
            Chart { at: Box::new(move |s| ((inner.at)(s).0, element(s))), back: inner.back }
        };
        let centre = t.point(Vec3::ZERO);
        check(&format!("sphere {k}"), &shape, &chart, &references(&mut rng, centre, &[0.1, 2.5, 4.0]));
    }
}

#[test]
fn whole_spheres_are_sampled_by_the_cone_that_is_seen() {
    let mut rng = Rng::new(6);
    for k in 0..6 {
        let t = random_similarity(&mut rng, 1.0);
        let shape = Shape::Sphere(Sphere::new(t, k % 2 == 0, SphereParams::whole(0.7)).unwrap());
        let primitive = shape.primitive(0);
        let centre = t.point(Vec3::ZERO);
        let radius = 0.7 * t.vector(Vec3::X).length();
        assert!((primitive.area() / (4.0 * PI * radius * radius) - 1.0).abs() < 1e-5);
        for distance in [1.01, 1.3, 4.0, 60.0, 1000.0] {
            let reference = references(&mut rng, centre, &[1.0, distance * radius])[1];
            let axis = Frame::from_z((reference.p - centre).normalize());
            // Heights of the cap that is seen, above the centre in units of the radius.
            let low = (radius / reference.p.distance(centre)).clamp(0.0, 1.0);
            let chart_back = |p: Vec3| {
                let q = axis.to_local((p - centre) / radius);
                // Where the sphere is only just seen, rounding may lead over the rim.
                let height = (q.z - low) / (1.0 - low);
                assert!((-1e-4..1.0001).contains(&height));
                Vec2::new(height.clamp(0.0, 1.0), azimuth(q) / TAU)
            };
            let chart_at = |s: Vec2| {
                let z = low + s.x * (1.0 - low);
                let (r, phi) = ((1.0 - z * z).sqrt(), TAU * s.y);
                axis.to_world(Vec3::new(r * ops::cos(phi), r * ops::sin(phi), z))
            };
            let area = f64::from(TAU * radius * radius * (1.0 - low));
            chi2::square_test(
                |u| primitive.sample_from(&reference, u).map(|s| chart_back(s.p)),
                |s| {
                    let n = chart_at(s);
                    let point = SurfacePoint { p: centre + radius * n, n, param: Vec2::ZERO };
                    let d = (point.p - reference.p).as_dvec3();
                    let solid_angle = area * d.normalize().dot(n.as_dvec3()).abs() / d.length_squared();
                    f64::from(primitive.pdf_from_point(&reference, &point)) * solid_angle
                },
                &Options { samples: 40_000, theta_bins: 8, phi_bins: 8, tests: 60, ..Options::default() },
            )
            .check(&format!("sphere {k} from {distance} radii"));
            // Closed form: the cap of sin θ = 1 / distance.
            let cos = (1.0 - 1.0 / f64::from(distance).powi(2)).sqrt();
            let solid_angle = std::f64::consts::TAU / (f64::from(distance).powi(2) * (1.0 + cos));
            for _ in 0..100 {
                let s = primitive.sample_from(&reference, rng.vec2()).unwrap();
                assert!((f64::from(s.pdf) * solid_angle - 1.0).abs() < 2e-3, "{distance}: {}", s.pdf);
                assert_eq!(s.pdf, primitive.pdf_from_point(&reference, &s.surface_point()));
                assert!((s.p.distance(centre) / radius - 1.0).abs() < 1e-5);
            }
        }
        // From inside the whole sphere is seen.
        let inside = ReferencePoint::free(centre + 0.5 * radius * rng.direction(), 0.0);
        chi2::sphere_test(
            |_, u| primitive.sample_from(&inside, u).map(|s| (s.p - inside.p).normalize()),
            |w| f64::from(primitive.pdf_from(&inside, w)),
            &Options { samples: 40_000, theta_bins: 10, phi_bins: 10, tests: 60, ..Options::default() },
        )
        .check("sphere from inside");
    }
}

#[test]
fn balls_side_by_side_are_sampled_as_each_by_itself() {
    let mut rng = Rng::new(11);
    for _ in 0..200 {
        let (mut balls, mut from, mut u) = (Balls::default(), ReferencePoints::default(), Vec2s::ZERO);
        let mut alone = [const { None }; WIDTH];
        for (slot, alone) in alone.iter_mut().enumerate() {
            let t = random_similarity(&mut rng, 1.0);
            let shape = Shape::Sphere(Sphere::new(t, slot % 3 == 0, SphereParams::whole(0.7)).unwrap());
            let (centre, radius) = (t.point(Vec3::ZERO), 0.7 * t.vector(Vec3::X).length());
            let distance = [0.5, 1.0 + 1e-6, 1.5, 20.0, 1000.0][slot % 5];
            let reference = references(&mut rng, centre, &[1.0, distance * radius])[1];
            balls.set(slot, shape.primitive(0).ball().unwrap());
            from.set(slot, reference);
            u.set(slot, if slot == 7 { Vec2::splat(0.5) } else { rng.vec2() });
            *alone = shape.primitive(0).sample_from(&reference, u.get(slot));
        }
        let mut out = ShapeSamples::default();
        let outside = balls.samples_from(Slots::first(WIDTH - 1), &from, &u, &mut out);
        let inside = Slots::first(WIDTH - 1).without(outside);
        assert!(
            inside.contains(5) && inside.keep(|slot| slot % 5 > 1).is_empty() && !outside.contains(WIDTH - 1)
        );
        for slot in outside {
            let one = (out.p.get(slot), out.p_error.get(slot), out.n.get(slot), out.pdf[slot]);
            let other = alone[slot].unwrap();
            assert_eq!(one, (other.p, other.p_error, other.n, other.pdf), "{slot}");
        }
    }
    let partial = SphereParams { z_max: 0.5, ..SphereParams::default() };
    let partial = Shape::Sphere(Sphere::new(Transform::IDENTITY, false, partial).unwrap());
    assert_eq!(partial.primitive(0).ball(), None);
}

#[test]
fn facets_side_by_side_are_sampled_as_each_by_itself() {
    let mut rng = Rng::new(12);
    let (mut sampled, mut none) = (0, 0);
    for _ in 0..200 {
        let (mut facets, mut from, mut u) = (Facets::default(), ReferencePoints::default(), Vec2s::ZERO);
        let mut alone = [const { None }; WIDTH];
        for (slot, alone) in alone.iter_mut().enumerate() {
            let at = rng.vec3();
            let mut corners = [at, at + 0.01 * rng.direction(), at + 0.01 * rng.direction()];
            // Without area, too.
            if slot == 5 {
                corners[2] = corners[1];
            }
            let parts =
                MeshParts { positions: corners.to_vec(), indices: vec![0, 1, 2], ..MeshParts::default() };
            let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, slot % 3 == 0).unwrap();
            let shape = Shape::Triangles(Arc::new(mesh));
            let facet = shape.primitive(0).facet().unwrap();
            let reference = references(&mut rng, at, &[1.0, 2.0])[1];
            assert!(facet.is_far(reference.p) && !facet.is_far(at + Vec3::splat(0.02)));
            facets.set(slot, facet);
            from.set(slot, reference);
            u.set(slot, rng.vec2());
            *alone = shape.primitive(0).sample_from(&reference, u.get(slot));
        }
        let mut out = ShapeSamples::default();
        facets.samples_from(&from, &u, &mut out);
        for (slot, alone) in alone.into_iter().enumerate() {
            let one = (out.p.get(slot), out.p_error.get(slot), out.n.get(slot), out.pdf[slot]);
            match alone {
                Some(other) => assert_eq!(one, (other.p, other.p_error, other.n, other.pdf), "{slot}"),
                None => assert_eq!(out.pdf[slot], 0.0),
            }
            *(if alone.is_some() { &mut sampled } else { &mut none }) += 1;
        }
    }
    assert!(sampled > 2500 && none >= 200);
    // Vertices that are shared or have normals make no facets.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
    let shared = MeshParts { positions, indices: vec![0, 1, 2, 2, 1, 3], ..MeshParts::default() };
    let bent = MeshParts {
        positions: shared.positions[..3].to_vec(),
        indices: vec![0, 1, 2],
        normals: Some(vec![Vec3::Z; 3]),
        ..MeshParts::default()
    };
    for parts in [shared, bent] {
        let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
        assert_eq!(Shape::Triangles(Arc::new(mesh)).primitive(0).facet(), None);
    }
}

#[test]
fn areas_and_solid_angles_match_closed_forms() {
    // An octant of the sphere: π/2.
    let octant = one_triangle([Vec3::X, Vec3::Y, Vec3::Z]);
    let origin = ReferencePoint::free(Vec3::ZERO, 0.0);
    let pdf = octant.primitive(0).pdf_from(&origin, Vec3::ONE.normalize());
    assert!((pdf * PI / 2.0 - 1.0).abs() < 1e-5);
    assert!((octant.primitive(0).area() - 0.5 * 3f32.sqrt()).abs() < 1e-6);
    // A square of half side a at distance d: 4 atan(a² / (d √(2a² + d²))).
    for (a, d) in [(1.0f32, 1.0f32), (0.1, 0.2), (5.0, 0.3), (0.1, 2.0), (1e-3, 5.0)] {
        let z = Vec3::new(0.0, 0.0, d);
        let [x, y] = [a * Vec3::X, a * Vec3::Y];
        let square = one_patch([z - x - y, z + x - y, z - x + y, z + x + y]);
        let want = 4.0 * ops::atan(a * a / (d * (2.0 * a * a + d * d).sqrt()));
        let near = a > 0.4 * d;
        let pdf = square.primitive(0).pdf_from(&origin, Vec3::Z);
        // From near by all directions are alike; from afar, those whose light matters more have the larger density.
        assert!((pdf * want - 1.0).abs() < if near { 1e-5 } else { a * a / (d * d) + 1e-5 }, "{a} {d}");
        // In either case the mean of the inverse density is the solid angle.
        let n = 64;
        let place = |i| Vec2::new(((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32);
        let inverses = (0..n * n).map(|i| {
            let sample = square.primitive(0).sample_from(&origin, place(i)).unwrap();
            f64::from(1.0 / sample.pdf)
        });
        let mean = (inverses.sum::<f64>() / f64::from(n * n)) as f32;
        assert!((mean / want - 1.0).abs() < 1e-4, "{a} {d}: {mean} {want}");
        assert!((square.primitive(0).area() / (4.0 * a * a) - 1.0).abs() < 1e-5);
    }
    let t = Transform::scale(Vec3::new(2.0, 2.0, 2.0)).unwrap();
    let cap = SphereParams { radius: 1.0, z_min: 0.5, z_max: 1.0, phi_max: PI };
    let cap = Shape::Sphere(Sphere::new(t, false, cap).unwrap());
    assert!((cap.primitive(0).area() - 4.0 * PI * 0.5).abs() < 1e-4);
    let ring = DiskParams { inner_radius: 0.5, phi_max: PI, ..DiskParams::default() };
    let t = Transform::scale(Vec3::new(2.0, 3.0, 7.0)).unwrap();
    let ring = Shape::Disk(Disk::new(t, false, ring).unwrap());
    assert!((ring.primitive(0).area() - 6.0 * 0.75 * PI / 2.0).abs() < 1e-4);
    // A prolate spheroid with half axes 1, 1, 2: 2π (1 + 2/e · asin e), e = √3/2.
    let t = Transform::scale(Vec3::new(1.0, 1.0, 2.0)).unwrap();
    let spheroid = Shape::Sphere(Sphere::new(t, false, SphereParams::default()).unwrap());
    let e = 0.75f32.sqrt();
    let want = TAU * (1.0 + 2.0 / e * ops::asin(e));
    assert!((spheroid.primitive(0).area() / want - 1.0).abs() < 1e-4);
    // A cylinder squashed to an elliptic one, half axes 1 and 2, height 2: its perimeter is 9.688448.
    let t = Transform::scale(Vec3::new(1.0, 2.0, 1.0)).unwrap();
    let pipe = Shape::Cylinder(Cylinder::new(t, false, CylinderParams::default()).unwrap());
    assert!((pipe.primitive(0).area() / (2.0 * 9.688_448) - 1.0).abs() < 1e-4);
}

#[test]
fn normal_cones_hold_all_normals() {
    let mut rng = Rng::new(8);
    for k in 0..300 {
        let t = random_transform(&mut rng, 1.0);
        let shape = match k % 3 {
            0 => patches(&mut rng, t, 1, 0.8),
            1 => triangles(&mut rng, t, 1, 0.8),
            _ => random_shape(&mut rng, t),
        };
        let primitive = shape.primitive(0);
        let cone = primitive.normal_cone();
        for _ in 0..100 {
            let Some(s) = primitive.sample_area(rng.vec2()) else { continue };
            assert!(cone.contains(s.n), "{cone:?} {s:?}");
            assert!(primitive.bounds().expanded(1e-4).contains(s.p));
        }
    }
}

#[test]
fn points_that_see_nothing_get_no_sample() {
    let triangle = one_triangle([Vec3::ZERO, Vec3::X, Vec3::Y]);
    let patch = one_patch([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE - Vec3::Z]);
    let mut rng = Rng::new(9);
    for shape in [&triangle, &patch] {
        let in_plane = ReferencePoint::free(Vec3::new(3.0, 0.5, 0.0), 0.0);
        for _ in 0..100 {
            assert_eq!(shape.primitive(0).sample_from(&in_plane, rng.vec2()), None);
        }
        assert_eq!(shape.primitive(0).pdf_from(&in_plane, Vec3::NEG_X), 0.0);
        let above = ReferencePoint::free(Vec3::Z, 0.0);
        assert_eq!(shape.primitive(0).pdf_from(&above, Vec3::Z), 0.0);
    }
    // Rays of samples reach what they were sampled on.
    let reference = ReferencePoint::free(Vec3::new(0.2, 0.3, 2.0), 0.0);
    for _ in 0..1000 {
        let s = patch.primitive(0).sample_from(&reference, rng.vec2()).unwrap();
        let ray: Ray = reference.spawn_ray_to(&s);
        assert!(patch.primitive(0).intersect(&ray, SHADOW_T_MAX, |_| true).is_none());
        assert!(patch.primitive(0).intersect(&ray, 1.01, |_| true).is_some());
    }
}
