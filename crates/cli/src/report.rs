//! What a render took, told at its end.

use crate::{
    diagnostics::say,
    load::Loaded,
    output::Target,
    units::{bytes, count, digits, duration, plural},
};
use serde_json::{Value, json};
use tenfold_render::schedule::{Noise, NoiseReport, Render, RenderSettings, Stop};

/// The closing line.
pub(crate) fn closing_line(render: &Render, settings: &RenderSettings, written: &[Target]) -> String {
    let statistics = &render.statistics;
    let per_second = |n: u64| count(n as f64 / statistics.seconds.max(1e-6));
    let size = render.film.bounds().size();
    let files: Vec<_> = written.iter().map(|target| target.path.display().to_string()).collect();
    let files = if files.is_empty() { String::new() } else { format!("{}: ", files.join(", ")) };
    let with = match &render.noise {
        None => plural(settings.spp as usize, "sample"),
        Some(report) => noise(report, render),
    };
    format!(
        "{files}{} × {} pixels with {with} in {}; {} samples ({}/s), {} rays ({}/s)",
        size.x,
        size.y,
        duration(statistics.seconds),
        count(statistics.samples as f64),
        per_second(statistics.samples),
        count(statistics.rays.total() as f64),
        per_second(statistics.rays.total()),
    )
}

/// The noise of a picture, why there are no more samples, and how many there are.
fn noise(report: &NoiseReport, render: &Render) -> String {
    let reached = match report.reached {
        None => "unknown noise".to_owned(),
        Some(Noise { value, interval: None }) => format!("noise {}", digits(value)),
        Some(Noise { value, interval: Some([low, high]) }) => {
            format!("noise {} (95 %: {} to {})", digits(value), digits(low), digits(high))
        }
    };
    let target = report.target.map_or(String::new(), |target| format!(", target {target}"));
    let samples = SamplesPerPixel::of(render);
    format!(
        "{reached}{target}, {}, {} samples a pixel ({} to {}), {} with the search for the error,",
        why(report),
        samples.mean.round(),
        samples.least,
        samples.most,
        samples.in_all.round(),
    )
}

/// Why a render took no more samples.
fn why(report: &NoiseReport) -> &'static str {
    match report.stop {
        Stop::Target
            if report.reached.is_none_or(|n| report.target.is_none_or(|target| n.value <= target)) =>
        {
            "reached"
        }
        Stop::Target => "missed with the samples that it was found to need",
        Stop::MostSamples => "ended by the most samples a pixel",
        Stop::TimeLimit => "ended by the time limit",
        Stop::Interrupted => "interrupted",
    }
}

/// How many samples there are of a pixel.
struct SamplesPerPixel {
    /// In the picture, in the mean.
    mean: f64,
    /// In the picture, of the pixel with the fewest.
    least: u32,
    /// In the picture, of the pixel with the most.
    most: u32,
    /// In the mean, with those that are not in the picture.
    in_all: f64,
}

impl SamplesPerPixel {
    fn of(render: &Render) -> Self {
        let counts = || render.film.sums().iter().map(|sum| sum.samples());
        let pixels = render.film.sums().len().max(1) as f64;
        Self {
            mean: render.film.samples() as f64 / pixels,
            least: counts().min().unwrap_or(0),
            most: counts().max().unwrap_or(0),
            in_all: render.statistics.samples as f64 / pixels,
        }
    }
}

/// What to say of samples that were left out, if any were.
pub(crate) fn dropped(render: &Render) -> Option<String> {
    let statistics = &render.statistics;
    let first = statistics.first_dropped.first()?;
    let (x, y) = (first.pixel.x, first.pixel.y);
    let were = if statistics.dropped == 1 { "was" } else { "were" };
    let samples = plural(statistics.dropped as usize, "sample");
    let place = match render.noise {
        // The same pixel alone would get other samples.
        Some(_) => format!("the first is in pixel {x},{y}"),
        None => {
            format!("the first is sample {} of pixel {x},{y} (--pixel {x},{y} renders it alone)", first.index)
        }
    };
    Some(format!("warning: {samples} {were} not finite and {were} left out; {place}"))
}

/// What programs are told at the end.
pub(crate) fn completed(render: &Render, settings: &RenderSettings, written: &[Target]) -> Value {
    let statistics = &render.statistics;
    let first = statistics.first_dropped.first();
    let bounds = render.film.bounds();
    let mut fields = json!({
        "outputs": written.iter().map(|t| t.path.display().to_string()).collect::<Vec<_>>(),
        "width": bounds.size().x,
        "height": bounds.size().y,
        "samples_per_pixel": render.noise.is_none().then_some(settings.spp),
        "seconds": statistics.seconds,
        "samples": statistics.samples,
        "samples_per_second": statistics.samples as f64 / statistics.seconds.max(1e-6),
        "path_rays": statistics.rays.path,
        "shadow_rays": statistics.rays.shadow,
        "dropped_samples": statistics.dropped,
        "first_dropped": first.map(|d| json!({ "x": d.pixel.x, "y": d.pixel.y, "index": d.index })),
    });
    if let Some(report) = &render.noise {
        let samples = SamplesPerPixel::of(render);
        fields["samples_per_pixel"] = json!({ "mean": samples.mean, "least": samples.least, "most": samples.most, "in_all": samples.in_all });
        fields["noise"] = json!({
            "target": report.target,
            "reached": report.reached.map(|n| n.value),
            "interval_95": report.reached.and_then(|n| n.interval),
            "stop": match report.stop {
                Stop::Target => "target",
                Stop::MostSamples => "max-spp",
                Stop::TimeLimit => "time-limit",
                Stop::Interrupted => "interrupted",
            },
        });
    }
    if bounds.area() == 1 {
        fields["value"] = json!(render.film.means()[0].to_array());
    }
    fields
}

/// Prints the table of `--stats`.
pub(crate) fn print_stats(loaded: &Loaded, settings: &RenderSettings, render: &Render) {
    let (statistics, counts) = (&render.statistics, &loaded.counts);
    let world = loaded.scene.world.stats();
    let per_sample = |n: u64| {
        format!("{}  ({:.2} a sample)", count(n as f64), n as f64 / statistics.samples.max(1) as f64)
    };
    let number = |n: usize| n.to_string();
    let mut rows = vec![
        ("reading the scene", duration(loaded.read_seconds)),
        ("compiling it, with its files and hierarchies", duration(loaded.compile_seconds)),
        ("rendering", duration(statistics.seconds)),
        ("sampler", settings.sampling.to_string()),
        ("samples", count(statistics.samples as f64)),
        ("samples left out, not finite", statistics.dropped.to_string()),
        ("path rays", per_sample(statistics.rays.path)),
        ("shadow rays", per_sample(statistics.rays.shadow)),
        ("shapes in the file", number(counts.shapes)),
        ("instances", number(counts.instances)),
        ("materials", number(counts.materials)),
        ("textures", number(counts.textures)),
        ("lights", number(loaded.scene.lights.len())),
        ("primitives", number(world.primitives)),
        ("triangles without area, left out", number(world.degenerate)),
        ("hierarchy nodes", number(world.nodes)),
        ("hierarchy memory", bytes(world.bytes as u64)),
    ];
    if let Some(peak) = peak_memory() {
        rows.push(("peak memory of the program", bytes(peak)));
    }
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().for_each(|(name, value)| say(&format!("  {name:<width$}  {value}")));
}

/// The largest amount of memory that the program has had, in bytes, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
