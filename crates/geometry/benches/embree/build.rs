//! Time and memory of building.

use crate::{
    Options,
    clock::{process_seconds, quantile, reset_peak, resident},
    library::{Embree, EmbreeMesh, EmbreeScene, Quality},
    meshes::Subject,
    trace::geometry,
};
use std::{env, process::Command, time::Instant};
use tenfold_geometry::{World, WorldDesc};

const ENGINES: [&str; 3] = ["ours", "default", "high"];

/// Each build runs in a process of its own, since memory once used is not always given back.
pub(crate) fn compare(options: &Options) -> Result<(), String> {
    println!(
        "{:>16} {:>8} {:>9} {:>7} {:>9} {:>7} {:>10} {:>10}",
        "mesh", "engine", "seconds", "ratio", "cpu s", "ratio", "peak MiB", "kept MiB"
    );
    for subject in &options.subjects {
        let mut rows = vec![Vec::new(); ENGINES.len()];
        for _ in 0..options.rounds {
            for (engine, rows) in ENGINES.iter().zip(&mut rows) {
                rows.push(spawn(subject, engine, options.threads)?);
            }
        }
        let median = |rows: &[[f64; 4]], column: usize| {
            quantile(&rows.iter().map(|row| row[column]).collect::<Vec<_>>(), 0.5)
        };
        for (i, engine) in ENGINES.iter().enumerate() {
            let ratio = |column: usize| {
                let ratios = rows[0].iter().zip(&rows[i]).map(|(ours, theirs)| ours[column] / theirs[column]);
                quantile(&ratios.collect::<Vec<_>>(), 0.5)
            };
            println!(
                "{subject:>16} {engine:>8} {:9.4} {:7.3} {:9.4} {:7.3} {:10.1} {:10.1}",
                median(&rows[i], 0),
                ratio(0),
                median(&rows[i], 1),
                ratio(1),
                median(&rows[i], 2),
                median(&rows[i], 3),
            );
        }
    }
    Ok(())
}

/// Seconds, those of all threads together, and mebibytes at the peak and afterwards.
fn spawn(subject: &str, engine: &str, threads: usize) -> Result<[f64; 4], String> {
    let program = env::current_exe().map_err(|e| e.to_string())?;
    let threads = threads.to_string();
    let output = Command::new(program)
        .args(["child", "--threads", &threads, engine, subject])
        .env("RAYON_NUM_THREADS", &threads)
        .output()
        .map_err(|e| e.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|w| w.parse().ok()).collect();
    numbers
        .try_into()
        .map_err(|_| format!("{engine} on {subject}: {text} {}", String::from_utf8_lossy(&output.stderr)))
}

/// One build: the subjects are the engine and the mesh.
pub(crate) fn child(embree: &Embree, options: &Options) -> Result<(), String> {
    let [engine, subject] = &options.subjects[..] else {
        return Err("an engine and a mesh are wanted".into());
    };
    let parts = Subject::named(subject)?.parts;
    let report = |run: &mut dyn FnMut()| {
        reset_peak();
        let before = resident()[0];
        let (start, before_all) = (Instant::now(), process_seconds());
        run();
        let (seconds, all) = (start.elapsed().as_secs_f64(), process_seconds() - before_all);
        let mebibytes = resident().map(|bytes| bytes.saturating_sub(before) as f64 / f64::from(1 << 20));
        println!("{seconds} {all} {} {}", mebibytes[1], mebibytes[0]);
    };
    if engine == "ours" {
        let mut desc = Some(WorldDesc { geometries: vec![geometry(parts, None)], ..WorldDesc::default() });
        let mut world = None;
        // Threads start before the clock does, as Embree's do with the device.
        rayon::broadcast(|_| ());
        report(&mut || world = desc.take().map(World::build));
    } else {
        let mesh = [EmbreeMesh::new(&[&parts.positions], &parts.indices)];
        drop(parts);
        let quality = if engine == "high" { Quality::High } else { Quality::Default };
        let mut scene = None;
        report(&mut || scene = Some(EmbreeScene::build(embree, &mesh, quality)));
    }
    Ok(())
}
