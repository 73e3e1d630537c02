//! From a point of a surface to the coordinates of a texture (pbrt book, 4th edition, §10.2).

use std::f32::consts::{FRAC_1_PI, PI, TAU};
use tenfold_math::ops;

use tenfold_math::{Affine3A, Transform, Vec2, Vec3, direction_to_spherical};

use super::TextureContext;

/// Coordinates of a two-dimensional texture and their derivatives over the film.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TexCoord2 {
    /// The coordinates.
    pub st: Vec2,
    /// ∂(s, t)/∂x.
    pub dstdx: Vec2,
    /// ∂(s, t)/∂y.
    pub dstdy: Vec2,
}

/// Coordinates of a solid texture and their derivatives over the film.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TexCoord3 {
    /// The coordinates.
    pub p: Vec3,
    /// ∂p/∂x.
    pub dpdx: Vec3,
    /// ∂p/∂y.
    pub dpdy: Vec3,
}

/// A map from surfaces to the plane of a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Mapping2 {
    /// The surface's own parameters, scaled and shifted.
    Uv {
        /// Factors of u and v.
        scale: Vec2,
        /// What is added after.
        delta: Vec2,
    },
    /// Polar angle over π and azimuth over 2π of the point seen from the texture's origin.
    Spherical {
        /// World to texture space.
        to_texture: Affine3A,
    },
    /// Azimuth around z, from −x, over 2π, and height.
    Cylindrical {
        /// World to texture space.
        to_texture: Affine3A,
    },
    /// Products with two vectors.
    Planar {
        /// World to texture space.
        to_texture: Affine3A,
        /// Direction of s.
        vs: Vec3,
        /// Direction of t.
        vt: Vec3,
        /// What is added after.
        delta: Vec2,
    },
}

impl Default for Mapping2 {
    fn default() -> Self {
        Self::Uv { scale: Vec2::ONE, delta: Vec2::ZERO }
    }
}

impl Mapping2 {
    /// The coordinates at a point of a surface.
    #[inline]
    pub fn map(&self, at: &TextureContext) -> TexCoord2 {
        match self {
            Self::Uv { scale, delta } => {
                let f = &at.footprint;
                TexCoord2 {
                    st: *scale * at.uv + *delta,
                    dstdx: *scale * Vec2::new(f.dudx, f.dvdx),
                    dstdy: *scale * Vec2::new(f.dudy, f.dvdy),
                }
            }
            Self::Spherical { to_texture } => spherical(&Local::new(to_texture, at)),
            Self::Cylindrical { to_texture } => cylindrical(&Local::new(to_texture, at)),
            Self::Planar { to_texture, vs, vt, delta } => {
                let local = Local::new(to_texture, at);
                let project = |v: Vec3| Vec2::new(v.dot(*vs), v.dot(*vt));
                TexCoord2 {
                    st: *delta + project(local.p),
                    dstdx: project(local.dpdx),
                    dstdy: project(local.dpdy),
                }
            }
        }
    }
}

/// A map from surfaces to the space of a solid texture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping3 {
    /// World to texture space.
    pub to_texture: Affine3A,
}

impl Mapping3 {
    /// The map into the space that `from_texture` maps into the world.
    pub fn new(from_texture: &Transform) -> Self {
        Self { to_texture: *from_texture.inverse_affine() }
    }

    /// The coordinates at a point of a surface.
    #[inline]
    pub fn map(&self, at: &TextureContext) -> TexCoord3 {
        Local::new(&self.to_texture, at)
    }
}

type Local = TexCoord3;

impl Local {
    #[inline]
    fn new(to_texture: &Affine3A, at: &TextureContext) -> Self {
        Self {
            p: to_texture.transform_point3(at.p),
            dpdx: to_texture.transform_vector3(at.footprint.dpdx),
            dpdy: to_texture.transform_vector3(at.footprint.dpdy),
        }
    }

    /// Chain rule: derivatives of (s, t) from their gradients.
    #[inline]
    fn coordinates(&self, st: Vec2, grad_s: Vec3, grad_t: Vec3) -> TexCoord2 {
        // On the axis the gradients do not exist; sampling at a point is what is left there.
        let finite = |v: Vec2| if v.is_finite() { v } else { Vec2::ZERO };
        TexCoord2 {
            st,
            dstdx: finite(Vec2::new(grad_s.dot(self.dpdx), grad_t.dot(self.dpdx))),
            dstdy: finite(Vec2::new(grad_s.dot(self.dpdy), grad_t.dot(self.dpdy))),
        }
    }
}

fn spherical(at: &Local) -> TexCoord2 {
    let p = at.p;
    let rho2 = p.x * p.x + p.y * p.y;
    let rho = rho2.sqrt();
    // θ = acos(z / r) and φ = atan2(y, x). pbrt-v4 takes these gradients in the other order than its coordinates.
    let grad_theta = Vec3::new(p.x * p.z / rho, p.y * p.z / rho, -rho) / (PI * (rho2 + p.z * p.z));
    let grad_phi = Vec3::new(-p.y, p.x, 0.0) / (TAU * rho2);
    let angles = direction_to_spherical(p.normalize_or(Vec3::Z));
    at.coordinates(Vec2::new(angles.x * FRAC_1_PI, angles.y / TAU), grad_theta, grad_phi)
}

fn cylindrical(at: &Local) -> TexCoord2 {
    let p = at.p;
    let grad_phi = Vec3::new(-p.y, p.x, 0.0) / (TAU * (p.x * p.x + p.y * p.y));
    at.coordinates(Vec2::new((PI + ops::atan2(p.y, p.x)) / TAU, p.z), grad_phi, Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Footprint;
    use tenfold_math::{vec2, vec3};

    /// A texture space turned, scaled and moved in the world.
    fn placed() -> Transform {
        Transform::translate(vec3(1.0, 2.0, 3.0))
            * Transform::rotate(0.8, vec3(1.0, -1.0, 0.5)).unwrap()
            * Transform::scale(vec3(2.0, 2.0, 2.0)).unwrap()
    }

    fn all() -> Vec<Mapping2> {
        let to_texture = *placed().inverse_affine();
        vec![
            Mapping2::Uv { scale: vec2(3.0, -2.0), delta: vec2(0.25, 0.5) },
            Mapping2::Spherical { to_texture },
            Mapping2::Cylindrical { to_texture },
            Mapping2::Planar {
                to_texture,
                vs: vec3(1.0, 0.5, 0.0),
                vt: vec3(0.0, 0.0, 2.0),
                delta: vec2(0.1, -0.2),
            },
        ]
    }

    #[test]
    fn coordinates_are_those_of_their_formulas() {
        // This local point has θ = 60°, φ = 210° and radius 2.
        let local = vec3(-1.5, -(0.75f32.sqrt()), 1.0);
        let at = TextureContext { uv: vec2(0.5, 0.25), ..TextureContext::at_point(placed().point(local)) };
        let want = [
            vec2(1.75, 0.0),
            vec2(1.0 / 3.0, 210.0 / 360.0),
            vec2(30.0 / 360.0, 1.0),
            vec2(0.1 - 1.5 - 0.5 * 0.75f32.sqrt(), 1.8),
        ];
        for (mapping, want) in all().iter().zip(want) {
            let got = mapping.map(&at);
            assert!((got.st - want).length() < 1e-5, "{mapping:?}: {got:?}, not {want}");
            assert_eq!((got.dstdx, got.dstdy), (Vec2::ZERO, Vec2::ZERO));
        }
        assert!((Mapping3::new(&placed()).map(&at).p - local).length() < 1e-5);
    }

    #[test]
    fn derivatives_are_those_of_the_coordinates() {
        let p = placed().point(vec3(0.4, 0.6, -0.7));
        let f = Footprint {
            dudx: 0.3,
            dudy: -0.1,
            dvdx: 0.2,
            dvdy: 0.4,
            dpdx: vec3(0.3, 0.1, -0.4),
            dpdy: vec3(-0.2, 0.5, 0.1),
        };
        let h = 1e-3;
        for mapping in all() {
            let at = TextureContext { uv: vec2(0.3, 0.6), footprint: f, ..TextureContext::at_point(p) };
            let got = mapping.map(&at);
            for (want, duv, dp) in
                [(got.dstdx, vec2(f.dudx, f.dvdx), f.dpdx), (got.dstdy, vec2(f.dudy, f.dvdy), f.dpdy)]
            {
                let moved =
                    |h: f32| mapping.map(&TextureContext { uv: at.uv + h * duv, p: p + h * dp, ..at }).st;
                let slope = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((slope - want).length() < 2e-3, "{mapping:?}: {slope}, not {want}");
            }
        }
    }

    #[test]
    fn the_axis_is_finite() {
        for mapping in all() {
            let footprint = Footprint { dpdx: Vec3::X, dpdy: Vec3::Y, ..Footprint::default() };
            for local in [Vec3::ZERO, Vec3::Z, Vec3::NEG_Z] {
                let at = TextureContext { footprint, ..TextureContext::at_point(placed().point(local)) };
                let c = mapping.map(&at);
                assert!(c.st.is_finite() && c.dstdx.is_finite() && c.dstdy.is_finite());
            }
        }
    }
}
