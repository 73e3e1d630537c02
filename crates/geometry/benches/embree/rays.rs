//! The rays: what a path tracer asks for.

use crate::meshes::View;
use tenfold_geometry::{SurfaceInteraction, World};
use tenfold_math::{Ray, Vec3};
use tenfold_testkit::Rng;

/// Rays of one kind.
pub(crate) struct Batch {
    pub(crate) name: &'static str,
    /// Whether any hit will do.
    pub(crate) any: bool,
    pub(crate) t_max: f32,
    pub(crate) rays: Vec<Ray>,
}

/// Rays through `n` × `n` pixels in the order of scan lines, from what they hit to points of a light before it, and from there again in
/// directions by the cosine; all at random times in [0, 1].
pub(crate) fn batches(world: &World, view: &View, n: usize) -> [Batch; 3] {
    let mut rng = Rng::new(1);
    let forward = (view.target - view.eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let camera: Vec<Ray> = (0..n * n)
        .map(|i| {
            let x = ((i % n) as f32 + rng.f32()) / n as f32 - 0.5;
            let y = 0.5 - ((i / n) as f32 + rng.f32()) / n as f32;
            Ray::new(view.eye, (forward + x * right + y * up).normalize(), rng.f32())
        })
        .collect();
    let surface =
        |ray: &Ray| Some((world.interaction(ray, &world.intersect(ray, f32::INFINITY, |_| true)?), ray.time));
    let hits: Vec<(SurfaceInteraction, f32)> = camera.iter().filter_map(surface).collect();
    let (middle, radius) = view.light;
    let normal = |hit: &SurfaceInteraction| if hit.n.dot(hit.wo) < 0.0 { -hit.n } else { hit.n };
    let shadow = hits.iter().filter_map(|(hit, time)| {
        let point = middle + radius * rng.direction();
        let ray = hit.spawn_ray(point - hit.p);
        let lit = normal(hit).dot(ray.direction) > 0.0;
        lit.then(|| Ray::new(ray.origin, point - ray.origin, *time))
    });
    let shadow = shadow.collect();
    let bounce = hits.iter().map(|(hit, time)| {
        let n = normal(hit);
        // A point of the unit sphere that touches the surface: directions by the cosine.
        let d = (n + rng.direction()).normalize_or(n);
        let ray = hit.spawn_ray(d);
        Ray::new(ray.origin, ray.direction, *time)
    });
    let bounce = bounce.collect();
    let batch = |name, any, t_max, rays| Batch { name, any, t_max, rays };
    [
        batch("camera", false, f32::INFINITY, camera),
        batch("shadow", true, 0.999, shadow),
        batch("bounce", false, f32::INFINITY, bounce),
    ]
}
