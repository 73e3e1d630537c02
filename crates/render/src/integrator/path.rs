use super::{CombineStrategy, spectral::Lanes};
use crate::light::LightSample;
use tenfold_geometry::ReferencePoint;
use tenfold_math::Ray;
use tenfold_spectrum::SampledSpectrum;

/// A path under way: where it goes next and what it has gathered on its way.
///
/// The path so far has been drawn with the density of its hero. By spectral multiple importance sampling (Wilkie et al.
/// 2014) it stands for all its lanes: `ratio` holds, per lane, the density with which that lane as hero
/// would have drawn it over the density with which the true hero has, so that the balance heuristic divides
/// `beta` by the mean of `ratio`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Path {
    pub(super) ray: Ray,
    pub(super) lanes: Lanes,
    /// Product of f·|cos| over the hero's densities.
    pub(super) beta: SampledSpectrum,
    /// Per lane: density of the path over the hero's.
    pub(super) ratio: SampledSpectrum,
    /// Surfaces met, interfaces not counted.
    pub(super) bounce: u16,
    /// Product of the squared relative indices of refraction: what radiance lost by entering dense media and
    /// will win back on leaving (Walter et al. 2007).
    pub(super) eta_scale: f32,
    /// How the path could also have reached a light that it now meets.
    pub(super) arrival: Arrival,
}

/// How the last vertex was left.
#[derive(Copy, Clone, Debug)]
pub(super) enum Arrival {
    /// From the camera or a specular bounce: no light sample could have done it.
    Specular,
    /// From a bounce at `from`, where a light has been sampled too. `light_ratio` is, per lane, `ratio` with the
    /// last direction's density left out: times the light's density it is that of the other strategy.
    Scattered { from: ReferencePoint, light_ratio: SampledSpectrum },
}

impl Path {
    /// A path that starts at the camera.
    #[inline]
    pub(super) fn from_camera(ray: Ray) -> Self {
        Self {
            ray,
            lanes: Lanes::ALL,
            beta: SampledSpectrum::ONE,
            ratio: SampledSpectrum::ONE,
            bounce: 0,
            eta_scale: 1.0,
            arrival: Arrival::Specular,
        }
    }

    /// What the path carries back of the light `emitted` where it now is, weighed against a light sampled at its last vertex;
    /// `light_pdf` is the density with which that vertex samples this light in this direction.
    #[inline]
    pub(super) fn carried(
        &self,
        combine: CombineStrategy,
        emitted: SampledSpectrum,
        light_pdf: impl FnOnce(&ReferencePoint) -> f32,
    ) -> SampledSpectrum {
        let density = self.lanes.mean(self.ratio);
        let density = match &self.arrival {
            Arrival::Specular => density,
            Arrival::Scattered { from, light_ratio } => {
                let light_pdf = light_pdf(from);
                match combine {
                    CombineStrategy::Mis => {
                        let light_density = self.lanes.mean(*light_ratio) * light_pdf;
                        density + light_density * (light_density / density)
                    }
                    CombineStrategy::LightOnly if light_pdf > 0.0 => return SampledSpectrum::ZERO,
                    CombineStrategy::LightOnly | CombineStrategy::BsdfOnly => density,
                }
            }
        };
        self.beta * emitted / density
    }

    /// Per lane, the density by which to divide light that was sampled at the vertex where the path is, weighed against a
    /// scattered direction that meets it by itself with density `scatter_pdf`; `None` where the latter alone counts. Where lanes part
    /// (`parts`) each weighs its own densities, otherwise all weigh those of all.
    #[inline]
    pub(super) fn density_of_sampled(
        &self,
        combine: CombineStrategy,
        light: &LightSample,
        scatter_pdf: SampledSpectrum,
        parts: bool,
    ) -> Option<SampledSpectrum> {
        let all = |x: SampledSpectrum| if parts { x } else { SampledSpectrum::splat(self.lanes.mean(x)) };
        let density = all(self.ratio * light.pdf);
        match combine {
            CombineStrategy::Mis if !light.delta => {
                let scattered = all(self.ratio * scatter_pdf);
                Some(density + scattered * scattered.safe_div(density))
            }
            CombineStrategy::BsdfOnly if !light.delta => None,
            _ => Some(density),
        }
    }

    /// Settles the spectral weights of the path so far, so that from here lanes may part.
    #[inline]
    pub(super) fn settle(&mut self) {
        self.beta /= self.lanes.mean(self.ratio);
        self.ratio = self.lanes.mask();
    }

    /// The part of a settled path that goes on with other `lanes`.
    #[inline]
    pub(super) fn with_lanes(&self, lanes: Lanes) -> Self {
        Self { lanes, beta: self.beta * lanes.mask(), ratio: lanes.mask(), ..*self }
    }
}
