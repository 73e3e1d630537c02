use super::NoiseSettings;
use crate::{
    camera::TimeStrategy,
    film::PixelBounds,
    integrator::{DispersionRule, Strategies},
    scene::Scene,
};
use std::num::NonZeroUsize;
use tenfold_sampling::SamplePlan;

/// In which order tiles are rendered. The picture is the same for all.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum TileOrder {
    /// From the middle outward: what matters most shows first.
    #[default]
    Centre,
    /// Row by row from the top.
    Rows,
    /// Row by row from the bottom.
    Reverse,
}

/// What a render does, beyond what the scene says.
#[derive(Clone, Debug)]
pub struct RenderSettings {
    /// How the numbers of each variable are drawn.
    pub sampling: SamplePlan,
    /// Samples a pixel, where `noise` does not say otherwise.
    pub spp: u32,
    /// Has the noise measured, and decide over the samples.
    pub noise: Option<NoiseSettings>,
    /// Distinguishes renders of the same scene.
    pub seed: u64,
    /// The pixels to render.
    pub bounds: PixelBounds,
    /// Number of threads; all cores where `None`.
    pub threads: Option<NonZeroUsize>,
    /// Edge length of a tile, in pixels.
    pub tile_side: u32,
    /// In which order tiles go.
    pub tile_order: TileOrder,
    /// What becomes of the other wavelengths at dispersive glass.
    pub dispersion: DispersionRule,
    /// How lights and directions are sampled.
    pub strategies: Strategies,
    /// The one wavelength, in nm, in whose light the picture is seen; the visible ones are drawn where `None`.
    pub wavelength: Option<f32>,
    /// The wavelength, in nm, whose index of refraction all light has; each has its own where `None`.
    pub index_wavelength: Option<f32>,
    /// How the time is sampled.
    pub time: TimeStrategy,
}

impl RenderSettings {
    /// What the scene itself asks for.
    pub fn of(scene: &Scene) -> Self {
        Self {
            sampling: scene.sampler.kind.into(),
            spp: scene.sampler.spp,
            noise: None,
            seed: scene.sampler.seed,
            bounds: scene.film.bounds,
            threads: None,
            tile_side: 16,
            tile_order: TileOrder::default(),
            dispersion: DispersionRule::default(),
            strategies: Strategies::default(),
            wavelength: None,
            index_wavelength: None,
            time: TimeStrategy::default(),
        }
    }

    /// All strategies, as the command line takes them.
    pub fn strategy(&self) -> String {
        format!("{},time={}", self.strategies, self.time)
    }
}
