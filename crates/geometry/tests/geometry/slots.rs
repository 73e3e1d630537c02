//! Rays side by side against each alone.

use super::common::*;
use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::{Id, Ray, Rays, Slots, Transform, Vec3, WIDTH};
use tenfold_testkit::Rng;

/// A point of a grid: on such, rays run within planes and through edges and corners.
fn on_grid(rng: &mut Rng) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|_| rng.below(5) as f32 - 2.0))
}

/// Few shapes of all kinds, also parallelograms, and triangles that coincide or have no area.
fn few_shapes(rng: &mut Rng) -> WorldDesc {
    let mut desc = WorldDesc { shutter: [0.0, 1.0], ..WorldDesc::default() };
    for user in 0..1 + rng.below(6) as u32 {
        let place = random_similarity(rng, 2.0);
        let partial = rng.below(3) == 0;
        let count = 1 + rng.below(12);
        let shape = match rng.below(8) {
            0 | 1 => sphere(rng, place, partial),
            2 => triangles(rng, place, count, 0.6),
            3 => {
                let positions = (0..3 * count).map(|_| on_grid(rng)).collect();
                let indices = (0..3 * count as u32).chain([0, 1, 2, 1, 2, 0]).collect();
                let parts = MeshParts { positions, indices, ..MeshParts::default() };
                Shape::Triangles(Arc::new(TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap()))
            }
            4 => {
                let (p, u, v) = (on_grid(rng), on_grid(rng), on_grid(rng));
                let positions = vec![p, p + u, p + v, p + u + v];
                let parts = MeshParts { positions, indices: (0..4).collect(), ..MeshParts::default() };
                Shape::Patches(Arc::new(BilinearMesh::new(parts, &Transform::IDENTITY, false).unwrap()))
            }
            5 => patches(rng, place, 2, 0.6),
            // Closed, of corners that many triangles share.
            6 => {
                let parts = closed_mesh(rng, 3, 4, 0.5);
                Shape::Triangles(Arc::new(TriangleMesh::new(parts, &place, false).unwrap()))
            }
            _ => {
                let place = random_transform(rng, 2.0);
                random_shape(rng, place)
            }
        };
        desc.geometries.push(still(shape, user));
    }
    // Some are no world that every ray can be tested against alike.
    let geometry = &mut desc.geometries[0];
    match rng.below(8) {
        0 => geometry.masked = true,
        1 => geometry.motion = Some(random_motion(rng, 1.0)),
        _ => {}
    }
    desc
}

fn any_ray(rng: &mut Rng) -> Ray {
    match rng.below(16) {
        0 => Ray::new(Vec3::ZERO, Vec3::ZERO, 0.0),
        1 => Ray::new(Vec3::NAN, Vec3::X, 0.0),
        2 => Ray::new(Vec3::ZERO, Vec3::new(1.0, f32::INFINITY, 0.0), 0.0),
        3..8 => Ray::new(on_grid(rng), on_grid(rng), 0.0),
        _ => random_ray(rng, 4.0),
    }
}

/// Traces rays through a world in slots and alone; how many hit, and how many are in the way.
fn compare(world: &World, rng: &mut Rng) -> [usize; 2] {
    let mut rays = Rays::default();
    (0..WIDTH).for_each(|slot| rays.set(slot, any_ray(rng)));
    let slots = Slots::first(WIDTH).keep(|_| rng.below(4) != 0);
    let t_max = std::array::from_fn(|_| match rng.below(16) {
        0 => 0.0,
        1 => f32::NAN,
        2 => -1.0,
        3 | 4 => f32::INFINITY,
        5 | 6 => 1.0,
        _ => in_range(rng, 0.1, 6.0),
    });
    let mut courses = RayCourses::default();
    let unlike_any = Hit {
        t: -1.0,
        u: 0.0,
        v: 0.0,
        primitive: PrimitiveId { geometry: Id::new(0), index: 77 },
        instance: InstanceId::NONE,
    };
    let mut hits = [Some(unlike_any); WIDTH];
    // Every third is let through where it is asked for.
    let stops = |slot: usize, _: &Candidate<'_>| !slot.is_multiple_of(3);
    world.intersect_slots(slots, &rays, &mut courses, stops, &mut hits);
    let occluded = world.occluded_slots(slots, &rays, &mut courses, &t_max, stops);
    for slot in 0..WIDTH {
        if !slots.contains(slot) {
            assert!(hits[slot].take() == Some(unlike_any) && !occluded.contains(slot));
            continue;
        }
        let ray = rays.get(slot);
        assert_eq!(hits[slot], world.intersect(&ray, f32::INFINITY, |c| stops(slot, c)), "{ray:?}");
        let alone = world.occluded(&ray, t_max[slot], |c| stops(slot, c));
        assert_eq!(occluded.contains(slot), alone, "{ray:?} {}", t_max[slot]);
    }
    [hits.iter().flatten().count(), occluded.len()]
}

#[test]
fn rays_among_few_primitives_find_in_slots_what_they_find_alone() {
    let mut found = [0, 0];
    for seed in 0..600 {
        let mut rng = Rng::new(seed);
        let world = World::build(few_shapes(&mut rng)).unwrap();
        for _ in 0..20 {
            let [hits, occluded] = compare(&world, &mut rng);
            found = [found[0] + hits, found[1] + occluded];
        }
    }
    assert!(found.iter().all(|&n| n > 10_000), "{found:?}");
}

#[test]
fn rays_in_any_world_find_in_slots_what_they_find_alone() {
    let mut found = [0, 0];
    for seed in 0..24 {
        let mut rng = Rng::new(seed);
        let mut desc = random_scene(&mut rng, 4 + 2 * seed as usize);
        desc.geometries.iter_mut().for_each(|geometry| geometry.masked = rng.below(3) == 0);
        let build = || World::build(desc.clone()).unwrap();
        let at_once = [build().interleaved(), build().streaming()];
        let portable = [build().portable().interleaved(), build().portable().streaming()];
        for world in [build()].into_iter().chain(at_once).chain(portable) {
            for _ in 0..100 {
                let [hits, occluded] = compare(&world, &mut rng);
                found = [found[0] + hits, found[1] + occluded];
            }
        }
    }
    assert!(found.iter().all(|&n| n > 15_000), "{found:?}");
}

/// Large triangles anywhere: each ray comes to most nodes and leaves, which are more than wait at once.
#[test]
fn rays_that_come_to_very_much_find_in_slots_what_they_find_alone() {
    let mut rng = Rng::new(3);
    let shape = triangles(&mut rng, Transform::IDENTITY, 30_000, 1.5);
    let desc = WorldDesc { geometries: vec![still(shape, 0)], shutter: [0.0, 1.0], ..WorldDesc::default() };
    let build = || World::build(desc.clone()).unwrap().streaming();
    let mut found = [0, 0];
    for world in [build(), build().portable()] {
        for _ in 0..20 {
            let [hits, occluded] = compare(&world, &mut rng);
            found = [found[0] + hits, found[1] + occluded];
        }
    }
    assert!(found.iter().all(|&n| n > 150), "{found:?}");
}

/// Slivers whose edge functions all cancel in single precision: corners ±(1 + kδ, 1 + (k + 3)δ, 1), where δ is the distance of floats.
#[test]
fn slivers_that_look_flat_are_hit_in_slots_as_alone() {
    let corner = |sign: f32, k: i32| {
        let x = |k: i32| sign * (1.0 + k as f32 * f32::EPSILON);
        Vec3::new(x(k), x(k + 3), 1.0)
    };
    let mut rays = Rays::default();
    (0..WIDTH).for_each(|slot| rays.set(slot, Ray::new(Vec3::ZERO, Vec3::Z, 0.0)));
    for k in 1..20 {
        let positions = vec![corner(1.0, 1), corner(-1.0, 1 + k), corner(1.0, 2 + 2 * k)];
        let parts = MeshParts { positions, indices: vec![0, 1, 2], ..MeshParts::default() };
        let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
        let geometries = vec![still(Shape::Triangles(Arc::new(mesh)), 0)];
        let world = World::build(WorldDesc { geometries, ..WorldDesc::default() }).unwrap();
        let alone = world.intersect(&rays.get(0), f32::INFINITY, |_| true);
        assert_eq!(alone.unwrap().t, 1.0);
        let mut hits = [None; WIDTH];
        let all = Slots::first(WIDTH);
        world.intersect_slots(all, &rays, &mut RayCourses::default(), |_, _| true, &mut hits);
        assert_eq!(hits, [alone; WIDTH]);
    }
}
