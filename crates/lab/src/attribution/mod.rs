//! Noise attribution: which variable of the integral makes the noise of a picture.
//!
//! Noise is measured as a viewer sees it: the variance of a pixel's luminance over the square of the brightness around it, in
//! the mean over the picture. That of single samples, drawn independently, is taken apart by [`pick_freeze`]. A variable's
//! **total** share is what would be gone were it integrated exactly; the **first-order** share is what goes where its
//! numbers, and theirs alone, are spread evenly.
//!
//! Random walks in coats draw from a hash of the point, the wavelength and the directions, not from a variable: their noise is an
//! interaction of all that moves these, and in the total share of each.

mod advice;
mod group;
mod page;
pub mod pick_freeze;

pub use group::Group;
pub use page::page;

use crate::{Interrupted, Work};
use pick_freeze::{Evaluations, Share, Totals};
use rayon::prelude::*;
use tenfold_math::{UVec2, Vec3};
use tenfold_render::{
    film::PixelBounds,
    integrator::Workspace,
    scene::Scene,
    schedule::{PixelEstimator, RenderSettings, box_mean, brightness},
};
use tenfold_sampling::{Draw, SamplePlan, Sampler, SamplerKind, Variable, hash};

/// Independent parts of the samples, from whose spread the errors come.
pub const BLOCKS: usize = 16;
/// A group that changes nothing in so many trial samples, at least, is left out.
const TRIALS: usize = 1 << 14;
/// Edge length of a tile, in pixels.
const TILE: u32 = 8;
/// Tiles between two reports of progress.
const BATCH: usize = 32;
/// Sets the samples apart from those of the picture.
const SALT: u64 = 0x6e6f_6973;

/// What came out.
#[derive(Clone, Debug)]
pub struct Attribution {
    /// The groups of variables that make a difference.
    pub groups: Vec<Group>,
    /// Their shares, in the same order.
    pub totals: Totals,
    /// Samples a pixel, each evaluated twice and once more for every group.
    pub samples: u32,
    /// Evaluations in all.
    pub evaluations: u64,
    /// Samples left out because a value was not finite.
    pub dropped: u64,
    /// The pixels.
    pub bounds: PixelBounds,
    /// The picture, in linear sRGB.
    pub picture: Vec<Vec3>,
    /// For each pixel its part of the squared noise: variance of one sample over the squared brightness around.
    pub noise: Vec<f64>,
    /// For each group and pixel what part of that the group has in all it takes part in.
    pub parts: Vec<Vec<f64>>,
}

impl Attribution {
    /// The noise of one independent sample a pixel: quadratic mean of the relative standard errors of the pixels.
    pub fn noise(&self) -> Share {
        let variance = self.totals.variance();
        let value = variance.value.max(0.0).sqrt();
        let error = if value > 0.0 { 0.5 * variance.error / value } else { 0.0 };
        Share { value, error }
    }

    /// For each pixel the group with the largest total share around it, where there is any noise. Every pixel has one vote: the
    /// noisiest would decide alone.
    pub fn culprits(&self) -> Vec<Option<usize>> {
        let share = |(part, noise): (&f64, &f64)| if *noise > 0.0 { part / noise } else { 0.0 };
        let shares =
            |parts: &Vec<f64>| self.smooth(&parts.iter().zip(&self.noise).map(share).collect::<Vec<_>>());
        let shares: Vec<Vec<f64>> = self.parts.iter().map(shares).collect();
        let culprit = |pixel: usize| {
            let largest = (0..shares.len()).max_by(|&a, &b| shares[a][pixel].total_cmp(&shares[b][pixel]))?;
            (shares[largest][pixel] > 0.0).then_some(largest)
        };
        (0..self.noise.len()).map(culprit).collect()
    }

    /// The mean noise around each pixel.
    pub fn noise_around(&self) -> Vec<f64> {
        self.smooth(&self.noise.iter().map(|v| v.max(0.0).sqrt()).collect::<Vec<_>>())
    }

    /// Weighted means of 9 × 9 pixels: what one pixel says is noisy itself.
    fn smooth(&self, values: &[f64]) -> Vec<f64> {
        let width = self.bounds.size().x as usize;
        box_mean(&box_mean(values, width, 2), width, 2)
    }
}

/// The samples that [`attribute`] takes at most, for [`Work::new`].
pub fn work_of(settings: &RenderSettings) -> u64 {
    let evaluations = u64::from(samples(settings)) * (2 + Group::ALL.len() as u64);
    settings.bounds.area() as u64 * (u64::from(settings.spp) + evaluations)
}

fn samples(settings: &RenderSettings) -> u32 {
    settings.spp.max(1).next_multiple_of(BLOCKS as u32)
}

/// Finds out what makes the noise of `scene`. The picture is rendered as `settings` say; then as many samples a pixel (a multiple
/// of [`BLOCKS`], rounded up) are drawn independently. Variables that are held stay so.
///
/// # Errors
/// [`Interrupted`] where the observer of the work did not want to go on.
pub fn attribute<'s>(
    scene: &'s Scene,
    settings: &RenderSettings,
    work: &mut Work<'_>,
) -> Result<Attribution, Interrupted> {
    let samples = samples(settings);
    let bounds = settings.bounds;
    let area = bounds.area() as u64;
    let trials = TRIALS.div_ceil(bounds.area().max(1)) as u32;
    let all = Group::ALL.len() as u64;

    let picture = work.render(scene, settings)?.film.means();
    let seed = hash::combine(settings.seed, SALT);
    let estimator = PixelEstimator::new(scene, settings);
    let luminance = |rgb: Vec3| f64::from(scene.film.color_space.luminance(rgb));
    let means: Vec<f64> = picture.iter().map(|&rgb| luminance(rgb)).collect();
    let brightness = brightness(&means, bounds.size().x as usize);

    let plans = |groups: &[Group]| Plans::new(&settings.sampling, groups, samples, seed);
    let everything = plans(&Group::ALL);
    let evaluate =
        |plans: &Plans, pixel: UVec2, index: u32, workspace: &mut Workspace<'s>, row: &mut [f64]| {
            for (value, sampler) in row.iter_mut().zip(&plans.samplers) {
                *value = luminance(estimator.sample(&sampler.at(pixel, index), workspace));
            }
        };

    // Which groups make any difference?
    let tiles = bounds.tiles(TILE);
    let mut differs = [false; Group::ALL.len()];
    for batch in tiles.chunks(BATCH) {
        let of_tiles: Vec<_> = batch
            .par_iter()
            .map(|tile| {
                let mut differs = [false; Group::ALL.len()];
                let (mut workspace, mut row) = (Workspace::default(), vec![0.0; everything.samplers.len()]);
                for (pixel, trial) in tile.pixels().flat_map(|p| (0..trials).map(move |t| (p, t))) {
                    evaluate(&everything, pixel, samples + trial, &mut workspace, &mut row);
                    differs.iter_mut().zip(&row[2..]).for_each(|(d, &v)| *d |= v != row[0]);
                }
                differs
            })
            .collect();
        for tile in of_tiles {
            differs.iter_mut().zip(tile).for_each(|(d, t)| *d |= t);
        }
        work.advance(0)?;
    }
    let groups: Vec<Group> =
        Group::ALL.into_iter().zip(differs).filter(|(_, d)| *d).map(|(g, _)| g).collect();

    let plans = plans(&groups);
    let mut out = Attribution {
        totals: Totals::new(groups.len(), BLOCKS),
        samples,
        evaluations: area * u64::from(samples) * plans.samplers.len() as u64,
        dropped: 0,
        bounds,
        picture,
        noise: vec![0.0; bounds.area()],
        parts: vec![vec![0.0; bounds.area()]; groups.len()],
        groups,
    };
    for batch in tiles.chunks(BATCH) {
        let of_tiles: Vec<TileResult> = batch
            .par_iter()
            .map(|tile| {
                let groups = out.groups.len();
                let mut result = TileResult::new(groups);
                let mut evaluations = Evaluations::new(groups, BLOCKS);
                let (mut workspace, mut row) = (Workspace::default(), vec![0.0; 2 + groups]);
                for pixel in tile.pixels() {
                    evaluations.clear();
                    for index in 0..samples {
                        evaluate(&plans, pixel, index, &mut workspace, &mut row);
                        if row.iter().all(|v| v.is_finite()) {
                            evaluations.add(index as usize % BLOCKS, row[0], row[1], &row[2..]);
                        } else {
                            result.dropped += 1;
                        }
                    }
                    result.pixel(&evaluations, brightness[bounds.index(pixel)], area);
                }
                result
            })
            .collect();
        for (tile, result) in batch.iter().zip(of_tiles) {
            out.totals.merge(&result.totals);
            out.dropped += result.dropped;
            for (pixel, values) in tile.pixels().zip(result.pixels.chunks_exact(1 + out.groups.len())) {
                let at = bounds.index(pixel);
                out.noise[at] = values[0];
                out.parts.iter_mut().zip(&values[1..]).for_each(|(part, &v)| part[at] = v);
            }
        }
        let pixels: u64 = batch.iter().map(|t| t.area() as u64).sum();
        work.advance(pixels * u64::from(samples) * (2 + all))?;
    }
    let to_srgb = scene.film.color_space.to(tenfold_spectrum::RgbColorSpace::srgb());
    out.picture.iter_mut().for_each(|rgb| *rgb = to_srgb * *rgb);
    Ok(out)
}

/// The samplers of A, of B, and of A with each group from B.
struct Plans {
    samplers: Vec<Sampler>,
}

impl Plans {
    fn new(base: &SamplePlan, groups: &[Group], samples: u32, seed: u64) -> Self {
        let with_streams = |of_b: &dyn Fn(Variable) -> bool| {
            let mut plan = *base;
            for variable in Variable::ALL {
                if let Draw::By(_) = plan.draw(variable) {
                    plan.set(variable, Draw::By(SamplerKind::Independent));
                }
                plan.set_stream(variable, u32::from(of_b(variable)));
            }
            Sampler::new(plan, samples, seed)
        };
        let mut samplers = vec![with_streams(&|_| false), with_streams(&|_| true)];
        samplers.extend(groups.iter().map(|&group| with_streams(&|v| Group::of(v) == group)));
        Self { samplers }
    }
}

/// What a tile gives to the whole.
struct TileResult {
    totals: Totals,
    dropped: u64,
    /// For each pixel its noise, then the part of each group.
    pixels: Vec<f64>,
}

impl TileResult {
    fn new(groups: usize) -> Self {
        Self { totals: Totals::new(groups, BLOCKS), dropped: 0, pixels: Vec::new() }
    }

    fn pixel(&mut self, evaluations: &Evaluations, brightness: f64, area: u64) {
        let scale = if brightness > 0.0 { 1.0 / (brightness * brightness) } else { 0.0 };
        self.totals.add(evaluations, scale / area as f64);
        self.pixels.push(scale * evaluations.variance());
        for group in 0..self.totals.groups() {
            self.pixels.push(scale * evaluations.total_part(group));
        }
    }
}
