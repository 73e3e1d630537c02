//! What lights infinitely far away weigh in the choice among all.

use std::f32::consts::PI;
use tenfold_geometry::ReferencePoint;
use tenfold_math::Vec3;

/// The irradiance that light from infinitely far makes on surfaces, averaged over the visible wavelengths.
#[derive(Copy, Clone, Debug)]
pub(super) enum FarIrradiance {
    /// Of light from one unit direction, on a surface turned toward it.
    Parallel { irradiance: f32, direction: Vec3 },
    /// Of light from many directions: the mean over all orientations of a surface, and the mean of the directions, weighted by radiance.
    Around { mean: f32, toward: Vec3 },
}

/// The least weight of light from many directions, by the orientation of a surface.
const LEAST: f32 = 0.1;

impl FarIrradiance {
    /// Of light from many directions, of the mean radiance `radiance`, with the mean direction `toward`.
    pub(super) fn around(radiance: f32, toward: Vec3) -> Self {
        Self::Around { mean: PI * radiance, toward }
    }

    /// Whether there is any light.
    pub(super) fn is_some(self) -> bool {
        let (Self::Parallel { irradiance: amount, .. } | Self::Around { mean: amount, .. }) = self;
        amount > 0.0
    }

    /// An estimate at `from`, comparable to that of the light tree, and 0 only where no light arrives that matters; on a
    /// surface turned toward the light where there is none. Of light from many directions it is what the first two bands of spherical
    /// harmonics tell, in which the clamped cosine is ¼ + ½ cos (Ramamoorthi and Hanrahan 2001).
    #[inline]
    pub(super) fn at(&self, from: &ReferencePoint) -> f32 {
        match *self {
            Self::Parallel { irradiance, .. } if from.ns == Vec3::ZERO => irradiance,
            Self::Parallel { irradiance, direction } => irradiance * from.cosine(direction),
            Self::Around { mean, toward } if from.one_sided => {
                mean * (1.0 + 2.0 * from.ns.dot(toward)).max(LEAST)
            }
            Self::Around { mean, .. } => 2.0 * mean,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(ns: Vec3, one_sided: bool) -> ReferencePoint {
        ReferencePoint { n: ns, ns, one_sided, ..ReferencePoint::free(Vec3::ZERO, 0.0) }
    }

    #[test]
    fn parallel_light_goes_by_the_cosine() {
        let light = FarIrradiance::Parallel { irradiance: 3.0, direction: Vec3::Z };
        let slanted = Vec3::new(0.6, 0.0, -0.8);
        assert_eq!(light.at(&on(Vec3::Z, true)), 3.0);
        assert_eq!(light.at(&on(slanted, true)), 0.0);
        assert!((light.at(&on(slanted, false)) - 2.4).abs() < 1e-6);
        assert_eq!(light.at(&on(Vec3::ZERO, false)), 3.0);
    }

    /// A dome, and a whole sky: the first two bands are all there is to them.
    #[test]
    fn light_from_many_directions_goes_by_their_mean() {
        // Radiance 1 above, none below: its mean is ½, and the mean of its directions ½ z.
        let dome = FarIrradiance::around(0.5, 0.5 * Vec3::Z);
        assert!((dome.at(&on(Vec3::Z, true)) - PI).abs() < 1e-6);
        assert!((dome.at(&on(Vec3::X, true)) - 0.5 * PI).abs() < 1e-6);
        assert!(dome.at(&on(Vec3::NEG_Z, true)) > 0.0);
        let sky = FarIrradiance::around(1.0, Vec3::ZERO);
        assert!((sky.at(&on(Vec3::X, true)) - PI).abs() < 1e-6);
        assert!((sky.at(&on(Vec3::X, false)) - 2.0 * PI).abs() < 1e-6);
    }
}
