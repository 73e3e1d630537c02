//! The hierarchy against Embree 4: the same triangles and the same rays, one ray a call, in one process.
//!
//!     cargo bench -p tenfold-geometry --bench embree -- [trace|build|motion] [options] [blob-N | hall-N | FILE.obj ...]
//!
//! Embree's shared library is looked for where `EMBREE_LIBRARY` says, or in the active Python environment (`pip install embreex`). Without one there is
//! nothing to compare with, and the program says so and ends well.
//!
//! `trace` compares rays per second of one thread: rounds of the two alternate, and what is printed is the median over the rounds
//! of the ratio of rates (above 1: faster than Embree), with its quartiles. `build` compares the time and the peak memory of building on `--threads` threads,
//! each in a process of its own. `motion` is `trace` with half of the objects moving.

mod build;
mod clock;
mod library;
mod meshes;
mod rays;
mod trace;

use library::{Embree, Quality};
use std::{env, process::ExitCode};

/// What the command line says.
pub(crate) struct Options {
    mode: String,
    subjects: Vec<String>,
    /// Rounds of measurement.
    rounds: usize,
    /// Pixels along one edge.
    pixels: usize,
    /// Threads of a build.
    threads: usize,
    qualities: Vec<Quality>,
}

impl Options {
    fn parse(args: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self {
            mode: "trace".into(),
            subjects: Vec::new(),
            rounds: 9,
            pixels: 512,
            threads: 2,
            qualities: vec![Quality::Default, Quality::High],
        };
        let mut args = args.filter(|a| a != "--bench");
        while let Some(arg) = args.next() {
            let mut number =
                || args.next().and_then(|n| n.parse().ok()).ok_or(format!("{arg} wants a number"));
            match arg.as_str() {
                "--rounds" => options.rounds = number()?,
                "--pixels" => options.pixels = number()?,
                "--threads" => options.threads = number()?,
                "--robust" => options.qualities.push(Quality::Robust),
                "trace" | "build" | "motion" | "child" => options.mode = arg,
                _ if arg.starts_with('-') => return Err(format!("unknown option {arg}")),
                _ => options.subjects.push(arg),
            }
        }
        if options.subjects.is_empty() {
            let sizes = ["1e3", "1e5", "1e6"];
            options.subjects =
                ["blob", "hall"].iter().flat_map(|kind| sizes.map(|n| format!("{kind}-{n}"))).collect();
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    let options = match Options::parse(env::args().skip(1)) {
        Ok(options) => options,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    let embree = match Embree::find().and_then(|path| Embree::load(&path, options.threads)) {
        Ok(embree) => embree,
        Err(why) => {
            println!("skipped: there is no Embree to compare with ({why})");
            return ExitCode::SUCCESS;
        }
    };
    let run = match options.mode.as_str() {
        "build" => build::compare(&options),
        "child" => build::child(&embree, &options),
        mode => {
            println!("Embree {}, one thread, {} rounds", embree.version(), options.rounds);
            trace::compare(&embree, &options, mode == "motion")
        }
    };
    match run {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
