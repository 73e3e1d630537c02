//! A light at a point that shines evenly in all directions.

use super::{Emission, LightBounds, LightSample, ShadowTarget};
use tenfold_geometry::{NormalCone, ReferencePoint};
use tenfold_math::Vec3;
use tenfold_spectrum::SampledWavelengths;

/// An isotropic point light.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Where it is.
    pub position: Vec3,
    /// Its radiant intensity, in W·sr⁻¹·nm⁻¹.
    pub intensity: Emission,
}

impl PointLight {
    pub(super) fn bounds(&self) -> LightBounds {
        LightBounds::point(self.position, NormalCone::EVERYWHERE, self.intensity.visible_mean())
    }

    #[inline]
    pub(super) fn sample(&self, from: &ReferencePoint, w: &SampledWavelengths) -> Option<LightSample> {
        let toward = Toward::new(from, self.position)?;
        Some(toward.sample(self.intensity.sample(w)))
    }
}

/// A light's position as a point sees it.
#[derive(Copy, Clone, Debug)]
pub(super) struct Toward {
    /// Unit direction to the light.
    pub(super) wi: Vec3,
    position: Vec3,
    distance_squared: f32,
}

impl Toward {
    /// `None` at the very position of the light.
    #[inline]
    pub(super) fn new(from: &ReferencePoint, position: Vec3) -> Option<Self> {
        let d = position - from.p;
        let distance_squared = d.length_squared();
        (distance_squared > 0.0).then(|| Self { wi: d / distance_squared.sqrt(), position, distance_squared })
    }

    /// The sample of a light that has this `intensity` toward the point.
    #[inline]
    pub(super) fn sample(&self, intensity: tenfold_spectrum::SampledSpectrum) -> LightSample {
        LightSample {
            radiance: intensity / self.distance_squared,
            wi: self.wi,
            target: ShadowTarget::Point(self.position),
            pdf: 1.0,
            delta: true,
        }
    }
}
