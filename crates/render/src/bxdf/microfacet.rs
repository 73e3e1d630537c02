use std::f32::consts::{FRAC_1_PI, TAU};
use tenfold_math::ops;

use tenfold_math::{Vec2, Vec3};

use super::local::{either, same_hemisphere};

/// Least α: the distribution is no narrower than this in either direction unless it is smooth in both.
const ALPHA_MIN: f32 = 1e-4;
/// Below this α the surface counts as a perfect mirror.
const ALPHA_SMOOTH: f32 = 1e-3;

/// The anisotropic microfacet distribution of Trowbridge and Reitz 1975, named GGX by Walter et al. 2007.
///
/// Directions are local; a direction below the surface is taken with the distribution's mirror image, so
/// only `|z|` matters.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TrowbridgeReitz {
    alpha_x: f32,
    alpha_y: f32,
}

/// Reflection of one direction to another by microfacets that are perfect mirrors; all 0 where none reflects so.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Mirror {
    /// Cosine between either direction and the normal of these microfacets.
    pub(crate) cos: f32,
    /// The BRDF: `D G₂ / (4 cos θo cos θi)`.
    pub(crate) value: f32,
    /// Density in solid angle of reflection about visible normals.
    pub(crate) pdf: f32,
}

impl TrowbridgeReitz {
    /// A distribution with root-mean-square-like slopes `alpha_x`, `alpha_y` along the axes; not negative.
    #[inline]
    pub fn new(alpha_x: f32, alpha_y: f32) -> Self {
        if alpha_x.max(alpha_y) < ALPHA_SMOOTH {
            Self { alpha_x: 0.0, alpha_y: 0.0 }
        } else {
            Self { alpha_x: alpha_x.max(ALPHA_MIN), alpha_y: alpha_y.max(ALPHA_MIN) }
        }
    }

    /// The distribution of a mirror.
    pub const SMOOTH: Self = Self { alpha_x: 0.0, alpha_y: 0.0 };

    /// pbrt-v4's mapping of a perceived roughness in `[0, 1]` to α: its square root.
    #[inline]
    pub fn roughness_to_alpha(roughness: f32) -> f32 {
        roughness.max(0.0).sqrt()
    }

    /// Whether the surface is treated as a perfect mirror; then no other method may be called.
    #[inline]
    pub fn effectively_smooth(&self) -> bool {
        self.alpha_x == 0.0
    }

    /// α along x, 0 where the surface is effectively smooth.
    #[inline]
    pub fn alpha_x(&self) -> f32 {
        self.alpha_x
    }

    /// α along y, 0 where the surface is effectively smooth.
    #[inline]
    pub fn alpha_y(&self) -> f32 {
        self.alpha_y
    }

    /// Density of microfacet normals D, per steradian and per area of the macrosurface (pbrt book, eq. 9.16).
    #[inline(always)]
    pub fn d(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.alpha_x, m.y / self.alpha_y);
        let e = x * x + y * y + m.z * m.z;
        FRAC_1_PI / (self.alpha_x * self.alpha_y * e * e)
    }

    /// `|cos θ| · (1 + 2 Λ(w))`, the length of `w` after stretching: Λ without its pole at the horizon.
    #[inline(always)]
    pub(crate) fn stretched(&self, w: Vec3) -> f32 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        (w.z * w.z + x * x + y * y).sqrt()
    }

    /// Smith's Λ: masked over visible area of microfacets (pbrt book, eq. 9.20). Infinite at the horizon.
    #[inline(always)]
    pub fn lambda(&self, w: Vec3) -> f32 {
        0.5 * (self.stretched(w) / w.z.abs() - 1.0)
    }

    /// Smith's masking G₁: the visible fraction of microfacet area from `w`.
    #[inline(always)]
    pub fn g1(&self, w: Vec3) -> f32 {
        2.0 * w.z.abs() / (w.z.abs() + self.stretched(w))
    }

    /// Height-correlated masking and shadowing G₂ = 1 / (1 + Λ(wo) + Λ(wi)) (Heitz 2014, eq. 99), also for a
    /// transmission, as in pbrt-v4.
    #[inline(always)]
    pub fn g2(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (zo, zi) = (wo.z.abs(), wi.z.abs());
        2.0 * zo * zi / (zo * self.stretched(wi) + zi * self.stretched(wo))
    }

    /// `D(m) · G₂(wo, wi) / (4 |cos θo cos θi|)`, finite also at the horizon.
    #[inline(always)]
    pub(crate) fn d_g2_over_4_cos_cos(&self, m: Vec3, wo: Vec3, wi: Vec3) -> f32 {
        let sum = wo.z.abs() * self.stretched(wi) + wi.z.abs() * self.stretched(wo);
        if sum > 0.0 { 0.5 * self.d(m) / sum } else { 0.0 }
    }

    /// Density of the normals visible from `wo`, per steradian of `m` (Heitz 2014, eq. 16).
    #[inline(always)]
    pub fn visible_pdf(&self, wo: Vec3, m: Vec3) -> f32 {
        2.0 * self.d(m) * wo.dot(m).abs() / (wo.z.abs() + self.stretched(wo))
    }

    /// Reflection by microfacets that are perfect mirrors.
    #[inline(always)]
    pub(crate) fn mirror(&self, wo: Vec3, wi: Vec3) -> Mirror {
        let half = wo + wi;
        let length = half.length_squared().sqrt();
        let m = half / length;
        let cos = wo.dot(m);
        let exists = same_hemisphere(wo, wi) & (length > 0.0);
        let of = |x: f32| if exists { x } else { 0.0 };
        Mirror {
            cos: of(cos),
            value: of(self.d_g2_over_4_cos_cos(m, wo, wi)),
            pdf: of(self.visible_pdf(wo, m) / (4.0 * cos.abs())),
        }
    }

    /// Samples a normal with [`TrowbridgeReitz::visible_pdf`], on the side of `wo`: in the space where the surface
    /// is a hemisphere, reflected directions are uniform on a spherical cap (Dupuy and Benyoub 2023, listing 3). The very
    /// middle of the square, which chance does not hit, is sent to that of the lobe, for who freezes directions there.
    #[inline(always)]
    pub fn sample_visible(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let sign = 1f32.copysign(wo.z);
        let w = Vec3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z) * sign;
        let w = w / w.length_squared().sqrt();
        // 1 - cos θ of the cap's point, so that nothing cancels near the pole and h.z cannot be negative.
        let t = u.y * (1.0 + w.z);
        let sin = (t * (2.0 - t)).max(0.0).sqrt();
        let (s, c) = ops::sin_cos_of_moderate(TAU * u.x);
        let h = Vec3::new(sin * c + w.x, sin * s + w.y, (1.0 - u.y) * (1.0 + w.z));
        let m = Vec3::new(h.x * self.alpha_x, h.y * self.alpha_y, h.z);
        let scale = 1.0 / m.length_squared().sqrt();
        let is_usable = (scale > 0.0) & (scale < f32::INFINITY);
        let is_middle = (u.x == 0.5) & (u.y == 0.5);
        either(is_usable & !is_middle, m * scale, Vec3::Z) * sign
    }
}
