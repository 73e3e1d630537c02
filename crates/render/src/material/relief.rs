//! Fine relief that only bends the shading frame: bump maps and normal maps.

use std::sync::Arc;

use tenfold_geometry::{Shading, SurfaceInteraction};
use tenfold_image::{Image, WrapMode};
use tenfold_math::{Frame, Vec2, Vec3};

use crate::texture::{FloatSlot, TextureContext, Textures};

/// The relief of a surface.
#[derive(Clone, Debug, Default)]
pub enum Relief {
    /// None: the shape's own shading frame.
    #[default]
    Smooth,
    /// Heights along the normal (Blinn 1978; pbrt book, 4th edition, §10.5.3).
    Displacement(FloatSlot),
    /// Normals in the tangent frame, as linear `(n + 1) / 2` in three channels.
    NormalMap(Arc<Image>),
}

impl Relief {
    /// The shading frame at a point: z is the shading normal, x along ∂p/∂u.
    #[inline]
    pub fn frame(&self, textures: &Textures, surface: &SurfaceInteraction, at: &TextureContext) -> Frame {
        let shading = &surface.shading;
        let bent = match self {
            Self::Smooth => return Frame::from_z_and_tangent(shading.n, shading.dpdu),
            Self::Displacement(height) => displaced(textures, height, shading, at),
            Self::NormalMap(image) => mapped(image, shading, at),
        };
        // A degenerate parametrisation has no frame to bend.
        let Some((n, dpdu)) = bent else { return Frame::from_z_and_tangent(shading.n, shading.dpdu) };
        let n = if n.dot(surface.n) < 0.0 { -n } else { n };
        Frame::from_z_and_tangent(n, dpdu)
    }
}

/// The normal and ∂p/∂u of the displaced surface `p + h n`.
fn displaced(
    textures: &Textures,
    height: &FloatSlot,
    shading: &Shading,
    at: &TextureContext,
) -> Option<(Vec3, Vec3)> {
    // Half a footprint, or a small step where there is none.
    let step = |x: f32, y: f32| match 0.5 * (x.abs() + y.abs()) {
        0.0 => 5e-4,
        step => step,
    };
    let f = &at.footprint;
    let (du, dv) = (step(f.dudx, f.dudy), step(f.dvdx, f.dvdy));
    let height_at = |p: Vec3, uv: Vec2| textures.float(height, &TextureContext { p, uv, ..*at });
    let h = textures.float(height, at);
    let dhdu = (height_at(at.p + du * shading.dpdu, at.uv + Vec2::new(du, 0.0)) - h) / du;
    let dhdv = (height_at(at.p + dv * shading.dpdv, at.uv + Vec2::new(0.0, dv)) - h) / dv;
    let dpdu = shading.dpdu + dhdu * shading.n + h * shading.dndu;
    let dpdv = shading.dpdv + dhdv * shading.n + h * shading.dndv;
    Some((dpdu.cross(dpdv).try_normalize()?, dpdu))
}

/// The normal that an image tells, and ∂p/∂u turned with it.
fn mapped(image: &Image, shading: &Shading, at: &TextureContext) -> Option<(Vec3, Vec3)> {
    let st = Vec2::new(at.uv.x, 1.0 - at.uv.y);
    let local = (2.0 * image.bilerp_rgb(st, WrapMode::Repeat) - Vec3::ONE).try_normalize()?;
    // The tangent frame is that of ∂p/∂u and the normal.
    let n = Frame::from_z_and_tangent(shading.n, shading.dpdu).to_world(local);
    let dpdu = (shading.dpdu - n * n.dot(shading.dpdu)).try_normalize()?;
    Some((n, dpdu))
}
