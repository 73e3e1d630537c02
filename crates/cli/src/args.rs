//! The command line.

use crate::{
    failure::Failure,
    lab::{self, LabArgs},
    layers::Layer,
    noise::NoiseArgs,
    pbrt_options,
    progress::Style,
    sampling::{self, Freeze, SamplerChoice},
    strategy::{self, Strategy},
};
use clap::{CommandFactory, FromArgMatches, Parser, ValueEnum, builder::styling};
use std::{ffi::OsString, path::PathBuf};
use tenfold_render::{integrator::DispersionRule, schedule};

pub(crate) const STYLES: styling::Styles = styling::Styles::styled()
    .header(styling::AnsiColor::Green.on_default().bold())
    .usage(styling::AnsiColor::Green.on_default().bold())
    .literal(styling::AnsiColor::Cyan.on_default().bold())
    .placeholder(styling::AnsiColor::Cyan.on_default());

const ABOUT: &str = "\
Renders pbrt-v4 scenes by spectral path tracing.

SCENE is a file in pbrt-v4's format; `-` reads standard input. Without one, a still life that comes
with the program is rendered to tenfold.png. Options have pbrt's names where pbrt has them.";

const EXAMPLES: &str = "\
Examples:
  tenfold                           the scene that comes with the program, to tenfold.png
  tenfold room.pbrt                 a scene, to the file that it names
  tenfold room.pbrt -o room.exr -o room.png --spp 256
  tenfold room.pbrt --cropwindow 0.5,1,0,0.5 -o corner.png
  tenfold room.pbrt --noise 0.01       until the noise is 1 %, with the samples where the error is
  tenfold room.pbrt --pixel 320,240    one pixel, its value on standard output
  tenfold room.pbrt --progress json    for programs: one JSON object a line
  tenfold lab --help                experiments on the renderer

Files are written in full or not at all. Ctrl-C ends a render early and keeps what there is.

Exit codes:
  0  done
  1  the render failed: interrupted, or its picture cannot be written
  2  the scene or the command line is wrong";

/// The command line.
#[derive(Parser, Clone, Debug)]
#[command(
    name = "tenfold",
    version,
    about = ABOUT,
    disable_help_flag = true,
    disable_version_flag = true,
    override_usage = "tenfold [render] [SCENE] [OPTIONS]",
    after_help = EXAMPLES,
    styles = STYLES,
    max_term_width = 100,
    args_override_self = true
)]
pub(crate) struct Args {
    /// The scene to render
    pub(crate) scene: Option<PathBuf>,

    /// Where the picture goes (.exr, .png, .pfm, .hdr); several may be given [default: what the
    /// scene says, or tenfold.exr]
    #[arg(short = 'o', long = "outfile", value_name = "FILE", help_heading = "Picture")]
    pub(crate) outfile: Vec<PathBuf>,

    /// Write PNG files with 16 bits a channel; else 8, dithered
    #[arg(long, help_heading = "Picture")]
    pub(crate) png16: bool,

    /// Have EXR files hold these of every pixel too: the number of samples, the standard error
    #[arg(long, value_name = "samples,error", value_enum, value_delimiter = ',', help_heading = "Picture")]
    pub(crate) layers: Vec<Layer>,

    /// Render a part only, in fractions of width and height
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = list::<f32, 4>, allow_hyphen_values = true,
          conflicts_with_all = ["pixelbounds", "pixel"], help_heading = "Picture")]
    pub(crate) cropwindow: Option<[f32; 4]>,

    /// Render a part only, in pixels, the upper ends not included
    #[arg(long, value_name = "X0,X1,Y0,Y1", value_parser = list::<i32, 4>, allow_hyphen_values = true,
          conflicts_with = "pixel", help_heading = "Picture")]
    pub(crate) pixelbounds: Option<[i32; 4]>,

    /// Render one pixel and print its value; a picture is written only with -o
    #[arg(long, value_name = "X,Y", value_parser = list::<i32, 2>, allow_hyphen_values = true, help_heading = "Picture")]
    pub(crate) pixel: Option<[i32; 2]>,

    /// Samples a pixel [default: what the scene says]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Sampling")]
    pub(crate) spp: Option<u32>,

    /// One sample a pixel, to have a look
    #[arg(long, conflicts_with = "spp", help_heading = "Sampling")]
    pub(crate) quick: bool,

    /// Distinguishes renders of the same scene [default: what the scene says]
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub(crate) seed: Option<u64>,

    /// independent, jittered, n-rooks, multi-jittered, halton, sobol or zsobol (blue noise), for all variables or for some
    /// (lens=n-rooks,time=jittered): pixel, lens, time, wavelength, light, scatter, ... [default: what the scene says]
    #[arg(long, value_name = "[VARIABLE=]NAME,...", value_parser = sampling::sampler, value_delimiter = ',',
          help_heading = "Sampling")]
    pub(crate) sampler: Vec<SamplerChoice>,

    /// How lights, directions and the time are sampled; the picture is the same for all but for its noise. Several with commas between:
    /// light=uniform-area, solid-angle, by-texture or complementary; scatter=uniform, cosine or bsdf; combine=mis, light-only or
    /// bsdf-only; time=shutter or path:NAME, uniform along the path of an object or the camera
    /// [default: the last of light and scatter, the first of combine and time]
    #[arg(long, value_name = "VARIABLE=NAME", value_parser = strategy::parse, value_delimiter = ',',
          help_heading = "Sampling")]
    pub(crate) strategy: Vec<Strategy>,

    /// Hold variables at a value (time=0.5,lens,light,...), in the middle where none is given: their effects are absent. The
    /// wavelength is in nm; dispersion[=NM] has all light refracted alike
    #[arg(long, value_name = "VARIABLE[=VALUE],...", value_parser = sampling::freeze, value_delimiter = ',',
          help_heading = "Sampling")]
    pub(crate) freeze: Vec<Freeze>,

    /// What the other wavelengths do at dispersive glass: go ways of their own, or end there as in pbrt
    #[arg(long, value_name = "RULE", value_enum, default_value = "split", help_heading = "Sampling")]
    pub(crate) dispersion: Dispersion,

    #[command(flatten)]
    pub(crate) noise: NoiseArgs,

    /// Number of threads; 0 takes all cores
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true,
          value_parser = clap::value_parser!(u16).range(..=4096), help_heading = "Work")]
    pub(crate) nthreads: u16,

    /// Edge length of the tiles that threads take, in pixels; the picture is the same for all
    #[arg(long, value_name = "N", default_value_t = 16,
          value_parser = clap::value_parser!(u32).range(1..=4096), help_heading = "Work")]
    pub(crate) tile_size: u32,

    /// In which order tiles are rendered; the picture is the same for all
    #[arg(long, value_name = "ORDER", value_enum, default_value = "centre", help_heading = "Work")]
    pub(crate) tile_order: TileOrder,

    /// How to tell how far the render is; auto is a bar on terminals and plain lines elsewhere
    #[arg(long, value_name = "STYLE", value_enum, default_value = "auto", help_heading = "Reports")]
    pub(crate) progress: Style,

    /// Say nothing but errors
    #[arg(long, short = 'q', help_heading = "Reports")]
    pub(crate) quiet: bool,

    /// Print a table of times, rays and sizes at the end
    #[arg(long, help_heading = "Reports")]
    pub(crate) stats: bool,

    /// Messages of the program's parts on standard error: error, warn, info, debug, trace, or a filter such as
    /// tenfold_render=debug
    #[arg(long, alias = "log-level", value_name = "LEVEL", value_parser = log_filter, help_heading = "Reports")]
    pub(crate) log: Option<String>,

    /// Print this help
    #[arg(long, short = 'h', action = clap::ArgAction::HelpShort, help_heading = "Reports")]
    help: Option<bool>,

    /// Print the version
    #[arg(long, short = 'V', action = clap::ArgAction::Version, help_heading = "Reports")]
    version: Option<bool>,
}

/// What becomes of the other wavelengths at dispersive glass.
#[derive(Copy, Clone, Debug, ValueEnum)]
pub(crate) enum Dispersion {
    Split,
    Terminate,
}

impl From<Dispersion> for DispersionRule {
    fn from(rule: Dispersion) -> Self {
        match rule {
            Dispersion::Split => Self::Split,
            Dispersion::Terminate => Self::Terminate,
        }
    }
}

/// In which order tiles are rendered.
#[derive(Copy, Clone, Debug, ValueEnum)]
pub(crate) enum TileOrder {
    #[value(alias = "center")]
    Centre,
    Rows,
    Reverse,
}

impl From<TileOrder> for schedule::TileOrder {
    fn from(order: TileOrder) -> Self {
        match order {
            TileOrder::Centre => Self::Centre,
            TileOrder::Rows => Self::Rows,
            TileOrder::Reverse => Self::Reverse,
        }
    }
}

/// What the command line asks for.
pub(crate) enum Request {
    /// Help or the version, which have been shown.
    Shown,
    /// A render; the strings are to be told first.
    Render(Box<Args>, Vec<String>),
    /// An experiment.
    Lab(Box<LabArgs>),
}

/// Understands the command line, given without the program's name.
pub(crate) fn parse(argv: Vec<OsString>) -> Result<Request, Failure> {
    if let Some(("lab", rest)) = argv.split_first().and_then(|(first, rest)| Some((first.to_str()?, rest))) {
        return Ok(lab::parse(rest)?.map_or(Request::Shown, |args| Request::Lab(Box::new(args))));
    }
    let command = Args::command();
    let translated = pbrt_options::translate(argv, &command)?;
    let program = std::iter::once(OsString::from("tenfold"));
    let args = understand::<Args>(command, program.chain(translated.argv))?;
    Ok(args.map_or(Request::Shown, |args| Request::Render(Box::new(args), translated.notes)))
}

/// Has `command` understand a whole command line. `None` where help or the version was asked for, and has been shown.
pub(crate) fn understand<T: FromArgMatches>(
    command: clap::Command,
    argv: impl IntoIterator<Item = OsString>,
) -> Result<Option<T>, Failure> {
    let matched = command.try_get_matches_from(argv);
    match matched.and_then(|matches| T::from_arg_matches(&matches)) {
        Ok(args) => Ok(Some(args)),
        Err(error) if error.use_stderr() => Err(Failure::Usage(error.render().to_string())),
        Err(shown) => {
            // Where nobody reads it there is nobody to tell.
            let _ = shown.print();
            Ok(None)
        }
    }
}

/// Whether the command line, right or wrong, asks for JSON.
pub(crate) fn wants_json(argv: &[OsString]) -> bool {
    let named = |arg: &OsString| arg == "--progress" || arg == "-progress";
    argv.windows(2).any(|pair| named(&pair[0]) && pair[1] == "json")
        || argv.iter().any(|arg| arg == "--progress=json" || arg == "-progress=json")
}

/// Numbers with commas between.
pub(crate) fn list<T: std::str::FromStr + PartialOrd + Copy, const N: usize>(
    text: &str,
) -> Result<[T; N], String> {
    let numbers: Option<Vec<T>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    // What is not equal to itself is not a number.
    let numbers = numbers.filter(|all| all.iter().all(|n| n.partial_cmp(n).is_some()));
    numbers
        .and_then(|all| all.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers with commas between, and no blanks"))
}

/// What to say of a name that means nothing.
pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> String {
    match tenfold_scene::nearest(name, known.iter().copied()) {
        Some(near) => format!("there is no {what} \"{name}\"; did you mean {near}?"),
        None => format!("there is no {what} \"{name}\"; there are {}", known.join(", ")),
    }
}

/// A level or a filter; pbrt's levels are known too.
fn log_filter(level: &str) -> Result<String, String> {
    let filter = match level {
        "verbose" => "debug",
        "fatal" => "error",
        other => other,
    };
    match tracing_subscriber::EnvFilter::try_new(filter) {
        Ok(_) => Ok(filter.to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Args, Failure> {
        match parse(line.split_whitespace().map(OsString::from).collect())? {
            Request::Render(args, _) => Ok(*args),
            Request::Shown | Request::Lab(_) => panic!("nothing to render"),
        }
    }

    #[test]
    fn the_definition_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn scenes_and_options_mix() {
        let args =
            parsed("render --spp 4 a.pbrt -o a.exr --outfile=b.png --cropwindow 0,0.5,0.25,1").unwrap();
        assert_eq!(args.scene, Some(PathBuf::from("a.pbrt")));
        assert_eq!(args.outfile, ["a.exr", "b.png"].map(PathBuf::from));
        assert_eq!((args.spp, args.cropwindow), (Some(4), Some([0.0, 0.5, 0.25, 1.0])));
        assert_eq!(parsed("").unwrap().scene, None);
    }

    #[test]
    fn wrong_command_lines_are_refused() {
        for line in [
            "--spp 0",
            "--spp many",
            "--cropwindow 0,1",
            "--cropwindow 0,1,0,NaN",
            "--pixel 1,2,3",
            "--pixel 1,1 --pixelbounds 0,1,0,1",
            "--sampler zsobl",
            "--sampler lans=zsobol",
            "--sampler lens=",
            "--sampler zsobol,",
            "--freeze lans",
            "--freeze time=1",
            "--freeze time=",
            "--freeze wavelength=0.5",
            "--dispersion other",
            "--strategy light=dark",
            "--strategy scatter=bsdf,combine",
            "--tile-size 0",
            "--nthreads -1",
            "--no-such-option",
            "a.pbrt b.pbrt",
            "--log =",
            "--noise 0",
            "--noise 0.01 --spp 4",
            "--time-limit 3d",
            "--time-limit 3 --quick",
            "--layers depth",
        ] {
            let failure = parsed(line).unwrap_err();
            assert_eq!(failure.code(), 2, "{line}");
        }
        assert!(parsed("--sampler zsobl").unwrap_err().message().contains("zsobol"));
    }

    #[test]
    fn strategies_come_in_lists_and_one_by_one() {
        let one_by_one = parsed("--strategy light=solid-angle -strategy combine=mis").unwrap().strategy;
        assert_eq!(one_by_one.len(), 2);
        assert_eq!(parsed("--strategy light=solid-angle,combine=mis").unwrap().strategy, one_by_one);
    }

    #[test]
    fn json_is_seen_in_broken_command_lines() {
        let wants = |line: &str| wants_json(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert!(wants("--progress json --what") && wants("--progress=json --spp"));
        assert!(!wants("--progress plain json") && !wants("json"));
    }
}
