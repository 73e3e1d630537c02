//! A light at a point whose intensity is measured over all directions.

use super::point::Toward;
use super::{Emission, LightBounds, LightSample};
use tenfold_geometry::{NormalCone, ReferencePoint};
use tenfold_math::{Transform, Vec2, Vec3, equal_area_sphere_to_square};
use tenfold_spectrum::SampledWavelengths;

/// A point light with a map of its intensity over the sphere of directions.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    position: Vec3,
    light_from_world: Transform,
    intensity: Emission,
    /// Factors, by the equal-area octahedral map, `side × side`.
    factors: Vec<f32>,
    side: usize,
}

impl GoniometricLight {
    /// A light at the origin of the space `world_from_light`; its intensity, in W·sr⁻¹·nm⁻¹, in a direction
    /// of that space is `intensity` times the factor that the equal-area octahedral map finds among
    /// `factors`, `side × side` of them, rows from the top.
    pub fn new(world_from_light: &Transform, intensity: Emission, factors: Vec<f32>, side: usize) -> Self {
        debug_assert!(side > 0 && factors.len() == side * side);
        Self {
            position: world_from_light.point(Vec3::ZERO),
            light_from_world: world_from_light.inverse(),
            intensity,
            factors,
            side,
        }
    }

    #[inline]
    fn factor(&self, direction: Vec3) -> f32 {
        let Vec2 { x, y } = equal_area_sphere_to_square(direction) * self.side as f32;
        let last = self.side - 1;
        self.factors[(y as usize).min(last) * self.side + (x as usize).min(last)]
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let mean = self.factors.iter().map(|&f| f64::from(f)).sum::<f64>() / self.factors.len() as f64;
        let intensity = self.intensity.visible_mean() * mean as f32;
        LightBounds::point(self.position, NormalCone::EVERYWHERE, intensity)
    }

    #[inline]
    pub(super) fn sample(&self, from: &ReferencePoint, w: &SampledWavelengths) -> Option<LightSample> {
        let toward = Toward::new(from, self.position)?;
        let factor = self.factor(self.light_from_world.vector(-toward.wi).normalize());
        (factor > 0.0).then(|| toward.sample(factor * self.intensity.sample(w)))
    }
}
