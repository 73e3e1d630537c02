//! A render from the command line to its files.

use crate::{
    args::Args,
    diagnostics::say,
    embedded,
    failure::Failure,
    interrupt, layers, load,
    load::Loaded,
    output::{self, Picture, Target},
    progress::{Reporter, json},
    report,
    sampling::{self, Freeze, SamplerChoice},
    units::{bytes, plural},
};
use serde_json::json;
use std::{io::Write, num::NonZeroUsize};
use tenfold_math::UVec2;
use tenfold_render::{
    compile::crop_window,
    film::{PixelBounds, PixelSum},
    schedule::{self, Frozen, Render, RenderSettings},
};

/// Does what the command line asks for.
pub(crate) fn render(args: &Args) -> Result<(), Failure> {
    use_threads(args.nthreads);
    let reporter = Reporter::new(args.progress, args.quiet);
    // What cannot be written must be known before the work, not after it.
    let mut targets = output::asked_for(args)?;
    targets.iter().try_for_each(Target::check_writable)?;
    let loaded = load::load(args.scene.as_deref(), &embedded::DEFAULT, args.quiet, &reporter, None)?;
    if targets.is_empty() && args.pixel.is_none() {
        targets.push(output::default_target(args, &loaded.scene)?);
        targets.iter().try_for_each(Target::check_writable)?;
    }
    let settings = settings(args, &loaded)?;
    let layers = layers::checked(&args.layers, settings.noise.is_some(), targets.iter().any(Target::is_exr))?;
    check_memory(&settings)?;

    if matches!(reporter, Reporter::Json(_)) {
        json::started(started(&loaded, &settings, &targets));
    }
    interrupt::rendering(true);
    let render = schedule::render(&loaded.scene, &settings, &|progress| {
        reporter.update(progress);
        !interrupt::requested()
    });
    reporter.finish();
    if interrupt::requested() && render.statistics.samples == 0 {
        return Err(Failure::Failed("interrupted, nothing was written".to_owned()));
    }

    let picture = Picture {
        scene: &loaded.scene,
        scene_name: &loaded.name,
        settings: &settings,
        render: &render,
        layers: &layers,
    };
    write_all(&targets, &picture, args.png16)?;
    tell(args, &loaded, &settings, &render, &targets);
    if !render.complete {
        return Err(Failure::Failed(interrupted(&render, &settings, &targets)));
    }
    if matches!(reporter, Reporter::Json(_)) {
        json::completed(report::completed(&render, &settings, &targets));
    }
    Ok(())
}

/// What to say of a render that the user ended, and of what there is of it.
fn interrupted(render: &Render, settings: &RenderSettings, written: &[Target]) -> String {
    let files: Vec<_> = written.iter().map(|t| t.path.display().to_string()).collect();
    let files = if files.is_empty() { "the picture".to_owned() } else { files.join(", ") };
    if render.noise.is_some() {
        return format!("interrupted: {files} with the noise it had");
    }
    let total = settings.bounds.area() as f64 * settings.spp as f64;
    let share = 100.0 * render.statistics.samples as f64 / total;
    format!("interrupted: {files} with {share:.1} % of the samples")
}

/// Has the compile step use as many threads as the render will.
pub(crate) fn use_threads(n: u16) {
    let built = rayon::ThreadPoolBuilder::new().num_threads(n.into()).build_global();
    if let Err(error) = built {
        tracing::warn!("cannot set the number of threads: {error}");
    }
}

/// What the scene asks for, and what the command line says instead.
fn settings(args: &Args, loaded: &Loaded) -> Result<RenderSettings, Failure> {
    let mut settings = RenderSettings::of(&loaded.scene);
    let resolution = loaded.scene.film.resolution;
    let spp = args.spp.or(args.quick.then_some(1));
    settings.spp = spp.unwrap_or(settings.spp);
    settings.noise = args.noise.settings()?;
    settings.seed = args.seed.unwrap_or(settings.seed);
    sampling::apply(&args.sampler, &mut settings.sampling);
    if !args.quiet {
        args.sampler.iter().filter_map(SamplerChoice::note).for_each(|note| say(&format!("note: {note}")));
    }
    args.freeze.iter().flat_map(Freeze::frozen).for_each(|frozen| settings.freeze(frozen));
    settings.threads = NonZeroUsize::new(args.nthreads.into());
    settings.tile_side = args.tile_size;
    settings.tile_order = args.tile_order.into();
    settings.dispersion = args.dispersion.into();
    args.strategy.iter().try_for_each(|strategy| strategy.apply(&mut settings, &loaded.scene))?;
    if let Some(bounds) = asked_bounds(args, resolution) {
        if bounds.is_empty() {
            return Err(Failure::Wrong(format!(
                "there is no pixel within these bounds: the picture has {} × {}",
                resolution.x, resolution.y
            )));
        }
        settings.bounds = bounds;
    }
    Ok(settings)
}

/// The part of the picture that the command line asks for, if it does.
fn asked_bounds(args: &Args, resolution: UVec2) -> Option<PixelBounds> {
    let corner = |x: i32, y: i32| UVec2::new(x.max(0) as u32, y.max(0) as u32).min(resolution);
    if let Some([x, y]) = args.pixel {
        let max = corner(x.saturating_add(1), y.saturating_add(1));
        return Some(PixelBounds { min: corner(x, y), max });
    }
    if let Some([x0, x1, y0, y1]) = args.pixelbounds {
        return Some(PixelBounds { min: corner(x0, y0), max: corner(x1, y1) });
    }
    args.cropwindow.map(|window| crop_window(resolution, window))
}

/// Refuses pictures that memory cannot hold; a program that runs out of it ends without a word.
fn check_memory(settings: &RenderSettings) -> Result<(), Failure> {
    let bounds = settings.bounds;
    // The sums, their means and the copies that are written; and what the noise is told from.
    let per_pixel = size_of::<PixelSum>() + 64 + if settings.noise.is_some() { 512 } else { 0 };
    let needed = bounds.area().saturating_mul(per_pixel);
    if Vec::<u8>::new().try_reserve_exact(needed).is_err() {
        let size = bounds.size();
        return Err(Failure::Failed(format!(
            "there is not enough memory for {} × {} pixels, which need {}; --cropwindow renders a part",
            size.x,
            size.y,
            bytes(needed as u64)
        )));
    }
    Ok(())
}

fn started(loaded: &Loaded, settings: &RenderSettings, targets: &[Target]) -> serde_json::Value {
    let (resolution, bounds) = (loaded.scene.film.resolution, settings.bounds);
    let known = settings.noise.is_none();
    json!({
        "program": concat!("tenfold ", env!("CARGO_PKG_VERSION")),
        "scene": loaded.name,
        "outputs": targets.iter().map(|t| t.path.display().to_string()).collect::<Vec<_>>(),
        "resolution": [resolution.x, resolution.y],
        "bounds": [bounds.min.x, bounds.max.x, bounds.min.y, bounds.max.y],
        "samples_per_pixel": known.then_some(settings.spp),
        "samples": known.then_some(bounds.area() as u64 * settings.spp as u64),
        "noise_target": settings.noise.and_then(|n| n.target),
        "time_limit": settings.noise.and_then(|n| n.time_limit),
        "seed": settings.seed,
        "sampler": settings.sampling.to_string(),
        "strategy": settings.strategy(),
        "frozen": settings.frozen().iter().map(Frozen::to_string).collect::<Vec<_>>(),
    })
}

/// Writes every file that can be written.
fn write_all(targets: &[Target], picture: &Picture<'_>, png16: bool) -> Result<(), Failure> {
    let faults: Vec<String> = targets.iter().filter_map(|t| t.write(picture, png16).err()).collect();
    if faults.is_empty() {
        return Ok(());
    }
    let files = plural(faults.len(), "file");
    Err(Failure::Failed(format!("{files} could not be written: {}", faults.join("; "))))
}

/// Tells people what came out.
fn tell(args: &Args, loaded: &Loaded, settings: &RenderSettings, render: &Render, written: &[Target]) {
    let json = args.progress == crate::progress::Style::Json;
    if let ([value], Some([x, y]), false) = (&render.film.means()[..], args.pixel, json) {
        // A result, so it goes where results go, also from quiet runs.
        let _ = writeln!(std::io::stdout().lock(), "{x},{y}: {} {} {}", value.x, value.y, value.z);
    }
    if !args.quiet {
        if let Some(warning) = report::dropped(render) {
            say(&warning);
        }
        say(&report::closing_line(render, settings, written));
    }
    if args.stats {
        report::print_stats(loaded, settings, render);
    }
}
