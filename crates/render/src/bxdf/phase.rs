use std::f32::consts::{FRAC_1_PI, TAU};

use tenfold_math::{Frame, Vec2, Vec3, spherical_direction};

/// The phase function of Henyey and Greenstein 1941.
#[derive(Copy, Clone, Debug)]
pub(crate) struct HenyeyGreenstein {
    g: f32,
}

impl HenyeyGreenstein {
    /// Of mean cosine `g` between the directions of travel, kept inside `(-1, 1)`; positive scatters forward.
    #[inline]
    pub(crate) fn new(g: f32) -> Self {
        Self { g: g.clamp(-0.999, 0.999) }
    }

    /// Density in solid angle of scattering to `wi`; both directions point away from the point.
    #[inline]
    pub(crate) fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let g = self.g;
        let d = 1.0 + g * g + 2.0 * g * wo.dot(wi);
        0.25 * FRAC_1_PI * (1.0 - g * g) / (d * d.max(0.0).sqrt())
    }

    /// Samples [`HenyeyGreenstein::density`] exactly (pbrt book, eq. 11.14).
    #[inline]
    pub(crate) fn sample(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let g = self.g;
        let cos = if g.abs() < 1e-3 {
            1.0 - 2.0 * u.x
        } else {
            let q = (1.0 - g * g) / (1.0 + g - 2.0 * g * u.x);
            -(1.0 + g * g - q * q) / (2.0 * g)
        };
        let cos = cos.clamp(-1.0, 1.0);
        let local = spherical_direction((1.0 - cos * cos).max(0.0).sqrt(), cos, TAU * u.y);
        Frame::from_z(wo).to_world(local)
    }
}
