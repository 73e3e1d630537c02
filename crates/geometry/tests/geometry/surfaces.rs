//! Interactions: error bounds, rays that leave, and the conventions.

use super::common::*;
use glam::{DMat3, DVec3};
use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::ops;
use tenfold_math::{Id, Motion, Ray, Rays, Slots, Transform, Vec2, Vec3, WIDTH};
use tenfold_testkit::Rng;

/// Values at the corners of `p ± error` of a function that vanishes on the surface: whether they have both signs.
fn surface_crosses_box(p: Vec3, error: Vec3, f: impl Fn(DVec3) -> f64) -> bool {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..8 {
        let sign = |k: usize| if i >> k & 1 == 0 { -1.0 } else { 1.0 };
        let value = f(p.as_dvec3() + error.as_dvec3() * DVec3::new(sign(0), sign(1), sign(2)));
        range = (range.0.min(value), range.1.max(value));
    }
    range.0 <= 0.0 && range.1 >= 0.0
}

/// World to object space, exactly enough.
fn exact_inverse(t: &Transform) -> impl Fn(DVec3) -> DVec3 {
    let m = t.affine().matrix3;
    let m = DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3()).inverse();
    let translation = Vec3::from(t.affine().translation).as_dvec3();
    move |p| m * (p - translation)
}

/// Hits and samples of a quadric lie within their error bounds of the exact surface `f = 0` of object space.
fn check_bounds(name: &str, shape: &Shape, t: &Transform, f: impl Fn(DVec3) -> f64, rng: &mut Rng) {
    let (primitive, inverse) = (shape.primitive(0), exact_inverse(t));
    for i in 0..3000 {
        let found = if i % 2 == 0 {
            let target = primitive.sample_area(rng.vec2()).unwrap().p;
            let origin = target + ops::powf(10f32, in_range(rng, -1.0, 3.0)) * rng.direction();
            let ray = Ray::new(origin, (target - origin).normalize(), 0.0);
            primitive
                .intersect(&ray, f32::INFINITY, |_| true)
                .map(|hit| primitive.interaction(&ray, &hit))
                .map(|s| (s.p, s.p_error))
        } else {
            let reference = ReferencePoint::free(in_box(rng, 20.0), 0.0);
            let by_area = primitive.sample_area(rng.vec2());
            let s = if i % 4 == 1 { primitive.sample_from(&reference, rng.vec2()) } else { by_area };
            s.map(|s| (s.p, s.p_error))
        };
        let Some((p, error)) = found else { continue };
        assert!(surface_crosses_box(p, error, |p| f(inverse(p))), "{name}: {p} ± {error}");
        assert!(error.max_element() < 1e-4 * (1.0 + p.abs().max_element()), "{name}: {error} is too wide");
    }
}

#[test]
fn error_bounds_of_quadrics_hold() {
    let mut rng = Rng::new(1);
    for k in 0..40 {
        let spread = [1.0, 1.0, 100.0, 1000.0][k % 4];
        let t =
            if k % 3 == 0 { random_similarity(&mut rng, spread) } else { random_transform(&mut rng, spread) };
        let sphere = Sphere::new(t, false, SphereParams::whole(0.7)).unwrap();
        let r = f64::from(0.7f32);
        check_bounds("sphere", &Shape::Sphere(sphere), &t, |p| p.length() - r, &mut rng);
        let cylinder = CylinderParams { radius: 0.7, ..CylinderParams::default() };
        let cylinder = Shape::Cylinder(Cylinder::new(t, false, cylinder).unwrap());
        check_bounds("cylinder", &cylinder, &t, |p| ops::hypot(p.x, p.y) - r, &mut rng);
        let disk = Disk::new(t, false, DiskParams { height: 0.7, ..DiskParams::default() }).unwrap();
        check_bounds("disk", &Shape::Disk(disk), &t, |p| p.z - r, &mut rng);
    }
}

#[test]
fn error_bounds_of_meshes_hold() {
    let mut rng = Rng::new(2);
    for k in 0..2000 {
        let spread = [0.0, 1.0, 100.0, 10_000.0][k % 4];
        let offset = in_box(&mut rng, spread);
        let p = [(); 4].map(|()| offset + in_box(&mut rng, 1.0));
        let triangle = MeshParts { positions: p.to_vec(), indices: vec![0, 1, 2], ..MeshParts::default() };
        let triangle = Arc::new(TriangleMesh::new(triangle, &Transform::IDENTITY, false).unwrap());
        let patch = MeshParts { positions: p.to_vec(), indices: vec![0, 1, 2, 3], ..MeshParts::default() };
        let patch = Arc::new(BilinearMesh::new(patch, &Transform::IDENTITY, false).unwrap());
        for shape in [Shape::Triangles(triangle), Shape::Patches(patch)] {
            let q = p.map(Vec3::as_dvec3);
            let exact = |u: Vec2| {
                let (u, v) = (f64::from(u.x), f64::from(u.y));
                match &shape {
                    Shape::Triangles(_) => q[0] * (1.0 - u - v) + q[1] * u + q[2] * v,
                    _ => (q[0] * (1.0 - u) + q[1] * u) * (1.0 - v) + (q[2] * (1.0 - u) + q[3] * u) * v,
                }
            };
            let primitive = shape.primitive(0);
            let reference = ReferencePoint::free(offset + in_box(&mut rng, 4.0), 0.0);
            let check = |param: Vec2, p: Vec3, error: Vec3| {
                let off = (exact(param) - p.as_dvec3()).abs();
                assert!(off.cmple(error.as_dvec3()).all(), "{shape:?}: {p} is off by {off}, not {error}");
            };
            for s in [primitive.sample_area(rng.vec2()), primitive.sample_from(&reference, rng.vec2())] {
                let Some(s) = s else { continue };
                check(s.param, s.p, s.p_error);
                let ray = Ray::new(reference.p, (s.p - reference.p).normalize(), 0.0);
                let Some(hit) = primitive.intersect(&ray, f32::INFINITY, |_| true) else { continue };
                let surface = primitive.interaction(&ray, &hit);
                check(surface.param, surface.p, surface.p_error);
                // The point is where the ray is.
                let distance = surface.p.distance(ray.at(hit.t));
                assert!(
                    distance < 1e-5 * (10.0 + offset.length()) / surface.n.dot(surface.wo).abs(),
                    "{distance}"
                );
            }
        }
    }
}

#[test]
fn rays_that_leave_a_flat_surface_never_meet_it() {
    let mut rng = Rng::new(3);
    // A sheet of triangles: a ray from one must not meet its neighbours in the same plane either.
    let n = 12u32;
    let mut sheet = MeshParts::default();
    for i in 0..=n {
        for j in 0..=n {
            sheet.positions.push(Vec3::new(i as f32 / n as f32, j as f32 / n as f32, 0.0));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let k = i * (n + 1) + j;
            sheet.indices.extend([k, k + 1, k + n + 2, k, k + n + 2, k + n + 1]);
        }
    }
    for k in 0..30 {
        let spread = [0.5, 10.0, 1000.0][k % 3];
        let t = random_transform(&mut rng, spread);
        let triangles = Shape::Triangles(Arc::new(TriangleMesh::new(sheet.clone(), &t, false).unwrap()));
        let quad = MeshParts {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)],
            indices: vec![0, 1, 2, 3],
            ..MeshParts::default()
        };
        let quad = Shape::Patches(Arc::new(BilinearMesh::new(quad, &t, false).unwrap()));
        let disk = Shape::Disk(Disk::new(t, false, DiskParams::default()).unwrap());
        for (name, shape) in [("sheet", triangles), ("quad", quad), ("disk", disk)] {
            let world = World::build(WorldDesc { geometries: vec![still(shape, 0)], ..WorldDesc::default() })
                .unwrap();
            let mut hits = 0;
            for _ in 0..1500 {
                let target = t.point(Vec3::new(rng.f32(), rng.f32(), 0.0));
                let origin = target + ops::powf(10f32, in_range(&mut rng, -2.0, 3.0)) * rng.direction();
                let ray = Ray::new(origin, (target - origin).normalize(), 0.0);
                let Some(hit) = world.intersect(&ray, f32::INFINITY, |_| true) else { continue };
                let surface = world.interaction(&ray, &hit);
                let mut d = rng.direction();
                if spread < 100.0 && rng.below(2) == 0 {
                    // Nearly along the surface; far from the origin rounded vertices are not in one plane.
                    d = (d - d.dot(surface.n) * (1.0 - 1e-3) * surface.n).normalize();
                }
                let out = surface.spawn_ray(d);
                let again = world.intersect(&out, f32::INFINITY, |_| true);
                assert_eq!(again, None, "{name}: {surface:?} {out:?}");
                hits += 1;
            }
            assert!(hits > 1000, "{name}: {hits}");
        }
    }
}

#[test]
fn rays_that_leave_a_sphere_meet_it_where_the_chord_ends() {
    let mut rng = Rng::new(4);
    for k in 0..60 {
        let spread = [1.0, 30.0, 1000.0][k % 3];
        let t = random_similarity(&mut rng, spread);
        let scale = t.vector(Vec3::X).length();
        let sphere = Shape::Sphere(Sphere::new(t, false, SphereParams::whole(1.0)).unwrap());
        let pipe = CylinderParams { z_min: -50.0, z_max: 50.0, ..CylinderParams::default() };
        let pipe = Shape::Cylinder(Cylinder::new(t, false, pipe).unwrap());
        for (name, shape) in [("sphere", sphere), ("cylinder", pipe)] {
            let primitive = shape.primitive(0);
            for _ in 0..1000 {
                let target = t.point(in_box(&mut rng, 0.6));
                let origin = target + ops::powf(10f32, in_range(&mut rng, -1.0, 2.0)) * rng.direction();
                let ray = Ray::new(origin, (target - origin).normalize(), 0.0);
                let Some(hit) = primitive.intersect(&ray, f32::INFINITY, |_| true) else { continue };
                let surface = primitive.interaction(&ray, &hit);
                let d = rng.direction();
                let out = surface.spawn_ray(d);
                let again = primitive.intersect(&out, f32::INFINITY, |_| true);
                if d.dot(surface.n) > 0.0 {
                    assert_eq!(again, None, "{name}: {surface:?} {out:?}");
                    continue;
                }
                // The part of the direction across the cylinder's axis counts.
                let axis = t.vector(Vec3::Z).normalize();
                let across = if name == "sphere" { 1.0 } else { (1.0 - d.dot(axis).powi(2)).sqrt() };
                let chord = -2.0 * scale * d.dot(surface.n) / (across * across);
                let height = t.inverse().point(surface.p).z;
                // Shorter chords drown in the rounding of the place.
                let rounding = out.origin.distance(surface.p);
                let shortest = if spread > 100.0 { 0.3 } else { 0.02 } * scale;
                if chord > shortest && chord < 20.0 * scale && height.abs() < 20.0 {
                    let t = again.unwrap().t;
                    let moved = rounding / d.dot(surface.n).abs();
                    assert!((t - chord).abs() < 0.02 * chord + 2.0 * moved, "{name}: {t} of {chord}");
                }
            }
        }
    }
}

#[test]
fn parametrisations_and_normals_are_pbrts() {
    let ray = |o: Vec3, d: Vec3| Ray::new(o, d, 0.0);
    let see = |shape: Shape, o: Vec3, d: Vec3| {
        let ray = ray(o, d);
        let hit = shape.primitive(0).intersect(&ray, f32::INFINITY, |_| true).unwrap();
        shape.primitive(0).interaction(&ray, &hit)
    };
    let close = |a: Vec3, b: Vec3| (a - b).length() < 1e-4;
    let id = Transform::IDENTITY;

    // φ from +x towards +y; v from the south pole to the north.
    let sphere = |t, reverse| Shape::Sphere(Sphere::new(t, reverse, SphereParams::default()).unwrap());
    let s = see(sphere(id, false), Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y);
    assert!((s.uv - Vec2::new(0.25, 0.5)).length() < 1e-5, "{s:?}");
    assert!(close(s.n, Vec3::Y) && close(s.wo, Vec3::Y));
    assert!(close(s.dpdu, Vec3::new(-std::f32::consts::TAU, 0.0, 0.0)));
    assert!(close(s.dpdv, Vec3::new(0.0, 0.0, std::f32::consts::PI)));
    // The unit sphere's normal is its position, so their derivatives agree.
    assert!(close(s.shading.dndu, s.dpdu) && close(s.shading.dndv, s.dpdv));
    let s = see(sphere(id, false), Vec3::new(1e-3, 0.0, 5.0), Vec3::NEG_Z);
    assert!(s.uv.y > 0.999);
    assert!(close(see(sphere(id, true), Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y).n, Vec3::NEG_Y));
    let mirror = Transform::scale(Vec3::new(1.0, 1.0, -1.0)).unwrap();
    assert!(close(see(sphere(mirror, false), Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Y).n, Vec3::NEG_Y));

    // v from the rim to the hole.
    let ring = DiskParams { inner_radius: 0.5, ..DiskParams::default() };
    let s = see(Shape::Disk(Disk::new(id, false, ring).unwrap()), Vec3::new(-0.75, 0.0, 3.0), Vec3::NEG_Z);
    assert!((s.uv - Vec2::new(0.5, 0.5)).length() < 1e-5);
    assert!(close(s.n, Vec3::Z) && close(s.dpdv, Vec3::new(0.5, 0.0, 0.0)));

    let pipe = CylinderParams { z_min: -1.0, z_max: 3.0, ..CylinderParams::default() };
    let s = see(Shape::Cylinder(Cylinder::new(id, false, pipe).unwrap()), Vec3::new(0.0, -5.0, 2.0), Vec3::Y);
    assert!((s.uv - Vec2::new(0.75, 0.75)).length() < 1e-5);
    assert!(close(s.n, Vec3::NEG_Y) && close(s.dpdv, Vec3::new(0.0, 0.0, 4.0)));

    // Default texture coordinates (0,0), (1,0), (1,1).
    let parts = MeshParts {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0)],
        indices: vec![0, 1, 2],
        ..MeshParts::default()
    };
    let triangle = |parts: &MeshParts, reverse| {
        Shape::Triangles(Arc::new(TriangleMesh::new(parts.clone(), &id, reverse).unwrap()))
    };
    let eye = Vec3::new(0.75, 0.25, 1.0);
    let s = see(triangle(&parts, false), eye, Vec3::NEG_Z);
    assert!((s.uv - Vec2::new(0.75, 0.25)).length() < 1e-6);
    assert!(close(s.dpdu, Vec3::X) && close(s.dpdv, Vec3::Y) && close(s.n, Vec3::Z));
    assert!(close(see(triangle(&parts, true), eye, Vec3::NEG_Z).n, Vec3::NEG_Z));
    // Vertex normals decide the side of the geometric one; reversed orientation turns them.
    let tilted = Vec3::new(0.3, 0.0, -1.0);
    let smooth = MeshParts { normals: Some(vec![tilted; 3]), ..parts.clone() };
    let s = see(triangle(&smooth, false), eye, Vec3::NEG_Z);
    assert!(close(s.n, Vec3::NEG_Z) && close(s.shading.n, tilted.normalize()));
    assert!(s.shading.dpdu.dot(s.shading.n).abs() < 1e-6);
    assert!(close(see(triangle(&smooth, true), eye, Vec3::NEG_Z).n, Vec3::Z));
    // Texture coordinates that do not span a plane still give a frame.
    let flat_uv = MeshParts { uvs: Some(vec![Vec2::ONE; 3]), ..parts };
    let s = see(triangle(&flat_uv, false), eye, Vec3::NEG_Z);
    assert!(s.dpdu.cross(s.dpdv).length() > 0.5 && s.dpdu.dot(s.n).abs() < 1e-6);

    // Patches: u from corner 0 to 1, v from 0 to 2.
    let parts = MeshParts {
        positions: vec![Vec3::ZERO, 2.0 * Vec3::X, Vec3::Y, Vec3::new(2.0, 1.0, 0.0)],
        indices: vec![0, 1, 2, 3],
        face_indices: Some(vec![42]),
        ..MeshParts::default()
    };
    let patch =
        |parts: &MeshParts| Shape::Patches(Arc::new(BilinearMesh::new(parts.clone(), &id, false).unwrap()));
    let eye = Vec3::new(0.5, 0.75, 1.0);
    let s = see(patch(&parts), eye, Vec3::NEG_Z);
    assert!((s.uv - Vec2::new(0.25, 0.75)).length() < 1e-6 && s.face_index == 42);
    assert!(close(s.dpdu, 2.0 * Vec3::X) && close(s.dpdv, Vec3::Y) && close(s.n, Vec3::Z));
    let uvs = [[1.0, 0.0], [1.0, 2.0], [0.0, 0.0], [0.0, 2.0]].map(Vec2::from_array);
    let s = see(patch(&MeshParts { uvs: Some(uvs.to_vec()), ..parts }), eye, Vec3::NEG_Z);
    assert!((s.uv - Vec2::new(0.25, 0.5)).length() < 1e-6);
    assert!(close(s.dpdu, Vec3::NEG_Y) && close(s.dpdv, Vec3::X), "{s:?}");
    assert!(close(s.n, Vec3::Z));
}

#[test]
fn derivatives_are_those_of_the_surface() {
    // ∂p/∂u and ∂n/∂u against differences between neighbouring hits.
    let mut rng = Rng::new(6);
    let mut checked = 0;
    for k in 0..300 {
        let t = random_similarity(&mut rng, 0.3);
        let shape = match k % 4 {
            0 => sphere(&mut rng, t, false),
            1 => cylinder(&mut rng, t, true),
            2 => disk(&mut rng, t, true),
            _ => patches(&mut rng, t, 1, 1.0),
        };
        let primitive = shape.primitive(0);
        let Some(s) = primitive.sample_area(rng.vec2()) else { continue };
        let see = |target: Vec3| {
            let ray = Ray::new(target + 0.3 * s.n, -s.n, 0.0);
            let hit = primitive.intersect(&ray, f32::INFINITY, |_| true)?;
            Some(primitive.interaction(&ray, &hit))
        };
        let Some(a) = see(s.p) else { continue };
        let step = 2e-3;
        for tangent in [a.dpdu.normalize_or_zero(), a.dpdv.normalize_or_zero()] {
            let Some(b) = see(s.p + step * tangent) else { continue };
            let duv = b.uv - a.uv;
            if duv.length() > 0.3 || a.uv.y < 0.05 || a.uv.y > 0.95 {
                continue;
            }
            let dp = a.dpdu * duv.x + a.dpdv * duv.y;
            assert!((b.p - a.p).distance(dp) < 0.05 * step, "{shape:?} {a:?} {b:?}");
            let dn = a.shading.dndu * duv.x + a.shading.dndv * duv.y;
            let dn = if a.n.dot(a.dpdu.cross(a.dpdv)) < 0.0 { -dn } else { dn };
            assert!(
                (b.n - a.n).distance(dn) < 0.05 * step * (1.0 + 10.0 * dn.length() / step),
                "{a:?} {b:?}"
            );
            checked += 1;
        }
    }
    assert!(checked > 200, "{checked}");
}

#[test]
fn instances_see_their_surface_in_the_world() {
    let mut rng = Rng::new(7);
    let group = Id::new(0);
    for _ in 0..30 {
        let inner = random_transform(&mut rng, 0.5);
        let motion = random_motion(&mut rng, 1.0);
        let placed = sphere(&mut rng, inner, false);
        let Shape::Sphere(_) = placed else { unreachable!() };
        let world = World::build(WorldDesc {
            geometries: vec![Geometry {
                shape: placed.clone(),
                motion: None,
                group: Some(group),
                user: 1,
                masked: false,
            }],
            instances: vec![Instance { group, motion: motion.clone() }],
            shutter: [0.0, 1.0],
        })
        .unwrap();
        for _ in 0..200 {
            let time = rng.f32();
            let t = motion.at(time);
            let target = t.point(placed.primitive(0).sample_area(rng.vec2()).unwrap().p);
            let origin = target + 3.0 * rng.direction();
            let ray = Ray::new(origin, (target - origin).normalize(), time);
            let hit = world.intersect(&ray, f32::INFINITY, |_| true);
            let Some(hit) = hit else { continue };
            assert!(hit.instance.is_some());
            let s = world.interaction(&ray, &hit);
            assert!((s.p - ray.at(hit.t)).length() < 1e-4);
            let tangent = s.dpdu.cross(s.dpdv).normalize();
            assert!(tangent.dot(s.n).abs() > 0.999, "{s:?}");
            // Back along the normal: nothing near, though the ray may have come from inside.
            let out = s.spawn_ray(if s.n.dot(s.wo) > 0.0 { s.n } else { -s.n });
            assert!(!world.occluded(&out, 0.02, |_| true));
        }
    }
    // What stands still is never an instance.
    let world = World::build(WorldDesc {
        geometries: vec![still(sphere(&mut rng, Transform::IDENTITY, false), 0)],
        instances: vec![Instance { group, motion: Motion::still(Transform::IDENTITY) }],
        ..WorldDesc::default()
    })
    .unwrap();
    let hit = world.intersect(&Ray::new(Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z, 0.0), f32::INFINITY, |_| true);
    assert_eq!(hit.unwrap().instance, InstanceId::NONE);
}

#[test]
fn bad_parts_are_refused() {
    let nan = SphereParams { radius: f32::NAN, ..SphereParams::default() };
    assert!(Sphere::new(Transform::IDENTITY, false, nan).is_err());
    assert!(Sphere::new(Transform::IDENTITY, false, SphereParams::whole(0.0)).is_err());
    assert!(
        Disk::new(Transform::IDENTITY, false, DiskParams { radius: -1.0, ..DiskParams::default() }).is_err()
    );
    let endless = CylinderParams { z_max: f32::INFINITY, ..CylinderParams::default() };
    assert!(Cylinder::new(Transform::IDENTITY, false, endless).is_err());

    let good = MeshParts {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        indices: vec![0, 1, 2],
        ..MeshParts::default()
    };
    let error = |parts: MeshParts| TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap_err();
    let wrong = MeshParts { indices: vec![0, 1], ..good.clone() };
    assert_eq!(error(wrong.clone()), MeshError::IndexCount { count: 2, arity: 3 });
    assert!(BilinearMesh::new(wrong, &Transform::IDENTITY, false).is_err());
    let wrong = MeshParts { indices: vec![0, 1, 3], ..good.clone() };
    assert_eq!(error(wrong), MeshError::IndexOutOfRange { at: 2, index: 3, vertices: 3 });
    let wrong = MeshParts { positions: vec![Vec3::ZERO, Vec3::NAN, Vec3::Y], ..good.clone() };
    assert_eq!(error(wrong), MeshError::NotFinite { attribute: "positions", at: 1 });
    let wrong = MeshParts { normals: Some(vec![Vec3::Z]), ..good.clone() };
    assert_eq!(error(wrong), MeshError::AttributeCount { attribute: "normals", count: 1, expected: 3 });
    // Overflow by the transform is found too.
    let huge = Transform::scale(Vec3::splat(1e30)).unwrap();
    let far = MeshParts { positions: vec![Vec3::ZERO, 1e20 * Vec3::X, Vec3::Y], ..good };
    assert!(matches!(TriangleMesh::new(far, &huge, false), Err(MeshError::NotFinite { .. })));
}

#[test]
fn parallelograms_are_hit_where_they_are() {
    let mut rng = Rng::new(77);
    for _ in 0..200 {
        // Whole numbers, whose differences are exact.
        let whole = |rng: &mut Rng| in_box(rng, 8.0).round();
        let (corner, across, along) = (whole(&mut rng), whole(&mut rng), whole(&mut rng));
        let n = across.cross(along);
        if n.length() < 1.0 {
            continue;
        }
        let corners = [corner, corner + across, corner + along, corner + across + along];
        let parts =
            MeshParts { positions: corners.to_vec(), indices: vec![0, 1, 2, 3], ..MeshParts::default() };
        let mesh = BilinearMesh::new(parts, &Transform::IDENTITY, false).unwrap();
        let shape = Shape::Patches(Arc::new(mesh));
        for _ in 0..50 {
            let place = 1.5 * Vec2::new(rng.f32(), rng.f32()) - Vec2::splat(0.25);
            let p = corner + place.x * across + place.y * along;
            let origin = p + whole(&mut rng) + 0.5 * n.normalize();
            let ray = Ray::new(origin, 0.5 * (p - origin), 0.0);
            let hit = shape.primitive(0).intersect(&ray, f32::INFINITY, |_| true);
            let steep = (p - origin).normalize().dot(n.normalize()).abs() > 0.02;
            let margin = place.min(Vec2::ONE - place).min_element();
            match hit {
                _ if !steep || margin.abs() < 1e-4 => {}
                Some(hit) => {
                    assert!(margin > 0.0);
                    assert!((hit.t - 2.0).abs() < 1e-3 && (Vec2::new(hit.u, hit.v) - place).length() < 1e-3);
                }
                None => assert!(margin < 0.0, "{corners:?} {place}"),
            }
        }
    }
}

/// A shape in a small world, and whether its surfaces are told side by side: all but those with shading frames of their own.
fn plain_or_not(kind: usize, reverse: bool, rng: &mut Rng) -> (Shape, bool) {
    let t = random_similarity(rng, 0.1);
    match kind {
        0..=3 => {
            let parts = MeshParts {
                positions: (0..9).map(|_| in_box(rng, 1.0)).collect(),
                indices: (0..9).collect(),
                uvs: (kind == 2).then(|| (0..9).map(|_| rng.vec2()).collect()),
                normals: (kind == 3).then(|| (0..9).map(|_| rng.direction()).collect()),
                face_indices: Some(vec![7, 8, 9]),
                ..MeshParts::default()
            };
            let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, reverse).unwrap();
            (Shape::Triangles(Arc::new(mesh)), kind < 2)
        }
        // Parallelograms, and patches that are twisted, that end in a point, with texture coordinates (also mirrored ones) and with normals.
        4..=8 => {
            let [a, b, c] = [(); 3].map(|()| in_box(rng, 1.0));
            let fourth = if kind == 4 { b + (c - a) } else { in_box(rng, 1.0) };
            let c = if kind == 5 { a } else { c };
            let parts = MeshParts {
                positions: vec![a, b, c, fourth],
                indices: vec![0, 1, 2, 3],
                uvs: (kind != 6).then(|| (0..4).map(|_| rng.vec2()).collect()),
                normals: (kind == 8).then(|| vec![rng.direction(); 4]),
                face_indices: Some(vec![7]),
                ..MeshParts::default()
            };
            let mesh = BilinearMesh::new(parts, &Transform::IDENTITY, reverse).unwrap();
            (Shape::Patches(Arc::new(mesh)), kind < 8)
        }
        9 => (Shape::Sphere(Sphere::new(t, reverse, SphereParams::whole(0.7)).unwrap()), true),
        10 => {
            let part = SphereParams { z_max: 0.3, ..SphereParams::whole(0.7) };
            (Shape::Sphere(Sphere::new(t, reverse, part).unwrap()), false)
        }
        _ => (Shape::Disk(Disk::new(t, reverse, DiskParams::default()).unwrap()), false),
    }
}

/// What is told of plain surfaces side by side is what is told of each alone, to the bit; of all else nothing is.
#[test]
fn plain_surfaces_are_those_of_interactions() {
    let mut rng = Rng::new(31);
    let mut counts = [0; 12];
    for round in 0..600 {
        // One shape, or two of which rays see both.
        let kinds = [round % 12, (round / 24) % 12];
        let shapes = kinds.map(|kind| plain_or_not(kind, (round / 12) % 2 == 0, &mut rng));
        let is_plain = shapes.clone().map(|(_, is_plain)| is_plain);
        let geometries = shapes.into_iter().map(|(shape, _)| still(shape, 0)).collect();
        let world = World::build(WorldDesc { geometries, ..WorldDesc::default() }).unwrap();
        let mut rays = Rays::default();
        for slot in 0..WIDTH {
            let (origin, target) = (3.0 * rng.direction(), in_box(&mut rng, 0.3));
            let direction = if slot % 2 == 0 { target - origin } else { (target - origin).normalize() };
            rays.set(slot, Ray::new(origin, direction, 0.0));
        }
        let hits = std::array::from_fn(|slot| world.intersect(&rays.get(slot), f32::INFINITY, |_| true));
        let textured = Slots::first(8);
        let mut surfaces = PlainSurfaces::default();
        let found = world.plain_surfaces(Slots::first(WIDTH), textured, &rays, &hits, &mut surfaces);
        for slot in 0..WIDTH {
            let Some(hit) = &hits[slot] else {
                assert!(!found.contains(slot));
                continue;
            };
            let which = hit.primitive.geometry.index();
            let kind = kinds[which];
            if !found.contains(slot) {
                // Single hits of patches and spheres may be left out.
                let same = hits.iter().flatten().filter(|other| other.primitive == hit.primitive).count();
                assert!(!is_plain[which] || (kind > 3 && same < 2));
                continue;
            }
            assert!(is_plain[which], "{kind}");
            counts[kind] += 1;
            let alone = world.interaction(&rays.get(slot), hit);
            assert_eq!((surfaces.p.get(slot), surfaces.p_error.get(slot)), (alone.p, alone.p_error));
            assert_eq!((surfaces.n.get(slot), surfaces.n.get(slot)), (alone.n, alone.shading.n));
            assert_eq!(surfaces.dpdu.get(slot), alone.shading.dpdu);
            assert_eq!((surfaces.wo.get(slot), surfaces.face_index[slot]), (alone.wo, alone.face_index));
            if kind != 9 || textured.contains(slot) {
                assert_eq!(surfaces.uv.get(slot), alone.uv);
            }
        }
    }
    let plain = [0, 1, 4, 5, 6, 7, 9];
    assert!(plain.iter().all(|&kind| counts[kind] > 100), "{counts:?}");
}

/// A patch of which an edge is a point has no normal there by itself: such hits are left to others.
#[test]
fn surfaces_without_a_plane_are_left_out() {
    let parts = MeshParts {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::X],
        indices: vec![0, 1, 2, 3],
        ..MeshParts::default()
    };
    let mesh = BilinearMesh::new(parts, &Transform::IDENTITY, false).unwrap();
    let geometries = vec![still(Shape::Patches(Arc::new(mesh)), 0)];
    let world = World::build(WorldDesc { geometries, ..WorldDesc::default() }).unwrap();
    let primitive = PrimitiveId { geometry: Id::new(0), index: 0 };
    let hit = Hit { t: 1.0, u: 0.5, v: 0.5, primitive, instance: InstanceId::NONE };
    let mut surfaces = PlainSurfaces::default();
    let slots = Slots::first(WIDTH);
    let found = world.plain_surfaces(slots, slots, &Rays::default(), &[Some(hit); WIDTH], &mut surfaces);
    assert!(found.is_empty());
}
