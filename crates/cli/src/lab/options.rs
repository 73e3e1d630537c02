//! What all experiments share: the page, the seed, the threads, the scene.

use crate::{
    args::list,
    diagnostics::say,
    embedded::Embedded,
    failure::Failure,
    interrupt,
    load::{self, Loaded},
    output,
    progress::{Reporter, Style},
    units::duration,
    work::use_threads,
};
use clap::Args;
use std::{
    num::NonZeroUsize,
    path::{Path, PathBuf},
    time::Instant,
};
use tenfold_lab::{Interrupted, Page, Work};
use tenfold_render::{compile::crop_window, schedule::RenderSettings};

/// Pictures of experiments have at most so many pixels unless told otherwise.
const MOST_PIXELS: u32 = 10_000;

/// Options of all experiments.
#[derive(Args, Clone, Debug)]
pub(super) struct Common {
    /// Where the page goes, an .html file; the numbers go beside it [default: named after the experiment]
    #[arg(short = 'o', long = "outfile", value_name = "FILE")]
    outfile: Option<PathBuf>,

    /// Distinguishes runs of the same experiment
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,

    /// Number of threads; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true,
          value_parser = clap::value_parser!(u16).range(..=4096))]
    nthreads: u16,

    /// Say nothing but errors
    #[arg(long, short = 'q')]
    quiet: bool,
}

/// Options of experiments with scenes.
#[derive(Args, Clone, Debug)]
pub(super) struct SceneOptions {
    /// Make pictures coarser that have more pixels [default: 10000, of effects 15000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) max_pixels: Option<u32>,

    /// Look at a part of the picture only, in fractions of width and height
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = list::<f32, 4>, allow_hyphen_values = true)]
    cropwindow: Option<[f32; 4]>,
}

/// An experiment that is being done.
pub(super) struct Session<'a> {
    common: &'a Common,
    page: PathBuf,
    reporter: Reporter,
    start: Instant,
}

impl<'a> Session<'a> {
    /// Prepares the experiment `name`: whether its page can be written is found out first.
    pub(super) fn new(common: &'a Common, name: &str) -> Result<Self, Failure> {
        let page = common.outfile.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.html")));
        let suffix = page.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if !matches!(suffix.as_str(), "html" | "htm") {
            return Err(Failure::Wrong(format!("cannot write {}: pages are .html files", page.display())));
        }
        output::check_writable(&page)?;
        use_threads(common.nthreads);
        Ok(Self { common, page, reporter: Reporter::new(Style::Auto, common.quiet), start: Instant::now() })
    }

    /// The scene at `path`, `embedded` where there is none, and how it is rendered.
    pub(super) fn load(
        &self,
        path: Option<&Path>,
        embedded: &'static Embedded,
        options: &SceneOptions,
    ) -> Result<(Loaded, RenderSettings), Failure> {
        let loaded = load::load(
            path,
            embedded,
            self.common.quiet,
            &self.reporter,
            Some(options.max_pixels.unwrap_or(MOST_PIXELS)),
        )?;
        let mut settings = RenderSettings::of(&loaded.scene);
        settings.threads = NonZeroUsize::new(self.common.nthreads.into());
        if let Some(window) = options.cropwindow {
            settings.bounds = crop_window(loaded.scene.film.resolution, window);
        }
        if settings.bounds.is_empty() {
            return Err(Failure::Wrong("there is no pixel within these bounds".to_owned()));
        }
        Ok((loaded, settings))
    }

    /// Does the work of `samples` samples, telling how far it is, until Ctrl-C ends it.
    pub(super) fn work<T>(
        &self,
        samples: u64,
        experiment: impl FnOnce(&mut Work<'_>) -> Result<T, Interrupted>,
    ) -> Result<T, Failure> {
        interrupt::rendering(true);
        let observe = |progress| {
            self.reporter.update(progress);
            !interrupt::requested()
        };
        let result = experiment(&mut Work::new(samples, &observe));
        interrupt::rendering(false);
        self.reporter.finish();
        result.map_err(|_| Failure::Failed("interrupted, nothing was written".to_owned()))
    }

    /// Writes the page, and tells of it.
    pub(super) fn finish(&self, page: &Page) -> Result<(), Failure> {
        let written = page.write(&self.page);
        let files = written.map_err(|(path, error)| {
            Failure::Failed(format!("{} could not be written: {error}", path.display()))
        })?;
        if !self.common.quiet {
            let files: Vec<_> = files.iter().map(|f| f.display().to_string()).collect();
            say(&format!(
                "wrote {} after {}",
                files.join(", "),
                duration(self.start.elapsed().as_secs_f64())
            ));
        }
        Ok(())
    }
}
