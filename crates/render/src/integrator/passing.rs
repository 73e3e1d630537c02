//! Surfaces that rays may pass.

use super::PathTracer;
use crate::texture::TextureContext;
use tenfold_geometry::{Candidate, Hit};
use tenfold_math::Ray;
use tenfold_sampling::{Dimension, PixelSample, Variable, hash};

impl PathTracer<'_> {
    /// Whether a ray stops at a primitive that may let rays pass: it does not at the holes of an alpha mask.
    #[inline]
    pub(super) fn stops(&self, ray: &Ray, candidate: &Candidate<'_>, chance: Chance<'_>) -> bool {
        let scene = self.scene;
        let surface = &scene.surfaces[candidate.user as usize];
        let Some(alpha) = &surface.alpha else { return true };
        let hit = scene.world.interaction(ray, &candidate.hit);
        let a = scene.textures.float(alpha, &TextureContext::at(&hit));
        if a >= 1.0 {
            return true;
        }
        if a <= 0.0 {
            return false;
        }
        chance.of(&candidate.hit) < a
    }
}

/// Decides whether rays that leave a vertex stop at surfaces that are partly there: at each by a number of its own, which is the
/// same whenever the traversal asks.
#[derive(Copy, Clone)]
pub(super) struct Chance<'a> {
    pub(super) sampler: &'a PixelSample<'a>,
    pub(super) bounce: u16,
}

impl Chance<'_> {
    /// The number, in `[0, 1)`, of a surface that is hit.
    fn of(self, hit: &Hit) -> f32 {
        if let Some(value) = self.sampler.held(Variable::Alpha) {
            return value.x;
        }
        let seed = self.sampler.hash(Dimension::alpha(self.bounce));
        let id = hit.primitive;
        let place = u64::from(hit.t.to_bits()) << 32 | u64::from(id.index);
        let bits = hash::combine(hash::combine(seed, place), id.geometry.index() as u64);
        hash::unit_f32(bits as u32)
    }
}
