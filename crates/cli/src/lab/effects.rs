//! `tenfold lab effects`.

use super::options::{Common, SceneOptions, Session};
use crate::{embedded, failure::Failure};
use std::path::PathBuf;
use tenfold_lab::effects::{page, table, work_of};

/// Whose effects, and at how many samples.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Args {
    /// The scene; without it, one that comes with the program and has them all
    scene: Option<PathBuf>,

    /// Samples per pixel, a column each
    #[arg(long, value_name = "N,...", value_parser = clap::value_parser!(u32).range(1..), value_delimiter = ',',
          default_value = "1,4,16,64,256")]
    spp: Vec<u32>,

    #[command(flatten)]
    options: SceneOptions,

    #[command(flatten)]
    common: Common,
}

/// Does the experiment.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let session = Session::new(&args.common, "effects")?;
    let mut options = args.options.clone();
    options.max_pixels.get_or_insert(15_000);
    let (loaded, mut settings) = session.load(args.scene.as_deref(), &embedded::EFFECTS, &options)?;
    settings.seed = args.common.seed;
    let mut counts = args.spp.clone();
    counts.sort_unstable();
    counts.dedup();
    let work = work_of(&settings, &counts);
    let rows = session.work(work, |work| table(&loaded.scene, &settings, &counts, work))?;
    session.finish(&page(&loaded.short_name(), settings.bounds.size().x, &rows))
}
