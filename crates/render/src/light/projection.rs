//! A light at a point that throws an image.

use super::point::Toward;
use super::radiance_image::{RadianceImage, weighted_rgb};
use super::spot::is_similarity;
use super::{LightBounds, LightSample};
use tenfold_geometry::{NormalCone, ReferencePoint};
use tenfold_image::Image;
use tenfold_math::ops;
use tenfold_math::{Transform, Vec2, Vec3};
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

/// The pyramid of directions through a screen at distance 1 along +z (pbrt book, 4th edition, section 12.2.2).
#[derive(Copy, Clone, Debug)]
pub struct Screen {
    /// Half the width and half the height; the top of the image is at positive y.
    half: Vec2,
}

/// Least cosine to the axis of a direction that counts: pbrt-v4's near plane.
const NEAR: f32 = 1e-3;

impl Screen {
    /// The screen for an image of `width × height` pixels whose shorter side is seen under the angle `fov`,
    /// in radians.
    pub fn new(width: u32, height: u32, fov: f32) -> Self {
        let aspect = width as f32 / height as f32;
        let shape = if aspect > 1.0 { Vec2::new(aspect, 1.0) } else { Vec2::new(1.0, 1.0 / aspect) };
        Self { half: shape * ops::tan(0.5 * fov) }
    }

    /// Image coordinates of a unit direction.
    #[inline]
    fn project(&self, w: Vec3) -> Option<Vec2> {
        if w.z < NEAR {
            return None;
        }
        let st = (Vec2::new(w.x, -w.y) / (w.z * self.half) + Vec2::ONE) * 0.5;
        (st.cmpge(Vec2::ZERO).all() && st.cmple(Vec2::ONE).all()).then_some(st)
    }

    /// The unit direction through image coordinates.
    fn direction(&self, st: Vec2) -> Vec3 {
        let p = (2.0 * st - Vec2::ONE) * self.half;
        Vec3::new(p.x, -p.y, 1.0).normalize()
    }

    /// ∫ of the image's colour over the solid angle, in steradians: the power of a light whose intensity is
    /// the image.
    pub fn measure(&self, image: &Image) -> Vec3 {
        let area = 4.0 * self.half.x * self.half.y;
        // dω = cos³θ dA at distance 1.
        area * weighted_rgb(image, |st| self.direction(st).z.powi(3))
    }
}

/// A projector.
#[derive(Clone, Debug)]
pub struct ProjectionLight {
    position: Vec3,
    axis: Vec3,
    light_from_world: Transform,
    screen: Screen,
    image: RadianceImage,
    scale: f32,
}

impl ProjectionLight {
    /// A projector at the origin of the space `world_from_light`, looking along its z axis with the top of
    /// the image toward y. Its radiant intensity, in W·sr⁻¹·nm⁻¹, is `scale` times the image.
    pub fn new(world_from_light: &Transform, screen: Screen, image: RadianceImage, scale: f32) -> Self {
        Self {
            position: world_from_light.point(Vec3::ZERO),
            axis: world_from_light.vector(Vec3::Z).normalize_or(Vec3::Z),
            light_from_world: world_from_light.inverse(),
            screen,
            image,
            scale,
        }
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let cone = if is_similarity(&self.light_from_world) {
            NormalCone { axis: self.axis, cos_theta: self.screen.direction(Vec2::ONE).z }
        } else {
            NormalCone::EVERYWHERE
        };
        LightBounds::point(self.position, cone, self.scale * self.image.visible_mean())
    }

    #[inline]
    pub(super) fn sample(&self, from: &ReferencePoint, w: &SampledWavelengths) -> Option<LightSample> {
        let toward = Toward::new(from, self.position)?;
        let st = self.screen.project(self.light_from_world.vector(-toward.wi).normalize())?;
        let value = self.image.nearest(st, w);
        (value != SampledSpectrum::ZERO).then(|| toward.sample(self.scale * value))
    }
}
