use super::{Eta, Point, Roughness};
use crate::bxdf;

/// Glass, water: what reflects and refracts.
#[derive(Clone, Debug)]
pub struct Dielectric {
    /// Its index of refraction.
    pub eta: Eta,
    /// How rough it is.
    pub roughness: Roughness,
}

impl Dielectric {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> bxdf::Dielectric {
        bxdf::Dielectric::new(self.eta.sample(at.waves.indices), at.distribution(&self.roughness))
    }
}

/// A pane too thin to displace what is seen through it.
#[derive(Clone, Debug)]
pub struct ThinDielectric {
    /// Its index of refraction.
    pub eta: Eta,
}

impl ThinDielectric {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> bxdf::ThinDielectric {
        bxdf::ThinDielectric::new(self.eta.sample(at.waves.indices))
    }
}
