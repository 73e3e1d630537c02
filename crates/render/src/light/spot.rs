//! A light at a point that shines into a cone.

use super::point::Toward;
use super::{Emission, LightBounds, LightSample};
use std::f32::consts::TAU;
use tenfold_geometry::{NormalCone, ReferencePoint};
use tenfold_math::ops;
use tenfold_math::{Transform, Vec3, sqr};
use tenfold_spectrum::SampledWavelengths;

/// A spot light: full intensity within an inner cone, none beyond an outer one, a smooth step of the cosine between
/// (pbrt book, 4th edition, section 12.2.1).
#[derive(Clone, Debug)]
pub struct SpotLight {
    position: Vec3,
    axis: Vec3,
    /// From the world to the space in which the cone is round around z.
    light_from_world: Transform,
    intensity: Emission,
    cos_start: f32,
    cos_end: f32,
}

impl SpotLight {
    /// A spot light at the origin of the space `world_from_light`, along its z axis, with the intensity
    /// given, in W·sr⁻¹·nm⁻¹, up to the angle `start` from the axis and none from the angle `end` on; both in
    /// radians, `0 ≤ start ≤ end ≤ π`.
    pub fn new(world_from_light: &Transform, intensity: Emission, start: f32, end: f32) -> Self {
        Self {
            position: world_from_light.point(Vec3::ZERO),
            axis: world_from_light.vector(Vec3::Z).normalize_or(Vec3::Z),
            light_from_world: world_from_light.inverse(),
            intensity,
            cos_start: ops::cos(start),
            cos_end: ops::cos(end),
        }
    }

    /// ∫ of the falloff over the sphere, in steradians: the power of a light with intensity 1 (pbrt book, 4th
    /// edition, section 12.2.1). Angles in radians.
    pub fn measure(start: f32, end: f32) -> f32 {
        TAU * ((1.0 - ops::cos(start)) + (ops::cos(start) - ops::cos(end)) / 2.0)
    }

    /// Part of the intensity in a direction with this cosine to the axis.
    #[inline]
    fn falloff(&self, cos: f32) -> f32 {
        if cos >= self.cos_start {
            1.0
        } else if cos <= self.cos_end {
            0.0
        } else {
            let t = (cos - self.cos_end) / (self.cos_start - self.cos_end);
            sqr(t) * (3.0 - 2.0 * t)
        }
    }

    pub(super) fn bounds(&self) -> LightBounds {
        // Transforms with unequal scales make an elliptic cone, which may be wider.
        let cone = if self.is_round() {
            NormalCone { axis: self.axis, cos_theta: self.cos_end }
        } else {
            NormalCone::EVERYWHERE
        };
        LightBounds::point(self.position, cone, self.intensity.visible_mean())
    }

    fn is_round(&self) -> bool {
        is_similarity(&self.light_from_world)
    }

    #[inline]
    pub(super) fn sample(&self, from: &ReferencePoint, w: &SampledWavelengths) -> Option<LightSample> {
        let toward = Toward::new(from, self.position)?;
        let falloff = self.falloff(self.light_from_world.vector(-toward.wi).normalize().z);
        (falloff > 0.0).then(|| toward.sample(falloff * self.intensity.sample(w)))
    }
}

/// Whether a map keeps angles, up to rounding.
pub(crate) fn is_similarity(t: &Transform) -> bool {
    let (x, y, z) = (t.vector(Vec3::X), t.vector(Vec3::Y), t.vector(Vec3::Z));
    let size = x.length_squared();
    let near = |a: f32, b: f32| (a - b).abs() <= 1e-4 * size;
    near(y.length_squared(), size)
        && near(z.length_squared(), size)
        && near(x.dot(y), 0.0)
        && near(y.dot(z), 0.0)
        && near(z.dot(x), 0.0)
}
