//! `tenfold lab convergence`.

use super::{
    options::{Common, SceneOptions, Session},
    variants::{self, NamedPlan, NamedStrategies},
};
use crate::{embedded, failure::Failure, load::Loaded};
use std::path::Path;
use tenfold_lab::convergence::{
    self, Integral, Options, of_integral, of_scene, work_of_integral, work_of_scene,
};
use tenfold_render::schedule::RenderSettings;
use tenfold_sampling::SamplerKind;

/// All samplers, from the simplest to the default.
const KINDS: [SamplerKind; 7] = [
    SamplerKind::Independent,
    SamplerKind::Stratified,
    SamplerKind::NRooks,
    SamplerKind::MultiJittered,
    SamplerKind::Halton,
    SamplerKind::PaddedSobol,
    SamplerKind::ZSobol,
];

/// What to compare, and on what.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Args {
    /// Scenes (.pbrt), or integrals whose value is known: integral:smooth-2d, integral:disk-2d, integral:smooth-4d,
    /// integral:smooth-10d [default: these four]
    #[arg(value_name = "SCENE")]
    subjects: Vec<String>,

    /// Samplers to compare, those of one render with + between: zsobol,zsobol+lens=n-rooks [default: all; with
    /// --strategies the default one]
    #[arg(long, value_name = "NAME,...", value_parser = variants::plan, value_delimiter = ',')]
    samplers: Vec<NamedPlan>,

    /// Strategies to compare, those of one render with + between: combine=mis,combine=light-only+light=uniform-area
    #[arg(long, value_name = "VARIABLE=NAME+...,...", value_parser = variants::strategies, value_delimiter = ',')]
    strategies: Vec<NamedStrategies>,

    /// Samples per pixel at which the error is measured
    #[arg(long, value_name = "N,...", value_parser = clap::value_parser!(u32).range(1..), value_delimiter = ',',
          default_value = "1,2,4,8,16,32,64,128,256")]
    spp: Vec<u32>,

    /// Renders for each of them, whose spread gives the error bars
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(2..=10_000))]
    seeds: u32,

    /// The reference has N times the samples of the largest count
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(16..=1_000_000))]
    reference: u32,

    #[command(flatten)]
    scene: SceneOptions,

    #[command(flatten)]
    common: Common,
}

/// What is to be estimated.
enum Subject {
    Integral(Integral),
    Scene(Box<(Loaded, RenderSettings)>),
}

/// Does the experiment.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let session = Session::new(&args.common, "convergence")?;
    let subjects = subjects(args, &session)?;
    let mut counts = args.spp.clone();
    counts.sort_unstable();
    counts.dedup();
    let options = Options { counts, seeds: args.seeds, seed: args.common.seed, reference: args.reference };

    let plans = plans(args);
    let variants = |subject: &Subject| match subject {
        Subject::Integral(_) => Ok(Vec::new()),
        Subject::Scene(scene) => variants::all(&plans, &args.strategies, &scene.1, &scene.0.scene),
    };
    let variants = subjects.iter().map(variants).collect::<Result<Vec<_>, _>>()?;
    let subjects: Vec<_> = subjects.iter().zip(&variants).collect();
    let plain: Vec<_> = plans.iter().map(|p| (p.name.clone(), p.plan)).collect();
    let samples = subjects.iter().map(|(subject, variants)| match subject {
        Subject::Integral(_) => work_of_integral(plans.len(), &options),
        Subject::Scene(scene) => work_of_scene(scene.1.bounds, variants.len(), &options),
    });
    let results = session.work(samples.sum(), |work| {
        let experiment = |(subject, variants): &(&Subject, &Vec<_>)| match subject {
            Subject::Integral(integral) => of_integral(integral, &plain, &options, work),
            Subject::Scene(scene) => {
                let (loaded, settings) = &**scene;
                of_scene(&loaded.short_name(), &loaded.scene, settings, variants, &options, work)
            }
        };
        subjects.iter().map(experiment).collect::<Result<Vec<_>, _>>()
    })?;
    session.finish(&convergence::page(&results))
}

/// The ways to draw the samples.
fn plans(args: &Args) -> Vec<NamedPlan> {
    let named = |kind: SamplerKind| NamedPlan { name: kind.name().to_owned(), plan: kind.into() };
    match (&args.samplers[..], &args.strategies[..]) {
        ([], []) => KINDS.map(named).into(),
        ([], _) => vec![named(SamplerKind::default())],
        (given, _) => given.to_vec(),
    }
}

fn subjects(args: &Args, session: &Session<'_>) -> Result<Vec<Subject>, Failure> {
    if args.subjects.is_empty() {
        return Ok(Integral::ALL.map(Subject::Integral).into());
    }
    let subject = |text: &String| match text.strip_prefix("integral:") {
        Some(name) => integral(name).map(Subject::Integral),
        None => Ok(Subject::Scene(Box::new(session.load(
            Some(Path::new(text)),
            &embedded::DEFAULT,
            &args.scene,
        )?))),
    };
    args.subjects.iter().map(subject).collect()
}

fn integral(name: &str) -> Result<Integral, Failure> {
    Integral::named(name).ok_or_else(|| {
        let known = Integral::ALL.map(|integral| integral.name);
        let hint = match tenfold_scene::nearest(name, known) {
            Some(near) => format!("did you mean integral:{near}?"),
            None => format!("there are {}", known.join(", ")),
        };
        Failure::Wrong(format!("there is no integral {name}; {hint}"))
    })
}
