use super::bilinear_patch::bilerp;
use crate::{
    ReferencePoint, ShapeSample, SurfacePoint,
    sample::{corner_weights, pdf_by_solid_angle},
};
use glam::{Mat3A, Vec3A};
use tenfold_math::{Vec2, Vec3, Vec4, gamma};
use tenfold_sampling::warp::{SphericalRectangle, bilinear_pdf, sample_bilinear};

/// Rectangles whose farthest point is less than this part of their distance from the middle are far: from there the light that
/// arrives varies so little over them that weights at the corners tell it all.
const FAR: f32 = 0.5;
/// Rectangles that fill less solid angle than this are sampled as those that are far (pbrt's bound).
const MIN_SPHERICAL_AREA: f32 = 1e-4;

/// A bilinear patch that is a rectangle, to be sampled as it is seen from points: what does not depend on the point is computed once.
#[derive(Clone, Debug, PartialEq)]
pub struct Rectangle {
    /// In the order 00, 10, 01, 11.
    corners: [Vec3A; 4],
    /// To axes along the edges and across.
    to_local: Mat3A,
    size: Vec2,
    /// Unit geometric normal.
    n: Vec3,
    p_error: Vec3,
    /// Texture coordinates at the corners, where they are not those of the unit square.
    uvs: Option<[Vec2; 4]>,
}

impl Rectangle {
    /// The rectangle with these corners, up to rounding; `None` where they are not those of one.
    pub(super) fn new(corners: [Vec3; 4], flip: bool, uvs: Option<[Vec2; 4]>) -> Option<Self> {
        let [p00, p10, p01, p11] = corners;
        let (eu, ev) = (p10 - p00, p01 - p00);
        let (lu, lv) = (eu.length(), ev.length());
        let skew = (p11 - p10 - ev).length();
        if !(lu > 0.0 && lv > 0.0 && skew <= 1e-5 * lu.min(lv) && eu.dot(ev).abs() <= 1e-5 * lu * lv) {
            return None;
        }
        let (u, v) = (eu.as_dvec3(), ev.as_dvec3());
        let (x, y) = (u.try_normalize()?, v.try_normalize()?);
        let z = x.cross(y).as_vec3();
        Some(Self {
            corners: corners.map(Vec3A::from),
            to_local: Mat3A::from_cols(x.as_vec3().into(), y.as_vec3().into(), z.into()).transpose(),
            size: Vec2::new(u.length() as f32, v.length() as f32),
            n: if flip { -z } else { z },
            p_error: gamma(6) * corners.iter().fold(Vec3::ZERO, |m, p| m.max(p.abs())),
            uvs,
        })
    }

    /// A point on the surface chosen for its view from `reference`; its density is by solid angle there.
    #[inline]
    pub fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        let corner = self.corner_from(reference);
        let Some(rectangle) = self.spherical(corner) else {
            let weights = self.far_weights(reference, corner);
            let uv = sample_bilinear(u, weights);
            let pdf = self.far_pdf(corner, weights, uv);
            return (pdf > 0.0).then(|| self.point(uv, pdf));
        };
        let (mut u, mut pdf) = (u, rectangle.pdf());
        if reference.ns != Vec3::ZERO {
            let weights = self.near_weights(reference, corner, &rectangle);
            u = sample_bilinear(u, weights);
            pdf *= bilinear_pdf(u, weights);
        }
        Some(self.point(rectangle.sample(u), pdf))
    }

    /// Density by solid angle of [`Rectangle::sample_from`] for the direction to a known point of the surface, which may
    /// also be known as a point of triangles that cover it.
    #[inline]
    pub fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let corner = self.corner_from(reference);
        let place = Vec3::from(self.to_local * (Vec3A::from(point.p) - self.corners[0])).truncate();
        let uv = (place / self.size).clamp(Vec2::ZERO, Vec2::ONE);
        let Some(rectangle) = self.spherical(corner) else {
            return self.far_pdf(corner, self.far_weights(reference, corner), uv);
        };
        let pdf = rectangle.pdf();
        if reference.ns == Vec3::ZERO {
            return pdf;
        }
        pdf * bilinear_pdf(rectangle.invert(uv), self.near_weights(reference, corner, &rectangle))
    }

    /// The way from a point to the corner 00, along the axes.
    #[inline]
    fn corner_from(&self, reference: &ReferencePoint) -> Vec3 {
        Vec3::from(self.to_local * (self.corners[0] - Vec3A::from(reference.p)))
    }

    /// The rectangle seen from near by; `None` where it is sampled as one that is far.
    #[inline]
    fn spherical(&self, corner: Vec3) -> Option<SphericalRectangle> {
        let half = 0.5 * self.size;
        let middle = corner + half.extend(0.0);
        if half.length_squared() < FAR * FAR * middle.length_squared() {
            return None;
        }
        SphericalRectangle::new(corner, self.size).filter(|r| r.solid_angle() > MIN_SPHERICAL_AREA)
    }

    /// The heights of the four corners over the surface of the point, in order.
    #[inline]
    fn heights(&self, reference: &ReferencePoint, corner: Vec3) -> Vec4 {
        let n = Vec3::from(self.to_local * Vec3A::from(reference.ns));
        let (along, across) = (self.size.x * n.x, self.size.y * n.y);
        let first = corner * n;
        (first.x + first.y) + first.z + Vec4::new(0.0, along, across, along + across)
    }

    /// Weights of directions to the corners from near by: their cosines.
    #[inline]
    fn near_weights(&self, reference: &ReferencePoint, corner: Vec3, seen: &SphericalRectangle) -> [f32; 4] {
        let cosines = self.heights(reference, corner) / Vec4::from_array(seen.corner_distances());
        corner_weights(reference, cosines.to_array())
    }

    /// Weights of the points at the corners from afar: what arrives of their light, cosine · |cosine at the light| / distance², but for a
    /// factor.
    #[inline]
    fn far_weights(&self, reference: &ReferencePoint, corner: Vec3) -> [f32; 4] {
        let x = corner.x + Vec4::new(0.0, self.size.x, 0.0, self.size.x);
        let y = corner.y + Vec4::new(0.0, 0.0, self.size.y, self.size.y);
        let squared = x * x + y * y + corner.z * corner.z;
        let distance = squared.sqrt();
        let cosines = match reference.ns == Vec3::ZERO {
            true => [1.0; 4],
            false => corner_weights(reference, (self.heights(reference, corner) / distance).to_array()),
        };
        (Vec4::from_array(cosines) / (squared * distance)).to_array()
    }

    /// Density by solid angle of the point at `uv` under the weights of afar; 0 where it has none.
    #[inline]
    fn far_pdf(&self, corner: Vec3, weights: [f32; 4], uv: Vec2) -> f32 {
        let to_point = corner + (uv * self.size).extend(0.0);
        let pdf = bilinear_pdf(uv, weights) / (self.size.x * self.size.y);
        pdf_by_solid_angle(pdf, to_point, Vec3::Z)
    }

    #[inline]
    fn point(&self, uv: Vec2, pdf: f32) -> ShapeSample {
        let p = bilerp(uv, self.corners);
        let texture = self.uvs.map_or(uv, |uvs| bilerp(uv, uvs));
        ShapeSample { p: p.into(), p_error: self.p_error, n: self.n, uv: texture, param: uv, pdf }
    }
}
