//! Random scenes for the tests, and a search without any hierarchy.

use std::sync::Arc;
use tenfold_geometry::*;
use tenfold_math::ops;
use tenfold_math::{Id, Key, Motion, Ray, Transform, Vec3};
use tenfold_testkit::Rng;

pub(crate) fn in_range(rng: &mut Rng, low: f32, high: f32) -> f32 {
    low + (high - low) * rng.f32()
}

pub(crate) fn in_box(rng: &mut Rng, half: f32) -> Vec3 {
    half * (2.0 * rng.vec3() - Vec3::ONE)
}

/// Turned, moved, and scaled differently along the axes, sometimes mirrored.
pub(crate) fn random_transform(rng: &mut Rng, spread: f32) -> Transform {
    let sign = if rng.below(4) == 0 { -1.0 } else { 1.0 };
    let scale = Vec3::new(in_range(rng, 0.3, 2.0) * sign, in_range(rng, 0.3, 2.0), in_range(rng, 0.3, 2.0));
    Transform::translate(in_box(rng, spread))
        * Transform::rotate(in_range(rng, 0.0, 6.0), rng.direction()).unwrap()
        * Transform::scale(scale).unwrap()
}

/// Turned, moved and scaled alike along the axes.
pub(crate) fn random_similarity(rng: &mut Rng, spread: f32) -> Transform {
    Transform::translate(in_box(rng, spread))
        * Transform::rotate(in_range(rng, 0.0, 6.0), rng.direction()).unwrap()
        * Transform::scale(Vec3::splat(in_range(rng, 0.3, 2.0))).unwrap()
}

pub(crate) fn sphere(rng: &mut Rng, t: Transform, partial: bool) -> Shape {
    let radius = in_range(rng, 0.2, 1.0);
    let params = if partial {
        SphereParams {
            radius,
            z_min: -radius * rng.f32(),
            z_max: radius * rng.f32(),
            phi_max: in_range(rng, 0.5, 6.0),
        }
    } else {
        SphereParams::whole(radius)
    };
    Shape::Sphere(Sphere::new(t, rng.below(2) == 0, params).unwrap())
}

pub(crate) fn disk(rng: &mut Rng, t: Transform, partial: bool) -> Shape {
    let radius = in_range(rng, 0.4, 1.0);
    let height = in_range(rng, -1.0, 1.0);
    let params = if partial {
        DiskParams {
            height,
            radius,
            inner_radius: 0.5 * radius * rng.f32(),
            phi_max: in_range(rng, 0.5, 6.0),
        }
    } else {
        DiskParams { height, radius, ..DiskParams::default() }
    };
    Shape::Disk(Disk::new(t, rng.below(2) == 0, params).unwrap())
}

pub(crate) fn cylinder(rng: &mut Rng, t: Transform, partial: bool) -> Shape {
    let params = CylinderParams {
        radius: in_range(rng, 0.2, 1.0),
        z_min: in_range(rng, -1.0, 0.0),
        z_max: in_range(rng, 0.0, 1.0),
        phi_max: if partial { in_range(rng, 0.5, 6.0) } else { std::f32::consts::TAU },
    };
    Shape::Cylinder(Cylinder::new(t, rng.below(2) == 0, params).unwrap())
}

pub(crate) fn triangles(rng: &mut Rng, t: Transform, count: usize, size: f32) -> Shape {
    let mut parts = MeshParts::default();
    for i in 0..count {
        let centre = in_box(rng, 1.0);
        for j in 0..3 {
            parts.positions.push(centre + in_box(rng, size));
            parts.indices.push((3 * i + j) as u32);
        }
    }
    Shape::Triangles(Arc::new(TriangleMesh::new(parts, &t, rng.below(2) == 0).unwrap()))
}

pub(crate) fn patches(rng: &mut Rng, t: Transform, count: usize, size: f32) -> Shape {
    let mut parts = MeshParts::default();
    for i in 0..count {
        let (centre, eu, ev) = (in_box(rng, 1.0), in_box(rng, size), in_box(rng, size));
        for j in 0..4u32 {
            let p = centre + eu * (j & 1) as f32 + ev * (j >> 1) as f32 + in_box(rng, 0.3 * size);
            parts.positions.push(p);
            parts.indices.push(4 * i as u32 + j);
        }
    }
    Shape::Patches(Arc::new(BilinearMesh::new(parts, &t, rng.below(2) == 0).unwrap()))
}

pub(crate) fn random_shape(rng: &mut Rng, t: Transform) -> Shape {
    let partial = rng.below(2) == 0;
    match rng.below(5) {
        0 => sphere(rng, t, partial),
        1 => disk(rng, t, partial),
        2 => cylinder(rng, t, partial),
        3 => {
            let count = 1 + rng.below(60);
            triangles(rng, t, count, 0.4)
        }
        _ => {
            let count = 1 + rng.below(6);
            patches(rng, t, count, 0.6)
        }
    }
}

/// Through two keys or four.
pub(crate) fn random_motion(rng: &mut Rng, spread: f32) -> Motion {
    let mut transform = random_similarity(rng, spread);
    let keys = if rng.below(2) == 0 { 2 } else { 4 };
    let key = |i: usize| {
        let key = Key { time: i as f32 / (keys - 1) as f32, transform };
        let turn = Transform::rotate(in_range(rng, 0.0, 2.5), rng.direction()).unwrap();
        transform = transform * turn * Transform::translate(in_box(rng, 0.8));
        key
    };
    Motion::through(&(0..keys).map(key).collect::<Vec<_>>())
}

pub(crate) fn still(shape: Shape, user: u32) -> Geometry {
    Geometry { shape, motion: None, group: None, user, masked: false }
}

/// Shapes of all kinds: still, moving, instanced, and both at once.
pub(crate) fn random_scene(rng: &mut Rng, size: usize) -> WorldDesc {
    let mut desc = WorldDesc { shutter: [0.0, 1.0], ..WorldDesc::default() };
    for i in 0..size {
        let group = (rng.below(3) == 0).then(|| Id::new(rng.below(2)));
        let motion = (rng.below(4) == 0).then(|| random_motion(rng, 1.0));
        let t = random_transform(rng, if group.is_some() || motion.is_some() { 0.5 } else { 3.0 });
        let shape = random_shape(rng, t);
        desc.geometries.push(Geometry { shape, motion, group, user: i as u32, masked: false });
    }
    for i in 0..4 {
        let motion =
            if i % 2 == 0 { random_motion(rng, 3.0) } else { Motion::still(random_transform(rng, 3.0)) };
        desc.instances.push(Instance { group: Id::new(rng.below(3)), motion });
    }
    desc
}

pub(crate) fn random_ray(rng: &mut Rng, spread: f32) -> Ray {
    let origin = in_box(rng, spread);
    let direction = match rng.below(8) {
        // Along an axis.
        0 => Vec3::AXES[rng.below(3)] * if rng.below(2) == 0 { 1.0 } else { -1.0 },
        // Toward the middle, of another length.
        1..4 => (in_box(rng, 1.0) - origin) * in_range(rng, 0.1, 3.0),
        _ => rng.direction(),
    };
    Ray::new(origin, direction, rng.f32())
}

/// What [`World::intersect`] should find, by trying everything.
pub(crate) fn brute_force(desc: &WorldDesc, ray: &Ray, t_max: f32) -> Option<(f32, PrimitiveId)> {
    let mut best: Option<(f32, PrimitiveId)> = None;
    let mut try_at = |g: usize, to_world: Option<Transform>| {
        let local = to_world.map_or(*ray, |t| t.inverse().ray(ray));
        let shape = &desc.geometries[g].shape;
        for index in 0..shape.len() {
            let limit = best.map_or(t_max, |b| b.0);
            if let Some(hit) = shape.primitive(index).intersect(&local, limit, |_| true) {
                best = Some((hit.t, PrimitiveId { geometry: Id::new(g), index: index as u32 }));
            }
        }
    };
    for (g, geometry) in desc.geometries.iter().enumerate() {
        let inner = geometry.motion.as_ref().map(|m| m.at(ray.time));
        match geometry.group {
            None => try_at(g, inner),
            Some(group) => {
                for instance in desc.instances.iter().filter(|i| i.group == group) {
                    let outer = instance.motion.at(ray.time);
                    try_at(g, Some(inner.map_or(outer, |inner| outer * inner)));
                }
            }
        }
    }
    best
}

/// A closed mesh: a sphere of `rings` rings with `segments` corners each, bumpy where `bump > 0`.
pub(crate) fn closed_mesh(rng: &mut Rng, rings: u32, segments: u32, bump: f32) -> MeshParts {
    use std::f32::consts::{PI, TAU};
    let mut parts = MeshParts::default();
    parts.positions.push(Vec3::Z);
    for i in 1..rings {
        for j in 0..segments {
            let (theta, phi) = (PI * i as f32 / rings as f32, TAU * j as f32 / segments as f32);
            let d = tenfold_math::spherical_direction(ops::sin(theta), ops::cos(theta), phi);
            parts.positions.push(d * (1.0 + bump * (rng.f32() - 0.5)));
        }
    }
    parts.positions.push(Vec3::NEG_Z);
    let last = parts.positions.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * segments + j % segments;
    for j in 0..segments {
        parts.indices.extend([0, at(1, j), at(1, j + 1)]);
        parts.indices.extend([last, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            parts.indices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            parts.indices.extend([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    parts
}
