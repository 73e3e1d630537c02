//! Renders to a target of noise, or to a limit of time: `docs/noise.md` explains how.
//!
//! A few stages scout: they find out where the error is, and how many samples the target needs. The picture is the last
//! stage alone, which was planned before its first sample was drawn. Whatever was learned from the others, it is a plain
//! average of a fixed number of samples: neither the choice of pixels (Kirk and Arvo 1991) nor the time to stop can bias
//! it or the estimate of its error. Every stage is made of rounds that are scrambled independently of each other, and
//! it is their spread that tells the error.

mod knowledge;
mod moments;
mod noise;
mod plan;
mod report;
mod settings;
mod stage;

pub use noise::{Noise, box_mean, brightness, relative_error, tile_sums};
pub use report::{NoiseReport, Stop};
pub use settings::{Allocation, NoiseSettings};

use super::{Progress, Render, RenderSettings};
use crate::scene::Scene;
use knowledge::Knowledge;
use plan::{Next, Plan};
use stage::{Stage, Stages};

/// Renders `scene` within `limits`, as [`super::render`] does.
pub(super) fn render(
    scene: &Scene,
    settings: &RenderSettings,
    limits: &NoiseSettings,
    observe: &(dyn Fn(Progress) -> bool + Sync),
) -> Render {
    let pixels = settings.bounds.area();
    let mut stages = Stages::new(scene, settings, limits, observe);
    let mut knowledge = Knowledge::new(pixels, settings.bounds.size().x as usize);
    let mut picture: Option<Stage> = None;
    let mut plan = Plan::first(limits, pixels);
    let stop = loop {
        let (stage, cut) = stages.take(&plan, picture.as_ref());
        let whole = cut.is_none();
        if whole && plan.end.is_none() {
            knowledge.add(&plan, &stage);
        }
        // What was cut short goes by the rounds that all pixels have, if these tell their error.
        if picture.is_none() || stage.moments().rounds() >= 2 {
            picture = Some(stage);
        }
        if let Some(stop) = cut.or(plan.end) {
            break stop;
        }
        match Plan::next(&knowledge, limits, stages.affordable_spp()) {
            Next::Stage(next) => plan = next,
            Next::Stop => break Stop::TimeLimit,
        }
    };
    let statistics = stages.finish();
    let picture = picture.unwrap_or_else(|| Stage::new(scene, settings));
    Render {
        complete: stop != Stop::Interrupted,
        noise: Some(NoiseReport {
            target: limits.target,
            reached: picture.noise(),
            stop,
            standard_errors: picture.moments().standard_errors(),
        }),
        film: picture.into_film(),
        statistics,
    }
}
