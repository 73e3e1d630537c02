use super::Point;
use crate::{bxdf, texture::SpectrumSlot};

/// Scatters evenly back.
#[derive(Clone, Debug)]
pub struct Diffuse {
    /// The fraction of light scattered.
    pub reflectance: SpectrumSlot,
}

impl Diffuse {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> bxdf::Diffuse {
        bxdf::Diffuse::new(at.albedo(&self.reflectance))
    }
}

/// Scatters evenly to both sides.
#[derive(Clone, Debug)]
pub struct DiffuseTransmission {
    /// The fraction of light scattered back.
    pub reflectance: SpectrumSlot,
    /// The fraction of light scattered through.
    pub transmittance: SpectrumSlot,
    /// Factor on both.
    pub scale: f32,
}

impl DiffuseTransmission {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> bxdf::DiffuseTransmission {
        let fraction = |slot: &SpectrumSlot| (self.scale * at.spectrum(slot)).clamp(0.0, 1.0);
        bxdf::DiffuseTransmission::new(fraction(&self.reflectance), fraction(&self.transmittance))
    }
}
