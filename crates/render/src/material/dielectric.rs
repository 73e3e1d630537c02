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

    /// The boundary where it is rough, if nothing disperses.
    #[inline]
    pub(super) fn rough(&self, at: &Point<'_>) -> Option<bxdf::Interface> {
        let interface = bxdf::Interface::new(self.eta.constant()?, at.distribution(&self.roughness));
        (!interface.is_smooth()).then_some(interface)
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
