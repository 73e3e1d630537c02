//! Times rays against the triangles of an OBJ file: `cargo run --release --example rays_per_second -- FILE.obj`.

use std::{
    env, fs,
    hint::black_box,
    sync::Arc,
    time::{Instant, SystemTime},
};
use tenfold_geometry::{Geometry, MeshParts, Shape, TriangleMesh, World, WorldDesc};
use tenfold_math::{Ray, Transform, Vec3};
use tenfold_testkit::Rng;

fn main() {
    let Some(path) = env::args().nth(1) else {
        eprintln!("usage: rays_per_second FILE.obj");
        return;
    };
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("{path}: {error}");
            return;
        }
    };
    let mesh = TriangleMesh::new(parse(&text), &Transform::IDENTITY, false).expect("a sound mesh");
    let triangles = mesh.len();
    let geometry = Geometry {
        shape: Shape::Triangles(Arc::new(mesh)),
        motion: None,
        group: None,
        user: 0,
        masked: false,
    };
    let start = Instant::now();
    let world = World::build(WorldDesc { geometries: vec![geometry], ..WorldDesc::default() })
        .expect("a small world");
    println!("{triangles} triangles built in {:.3} s: {:?}", start.elapsed().as_secs_f64(), world.stats());

    let (centre, radius) = world.bounds().bounding_sphere();
    let eye = centre + 2.0 * radius * Vec3::new(0.3, 0.4, 0.85).normalize();
    let forward = (centre - eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let n = 1024;
    let camera: Vec<Ray> = (0..n * n)
        .map(|i| {
            let (x, y) = ((i % n) as f32 / n as f32 - 0.5, (i / n) as f32 / n as f32 - 0.5);
            Ray::new(eye, (forward + x * right + y * up).normalize(), 0.0)
        })
        .collect();
    let mut rng = Rng::new(1);
    let hits: Vec<_> = camera
        .iter()
        .filter_map(|ray| Some(world.interaction(ray, &world.intersect(ray, f32::INFINITY, |_| true)?)))
        .collect();
    // Diffuse bounces: uniform directions over the side that the ray came from.
    let bounces: Vec<Ray> = hits
        .iter()
        .map(|hit| {
            let d = rng.direction();
            hit.spawn_ray(if d.dot(hit.n) * hit.wo.dot(hit.n) < 0.0 { -d } else { d })
        })
        .collect();
    let incoherent: Vec<Ray> = (0..n * n)
        .map(|_| Ray::new(centre + radius * rng.direction(), (rng.direction() * radius).normalize(), 0.0))
        .collect();
    for (name, rays) in [("camera", &camera), ("bounce", &bounces), ("incoherent", &incoherent)] {
        time(name, "closest", rays, |ray| world.intersect(ray, f32::INFINITY, |_| true).is_some());
        time(name, "any hit", rays, |ray| world.occluded(ray, f32::INFINITY, |_| true));
    }
}

/// The best of several rounds.
fn time(name: &str, kind: &str, rays: &[Ray], hit: impl Fn(&Ray) -> bool) {
    let mut best = f64::INFINITY;
    let mut count = 0;
    for _ in 0..7 {
        let start = seconds();
        count = rays.iter().filter(|ray| hit(black_box(ray))).count();
        best = best.min(seconds() - start);
    }
    let rate = rays.len() as f64 / best / 1e6;
    println!("{name:>10} {kind:>8}: {rate:7.2} M rays/s, {count} of {} hit", rays.len());
}

/// Seconds that this thread ran, where the system tells (Linux); otherwise the time of day.
fn seconds() -> f64 {
    let on_cpu = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = on_cpu.and_then(|s| s.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(
        || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0.0, |d| d.as_secs_f64()),
        |ns| ns * 1e-9,
    )
}

/// Vertices and faces; faces of more corners become fans.
fn parse(text: &str) -> MeshParts {
    let mut parts = MeshParts::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
                parts.positions.push(Vec3::new(p[0], p[1], p[2]));
            }
            Some("f") => {
                let face: Vec<u32> =
                    words.filter_map(|w| w.split('/').next()?.parse::<u32>().ok()).map(|i| i - 1).collect();
                for i in 2..face.len() {
                    parts.indices.extend([face[0], face[i - 1], face[i]]);
                }
            }
            _ => {}
        }
    }
    parts
}
