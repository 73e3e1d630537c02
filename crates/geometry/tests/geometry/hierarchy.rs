//! The hierarchy against trying everything, and its corner cases.

use super::common::*;
use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::{Id, Motion, Ray, Transform, Vec3};
use tenfold_testkit::Rng;

#[test]
fn finds_what_trying_everything_finds() {
    let (mut hits, mut misses) = (0, 0);
    for seed in 0..24 {
        let mut rng = Rng::new(seed);
        let desc = random_scene(&mut rng, 4 + 4 * seed as usize);
        let world = World::build(desc.clone()).unwrap();
        let portable = World::build(desc.clone()).unwrap().portable();
        for _ in 0..2000 {
            let ray = random_ray(&mut rng, 5.0);
            let t_max = if rng.below(3) == 0 { in_range(&mut rng, 0.5, 5.0) } else { f32::INFINITY };
            let hit = world.intersect(&ray, t_max, |_| true);
            let want = brute_force(&desc, &ray, t_max);
            assert_eq!(hit.map(|h| h.t), want.map(|w| w.0), "seed {seed} {ray:?} {hit:?} {want:?}");
            assert_eq!(hit.map(|h| h.primitive), want.map(|w| w.1));
            assert_eq!(world.occluded(&ray, t_max, |_| true), want.is_some());
            assert_eq!(portable.intersect(&ray, t_max, |_| true), hit);
            *(if hit.is_some() { &mut hits } else { &mut misses }) += 1;
            if let Some(hit) = hit {
                let surface = world.interaction(&ray, &hit);
                let error = (surface.p - ray.at(hit.t)).abs().max_element();
                assert!(error < 2e-4 * (1.0 + hit.t * ray.direction.length()), "{hit:?} {surface:?}");
                assert!((surface.n.length() - 1.0).abs() < 1e-5);
                assert_eq!(surface.primitive, hit.primitive);
                assert!((surface.uv - world.uv(&ray, &hit)).length() < 1e-4);
            }
        }
    }
    assert!(hits > 10_000 && misses > 10_000, "{hits} hits, {misses} misses");
}

#[test]
fn does_not_depend_on_the_number_of_threads() {
    let mut rng = Rng::new(7);
    let shape = triangles(&mut rng, Transform::IDENTITY, 100_000, 0.05);
    let desc = WorldDesc { geometries: vec![still(shape, 0)], ..WorldDesc::default() };
    let with_threads = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| format!("{:?}", World::build(desc.clone()).unwrap()))
    };
    assert!(with_threads(1) == with_threads(3));
}

#[test]
fn empty_worlds_and_single_primitives_work() {
    let ray = Ray::new(Vec3::new(0.1, 0.2, -5.0), Vec3::Z, 0.0);
    let empty = World::build(WorldDesc::default()).unwrap();
    assert!(empty.bounds().is_empty());
    assert_eq!(empty.intersect(&ray, f32::INFINITY, |_| true), None);
    let mesh = TriangleMesh::new(MeshParts::default(), &Transform::IDENTITY, false).unwrap();
    let geometries = vec![still(Shape::Triangles(Arc::new(mesh)), 0)];
    let world = World::build(WorldDesc { geometries, ..WorldDesc::default() }).unwrap();
    assert!(!world.occluded(&ray, f32::INFINITY, |_| true));
    let mut rng = Rng::new(3);
    for _ in 0..50 {
        let t = random_similarity(&mut rng, 1.0);
        let shape = random_shape(&mut rng, t);
        let desc = WorldDesc { geometries: vec![still(shape, 0)], ..WorldDesc::default() };
        let world = World::build(desc.clone()).unwrap();
        for _ in 0..200 {
            let ray = random_ray(&mut rng, 3.0);
            let hit = world.intersect(&ray, f32::INFINITY, |_| true);
            assert_eq!(hit.map(|h| h.t), brute_force(&desc, &ray, f32::INFINITY).map(|w| w.0));
        }
    }
}

#[test]
fn an_instance_of_nothing_is_nothing() {
    let instances = vec![Instance { group: Id::new(5), motion: Motion::still(Transform::IDENTITY) }];
    let world = World::build(WorldDesc { instances, ..WorldDesc::default() }).unwrap();
    assert!(!world.occluded(&Ray::new(Vec3::ZERO, Vec3::X, 0.0), f32::INFINITY, |_| true));
}

#[test]
fn a_world_moves_where_anything_in_it_does() {
    let mut rng = Rng::new(8);
    let ball = |motion: Option<Motion>, group: Option<usize>| {
        let shape = sphere(&mut Rng::new(1), Transform::IDENTITY, false);
        Geometry { motion, group: group.map(Id::new), ..still(shape, 0) }
    };
    let motion = random_motion(&mut rng, 1.0);
    let placed = |motion| Instance { group: Id::new(0), motion };
    let standing = || placed(Motion::still(Transform::IDENTITY));
    for (geometry, instance, moves) in [
        (ball(None, None), standing(), false),
        (ball(None, Some(0)), standing(), false),
        (ball(Some(Motion::still(Transform::IDENTITY)), Some(0)), standing(), false),
        (ball(Some(motion.clone()), None), standing(), true),
        (ball(Some(motion.clone()), Some(0)), standing(), true),
        (ball(None, Some(0)), placed(motion), true),
    ] {
        let (geometries, instances) = (vec![ball(None, None), geometry], vec![instance]);
        let world = World::build(WorldDesc { geometries, instances, shutter: [0.0, 1.0] }).unwrap();
        assert_eq!(world.is_moving(), moves);
    }
}

#[test]
fn coincident_primitives_are_all_found() {
    let mut parts = MeshParts {
        positions: vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)],
        ..MeshParts::default()
    };
    for _ in 0..70_000 {
        parts.indices.extend([0, 1, 2]);
    }
    let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
    let mut geometry = still(Shape::Triangles(Arc::new(mesh)), 0);
    geometry.masked = true;
    let world = World::build(WorldDesc { geometries: vec![geometry], ..WorldDesc::default() }).unwrap();
    let ray = Ray::new(Vec3::new(0.0, 0.0, -1.0), Vec3::Z, 0.0);
    let seen = std::cell::Cell::new(0);
    let hit = world.intersect(&ray, f32::INFINITY, |_| {
        seen.set(seen.get() + 1);
        false
    });
    assert_eq!((hit, seen.get()), (None, 70_000));
    assert_eq!(
        world.intersect(&ray, f32::INFINITY, |c| c.hit.primitive.index == 77).unwrap().primitive.index,
        77
    );
}

#[test]
fn strongly_uneven_scenes_stay_within_the_stack() {
    // Sizes and distances in geometric progression defeat the heuristic: every split takes off one triangle.
    let mut parts = MeshParts::default();
    for i in 0..3000u32 {
        let s = 0.97f32.powi(i as i32 % 1200) * 1e3;
        let x = Vec3::new(s, 0.0, 0.0);
        parts.positions.extend([x, x + Vec3::new(0.0, s, 0.0), x + Vec3::new(0.0, 0.0, s)]);
        parts.indices.extend([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
    let desc =
        WorldDesc { geometries: vec![still(Shape::Triangles(Arc::new(mesh)), 0)], ..WorldDesc::default() };
    let world = World::build(desc.clone()).unwrap();
    let mut rng = Rng::new(11);
    for _ in 0..500 {
        let origin = 1e3 * rng.vec3();
        let ray = Ray::new(origin, (in_box(&mut rng, 10.0) - origin).normalize(), 0.0);
        let hit = world.intersect(&ray, f32::INFINITY, |_| true);
        assert_eq!(hit.map(|h| h.t), brute_force(&desc, &ray, f32::INFINITY).map(|w| w.0));
    }
}

#[test]
fn crowds_inside_crowds_are_found() {
    // Of each crowd, all of the next are in one cell of any grid.
    let mut rng = Rng::new(13);
    let scales = [1.0, 0.015, 2e-4];
    let geometries = scales.map(|scale| {
        let t = Transform::scale(Vec3::splat(scale)).unwrap();
        still(triangles(&mut rng, t, 70_000, 0.02), 0)
    });
    let desc = WorldDesc { geometries: geometries.into(), ..WorldDesc::default() };
    let world = World::build(desc.clone()).unwrap();
    let portable = World::build(desc.clone()).unwrap().portable();
    let mut hits = 0;
    for i in 0..90 {
        let scale = scales[i % 3];
        let origin = 3.0 * scale * rng.direction();
        let ray = Ray::new(origin, scale * in_box(&mut rng, 0.5) - origin, 0.0);
        let hit = world.intersect(&ray, f32::INFINITY, |_| true);
        assert_eq!(hit.map(|h| (h.t, h.primitive)), brute_force(&desc, &ray, f32::INFINITY));
        assert_eq!(portable.intersect(&ray, f32::INFINITY, |_| true), hit);
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 60, "{hits} hits");
}

#[test]
fn rays_that_are_not_numbers_hit_nothing() {
    let mut rng = Rng::new(5);
    let desc = random_scene(&mut rng, 40);
    let world = World::build(desc).unwrap();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let (mut p, mut d) = (Vec3::ZERO, Vec3::X);
            p[axis] = bad;
            assert_eq!(world.intersect(&Ray::new(p, d, 0.5), f32::INFINITY, |_| true), None);
            d[axis] = bad;
            assert_eq!(world.intersect(&Ray::new(Vec3::ZERO, d, 0.5), f32::INFINITY, |_| true), None);
        }
    }
    let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.5);
    assert_eq!(world.intersect(&Ray::new(Vec3::ZERO, Vec3::ZERO, 0.5), f32::INFINITY, |_| true), None);
    assert_eq!(world.intersect(&ray, f32::NAN, |_| true), None);
    assert_eq!(world.intersect(&ray, 0.0, |_| true), None);
    world.intersect(&Ray::new(Vec3::ZERO, Vec3::splat(1e-38), f32::NAN), f32::INFINITY, |_| true);
    world.intersect(&Ray::new(Vec3::splat(3e38), Vec3::splat(-3e38), 0.5), f32::INFINITY, |_| true);
}

#[test]
fn degenerate_triangles_are_counted_and_never_hit() {
    let parts = MeshParts {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::X, Vec3::Z],
        indices: vec![0, 1, 2, 0, 1, 3, 0, 0, 4, 1, 1, 1],
        ..MeshParts::default()
    };
    let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
    assert!(!mesh.has_no_area());
    let world = World::build(WorldDesc {
        geometries: vec![still(Shape::Triangles(Arc::new(mesh)), 0)],
        ..WorldDesc::default()
    })
    .unwrap();
    assert_eq!((world.stats().degenerate, world.stats().primitives), (3, 1));
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z, 0.0);
    assert_eq!(world.intersect(&ray, 2.0, |_| true).unwrap().primitive.index, 0);
}

#[test]
fn masks_let_rays_through_where_they_say() {
    let mut rng = Rng::new(21);
    for (i, kind) in ["sphere", "disk", "cylinder", "triangles", "patches"].into_iter().enumerate() {
        let t = random_similarity(&mut rng, 0.5);
        let shape = match i {
            0 => sphere(&mut rng, t, false),
            1 => disk(&mut rng, t, false),
            2 => cylinder(&mut rng, t, false),
            3 => triangles(&mut rng, t, 30, 1.0),
            _ => patches(&mut rng, t, 6, 1.5),
        };
        let mut geometry = still(shape, 9);
        geometry.masked = true;
        let desc = WorldDesc { geometries: vec![geometry], ..WorldDesc::default() };
        let world = World::build(desc).unwrap();
        let opaque = |c: &Candidate<'_>| {
            assert_eq!(c.user, 9);
            c.world.uv(c.ray, &c.hit).x < 0.5
        };
        let (mut through, mut hit_count) = (0, 0);
        for _ in 0..5000 {
            let ray = random_ray(&mut rng, 2.0);
            let all = world.intersect(&ray, f32::INFINITY, |_| true);
            let hit = world.intersect(&ray, f32::INFINITY, opaque);
            assert_eq!(world.occluded(&ray, f32::INFINITY, opaque), hit.is_some());
            if let Some(hit) = hit {
                assert!(world.interaction(&ray, &hit).uv.x < 0.5);
                assert!(hit.t >= all.unwrap().t);
                hit_count += 1;
                through += u32::from(hit.t > all.unwrap().t);
            } else if let Some(all) = all {
                assert!(world.interaction(&ray, &all).uv.x >= 0.5);
            }
        }
        assert!(hit_count > 50, "{kind}");
        assert!(kind == "disk" || through > 10, "{kind}: {through}");
    }
}

#[test]
fn of_hits_at_one_distance_that_of_the_first_primitive_counts() {
    // A grid of triangles and a copy of it, in different orders: rays through corners and edges hit many at once.
    let mut rng = Rng::new(13);
    let n = 12u32;
    let positions = (0..n * n).map(|i| Vec3::new((i % n) as f32, (i / n) as f32, 0.0)).collect::<Vec<_>>();
    let mut faces: Vec<[u32; 3]> = (0..(n - 1) * (n - 1))
        .flat_map(|i| {
            let a = i % (n - 1) + i / (n - 1) * n;
            [[a, a + 1, a + n], [a + 1, a + n + 1, a + n]]
        })
        .collect();
    let mut geometries = Vec::new();
    for user in 0..2 {
        for i in (1..faces.len()).rev() {
            faces.swap(i, rng.below(i + 1));
        }
        let parts = MeshParts {
            positions: positions.clone(),
            indices: faces.iter().flatten().copied().collect(),
            ..MeshParts::default()
        };
        let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
        geometries.push(still(Shape::Triangles(Arc::new(mesh)), user));
    }
    let desc = WorldDesc { geometries, ..WorldDesc::default() };
    let world = World::build(desc.clone()).unwrap();
    for x in 0..4 * n {
        for y in 0..4 * n {
            let to = 0.25 * Vec3::new(x as f32, y as f32, 0.0);
            for from in [to + Vec3::Z, Vec3::new(3.0, -2.0, 8.0)] {
                let ray = Ray::new(from, to - from, 0.0);
                let hit = world.intersect(&ray, f32::INFINITY, |_| true).map(|h| (h.t, h.primitive));
                assert_eq!(hit, brute_force(&desc, &ray, f32::INFINITY), "{ray:?}");
            }
        }
    }
}

#[test]
fn triangles_that_are_cut_are_found_along_their_whole_length() {
    // Long slanted ones among small ones are what the builder cuts: a few before the tree is built, many meanwhile.
    find_rods(2);
    find_rods(150);
}

fn find_rods(count: usize) {
    let mut rng = Rng::new(17);
    let mut parts = MeshParts::default();
    let mut add = |corners: [Vec3; 3]| {
        parts.indices.extend((0..3).map(|i| parts.positions.len() as u32 + i));
        parts.positions.extend(corners);
    };
    for _ in 0..3000 {
        let p = in_box(&mut rng, 1.0);
        add([p, p + in_box(&mut rng, 0.01), p + in_box(&mut rng, 0.01)]);
    }
    let rods: Vec<[Vec3; 3]> = (0..count)
        .map(|_| {
            let (a, b) = (in_box(&mut rng, 1.0), in_box(&mut rng, 1.0));
            [a, b, b + in_box(&mut rng, 0.01)]
        })
        .collect();
    rods.iter().for_each(|rod| add(*rod));
    let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
    let desc =
        WorldDesc { geometries: vec![still(Shape::Triangles(Arc::new(mesh)), 0)], ..WorldDesc::default() };
    let world = World::build(desc.clone()).unwrap();
    let portable = World::build(desc.clone()).unwrap().portable();
    let mut hits = 0usize;
    for [a, b, c] in rods {
        for _ in 0..10 {
            let s = rng.f32();
            let on_it = a + s * (0.5 * (b + c) - a);
            let origin = in_box(&mut rng, 3.0);
            let ray = Ray::new(origin, on_it - origin, 0.0);
            let hit = world.intersect(&ray, f32::INFINITY, |_| true);
            assert_eq!(hit.map(|h| (h.t, h.primitive)), brute_force(&desc, &ray, f32::INFINITY), "{ray:?}");
            assert_eq!(portable.intersect(&ray, f32::INFINITY, |_| true), hit);
            hits += usize::from(hit.is_some());
        }
    }
    assert!(hits >= 8 * count, "{hits}");
}
