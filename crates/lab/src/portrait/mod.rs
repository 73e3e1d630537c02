//! What the samples of one pixel look like, and the errors of many.

pub mod discrepancy;
mod page;
mod spectrum;

pub use page::page;
pub use spectrum::Spectrum;

use crate::{Interrupted, Work, convergence::Integral};
use discrepancy::{l2_star, star};
use rayon::prelude::*;
use tenfold_math::{DVec2, UVec2};
use tenfold_render::film::PixelBounds;
use tenfold_sampling::{Dimension, PixelSample, SamplePlan, Sampler, SamplerKind, hash::combine};

/// What is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Samples of the pixel whose points are shown.
    pub samples: u32,
    /// Point sets whose discrepancies are averaged, at least two.
    pub seeds: u32,
    /// Distinguishes portraits.
    pub seed: u64,
}

/// The looks of a sampler.
#[derive(Clone, Debug, PartialEq)]
pub struct Portrait {
    /// The sampler.
    pub name: String,
    /// How many samples the pixel has.
    pub samples: u32,
    /// Its points in two dimensions.
    pub views: Vec<View>,
    /// Its points in one.
    pub projections: Vec<Projection>,
    /// The discrepancy of a pair by number of samples.
    pub discrepancies: Vec<Discrepancy>,
    /// That of independent points.
    pub independent: Vec<Discrepancy>,
    /// The mean power spectrum of the points of a pair.
    pub points: Spectrum,
    /// The errors of neighbouring pixels.
    pub errors: PixelErrors,
}

/// Points of two dimensions, which may belong to different variables.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// What it shows.
    pub about: &'static str,
    /// What the axes are.
    pub axes: [&'static str; 2],
    /// One for each sample.
    pub points: Vec<DVec2>,
}

/// Points of one dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// Which dimension.
    pub name: &'static str,
    /// The numbers, rising.
    pub sorted: Vec<f64>,
}

impl Projection {
    /// The share of as many strata as there are numbers that hold exactly one.
    pub fn stratified(&self) -> f64 {
        let n = self.sorted.len();
        let mut counts = vec![0u32; n];
        for u in &self.sorted {
            counts[((u * n as f64) as usize).min(n - 1)] += 1;
        }
        counts.iter().filter(|c| **c == 1).count() as f64 / n as f64
    }

    /// How far each number, from the least, is from the middle of its stratum, in strata. Within ±½ where each has one.
    pub fn offsets(&self) -> impl Iterator<Item = f64> {
        let n = self.sorted.len() as f64;
        self.sorted.iter().enumerate().map(move |(i, u)| u * n - i as f64 - 0.5)
    }
}

/// How evenly points cover the unit square; means over seeds with their standard errors.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Discrepancy {
    /// Number of points.
    pub samples: u32,
    /// The star discrepancy.
    pub star: [f64; 2],
    /// The L2 star discrepancy.
    pub l2: [f64; 2],
}

/// The errors of neighbouring pixels that estimate the same smooth integral.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelErrors {
    /// Samples of each pixel.
    pub samples: u32,
    /// Pixels a side.
    pub side: u32,
    /// The errors of one seed, row by row.
    pub picture: Vec<f64>,
    /// Their mean power spectrum over seeds.
    pub spectrum: Spectrum,
}

/// The pixel that is looked at; none is special.
const PIXEL: UVec2 = UVec2::new(11, 7);
/// Pixels a side of the pictures of errors.
const SIDE: u32 = 64;
/// Samples of each of these pixels.
const ERROR_SAMPLES: u32 = 4;
/// Pictures over whose spectra the mean is taken.
const ERROR_PICTURES: u32 = 48;
/// Points of all sets together over whose spectra the mean is taken, about.
const SPECTRUM_POINTS: u32 = 25_600;

/// Numbers of points, by factors of √2, of which the discrepancy is measured.
fn counts() -> impl Iterator<Item = u32> {
    (4..=20)
        .map(|k| f64::from(1 << (k / 2)) * if k % 2 == 0 { 1.0 } else { std::f64::consts::SQRT_2 })
        .map(|n| n.round() as u32)
}

/// Sets of points over whose spectra the mean is taken.
fn sets(samples: u32) -> u32 {
    (SPECTRUM_POINTS / samples.max(1)).clamp(8, 400)
}

/// The samples that a [`portrait`] takes in all, to be told to [`Work`].
pub fn work(options: &Options) -> u64 {
    let discrepancies = 2 * counts().map(u64::from).sum::<u64>() * u64::from(options.seeds);
    let points = u64::from(options.samples) * u64::from(sets(options.samples));
    discrepancies + points + u64::from(SIDE * SIDE * ERROR_SAMPLES * ERROR_PICTURES)
}

/// Draws the portrait of a sampler.
///
/// # Errors
/// [`Interrupted`] where the observer of the work did not want to go on.
pub fn portrait(
    name: &str,
    plan: &SamplePlan,
    options: &Options,
    work: &mut Work<'_>,
) -> Result<Portrait, Interrupted> {
    let plain = SamplePlan::from(SamplerKind::Independent);
    Ok(Portrait {
        name: name.to_owned(),
        samples: options.samples,
        views: views(plan, options),
        projections: projections(plan, options),
        discrepancies: discrepancies(plan, options, work)?,
        independent: discrepancies(&plain, options, work)?,
        points: spectrum(plan, options, work)?,
        errors: pixel_errors(plan, options, work)?,
    })
}

/// Something of every sample of the pixel.
fn of_samples<T>(plan: &SamplePlan, n: u32, seed: u64, of: impl Fn(&PixelSample<'_>) -> T) -> Vec<T> {
    let sampler = Sampler::new(*plan, n, seed);
    (0..n).map(|i| of(&sampler.at(PIXEL, i))).collect()
}

/// The pair whose discrepancy and spectrum are measured.
fn pair(sample: &PixelSample<'_>) -> DVec2 {
    sample.get_2d(Dimension::light_point(0)).as_dvec2()
}

fn views(plan: &SamplePlan, options: &Options) -> Vec<View> {
    let x = |s: &PixelSample<'_>, d| f64::from(s.get_2d(d).x);
    let view = |about, axes, of: &dyn Fn(&PixelSample<'_>) -> DVec2| View {
        about,
        axes,
        points: of_samples(plan, options.samples, options.seed, of),
    };
    vec![
        view("One pair: the point on a light.", ["light-point x", "light-point y"], &pair),
        view("Two variables: a number of each.", ["lens x", "light-point x"], &|s| {
            DVec2::new(x(s, Dimension::LENS), x(s, Dimension::light_point(0)))
        }),
        view("Two bounces of one variable.", ["light-point x, bounce 0", "light-point x, bounce 1"], &|s| {
            DVec2::new(x(s, Dimension::light_point(0)), x(s, Dimension::light_point(1)))
        }),
        view("Two variables of one number.", ["time", "wavelength"], &|s| {
            DVec2::new(s.get_1d(Dimension::TIME).into(), s.get_1d(Dimension::WAVELENGTH).into())
        }),
    ]
}

fn projections(plan: &SamplePlan, options: &Options) -> Vec<Projection> {
    let projection = |name, of: &dyn Fn(&PixelSample<'_>) -> f64| {
        let mut sorted = of_samples(plan, options.samples, options.seed, of);
        sorted.sort_by(f64::total_cmp);
        Projection { name, sorted }
    };
    vec![
        projection("time", &|s| s.get_1d(Dimension::TIME).into()),
        projection("light-point x", &|s| pair(s).x),
        projection("light-point y", &|s| pair(s).y),
    ]
}

fn discrepancies(
    plan: &SamplePlan,
    options: &Options,
    work: &mut Work<'_>,
) -> Result<Vec<Discrepancy>, Interrupted> {
    let mut all = Vec::new();
    for samples in counts() {
        let of_seed = |k: u32| {
            let points = of_samples(plan, samples, combine(options.seed, k.into()), pair);
            [star(&points), l2_star(&points)]
        };
        let measured: Vec<[f64; 2]> = (0..options.seeds).into_par_iter().map(of_seed).collect();
        let [star, l2] = [0, 1].map(|i| mean_and_error(measured.iter().map(|m| m[i])));
        all.push(Discrepancy { samples, star, l2 });
        work.advance(u64::from(samples) * u64::from(options.seeds))?;
    }
    Ok(all)
}

/// The mean of at least two numbers, and its standard error.
fn mean_and_error(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let squares: f64 = values.map(|v| (v - mean) * (v - mean)).sum();
    [mean, (squares / (n - 1.0) / n).sqrt()]
}

fn spectrum(plan: &SamplePlan, options: &Options, work: &mut Work<'_>) -> Result<Spectrum, Interrupted> {
    // Beyond four times the frequency of a grid, spectra are flat.
    let largest = ((4.0 * f64::from(options.samples).sqrt()) as u32).clamp(8, 64);
    let points = |k: u32| of_samples(plan, options.samples, combine(options.seed, k.into()), pair);
    let sets: Vec<_> = (0..sets(options.samples)).map(points).collect();
    let spectrum = Spectrum::of_points(&sets, largest);
    work.advance(sets.iter().map(|set| set.len() as u64).sum())?;
    Ok(spectrum)
}

fn pixel_errors(
    plan: &SamplePlan,
    options: &Options,
    work: &mut Work<'_>,
) -> Result<PixelErrors, Interrupted> {
    let integral = Integral::SMOOTH_2D;
    let pixels: Vec<UVec2> = PixelBounds::full(UVec2::splat(SIDE)).pixels().collect();
    let mut pictures = Vec::new();
    for k in 0..ERROR_PICTURES {
        let sampler = Sampler::new(*plan, ERROR_SAMPLES, combine(options.seed, k.into()));
        let error = |&pixel: &UVec2| {
            let sum: f64 = (0..ERROR_SAMPLES).map(|i| (integral.at)(&sampler.at(pixel, i))).sum();
            sum / f64::from(ERROR_SAMPLES) - 1.0
        };
        pictures.push(pixels.par_iter().map(error).collect::<Vec<f64>>());
        work.advance(pixels.len() as u64 * u64::from(ERROR_SAMPLES))?;
    }
    let spectrum = Spectrum::of_pictures(&pictures, SIDE);
    Ok(PixelErrors { samples: ERROR_SAMPLES, side: SIDE, picture: pictures.swap_remove(0), spectrum })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looks(kind: SamplerKind, samples: u32) -> Portrait {
        let options = Options { samples, seeds: 4, seed: 1 };
        let mut work = Work::new(super::work(&options), &|p| p.done <= p.total);
        portrait(kind.name(), &kind.into(), &options, &mut work).unwrap()
    }

    #[test]
    fn portraits_tell_samplers_apart() {
        let [plain, rooks, zsobol] =
            [SamplerKind::Independent, SamplerKind::NRooks, SamplerKind::ZSobol].map(|kind| looks(kind, 64));
        for p in &rooks.projections {
            assert_eq!(p.stratified(), 1.0, "{}", p.name);
            assert!(p.offsets().all(|o| o.abs() <= 0.5 + 1e-4));
        }
        // Of independent numbers, about 1/e of the strata hold one.
        assert!(plain.projections.iter().all(|p| p.stratified() < 0.6));
        let last = |p: &Portrait| p.discrepancies.last().unwrap().star[0];
        assert!(last(&zsobol) < 0.5 * last(&rooks) && last(&rooks) < last(&plain));
        // Errors over pixels: zsobol's are blue, and independent ones white.
        let low = |p: &Portrait| p.errors.spectrum.radial()[..4].iter().map(|r| r[1]).sum::<f64>() / 4.0;
        assert!(low(&zsobol) < 0.3 && (low(&plain) - 1.0).abs() < 0.25, "{} {}", low(&zsobol), low(&plain));
        // N rooks have no power along the axes.
        let along = |p: &Portrait| {
            p.points.power[(p.points.largest * p.points.side() + p.points.largest + 5) as usize]
        };
        assert!(along(&rooks) < 0.1 && along(&plain) > 0.5);
    }
}
