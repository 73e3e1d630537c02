//! The same radiance from every direction, infinitely far away.

use super::{Emission, LightSample, LightStrategy, ShadowTarget};
use tenfold_geometry::ReferencePoint;
use tenfold_math::{Frame, ONE_MINUS_EPSILON, Vec2, Vec3};
use tenfold_sampling::warp::{
    cosine_hemisphere_pdf, sample_cosine_hemisphere, sample_uniform_sphere, uniform_sphere_pdf,
};
use tenfold_spectrum::SampledWavelengths;

/// A uniform sky.
#[derive(Clone, Debug)]
pub struct UniformInfinite {
    /// Its radiance, in W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Emission,
}

impl UniformInfinite {
    #[inline]
    pub(super) fn sample(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> LightSample {
        let wi = if by_cosine(strategy, from) {
            let (u, side) = if from.one_sided { (u, 1.0) } else { halve(u) };
            side * Frame::from_z(from.ns).to_world(sample_cosine_hemisphere(u))
        } else {
            sample_uniform_sphere(u)
        };
        LightSample {
            radiance: self.radiance.sample(w),
            wi,
            target: ShadowTarget::Infinity,
            pdf: self.pdf(strategy, from, wi),
            delta: false,
        }
    }

    #[inline]
    pub(super) fn pdf(&self, strategy: LightStrategy, from: &ReferencePoint, direction: Vec3) -> f32 {
        if !by_cosine(strategy, from) {
            return uniform_sphere_pdf();
        }
        let pdf = cosine_hemisphere_pdf(from.cosine(direction));
        if from.one_sided { pdf } else { 0.5 * pdf }
    }
}

/// Surfaces are lit in proportion to the cosine, so that is how directions are drawn for them.
#[inline]
fn by_cosine(strategy: LightStrategy, from: &ReferencePoint) -> bool {
    strategy != LightStrategy::UniformArea && from.ns != Vec3::ZERO
}

/// A side of the surface, and numbers for a direction on it.
#[inline]
fn halve(u: Vec2) -> (Vec2, f32) {
    let doubled = 2.0 * u.x;
    if doubled < 1.0 {
        (Vec2::new(doubled, u.y), 1.0)
    } else {
        (Vec2::new((doubled - 1.0).min(ONE_MINUS_EPSILON), u.y), -1.0)
    }
}
