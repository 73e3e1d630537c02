use tenfold_spectrum::SampledSpectrum;

use super::{Point, Roughness};
use crate::{bxdf, texture::SpectrumSlot};

/// The optical constants of a metal.
#[derive(Clone, Debug)]
pub enum Metal {
    /// The complex index of refraction, `eta + i k`.
    Index {
        /// Its real part.
        eta: SpectrumSlot,
        /// Its imaginary part.
        k: SpectrumSlot,
    },
    /// Any metal that reflects this fraction of the light that meets it straight.
    Reflectance(SpectrumSlot),
}

/// A metal.
#[derive(Clone, Debug)]
pub struct Conductor {
    /// Of which.
    pub metal: Metal,
    /// How rough.
    pub roughness: Roughness,
}

/// A complex index of refraction at the wavelengths of a path.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct ComplexIndex {
    pub(super) eta: SampledSpectrum,
    pub(super) k: SampledSpectrum,
}

impl Metal {
    /// Whether it varies over a surface.
    pub(super) fn is_textured(&self) -> bool {
        match self {
            Self::Index { eta, k } => eta.constant().and(k.constant()).is_none(),
            Self::Reflectance(r) => r.constant().is_none(),
        }
    }

    /// The index at a point.
    #[inline]
    pub(super) fn index(&self, at: &Point<'_>) -> ComplexIndex {
        match self {
            Self::Index { eta, k } => ComplexIndex { eta: at.spectrum(eta), k: at.spectrum(k) },
            Self::Reflectance(r) => {
                // With a real part of 1, r = k² / (4 + k²) at normal incidence.
                let r = at.spectrum(r).clamp(0.0, 0.9999);
                ComplexIndex { eta: SampledSpectrum::ONE, k: 2.0 * (r / (1.0 - r)).sqrt() }
            }
        }
    }
}

impl Conductor {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> bxdf::Conductor {
        let ComplexIndex { eta, k } = self.metal.index(at);
        bxdf::Conductor::new(eta, k, at.distribution(&self.roughness))
    }

    /// The same where it is rough.
    #[inline]
    pub(super) fn rough(&self, at: &Point<'_>) -> Option<bxdf::Conductor> {
        let distribution = at.distribution(&self.roughness);
        if distribution.effectively_smooth() {
            return None;
        }
        let ComplexIndex { eta, k } = self.metal.index(at);
        Some(bxdf::Conductor::new(eta, k, distribution))
    }
}
