//! The `tenfold` program.
//!
//! `args` turns the command line into a request, `load` the scene into what renders, `work` does it; `progress` and `report` tell
//! of it, `diagnostics` of the scene's faults, `output` writes the picture. `lab` is the experiments. Every way out passes through `main`, which turns
//! it into an exit code: 0 done, 1 the render failed, 2 the scene or the command line is wrong.

mod args;
mod bug;
mod diagnostics;
mod embedded;
mod failure;
mod interrupt;
mod lab;
mod layers;
mod load;
mod noise;
mod output;
mod pbrt_options;
mod progress;
mod report;
mod sampling;
mod strategy;
mod units;
mod work;

use args::Request;
use failure::Failure;
use progress::json;
use std::{ffi::OsString, process::ExitCode};

fn main() -> ExitCode {
    bug::catch_reports();
    let argv: Vec<OsString> = std::env::args_os().skip(1).collect();
    let json = args::wants_json(&argv);
    let outcome = bug::contain(|| run(argv, json));
    let Err(failure) = outcome else { return ExitCode::SUCCESS };
    failure.print();
    if json {
        json::failed(&failure);
    }
    ExitCode::from(failure.code())
}

fn run(argv: Vec<OsString>, json: bool) -> Result<(), Failure> {
    match args::parse(argv)? {
        Request::Shown => Ok(()),
        Request::Lab(args) => {
            interrupt::listen(false);
            lab::run(&args)
        }
        Request::Render(args, notes) => {
            start_log(args.log.as_deref())?;
            interrupt::listen(json);
            if !args.quiet {
                notes.iter().for_each(|note| diagnostics::say(&format!("note: {note}")));
            }
            work::render(&args)
        }
    }
}

/// Sends the libraries' messages at or above a level, or those that a filter lets through, to standard error.
fn start_log(filter: Option<&str>) -> Result<(), Failure> {
    let Some(filter) = filter else { return Ok(()) };
    let filter = tracing_subscriber::EnvFilter::try_new(filter)
        .map_err(|error| Failure::Wrong(format!("--log {filter}: {error}")))?;
    // A second subscriber cannot be: this runs once.
    let _ = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).try_init();
    Ok(())
}
