use super::bilinear_patch::bilerp;
use crate::{
    ReferencePoint, ReferencePoints, ShapeSample, ShapeSamples, SurfacePoint,
    sample::{corner_weights, pdf_by_solid_angle},
};
use tenfold_math::{Mat3, Slots, Vec2, Vec2s, Vec3, WIDTH, gamma, vectorized};
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
    corners: [Vec3; 4],
    /// To axes along the edges and across.
    to_local: Mat3,
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
            corners,
            to_local: Mat3::from_cols(x.as_vec3(), y.as_vec3(), z).transpose(),
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
            let (uv, pdf) = self.sample_far(reference, corner, u);
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

    /// [`Rectangle::sample_from`] for the points in `slots`: with a density of 0 in place of `None`.
    pub fn samples_from(
        &self,
        slots: Slots,
        references: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
    ) {
        let mut far = [false; WIDTH];
        samples_from_afar(self, references, u, out, &mut far);
        for slot in slots.filter(|&slot| !far[slot]) {
            match self.sample_from(&references.get(slot), u.get(slot)) {
                Some(sample) => out.set(slot, &sample),
                None => out.pdf[slot] = 0.0,
            }
        }
    }

    /// Density by solid angle of [`Rectangle::sample_from`] for the direction to a known point of the surface, which may
    /// also be known as a point of triangles that cover it.
    #[inline]
    pub fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let corner = self.corner_from(reference);
        let place = (self.to_local * (point.p - self.corners[0])).truncate();
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
    #[inline(always)]
    fn corner_from(&self, reference: &ReferencePoint) -> Vec3 {
        self.to_local * (self.corners[0] - reference.p)
    }

    /// Whether it is far from the point from which its corner 00 is seen at `corner`.
    #[inline(always)]
    fn is_far(&self, corner: Vec3) -> bool {
        let half = 0.5 * self.size;
        let middle = corner + half.extend(0.0);
        half.length_squared() < FAR * FAR * middle.length_squared()
    }

    /// The rectangle seen from near by; `None` where it is sampled as one that is far.
    #[inline]
    fn spherical(&self, corner: Vec3) -> Option<SphericalRectangle> {
        if self.is_far(corner) {
            return None;
        }
        SphericalRectangle::new(corner, self.size).filter(|r| r.solid_angle() > MIN_SPHERICAL_AREA)
    }

    /// A point chosen for its view from afar, from 0 to 1 along both edges, and its density by solid angle: 0 where it has none.
    #[inline(always)]
    fn sample_far(&self, reference: &ReferencePoint, corner: Vec3, u: Vec2) -> (Vec2, f32) {
        let weights = self.far_weights(reference, corner);
        let uv = sample_bilinear(u, weights);
        (uv, self.far_pdf(corner, weights, uv))
    }

    /// The heights of the four corners over the surface of the point, in order.
    #[inline(always)]
    fn heights(&self, reference: &ReferencePoint, corner: Vec3) -> [f32; 4] {
        let n = self.to_local * reference.ns;
        let (along, across) = (self.size.x * n.x, self.size.y * n.y);
        let first = corner * n;
        [0.0, along, across, along + across].map(|more| (first.x + first.y) + first.z + more)
    }

    /// Weights of directions to the corners from near by: their cosines.
    #[inline]
    fn near_weights(&self, reference: &ReferencePoint, corner: Vec3, seen: &SphericalRectangle) -> [f32; 4] {
        corner_weights(reference, ratios(self.heights(reference, corner), seen.corner_distances()))
    }

    /// Weights of the points at the corners from afar: what arrives of their light, cosine · |cosine at the light| / distance², but for a
    /// factor.
    #[inline(always)]
    fn far_weights(&self, reference: &ReferencePoint, corner: Vec3) -> [f32; 4] {
        let [x0, x1] = [0.0, self.size.x].map(|x| corner.x + x);
        let [y0, y1] = [0.0, self.size.y].map(|y| corner.y + y);
        let squared =
            [[x0, y0], [x1, y0], [x0, y1], [x1, y1]].map(|[x, y]| x * x + y * y + corner.z * corner.z);
        let distance = squared.map(f32::sqrt);
        let is_free = reference.ns == Vec3::ZERO;
        let cosines = corner_weights(reference, ratios(self.heights(reference, corner), distance));
        let cosines = cosines.map(|cos| if is_free { 1.0 } else { cos });
        std::array::from_fn(|i| cosines[i] / (squared[i] * distance[i]))
    }

    /// Density by solid angle of the point at `uv` under the weights of afar; 0 where it has none.
    #[inline(always)]
    fn far_pdf(&self, corner: Vec3, weights: [f32; 4], uv: Vec2) -> f32 {
        let to_point = corner + (uv * self.size).extend(0.0);
        let pdf = bilinear_pdf(uv, weights) / (self.size.x * self.size.y);
        pdf_by_solid_angle(pdf, to_point, Vec3::Z)
    }

    #[inline]
    fn point(&self, uv: Vec2, pdf: f32) -> ShapeSample {
        let p = bilerp(uv, self.corners);
        let texture = self.uvs.map_or(uv, |uvs| bilerp(uv, uvs));
        ShapeSample { p, p_error: self.p_error, n: self.n, uv: texture, param: uv, pdf }
    }
}

#[inline(always)]
fn ratios(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|i| a[i] / b[i])
}

vectorized! {
    /// Points on `rectangle` chosen for their view from all slots as if it were far, and where it is.
    fn samples_from_afar(
        rectangle: &Rectangle,
        references: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
        far: &mut [bool; WIDTH],
    ) {
        for i in 0..WIDTH {
            let reference = references.get(i);
            let corner = rectangle.corner_from(&reference);
            let (uv, pdf) = rectangle.sample_far(&reference, corner, u.get(i));
            far[i] = rectangle.is_far(corner);
            out.p.set(i, bilerp(uv, rectangle.corners));
            out.p_error.set(i, rectangle.p_error);
            out.n.set(i, rectangle.n);
            out.pdf[i] = pdf;
        }
    }
}
