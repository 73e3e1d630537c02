//! `tenfold lab …`: experiments, each to a page.

mod convergence;
mod effects;
mod noise;
mod options;
mod portrait;
mod variants;

use crate::{
    args::{STYLES, understand},
    failure::Failure,
};
use clap::{CommandFactory, Parser, Subcommand};
use std::ffi::OsString;

const ABOUT: &str = "\
Experiments on the renderer, each written to one HTML page with its plots and pictures.

The numbers are in CSV files beside the page, and within it.";

const EXAMPLES: &str = "\
Examples:
  tenfold lab convergence room.pbrt
  tenfold lab convergence integral:smooth-2d --samplers independent,jittered,zsobol -o smooth.html
  tenfold lab convergence room.pbrt --strategies combine=mis,combine=light-only,combine=bsdf-only
  tenfold lab portrait n-rooks --samples 100
  tenfold lab noise room.pbrt
  tenfold lab effects

Exit codes are those of tenfold: 0 done; 1 the experiment failed; 2 the scene or the command line is wrong.";

/// The command line after `tenfold lab`.
#[derive(Parser, Clone, Debug)]
#[command(
    name = "tenfold lab",
    about = ABOUT,
    after_help = EXAMPLES,
    styles = STYLES,
    max_term_width = 100,
    args_override_self = true
)]
pub(crate) struct LabArgs {
    #[command(subcommand)]
    experiment: Experiment,
}

/// Which experiment.
#[derive(Subcommand, Clone, Debug)]
enum Experiment {
    /// Error against samples and against seconds, with fitted slopes
    Convergence(convergence::Args),
    /// What the samples of a sampler look like
    Portrait(portrait::Args),
    /// A scene without its effects, with each alone and with all, at few samples and at many
    Effects(effects::Args),
    /// Which variable of the integral makes a scene's noise
    Noise(noise::Args),
}

/// Understands the command line after `tenfold lab`. `None` where help was asked for, and has been shown.
pub(crate) fn parse(argv: &[OsString]) -> Result<Option<LabArgs>, Failure> {
    let program = std::iter::once(OsString::from("tenfold lab"));
    understand(LabArgs::command(), program.chain(argv.iter().cloned()))
}

/// Does the experiment.
pub(crate) fn run(args: &LabArgs) -> Result<(), Failure> {
    match &args.experiment {
        Experiment::Convergence(args) => convergence::run(args),
        Experiment::Portrait(args) => portrait::run(args),
        Experiment::Effects(args) => effects::run(args),
        Experiment::Noise(args) => noise::run(args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        LabArgs::command().debug_assert();
    }

    #[test]
    fn wrong_command_lines_are_refused() {
        for line in [
            "",
            "convergense",
            "convergence --samplers zsobl",
            "convergence --samplers zsobol+lens=zsobl",
            "convergence --strategies light=dark",
            "convergence --strategies light=uniform-area+combine",
            "portrait",
            "portrait zsobl",
            "portrait zsobol --samples 0",
            "portrait zsobol --seeds 1",
            "convergence --spp 0",
            "convergence --spp 1,2,x",
            "convergence --seeds 1",
            "convergence --reference 8",
            "convergence --max-pixels 0",
            "noise --spp 0",
            "effects --spp 4,0",
            "convergence --cropwindow 0,1",
        ] {
            let argv: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
            assert_eq!(parse(&argv).unwrap_err().code(), 2, "{line}");
        }
    }
}
