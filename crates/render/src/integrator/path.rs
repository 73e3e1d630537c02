use super::{CombineStrategy, spectral::Lanes};
use tenfold_geometry::ReferencePoint;
use tenfold_math::Ray;
use tenfold_spectrum::SampledSpectrum;

/// A path under way: what it carries.
///
/// The path so far has been drawn with the density of its hero. By spectral multiple importance sampling (Wilkie et al.
/// 2014) it stands for all its lanes: `ratio` holds, per lane, the density with which that lane as hero
/// would have drawn it over the density with which the true hero has, so that the balance heuristic divides
/// `beta` by the mean of `ratio`.
#[derive(Copy, Clone, Debug)]
pub(super) struct Path {
    /// Which of the samples that are traced together it belongs to.
    pub(super) sample: usize,
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
    /// From a bounce where a light has been sampled too. `light_ratio` is, per lane, `ratio` with the
    /// last direction's density left out: times the light's density it is that of the other strategy.
    Scattered { light_ratio: SampledSpectrum },
}

/// A path that waits for its turn.
#[derive(Copy, Clone, Debug)]
pub(super) struct Waiting {
    pub(super) path: Path,
    /// Where it goes next.
    pub(super) ray: Ray,
    /// The vertex that it leaves.
    pub(super) from: ReferencePoint,
}

impl Path {
    /// The path of a sample that starts at the camera.
    #[inline]
    pub(super) fn from_camera(sample: usize) -> Self {
        Self {
            sample,
            lanes: Lanes::ALL,
            beta: SampledSpectrum::ONE,
            ratio: SampledSpectrum::ONE,
            bounce: 0,
            eta_scale: 1.0,
            arrival: Arrival::Specular,
        }
    }

    /// What the path carries back of the light `emitted` where it now is, weighed against a light sampled at its last vertex;
    /// `light_pdf` is the density with which it samples this light in this direction.
    #[inline]
    pub(super) fn carried(
        &self,
        combine: CombineStrategy,
        emitted: SampledSpectrum,
        light_pdf: impl FnOnce() -> f32,
    ) -> SampledSpectrum {
        let density = self.lanes.mean(self.ratio);
        let density = match &self.arrival {
            Arrival::Specular => density,
            Arrival::Scattered { light_ratio } => {
                let light_pdf = light_pdf();
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

    /// Per lane, the density by which to divide light that was sampled with the density `light_pdf` at the vertex where the path is, weighed
    /// against a scattered direction that meets it by itself with density `scatter_pdf`, which it does not where it is a `delta`; `None` where the latter alone counts. Where lanes part
    /// (`parts`) each weighs its own densities, otherwise all weigh those of all.
    #[inline]
    pub(super) fn density_of_sampled(
        &self,
        combine: CombineStrategy,
        light_pdf: f32,
        delta: bool,
        scatter_pdf: SampledSpectrum,
        parts: bool,
    ) -> Option<SampledSpectrum> {
        let all = |x: SampledSpectrum| if parts { x } else { SampledSpectrum::splat(self.lanes.mean(x)) };
        let density = all(self.ratio * light_pdf);
        match combine {
            CombineStrategy::Mis if !delta => {
                let scattered = all(self.ratio * scatter_pdf);
                Some(density + scattered * scattered.safe_div(density))
            }
            CombineStrategy::BsdfOnly if !delta => None,
            _ => Some(density),
        }
    }

    /// Weighs in a scattered direction with the value `f`, the absolute cosine `cos` and the densities `pdf` per lane; false where nothing is left
    /// to carry.
    #[inline]
    pub(super) fn advance(
        &mut self,
        f: SampledSpectrum,
        cos: f32,
        pdf: SampledSpectrum,
        specular: bool,
    ) -> bool {
        let hero_pdf = pdf.lane(self.lanes.hero());
        self.beta = self.beta * f * (cos / hero_pdf);
        self.arrival = match specular {
            true => Arrival::Specular,
            false => Arrival::Scattered { light_ratio: self.ratio / hero_pdf },
        };
        self.ratio = self.ratio * pdf / hero_pdf;
        !self.beta.is_black()
    }

    /// Leaves a vertex for a medium with the relative index of refraction `eta`.
    #[inline]
    pub(super) fn leave(&mut self, eta: f32) {
        self.eta_scale *= eta * eta;
        self.bounce += 1;
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
