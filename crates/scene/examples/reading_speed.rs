//! How fast files are read: `cargo run --release -p tenfold-scene --example reading_speed -- FILE.ply FILE.pbrt …`

use std::{path::Path, time::Instant};
use tenfold_scene::{SourceMap, read_pbrt, read_ply};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let megabytes = std::fs::metadata(&path)?.len() as f64 * 1e-6;
        for _ in 0..5 {
            let start = Instant::now();
            let (what, parsing) = if path.ends_with(".ply") {
                let bytes = std::fs::read(&path)?;
                let parsing = Instant::now();
                let mesh = read_ply(&bytes)?;
                (format!("{} triangles", mesh.triangles.len()), parsing.elapsed())
            } else {
                let (description, _) = read_pbrt(Path::new(&path), &mut SourceMap::new());
                (format!("{} shapes", description.shapes.len()), start.elapsed())
            };
            let (whole, parsing) = (start.elapsed().as_secs_f64(), parsing.as_secs_f64());
            println!(
                "{path}: {what} in {whole:.3} s, {:.0} MB/s; without reading the file {:.0} MB/s",
                megabytes / whole,
                megabytes / parsing
            );
        }
    }
    Ok(())
}
