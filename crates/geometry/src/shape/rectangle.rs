use super::bilinear_patch::bilerp;
use crate::{
    ReferencePoint, ShapeSample, SurfacePoint,
    sample::{corner_weights, pdf_by_solid_angle},
};
use glam::{Mat3A, Vec3A};
use tenfold_math::{Vec2, Vec3, gamma};
use tenfold_sampling::warp::{SphericalRectangle, bilinear_pdf, sample_bilinear};

/// Rectangles that fill less solid angle than this are sampled by area, which hardly differs there (pbrt's bound).
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
        let Some(view) = self.seen_from(reference) else {
            return self.point(u, self.pdf_area()).by_solid_angle(reference);
        };
        let (mut u, mut pdf) = (u, view.rectangle.pdf());
        if reference.ns != Vec3::ZERO {
            let weights = self.corner_weights(reference, &view);
            u = sample_bilinear(u, weights);
            pdf *= bilinear_pdf(u, weights);
        }
        Some(self.point(view.rectangle.sample(u), pdf))
    }

    /// Density by solid angle of [`Rectangle::sample_from`] for the direction to a known point of the surface, which may
    /// also be known as a point of triangles that cover it.
    #[inline]
    pub fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let Some(view) = self.seen_from(reference) else {
            return pdf_by_solid_angle(self.pdf_area(), point.p - reference.p, point.n);
        };
        let pdf = view.rectangle.pdf();
        if reference.ns == Vec3::ZERO {
            return pdf;
        }
        let place = Vec3::from(self.to_local * (Vec3A::from(point.p) - self.corners[0])).truncate();
        let u = view.rectangle.invert((place / self.size).clamp(Vec2::ZERO, Vec2::ONE));
        pdf * bilinear_pdf(u, self.corner_weights(reference, &view))
    }

    /// The rectangle seen from a point; `None` where it is too small to be sampled by solid angle.
    #[inline]
    fn seen_from(&self, reference: &ReferencePoint) -> Option<View> {
        let corner = Vec3::from(self.to_local * (self.corners[0] - Vec3A::from(reference.p)));
        let rectangle = SphericalRectangle::new(corner, self.size)?;
        (rectangle.solid_angle() > MIN_SPHERICAL_AREA).then_some(View { corner, rectangle })
    }

    #[inline]
    fn corner_weights(&self, reference: &ReferencePoint, view: &View) -> [f32; 4] {
        let n = Vec3::from(self.to_local * Vec3A::from(reference.ns));
        let to_corner = view.corner * n;
        let (along, across) = (self.size.x * n.x, self.size.y * n.y);
        let low = (to_corner.x + to_corner.y) + to_corner.z;
        let heights = [low, low + along, low + across, (low + along) + across];
        let distances = view.rectangle.corner_distances();
        corner_weights(reference, std::array::from_fn(|i| heights[i] / distances[i]))
    }

    fn pdf_area(&self) -> f32 {
        1.0 / (self.size.x * self.size.y)
    }

    #[inline]
    fn point(&self, uv: Vec2, pdf: f32) -> ShapeSample {
        let p = bilerp(uv, self.corners);
        let texture = self.uvs.map_or(uv, |uvs| bilerp(uv, uvs));
        ShapeSample { p: p.into(), p_error: self.p_error, n: self.n, uv: texture, param: uv, pdf }
    }
}

/// A rectangle seen from a point.
struct View {
    /// From the point to the corner 00, along the axes of the rectangle.
    corner: Vec3,
    rectangle: SphericalRectangle,
}
