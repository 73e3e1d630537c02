//! Rays per second.

use crate::{
    Options,
    clock::{quantile, thread_seconds},
    library::{Embree, EmbreeMesh, EmbreeScene},
    meshes::Subject,
    rays::{Batch, batches},
};
use std::{hint::black_box, sync::Arc};
use tenfold_geometry::{Geometry, MeshParts, Shape, TriangleMesh, World, WorldDesc};
use tenfold_math::{Motion, Transform, ops};
use tenfold_testkit::Rng;

/// A mesh as a geometry of a world.
pub(crate) fn geometry(parts: MeshParts, motion: Option<Motion>) -> Geometry {
    let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).expect("a sound mesh");
    Geometry { shape: Shape::Triangles(Arc::new(mesh)), motion, group: None, user: 0, masked: false }
}

/// The same triangles for both.
struct Scenes {
    world: World,
    embree: Vec<EmbreeMesh>,
}

impl Scenes {
    fn still(parts: &MeshParts) -> Self {
        let embree = vec![EmbreeMesh::new(&[&parts.positions], &parts.indices)];
        Self { world: world(vec![geometry(parts.clone(), None)]), embree }
    }

    /// Every other object moves in a straight line during the time from 0 to 1. Here each is a shape with an animated transform; in Embree they are one mesh
    /// with vertices at two times.
    fn moving(subject: &Subject) -> Self {
        let mut rng = Rng::new(5);
        let (mut still, mut start, mut end) = <(MeshParts, MeshParts, MeshParts)>::default();
        let mut geometries = Vec::new();
        for (i, object) in subject.objects().into_iter().enumerate() {
            if i % 2 == 0 {
                append(&mut still, &object);
                continue;
            }
            let size = tenfold_math::Bounds3::around(object.positions.iter().copied()).diagonal().length();
            let way = 0.25 * size * rng.direction();
            let motion = Motion::new(Transform::IDENTITY, 0.0, Transform::translate(way), 1.0);
            append(&mut start, &object);
            let moved = object.positions.iter().map(|p| *p + way).collect();
            append(&mut end, &MeshParts { positions: moved, ..object.clone() });
            geometries.push(geometry(object, Some(motion)));
        }
        let embree = vec![
            EmbreeMesh::new(&[&still.positions], &still.indices),
            EmbreeMesh::new(&[&start.positions, &end.positions], &start.indices),
        ];
        println!("{} triangles still, {} moving", still.indices.len() / 3, start.indices.len() / 3);
        geometries.push(geometry(still, None));
        Self { world: world(geometries), embree }
    }
}

fn append(to: &mut MeshParts, part: &MeshParts) {
    let first = to.positions.len() as u32;
    to.positions.extend(&part.positions);
    to.indices.extend(part.indices.iter().map(|i| first + i));
}

fn world(geometries: Vec<Geometry>) -> World {
    World::build(WorldDesc { geometries, instances: Vec::new(), shutter: [0.0, 1.0] })
        .expect("indices suffice")
}

pub(crate) fn compare(embree: &Embree, options: &Options, moving: bool) -> Result<(), String> {
    let mut logs: Vec<Vec<f64>> = vec![Vec::new(); options.qualities.len()];
    println!(
        "{:>16} {:>9} {:>7} {:>8} {:>8} {:>8} {:>16}  disagreements",
        "mesh", "triangles", "rays", "against", "M/s", "M/s", "ratio"
    );
    for name in &options.subjects {
        let subject = Subject::named(name)?;
        let triangles = subject.parts.indices.len() / 3;
        let scenes = if moving { Scenes::moving(&subject) } else { Scenes::still(&subject.parts) };
        let bytes = scenes.world.stats().bytes as f64 / triangles as f64;
        println!("{:>16} {bytes:.1} bytes a triangle", subject.name);
        let peers: Vec<EmbreeScene<'_>> = options
            .qualities
            .iter()
            .map(|quality| EmbreeScene::build(embree, &scenes.embree, *quality))
            .collect();
        for batch in batches(&scenes.world, &subject.view, options.pixels) {
            let rates = measure(&scenes.world, &peers, &batch, options.rounds);
            for (i, quality) in options.qualities.iter().enumerate() {
                let ratios: Vec<f64> = rates.iter().map(|r| r[0] / r[i + 1]).collect();
                let median =
                    |column: usize| quantile(&rates.iter().map(|r| r[column]).collect::<Vec<_>>(), 0.5);
                let middle = quantile(&ratios, 0.5);
                logs[i].push(ops::ln(middle));
                println!(
                    "{:>16} {triangles:>9} {:>7} {:>8} {:8.2} {:8.2} {middle:6.3} [{:.2}, {:.2}]  {}",
                    subject.name,
                    batch.name,
                    quality.name(),
                    median(0) * 1e-6,
                    median(i + 1) * 1e-6,
                    quantile(&ratios, 0.25),
                    quantile(&ratios, 0.75),
                    disagreements(&scenes.world, &peers[i], &batch),
                );
            }
        }
    }
    for (quality, logs) in options.qualities.iter().zip(&logs) {
        let least = ops::exp(logs.iter().copied().fold(f64::INFINITY, f64::min));
        let mean = ops::exp(logs.iter().sum::<f64>() / logs.len() as f64);
        println!("against {}: geometric mean {mean:.3}, least {least:.3}", quality.name());
    }
    Ok(())
}

/// Rays per second, by round: ours, then those of the peers.
fn measure(world: &World, peers: &[EmbreeScene<'_>], batch: &Batch, rounds: usize) -> Vec<Vec<f64>> {
    let engine = |i: usize| {
        let before = thread_seconds();
        match i {
            0 => ours(world, batch),
            _ => theirs(&peers[i - 1], batch),
        }
        batch.rays.len() as f64 / (thread_seconds() - before)
    };
    let count = peers.len() + 1;
    // A round to warm up; then who begins takes turns.
    (0..count).for_each(|i| {
        black_box(engine(i));
    });
    (0..rounds)
        .map(|round| {
            let mut rates = vec![0.0; count];
            (0..count).map(|i| (i + round) % count).for_each(|i| rates[i] = engine(i));
            rates
        })
        .collect()
}

fn ours(world: &World, batch: &Batch) {
    for ray in &batch.rays {
        match batch.any {
            true => drop(black_box(world.occluded(black_box(ray), batch.t_max, |_| true))),
            false => drop(black_box(world.intersect(black_box(ray), batch.t_max, |_| true))),
        }
    }
}

fn theirs(peer: &EmbreeScene<'_>, batch: &Batch) {
    for ray in &batch.rays {
        match batch.any {
            true => drop(black_box(peer.occluded(black_box(ray), batch.t_max))),
            false => drop(black_box(peer.intersect(black_box(ray), batch.t_max))),
        }
    }
}

/// How many rays hit one and miss the other, and how many hits are at another distance.
fn disagreements(world: &World, peer: &EmbreeScene<'_>, batch: &Batch) -> String {
    let (mut ours_alone, mut theirs_alone, mut elsewhere, mut hits) = (0, 0, 0, 0);
    for ray in &batch.rays {
        let (mine, other) = match batch.any {
            true => (
                world.occluded(ray, batch.t_max, |_| true).then_some(0.0),
                peer.occluded(ray, batch.t_max).then_some(0.0),
            ),
            false => (
                world.intersect(ray, batch.t_max, |_| true).map(|hit| hit.t),
                peer.intersect(ray, batch.t_max).map(|hit| hit.0),
            ),
        };
        hits += u32::from(mine.is_some());
        match (mine, other) {
            (Some(a), Some(b)) => elsewhere += u32::from((a - b).abs() > 1e-4 * a.max(1e-2)),
            (Some(_), None) => ours_alone += 1,
            (None, Some(_)) => theirs_alone += 1,
            (None, None) => {}
        }
    }
    format!(
        "{:.0} % hit; {ours_alone} ours alone, {theirs_alone} Embree's alone, {elsewhere} elsewhere",
        100.0 * f64::from(hits) / batch.rays.len() as f64
    )
}
