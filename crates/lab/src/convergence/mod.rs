//! Error against samples and against seconds.
//!
//! The error of an estimate is its root mean square over pixels and seeds, relative: that of integrals over their value, that
//! of a scene's pixel over its luminance plus 5 % of the picture's mean, so that black pixels do not decide.

mod error;
mod fit;
mod integral;
mod page;

pub use fit::PowerLaw;
pub use integral::Integral;
pub use page::page;

use crate::{Interrupted, Picture, Work};
use error::{MeanSquare, SquaredErrors};
use rayon::prelude::*;
use std::time::Instant;
use tenfold_math::{UVec2, Vec3};
use tenfold_render::{
    film::{Film, PixelBounds},
    scene::Scene,
    schedule::RenderSettings,
};
use tenfold_sampling::{SamplePlan, Sampler, SamplerKind, hash::combine};

/// A pixel's error counts relative to its luminance plus this part of the picture's mean.
pub const FLOOR: f64 = 0.05;

/// Renders of which the reference is the mean; their spread tells its own noise.
const ROUNDS: u32 = 16;

/// Slopes are fitted from this many samples on: below, all samplers are much the same.
pub const FITTED_FROM: u32 = 4;

/// The side of the square of pixels that estimate an integral each.
const SIDE: u32 = 64;

/// What is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Counts of samples per pixel, rising.
    pub counts: Vec<u32>,
    /// Renders for each count, at least two.
    pub seeds: u32,
    /// Distinguishes experiments.
    pub seed: u64,
    /// The reference of a scene has so many times the samples of the largest count, at least 16.
    pub reference: u32,
}

/// One way to render, a curve of the plots.
#[derive(Clone, Debug)]
pub struct Variant {
    /// What it is called.
    pub name: String,
    /// How it renders; the samples and the seed are the experiment's.
    pub settings: RenderSettings,
}

/// What came out for a scene or an integral.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// What was estimated.
    pub subject: String,
    /// What was estimated, and how its error is measured, in words.
    pub about: String,
    /// One for each way.
    pub curves: Vec<Curve>,
}

/// The error of one way to estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it is called.
    pub name: String,
    /// By count of samples, rising.
    pub points: Vec<ErrorPoint>,
    /// The slope of error against samples from [`FITTED_FROM`] samples on.
    pub by_samples: Option<PowerLaw>,
    /// That of error against seconds.
    pub by_seconds: Option<PowerLaw>,
    /// The picture, of scenes, with the samples that it has.
    pub picture: Option<(u32, Picture)>,
}

/// The error at one count of samples.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ErrorPoint {
    /// Samples per pixel.
    pub samples: u32,
    /// Relative root mean square error.
    pub error: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Seconds for all pixels, the least of those of all seeds: what other programs do at the time only adds.
    pub seconds: f64,
}

impl Curve {
    fn new(name: &str, points: Vec<ErrorPoint>, picture: Option<(u32, Picture)>) -> Self {
        let enough = points.iter().filter(|p| p.samples >= FITTED_FROM).count() > 1;
        let fitted = || points.iter().filter(move |p| !enough || p.samples >= FITTED_FROM);
        let by_samples = PowerLaw::fit(fitted().map(|p| [p.samples.into(), p.error]));
        let by_seconds = PowerLaw::fit(fitted().map(|p| [p.seconds, p.error]));
        Self { name: name.to_owned(), points, by_samples, by_seconds, picture }
    }

    /// The error with so many samples.
    pub fn at(&self, samples: u32) -> Option<&ErrorPoint> {
        self.points.iter().find(|p| p.samples == samples)
    }
}

impl Options {
    /// Samples of all renders of `variants` ways, per pixel.
    fn samples(&self, variants: usize) -> u64 {
        let each: u64 = self.counts.iter().map(|&n| u64::from(n)).sum();
        each * u64::from(self.seeds) * variants as u64
    }

    fn largest(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(1)
    }

    /// The seed of one of the renders, or of a part of the reference.
    fn seed_of(&self, part: Part) -> u64 {
        let (kind, number) = match part {
            Part::Measured(k) => (1, k),
            Part::Reference(round) => (2, round),
        };
        combine(combine(self.seed, kind), number.into())
    }
}

/// A render of an experiment.
enum Part {
    Measured(u32),
    Reference(u32),
}

/// The samples that [`of_scene`] takes in all, to be told to [`Work`].
pub fn work_of_scene(bounds: PixelBounds, variants: usize, options: &Options) -> u64 {
    let reference = u64::from(ROUNDS) * u64::from(reference_spp(options));
    bounds.area() as u64 * (options.samples(variants) + reference)
}

/// The samples that [`of_integral`] takes in all.
pub fn work_of_integral(plans: usize, options: &Options) -> u64 {
    u64::from(SIDE * SIDE) * options.samples(plans)
}

/// Samples per pixel of each part of the reference.
fn reference_spp(options: &Options) -> u32 {
    options.largest().saturating_mul(options.reference.max(16).div_ceil(ROUNDS))
}

/// Measures how pictures of a scene come near its reference, one of its own of many more samples. `usual` is how the
/// scene is rendered where nobody asks for anything else.
///
/// # Errors
/// [`Interrupted`] where the observer of the work did not want to go on.
pub fn of_scene(
    name: &str,
    scene: &Scene,
    usual: &RenderSettings,
    variants: &[Variant],
    options: &Options,
    work: &mut Work<'_>,
) -> Result<Convergence, Interrupted> {
    let reference = Reference::render(scene, usual, options, work)?;
    let size = usual.bounds.size();
    let shown = options.counts.iter().copied().filter(|&n| n <= 16).max().unwrap_or(options.largest());
    let mut curves = Vec::new();
    for variant in variants {
        let (mut points, mut picture) = (Vec::new(), None);
        for &samples in &options.counts {
            let (mut errors, mut seconds) = (SquaredErrors::new(size), f64::INFINITY);
            for k in 0..options.seeds {
                let seed = options.seed_of(Part::Measured(k));
                let settings = RenderSettings { spp: samples, seed, ..variant.settings.clone() };
                let render = work.render(scene, &settings)?;
                seconds = seconds.min(render.statistics.seconds);
                errors.add(&reference.squared_errors(scene, &render.film));
                if k == 0 && samples == shown {
                    picture = as_picture(scene, &render.film).map(|p| (samples, p));
                }
            }
            let mean = errors.mean();
            let value = mean.value - reference.noise;
            let [error, standard_error] = MeanSquare { value, ..mean }.root();
            points.push(ErrorPoint { samples, error, standard_error, seconds });
        }
        curves.push(Curve::new(&variant.name, points, picture));
    }
    let about = format!(
        "{} × {} pixels, {} seeds. The error is the root of the mean square, over pixels and seeds, of the difference in luminance \
         from the reference, divided by the pixel's luminance plus {} % of the picture's mean. The reference has {} samples per \
         pixel, {} times the largest count measured, with seeds of its own; its own error is {:.2} %, whose square was subtracted.",
        size.x,
        size.y,
        options.seeds,
        100.0 * FLOOR,
        ROUNDS * reference_spp(options),
        ROUNDS * reference_spp(options) / options.largest(),
        100.0 * reference.noise.sqrt(),
    );
    Ok(Convergence { subject: name.to_owned(), about, curves })
}

/// A picture that counts as right.
struct Reference {
    luminance: Vec<f64>,
    /// What divides errors, by pixel.
    scale: Vec<f64>,
    /// Its own mean squared error.
    noise: f64,
}

impl Reference {
    fn render(
        scene: &Scene,
        usual: &RenderSettings,
        options: &Options,
        work: &mut Work<'_>,
    ) -> Result<Self, Interrupted> {
        let mut rounds = Vec::new();
        for round in 0..ROUNDS {
            let seed = options.seed_of(Part::Reference(round));
            let sampling = SamplerKind::default().into();
            let settings = RenderSettings { spp: reference_spp(options), seed, sampling, ..usual.clone() };
            rounds.push(luminance(scene, &work.render(scene, &settings)?.film));
        }
        let n = f64::from(ROUNDS);
        let pixels = rounds[0].len();
        let mean = |p: usize| rounds.iter().map(|r| r[p]).sum::<f64>() / n;
        let luminance: Vec<f64> = (0..pixels).map(mean).collect();
        let average = luminance.iter().sum::<f64>() / pixels as f64;
        // A black picture has no relative error, and no error either.
        let scale = |l: &f64| (l.max(0.0) + FLOOR * average).max(f64::MIN_POSITIVE);
        let scale: Vec<f64> = luminance.iter().map(scale).collect();
        let variance = |p: usize| {
            let squares: f64 = rounds.iter().map(|r| ((r[p] - luminance[p]) / scale[p]).powi(2)).sum();
            squares / (n - 1.0) / n
        };
        let noise = (0..pixels).map(variance).sum::<f64>() / pixels as f64;
        Ok(Self { luminance, scale, noise })
    }

    /// The relative squared error of each pixel.
    fn squared_errors(&self, scene: &Scene, film: &Film) -> Vec<f64> {
        let references = self.luminance.iter().zip(&self.scale);
        let pixels = luminance(scene, film).into_iter().zip(references);
        pixels.map(|(l, (reference, scale))| ((l - reference) / scale).powi(2)).collect()
    }
}

/// The luminance of each pixel, row by row.
fn luminance(scene: &Scene, film: &Film) -> Vec<f64> {
    film.means().into_iter().map(|rgb| f64::from(scene.film.color_space.luminance(rgb))).collect()
}

/// A film as a picture of linear sRGB; `None` of an empty one.
fn as_picture(scene: &Scene, film: &Film) -> Option<Picture> {
    let to_srgb = scene.film.color_space.to(tenfold_spectrum::RgbColorSpace::srgb());
    let pixels: Vec<Vec3> = film.means().into_iter().map(|rgb| to_srgb * rgb).collect();
    Picture::from_linear_rgb(film.bounds().size().x, &pixels).ok()
}

/// Measures how estimates of an integral, one for each of many pixels, come near its value.
///
/// # Errors
/// As [`of_scene`].
pub fn of_integral(
    integral: &Integral,
    plans: &[(String, SamplePlan)],
    options: &Options,
    work: &mut Work<'_>,
) -> Result<Convergence, Interrupted> {
    let size = UVec2::splat(SIDE);
    let pixels: Vec<UVec2> = PixelBounds::full(size).pixels().collect();
    let mut curves = Vec::new();
    for (name, plan) in plans {
        let mut points = Vec::new();
        for &samples in &options.counts {
            let (mut errors, mut seconds) = (SquaredErrors::new(size), f64::INFINITY);
            for k in 0..options.seeds {
                let start = Instant::now();
                let sampler = Sampler::new(*plan, samples, options.seed_of(Part::Measured(k)));
                let squared_error = |&pixel: &UVec2| {
                    let sum: f64 = (0..samples).map(|i| (integral.at)(&sampler.at(pixel, i))).sum();
                    (sum / f64::from(samples) - 1.0).powi(2)
                };
                let squares: Vec<f64> = pixels.par_iter().map(squared_error).collect();
                seconds = seconds.min(start.elapsed().as_secs_f64());
                errors.add(&squares);
                work.advance(pixels.len() as u64 * u64::from(samples))?;
            }
            let [error, standard_error] = errors.mean().root();
            points.push(ErrorPoint { samples, error, standard_error, seconds });
        }
        curves.push(Curve::new(name, points, None));
    }
    let about = format!(
        "{} Each of {} pixels estimates it with {} seeds; the error is the root of the mean square, relative to the value.",
        integral.about,
        pixels.len(),
        options.seeds
    );
    Ok(Convergence { subject: format!("integral:{}", integral.name), about, curves })
}
