use super::{CombineStrategy, spectral::Lanes, weights::Weights};
use tenfold_geometry::ReferencePoint;
use tenfold_math::Ray;
use tenfold_spectrum::SampledSpectrum;

/// A path under way.
#[derive(Copy, Clone, Debug)]
pub(super) struct Path {
    pub(super) lanes: Lanes,
    /// Surfaces met, interfaces not counted.
    pub(super) bounce: u16,
    /// Whether it comes from the camera or a specular bounce: no light sample could have done what it does.
    pub(super) specular: bool,
}

/// A path that waits for its turn.
#[derive(Copy, Clone, Debug)]
pub(super) struct Waiting {
    /// That of its sample.
    pub(super) slot: usize,
    pub(super) path: Path,
    pub(super) weights: Weights,
    /// Where it goes next.
    pub(super) ray: Ray,
    /// The vertex that it leaves.
    pub(super) from: ReferencePoint,
}

impl Path {
    /// A path that starts at the camera.
    #[inline]
    pub(super) fn from_camera() -> Self {
        Self { lanes: Lanes::ALL, bounce: 0, specular: true }
    }

    /// What the path carries back of the light `emitted` where it now is, weighed against a light sampled at its last vertex;
    /// `light_pdf` is the density with which it samples this light in this direction.
    #[inline]
    pub(super) fn carried(
        &self,
        weights: &Weights,
        combine: CombineStrategy,
        emitted: SampledSpectrum,
        light_pdf: impl FnOnce() -> f32,
    ) -> SampledSpectrum {
        let density = self.lanes.mean(weights.ratio);
        let density = if self.specular {
            density
        } else {
            let light_pdf = light_pdf();
            match combine {
                CombineStrategy::Mis => {
                    let light_density = self.lanes.mean(weights.light_ratio) * light_pdf;
                    density + light_density * (light_density / density)
                }
                CombineStrategy::LightOnly if light_pdf > 0.0 => return SampledSpectrum::ZERO,
                CombineStrategy::LightOnly | CombineStrategy::BsdfOnly => density,
            }
        };
        weights.beta * emitted / density
    }
}
