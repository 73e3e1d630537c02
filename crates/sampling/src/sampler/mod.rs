//! Samplers: from (seed, pixel, sample index, dimension) to numbers in `[0, 1)`.

mod block;
mod group;
mod halton;
mod kind;
mod multi_jittered;
mod n_rooks;
mod padded;
mod permute;
mod plan;
mod sobol;
mod stratified;
mod stratum;
mod zsobol;

pub use block::SampleRoom;
pub use group::SampleGroup;
pub use kind::{Mapped, SamplerKind};
pub use plan::{Draw, SamplePlan};

use crate::hash::{combine, unit_f32};
use crate::{Dimension, Variable};
use halton::{Halton, HaltonSample};
use multi_jittered::{MultiJittered, MultiJitteredSample};
use n_rooks::NRooksSample;
use sobol::SobolSample;
use std::ops::Range;
use stratified::{Stratified, StratifiedSample};
use tenfold_math::{UVec2, Vec2, WIDTH};

/// A rule that spreads the samples of a pixel, and of its neighbours, over all dimensions.
///
/// It has no state: every number is a pure function of the sampler's settings, the pixel, the index and the dimension.
/// Indices from 0 to `samples_per_pixel - 1` form a round, in which the pattern is balanced; any further
/// indices form further rounds of the same kind, independent of each other. Every number by itself is
/// uniform over seeds, whatever the count of samples.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Sampler {
    plan: SamplePlan,
    /// The sampler of all variables, where the plan has but one.
    kind: Option<SamplerKind>,
    samples_per_pixel: u32,
    seed: u64,
    grid: Stratified,
    multi_jittered: MultiJittered,
    halton: Halton,
}

/// One sample of one pixel: asked for numbers by dimension. Cheap to copy.
#[derive(Copy, Clone, Debug)]
pub struct PixelSample<'a> {
    pixel: UVec2,
    index: u32,
    /// Hash of the seed and the pixel.
    pixel_seed: u64,
    pattern: Pattern<'a>,
}

#[derive(Copy, Clone, Debug)]
enum Pattern<'a> {
    Independent,
    Stratified(StratifiedSample),
    Sobol(SobolSample),
    NRooks(NRooksSample),
    MultiJittered(MultiJitteredSample),
    Halton(HaltonSample),
    /// At a place of a block whose numbers are kept.
    Kept(&'a SampleRoom, u32),
    /// Every variable in its own way, found out when it is asked for.
    Planned(&'a Sampler),
}

/// A variable by itself under a plan.
enum Alone<'a> {
    Drawn(PixelSample<'a>),
    Held(Vec2),
}

impl Sampler {
    /// A sampler for `samples_per_pixel` samples a round (at least one). The pattern does not depend on the size
    /// of the picture: a crop, and a larger picture, share the samples of the pixels they share.
    pub fn new(plan: impl Into<SamplePlan>, samples_per_pixel: u32, seed: u64) -> Self {
        let samples_per_pixel = samples_per_pixel.max(1);
        let plan = plan.into();
        Self {
            plan,
            kind: plan.uniform_kind(),
            samples_per_pixel,
            seed,
            grid: Stratified::new(samples_per_pixel),
            multi_jittered: MultiJittered::new(samples_per_pixel),
            halton: Halton::new(samples_per_pixel),
        }
    }

    /// How it draws each variable.
    pub fn plan(&self) -> &SamplePlan {
        &self.plan
    }

    /// Samples of a pixel in one round.
    pub fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    /// The seed it was made with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The sample `index` of `pixel`; any index is good.
    #[inline]
    pub fn at(&self, pixel: UVec2, index: u32) -> PixelSample<'_> {
        match self.kind {
            Some(kind) => self.by(kind, self.seed, pixel, index),
            None => {
                let by_hash = self.by(SamplerKind::Independent, self.seed, pixel, index);
                PixelSample { pattern: Pattern::Planned(self), ..by_hash }
            }
        }
    }

    /// Calls `take` with the samples `indices` of `pixel`, in order and up to `at_most` at a time. They have the numbers of
    /// [`Sampler::at`]; those of neighbours are computed together, in `room`, where the sampler can.
    #[inline]
    pub fn for_groups(
        &self,
        pixel: UVec2,
        mut indices: Range<u32>,
        room: &mut SampleRoom,
        mut take: impl FnMut(&SampleGroup<'_>),
    ) {
        while !indices.is_empty() {
            let first = self.at(pixel, indices.start);
            let mut group = SampleGroup::default();
            match first.pattern {
                Pattern::Sobol(sobol) if room.begin(sobol) => {
                    let lanes = WIDTH as u32;
                    let place = sobol.place();
                    let taken =
                        (sobol.block_size() - place).min(indices.len() as u32).min(lanes - place % lanes);
                    for i in 0..taken {
                        let (index, pattern) = (first.index + i, Pattern::Kept(&*room, place + i));
                        group.0.push(PixelSample { pixel, index, pixel_seed: first.pixel_seed, pattern });
                    }
                }
                _ => {
                    group.0.push(first);
                    for index in indices.clone().skip(1).take(WIDTH - 1) {
                        group.0.push(self.at(pixel, index));
                    }
                }
            }
            take(&group);
            indices.start += group.len() as u32;
        }
    }

    /// The sample with all variables drawn by `kind`.
    #[inline]
    fn by(&self, kind: SamplerKind, seed: u64, pixel: UVec2, index: u32) -> PixelSample<'_> {
        let position = u64::from(pixel.y) << 32 | u64::from(pixel.x);
        let pixel_seed = combine(seed, position);
        // The seed of the pixel's round and the index in it.
        let place = || {
            let (round, index) = self.round(index);
            (combine(pixel_seed, !round), index)
        };
        let rooks = || {
            let (seed, index) = place();
            NRooksSample { seed, index, count: self.samples_per_pixel }
        };
        let pattern = match kind {
            SamplerKind::Independent => Pattern::Independent,
            SamplerKind::Stratified => {
                let (seed, index) = place();
                Pattern::Stratified(self.grid.at(seed, index))
            }
            SamplerKind::PaddedSobol => {
                let (seed, index) = place();
                Pattern::Sobol(padded::at(seed, index, self.samples_per_pixel))
            }
            SamplerKind::ZSobol => {
                let (round, index) = self.round(index);
                let (seed, order) = (combine(seed, !round), pixel_seed.wrapping_add(round));
                Pattern::Sobol(zsobol::at(seed, order, pixel, index, self.samples_per_pixel))
            }
            SamplerKind::NRooks => Pattern::NRooks(rooks()),
            SamplerKind::MultiJittered => Pattern::MultiJittered(self.multi_jittered.at(rooks())),
            SamplerKind::Halton => {
                let (seed, index) = place();
                Pattern::Halton(self.halton.at(seed, index))
            }
        };
        PixelSample { pixel, index, pixel_seed, pattern }
    }

    /// One variable of the sample, as the plan has it.
    fn alone(&self, variable: Variable, pixel: UVec2, index: u32) -> Alone<'_> {
        match self.plan.draw(variable) {
            Draw::Held(value) => Alone::Held(value),
            Draw::By(kind) => {
                let seed = match self.plan.stream(variable) {
                    0 => self.seed,
                    stream => combine(self.seed, !u64::from(stream)),
                };
                Alone::Drawn(self.by(kind, seed, pixel, index))
            }
        }
    }

    #[inline]
    fn round(&self, index: u32) -> (u64, u32) {
        // Most indices are in the first round: spare them the division.
        if index < self.samples_per_pixel {
            (0, index)
        } else {
            (u64::from(index / self.samples_per_pixel), index % self.samples_per_pixel)
        }
    }
}

impl PixelSample<'_> {
    /// The pixel.
    pub fn pixel(&self) -> UVec2 {
        self.pixel
    }

    /// The sample's index in the pixel.
    pub fn index(&self) -> u32 {
        self.index
    }

    /// The numbers at which `variable` is held, where it is.
    #[inline]
    pub fn held(&self, variable: Variable) -> Option<Vec2> {
        let Pattern::Planned(sampler) = &self.pattern else { return None };
        match sampler.plan.draw(variable) {
            Draw::Held(value) => Some(value),
            Draw::By(_) => None,
        }
    }

    /// The number of a dimension, in `[0, 1)`.
    #[inline]
    pub fn get_1d(&self, dimension: Dimension) -> f32 {
        match self.pattern {
            Pattern::Kept(room, place) => room.get(place, dimension).x,
            _ => self.compute_1d(dimension),
        }
    }

    /// The two numbers of a dimension, each in `[0, 1)`.
    #[inline]
    pub fn get_2d(&self, dimension: Dimension) -> Vec2 {
        match self.pattern {
            Pattern::Kept(room, place) => room.get(place, dimension),
            _ => self.compute_2d(dimension),
        }
    }

    fn compute_1d(&self, dimension: Dimension) -> f32 {
        match &self.pattern {
            Pattern::Independent => unit_f32(self.hash(dimension) as u32),
            Pattern::Stratified(s) => s.get_1d(dimension.key(), self.hash(dimension)),
            Pattern::Sobol(s) => s.get_1d(dimension.key()),
            Pattern::NRooks(s) => s.get_1d(dimension.key(), self.hash(dimension)),
            Pattern::MultiJittered(s) => s.get_1d(dimension.key(), self.hash(dimension)),
            Pattern::Halton(s) => s.get_1d(dimension.key()),
            Pattern::Kept(room, place) => room.get(*place, dimension).x,
            Pattern::Planned(s) => match s.alone(dimension.variable, self.pixel, self.index) {
                Alone::Drawn(s) => s.get_1d(dimension),
                Alone::Held(value) => value.x,
            },
        }
    }

    fn compute_2d(&self, dimension: Dimension) -> Vec2 {
        match &self.pattern {
            Pattern::Independent => {
                let bits = self.hash(dimension);
                Vec2::new(unit_f32(bits as u32), unit_f32((bits >> 32) as u32))
            }
            Pattern::Stratified(s) => s.get_2d(dimension.key(), self.hash(dimension)),
            Pattern::Sobol(s) => s.get_2d(dimension.key()),
            Pattern::NRooks(s) => s.get_2d(dimension.key(), self.hash(dimension)),
            Pattern::MultiJittered(s) => s.get_2d(dimension.key(), self.hash(dimension)),
            Pattern::Halton(s) => s.get_2d(dimension.key(), self.hash(dimension)),
            Pattern::Kept(room, place) => room.get(*place, dimension),
            Pattern::Planned(s) => match s.alone(dimension.variable, self.pixel, self.index) {
                Alone::Drawn(s) => s.get_2d(dimension),
                Alone::Held(value) => value,
            },
        }
    }

    /// Hash of the seed, the pixel and the index.
    #[inline]
    fn identity(&self) -> u64 {
        combine(self.pixel_seed, u64::from(self.index))
    }

    /// 64 random bits of a dimension, without any pattern over samples: to seed what needs many numbers.
    #[inline]
    pub fn hash(&self, dimension: Dimension) -> u64 {
        let identity = match &self.pattern {
            Pattern::Planned(s) => match s.alone(dimension.variable, self.pixel, self.index) {
                Alone::Drawn(s) => s.identity(),
                // Held walks are the same in all samples of all pixels.
                Alone::Held(_) => 0,
            },
            _ => self.identity(),
        };
        combine(identity, u64::from(dimension.key()))
    }
}
