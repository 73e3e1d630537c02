//! Closed meshes let no ray out.

use super::common::*;
use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::{Id, Motion, Ray, Transform, Vec3};
use tenfold_testkit::Rng;

/// Rays from `origin` at vertices, points of edges, and anything else of a closed mesh around it: none may get out.
fn check_closed(name: &str, mesh: &TriangleMesh, world: &World, to_world: &Transform, rng: &mut Rng) {
    let positions = &mesh.parts().positions;
    let centre = positions.iter().sum::<Vec3>() / positions.len() as f32;
    let mut leaks = 0;
    for i in 0..60_000 {
        // All the meshes here are seen whole from around their middle.
        let off_centre = positions[rng.below(positions.len())] - centre;
        let origin = to_world.point(centre + 0.3 * rng.f32() * off_centre);
        let [a, b, c] = mesh.positions(rng.below(mesh.len())).map(|p| to_world.point(p));
        let target = match i % 4 {
            0 => a,
            1 => a + (b - a) * rng.f32(),
            2 => 0.5 * (b + c),
            _ => a + (b - a) * rng.f32() * 0.5 + (c - a) * rng.f32() * 0.5,
        };
        let mut direction = target - origin;
        if i % 8 < 4 {
            direction = direction.normalize();
        }
        if i % 97 == 0 {
            direction = Vec3::AXES[rng.below(3)];
        }
        let ray = Ray::new(origin, direction, rng.f32());
        leaks += u32::from(!world.occluded(&ray, f32::INFINITY, |_| true));
        leaks += u32::from(world.intersect(&ray, f32::INFINITY, |_| true).is_none());
    }
    assert_eq!(leaks, 0, "{name}");
}

fn world_of(mesh: &Arc<TriangleMesh>) -> World {
    let geometries = vec![still(Shape::Triangles(mesh.clone()), 0)];
    World::build(WorldDesc { geometries, ..WorldDesc::default() }).unwrap()
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    let mut rng = Rng::new(1);
    for (rings, segments) in [(3, 4), (8, 8), (40, 60), (100, 150)] {
        for (name, t) in [
            ("as it is", Transform::IDENTITY),
            ("turned", random_similarity(&mut rng, 1.0)),
            ("far away", Transform::translate(Vec3::new(1000.0, -300.0, 20.0))),
            ("flat", Transform::scale(Vec3::new(1.0, 1e-3, 1.0)).unwrap()),
            ("large", Transform::scale(Vec3::splat(1e5)).unwrap()),
            ("small", Transform::scale(Vec3::splat(1e-5)).unwrap()),
        ] {
            let bump = if rng.below(2) == 0 { 0.2 } else { 0.0 };
            let parts = closed_mesh(&mut rng, rings, segments, bump);
            let mesh = Arc::new(TriangleMesh::new(parts, &t, false).unwrap());
            let name = format!("{rings} rings, {name}");
            check_closed(&name, &mesh, &world_of(&mesh), &Transform::IDENTITY, &mut rng);
        }
    }
}

#[test]
fn no_ray_leaves_a_box_of_squares() {
    // Edges and box planes coincide everywhere here.
    let n = 8u32;
    let mut parts = MeshParts::default();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let first = parts.positions.len() as u32;
            for i in 0..=n {
                for j in 0..=n {
                    let mut p = Vec3::splat(side);
                    p[(axis + 1) % 3] = i as f32 / n as f32;
                    p[(axis + 2) % 3] = j as f32 / n as f32;
                    parts.positions.push(p);
                }
            }
            for i in 0..n {
                for j in 0..n {
                    let k = first + i * (n + 1) + j;
                    parts.indices.extend([k, k + 1, k + n + 2, k, k + n + 2, k + n + 1]);
                }
            }
        }
    }
    let mut rng = Rng::new(2);
    for offset in [Vec3::ZERO, Vec3::new(-0.5, -0.5, -0.5), Vec3::new(77.7, 3.3, -0.1)] {
        let mesh = TriangleMesh::new(parts.clone(), &Transform::translate(offset), false).unwrap();
        let mesh = Arc::new(mesh);
        check_closed("box", &mesh, &world_of(&mesh), &Transform::IDENTITY, &mut rng);
    }
}

#[test]
fn no_ray_leaves_an_instance() {
    let mut rng = Rng::new(3);
    for _ in 0..4 {
        let parts = closed_mesh(&mut rng, 30, 40, 0.1);
        let mesh = Arc::new(TriangleMesh::new(parts, &random_transform(&mut rng, 2.0), false).unwrap());
        let to_world = random_transform(&mut rng, 2.0);
        let group = Id::new(0);
        let mut geometry = still(Shape::Triangles(mesh.clone()), 0);
        geometry.group = Some(group);
        let world = World::build(WorldDesc {
            geometries: vec![geometry],
            instances: vec![Instance { group, motion: Motion::still(to_world) }],
            ..WorldDesc::default()
        })
        .unwrap();
        check_closed("instance", &mesh, &world, &to_world, &mut rng);
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh_of_patches() {
    // A box of bent patches that share edges.
    let mut rng = Rng::new(4);
    let corner: Vec<Vec3> = (0..8u32)
        .map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) + in_box(&mut rng, 0.2))
        .collect();
    let parts = MeshParts {
        positions: corner.clone(),
        indices: vec![0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 4, 5, 2, 3, 6, 7, 0, 2, 4, 6, 1, 3, 5, 7],
        ..MeshParts::default()
    };
    let mesh = Arc::new(BilinearMesh::new(parts, &Transform::IDENTITY, false).unwrap());
    let world =
        World::build(WorldDesc { geometries: vec![still(Shape::Patches(mesh), 0)], ..WorldDesc::default() })
            .unwrap();
    let edges =
        [(0, 1), (1, 3), (3, 2), (2, 0), (4, 5), (5, 7), (7, 6), (6, 4), (0, 4), (1, 5), (2, 6), (3, 7)];
    for i in 0..200_000 {
        let origin = Vec3::splat(0.5) + in_box(&mut rng, 0.1);
        let (a, b) = edges[rng.below(12)];
        let target = match i % 3 {
            0 => corner[a],
            1 => corner[a] + (corner[b] - corner[a]) * rng.f32(),
            _ => origin + rng.direction(),
        };
        let ray = Ray::new(origin, (target - origin).normalize(), 0.0);
        assert!(world.occluded(&ray, f32::INFINITY, |_| true), "{ray:?}");
    }
}
