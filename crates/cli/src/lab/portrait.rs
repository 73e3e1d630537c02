//! `tenfold lab portrait`.

use super::{
    options::{Common, Session},
    variants::{self, NamedPlan},
};
use crate::failure::Failure;
use tenfold_lab::portrait::{self, Options};

/// Whose samples, and how many.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Args {
    /// The sampler
    #[arg(value_name = "SAMPLER", value_parser = variants::plan)]
    sampler: NamedPlan,

    /// Samples of the pixel that is looked at
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    samples: u32,

    /// Point sets whose discrepancies are averaged
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(2..=1000))]
    seeds: u32,

    #[command(flatten)]
    common: Common,
}

/// Does the experiment.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let session = Session::new(&args.common, "portrait")?;
    let options = Options { samples: args.samples, seeds: args.seeds, seed: args.common.seed };
    let NamedPlan { name, plan } = &args.sampler;
    let result =
        session.work(portrait::work(&options), |work| portrait::portrait(name, plan, &options, work))?;
    session.finish(&portrait::page(&result))
}
