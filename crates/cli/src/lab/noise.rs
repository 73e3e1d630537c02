//! `tenfold lab noise`.

use super::options::{Common, SceneOptions, Session};
use crate::failure::Failure;
use std::path::{Path, PathBuf};
use tenfold_lab::attribution::{attribute, page, work_of};

/// Which variable of the integral makes a scene's noise.
///
/// Each variable's share of the variance of single samples, by itself (first-order) and in all that it takes part in (total),
/// estimated by pick and freeze (Sobol' indices), and where in the picture which of them is to blame.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Args {
    /// The scene; without it, the one that comes with the program
    scene: Option<PathBuf>,

    /// Samples of each pixel, a multiple of 16, rounded up; each is evaluated up to twelve times
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    spp: u32,

    #[command(flatten)]
    options: SceneOptions,

    #[command(flatten)]
    common: Common,
}

/// Does the experiment.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let session = Session::new(&args.common, "noise")?;
    let (loaded, mut settings) = session.load(args.scene.as_deref(), &args.options)?;
    settings.spp = args.spp;
    settings.seed = args.common.seed;
    let found = session.work(work_of(&settings), |work| attribute(&loaded.scene, &settings, work))?;
    let name = Path::new(&loaded.name).file_name().unwrap_or_default().to_string_lossy();
    session.finish(&page(if name.is_empty() { &loaded.name } else { &name }, &found))
}
