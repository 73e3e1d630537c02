//! `tenfold lab noise`.

use super::options::{Common, SceneOptions, Session};
use crate::{
    embedded,
    failure::Failure,
    sampling::{self, Freeze},
    strategy::{self, Strategy},
};
use std::path::PathBuf;
use tenfold_lab::attribution::{attribute, page, work_of};

/// Whose noise, and how well it is to be known.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Args {
    /// The scene; without it, the one that comes with the program
    scene: Option<PathBuf>,

    /// Samples of each pixel, a multiple of 16, rounded up; each is evaluated up to twelve times
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    spp: u32,

    /// How variables are sampled, as of renders [default: the best]
    #[arg(long, value_name = "VARIABLE=NAME,...", value_parser = strategy::parse, value_delimiter = ',')]
    strategy: Vec<Strategy>,

    /// Hold variables at a value, as in renders
    #[arg(long, value_name = "VARIABLE[=VALUE],...", value_parser = sampling::freeze, value_delimiter = ',')]
    freeze: Vec<Freeze>,

    #[command(flatten)]
    options: SceneOptions,

    #[command(flatten)]
    common: Common,
}

/// Does the experiment.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let session = Session::new(&args.common, "noise")?;
    let (loaded, mut settings) = session.load(args.scene.as_deref(), &embedded::DEFAULT, &args.options)?;
    settings.spp = args.spp;
    settings.seed = args.common.seed;
    args.strategy.iter().try_for_each(|strategy| strategy.apply(&mut settings, &loaded.scene))?;
    args.freeze.iter().flat_map(Freeze::frozen).for_each(|frozen| settings.freeze(frozen));
    let found = session.work(work_of(&settings), |work| attribute(&loaded.scene, &settings, work))?;
    session.finish(&page(&loaded.short_name(), &found))
}
