use super::{Rectangle, ShapeHit, quadric::integrate, unit_cross};
use crate::{
    BilinearMesh, NormalCone, ReferencePoint, Shading, ShapeSample, SurfaceInteraction, SurfacePoint,
    plain::{PlainHits, PlainSurface, PlainSurfaces},
    sample::pdf_by_solid_angle,
};
use glam::{DVec3, Vec3A};
use std::ops::{Add, Mul};
use tenfold_math::{Bounds3, Quat, Ray, Slots, Vec2, Vec3, WIDTH, gamma, higher, vectorized};
use tenfold_sampling::warp::{bilinear_pdf, sample_bilinear};

/// A bilinear patch of a mesh: `p(u, v)` interpolates four corners, given in the order 00, 10, 01, 11.
#[derive(Copy, Clone, Debug)]
pub struct BilinearPatch<'a> {
    mesh: &'a BilinearMesh,
    index: usize,
}

impl<'a> BilinearPatch<'a> {
    pub(super) fn new(mesh: &'a BilinearMesh, index: usize) -> Self {
        Self { mesh, index }
    }

    /// Vertex positions.
    #[inline(always)]
    pub fn positions(&self) -> [Vec3; 4] {
        match self.mesh.separate_positions(self.index) {
            Some(positions) => *positions,
            None => self.mesh.positions(self.index),
        }
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3::around(self.positions())
    }

    /// The patch as a rectangle; `None` where it is not one up to rounding, or where interpolated normals turn the geometric one around
    /// within it.
    pub fn rectangle(&self) -> Option<Rectangle> {
        let corners = self.positions();
        let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let flip = match self.mesh.normals(self.index) {
            Some(normals) => {
                let below = normals.map(|ns| n.dot(ns) < 0.0);
                if below.iter().any(|&b| b != below[0]) {
                    return None;
                }
                below[0]
            }
            None => self.mesh.flip,
        };
        Rectangle::new(corners, flip, self.mesh.uvs(self.index))
    }

    /// The geometric normal at parameters `uv`, where `∂p/∂u × ∂p/∂v` is `n` (of any length).
    fn orient(&self, n: Vec3, uv: Vec2) -> Vec3 {
        match self.mesh.normals(self.index) {
            Some(normals) if n.dot(bilerp(uv, normals)) < 0.0 => -n,
            Some(_) => n,
            None if self.mesh.flip => -n,
            None => n,
        }
    }

    pub(super) fn normal_cone(&self) -> NormalCone {
        // The unnormalised normal is itself bilinear, so the corners' ones span it.
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|uv| {
            let [dpdu, dpdv] = derivatives(uv, self.positions());
            self.orient(dpdu.cross(dpdv).normalize_or_zero(), uv)
        });
        if let Some(normals) = self.mesh.normals(self.index)
            && corners.iter().any(|n| normals.iter().any(|ns| n.dot(*ns) < 0.0))
        {
            return NormalCone::EVERYWHERE;
        }
        let Some(axis) = corners.iter().sum::<Vec3>().try_normalize() else {
            return NormalCone::EVERYWHERE;
        };
        let cos_theta =
            corners.iter().filter(|n| **n != Vec3::ZERO).map(|n| axis.dot(*n)).fold(1f32, f32::min);
        if cos_theta > 0.0 { NormalCone { axis, cos_theta } } else { NormalCone::EVERYWHERE }
    }

    pub(super) fn area(&self) -> f32 {
        let p = self.positions();
        let area = integrate(4, |u| {
            integrate(4, |v| {
                let [dpdu, dpdv] = derivatives(Vec2::new(u as f32, v as f32), p);
                f64::from(dpdu.cross(dpdv).length())
            })
        });
        area as f32
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        mut accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        let corners = self.positions();
        let Some(parallelogram) = Parallelogram::new(&corners) else {
            return intersect_twisted(&corners, ray, t_max, &mut accept);
        };
        let (hit, is_hit) = parallelogram.hit(ray, t_max);
        (is_hit && accept(hit)).then_some(hit)
    }

    /// The patch as a parallelogram, where it is one.
    pub(crate) fn parallelogram(&self) -> Option<Parallelogram> {
        Parallelogram::new(&self.positions())
    }

    pub(super) fn uv(&self, _: &Ray, hit: &ShapeHit) -> Vec2 {
        self.texture_uv(Vec2::new(hit.u, hit.v))
    }

    #[inline]
    fn texture_uv(&self, uv: Vec2) -> Vec2 {
        self.mesh.uvs(self.index).map_or(uv, |corners| bilerp(uv, corners))
    }

    pub(super) fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        // In vector registers.
        let p = self.positions().map(Vec3A::from);
        let uv = Vec2::new(hit.u, hit.v);
        let mut dp = derivatives(uv, p);
        let across = unit_cross(dp[0].into(), dp[1].into());
        let n = across.unwrap_or_else(|| self.unit_normal(uv));
        let twist = (p[0] - p[2]) + (p[3] - p[1]);
        let is_twisted = twist != Vec3A::ZERO;
        let mut dn = [Vec3A::ZERO; 2];
        if is_twisted {
            dn = normal_derivatives(dp, Vec3A::from(n).dot(twist));
        }
        let by_texture = self.texture_jacobian(uv);
        if let (Some([by_s, by_t]), Some(_)) = (by_texture, across) {
            // The frame keeps its hand where the texture is mirrored.
            let by = [by_s, if by_s.perp_dot(by_t) < 0.0 { -by_t } else { by_t }];
            dp = by.map(|j| dp[0] * j.x + dp[1] * j.y);
            if is_twisted {
                dn = by.map(|j| dn[0] * j.x + dn[1] * j.y);
            }
        }
        let [dpdu, dpdv, dndu, dndv] = [dp[0], dp[1], dn[0], dn[1]].map(Vec3::from);
        let mut surface = SurfaceInteraction::new(
            bilerp(uv, p).into(),
            (gamma(6) * p.iter().fold(Vec3A::ZERO, |m, p| m.max(p.abs()))).into(),
            if self.mesh.flip { -n } else { n },
            self.texture_uv(uv),
            uv,
            [dpdu, dpdv, dndu, dndv],
            ray,
        );
        surface.face_index = self.mesh.face_index(self.index);
        let Some(normals) = self.mesh.normals(self.index) else { return surface };
        if let Some(ns) = bilerp(uv, normals).try_normalize() {
            let [mut dndu, mut dndv] = derivatives(uv, normals);
            if let Some(by_texture) = by_texture {
                [dndu, dndv] = by_texture.map(|j| dndu * j.x + dndv * j.y);
            }
            // Turn the tangents along with the normal, by the shortest way.
            let turn = Quat::from_rotation_arc(surface.n, ns);
            surface.shading = Shading { n: ns, dpdu: turn * dpdu, dpdv: turn * dpdv, dndu, dndv };
            if surface.n.dot(ns) < 0.0 {
                surface.n = -surface.n;
            }
        }
        surface
    }

    /// [`BilinearPatch::interaction`] at hits of a patch without normals of its own, in those of `slots` where its edges span a plane. Returns them.
    pub(crate) fn plain_surfaces(&self, slots: Slots, at: &PlainHits, out: &mut PlainSurfaces) -> Slots {
        let (corners, uvs) = (self.positions(), self.mesh.uvs(self.index));
        let mut found = slots.flags();
        plain_surfaces(
            &corners,
            self.mesh.flip,
            &uvs.unwrap_or_default(),
            uvs.is_some(),
            at,
            &mut found,
            out,
        );
        slots.keep(|slot| found[slot])
    }

    /// [`texture_jacobian`] where the patch has texture coordinates that span the plane.
    fn texture_jacobian(&self, uv: Vec2) -> Option<[Vec2; 2]> {
        let (spans, by_texture) = texture_jacobian(uv, self.mesh.uvs(self.index)?);
        spans.then_some(by_texture)
    }

    /// Unit `∂p/∂u × ∂p/∂v`; where an edge has shrunk to a point, that of the middle.
    fn unit_normal(&self, uv: Vec2) -> Vec3 {
        let normal = |uv: Vec2| {
            let [dpdu, dpdv] = derivatives(uv, self.positions());
            unit_cross(dpdu, dpdv)
        };
        normal(uv).or_else(|| normal(Vec2::splat(0.5))).unwrap_or(Vec3::Z)
    }

    fn point(&self, uv: Vec2, pdf: f32) -> ShapeSample {
        let p = self.positions();
        ShapeSample {
            p: bilerp(uv, p),
            p_error: point_error(p),
            n: self.orient(self.unit_normal(uv), uv),
            uv: self.texture_uv(uv),
            param: uv,
            pdf,
        }
    }

    /// Areas of the parallelograms at the corners: the density over (u, v) follows them.
    fn area_weights(&self) -> [f32; 4] {
        let p = self.positions();
        [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|uv| {
            let [dpdu, dpdv] = derivatives(uv, p);
            dpdu.cross(dpdv).length()
        })
    }

    fn pdf_at(&self, uv: Vec2) -> f32 {
        let [dpdu, dpdv] = derivatives(uv, self.positions());
        bilinear_pdf(uv, self.area_weights()) / dpdu.cross(dpdv).length()
    }

    pub(super) fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let uv = sample_bilinear(u, self.area_weights());
        let pdf = self.pdf_at(uv);
        (pdf.is_finite() && pdf > 0.0).then(|| self.point(uv, pdf))
    }

    pub(super) fn pdf_area(&self, point: &SurfacePoint) -> f32 {
        let pdf = self.pdf_at(point.param);
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    pub(super) fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        match self.rectangle() {
            Some(rectangle) => rectangle.sample_from(reference, u),
            None => self.sample_area(u)?.by_solid_angle(reference),
        }
    }

    pub(super) fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        match self.rectangle() {
            Some(rectangle) => rectangle.pdf_from_point(reference, point),
            None => pdf_by_solid_angle(self.pdf_area(point), point.p - reference.p, point.n),
        }
    }
}

vectorized! {
    /// Surfaces of a patch without normals of its own, in the slots that are `found`: it stays so where the edges span a plane. `uvs` count where it
    /// `has_uvs`.
    fn plain_surfaces(
        corners: &[Vec3; 4],
        flip: bool,
        uvs: &[Vec2; 4],
        has_uvs: bool,
        at: &PlainHits,
        found: &mut [bool; WIDTH],
        out: &mut PlainSurfaces,
    ) {
        let p_error = point_error(*corners);
        for i in 0..WIDTH {
            let uv = Vec2::new(at.u[i], at.v[i]);
            let [dpdu, dpdv] = derivatives(uv, *corners);
            let n = unit_cross(dpdu, dpdv).unwrap_or_default();
            let (spans, [by_s, _]) = texture_jacobian(uv, *uvs);
            let dpds = dpdu * by_s.x + dpdv * by_s.y;
            let surface = PlainSurface {
                p: bilerp(uv, *corners),
                p_error,
                n: if flip { -n } else { n },
                uv: if has_uvs { bilerp(uv, *uvs) } else { uv },
                dpdu: if has_uvs & spans { dpds } else { dpdu },
            };
            found[i] &= (n.x != 0.0) | (n.y != 0.0) | (n.z != 0.0);
            out.set_if(found[i], i, surface);
        }
    }
}

/// Derivatives of the parameters by the texture coordinates that have the values `uvs` at the corners: `[∂(u,v)/∂s, ∂(u,v)/∂t]`, and whether they
/// span the plane.
#[inline(always)]
fn texture_jacobian(uv: Vec2, uvs: [Vec2; 4]) -> (bool, [Vec2; 2]) {
    let [du, dv] = derivatives(uv, uvs);
    let determinant = du.perp_dot(dv);
    let scale = 1.0 / determinant;
    let by_texture = [Vec2::new(dv.y, -du.y) * scale, Vec2::new(-dv.x, du.x) * scale];
    (determinant.abs() > 1e-12, by_texture)
}

/// Bound on the error of points of the patch with these corners.
#[inline(always)]
fn point_error(corners: [Vec3; 4]) -> Vec3 {
    gamma(6) * corners.iter().fold(Vec3::ZERO, |m, p| m.max(p.abs()))
}

/// The derivatives of the unit normal by u and v from those of the position, where `twist` is the part along the normal of the mixed
/// second one, and the others vanish: the Weingarten equations, pbrt book, 4th edition, eq. 6.6.
fn normal_derivatives([dpdu, dpdv]: [Vec3A; 2], twist: f32) -> [Vec3A; 2] {
    let (uu, uv, vv) = (dpdu.dot(dpdu), dpdu.dot(dpdv), dpdv.dot(dpdv));
    let determinant = uu * vv - uv * uv;
    if determinant == 0.0 {
        return [Vec3A::ZERO; 2];
    }
    let s = twist / determinant;
    [(uv * s) * dpdu - (uu * s) * dpdv, (uv * s) * dpdv - (vv * s) * dpdu]
}

/// A patch whose opposite edges are the same, to be hit; in double precision.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Parallelogram {
    p00: DVec3,
    /// To the next corners, by u and by v.
    edges: [DVec3; 2],
    /// Across these, of any length.
    n: DVec3,
    largest: f32,
}

impl Parallelogram {
    #[inline(always)]
    fn new(corners: &[Vec3; 4]) -> Option<Self> {
        let [p00, p10, p01, p11] = corners.map(Vec3::as_dvec3);
        let edges = [p10 - p00, p01 - p00];
        let n = edges[0].cross(edges[1]);
        (edges[1] == p11 - p10).then(|| Self { p00, edges, n, largest: largest(corners) })
    }

    /// Where a ray hits it with `0 < t < t_max`, and whether it does. Without branches, for loops over slots.
    #[inline(always)]
    pub(crate) fn hit(&self, ray: &Ray, t_max: f32) -> (ShapeHit, bool) {
        // Cramer's rule for p00 + u · edges[0] + v · edges[1] = o + t · d.
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let from = o - self.p00;
        let q = from.cross(d);
        let scale = 1.0 / d.dot(self.n);
        let [across, e00] = self.edges;
        let hit = [-from.dot(self.n) * scale, -e00.dot(q) * scale, across.dot(q) * scale];
        hit_at(hit, self.largest, ray, t_max)
    }
}

/// The largest coordinate of the corners, without its sign.
#[inline(always)]
fn largest(corners: &[Vec3; 4]) -> f32 {
    corners.iter().fold(Vec3::ZERO, |m, p| m.max(p.abs())).max_element()
}

/// The hit with the parameters `t`, `u` and `v`, and whether it is one.
#[inline(always)]
fn hit_at([t, u, v]: [f64; 3], largest: f32, ray: &Ray, t_max: f32) -> (ShapeHit, bool) {
    let inside = |x: f64| (-SLACK..=1.0 + SLACK).contains(&x);
    // Nearer than rounding can tell from the origin's own surface.
    let origin = ray.origin.abs();
    let size = higher(higher(origin.x, origin.y), higher(origin.z, largest));
    let t_min = 1e-13 * f64::from(size) / ray.direction.as_dvec3().length_squared().sqrt();
    let is_hit = inside(u) & inside(v) & (t > 0.0) & ((t as f32) < t_max) & (t > t_min);
    let clamped = |x: f64| (x as f32).clamp(0.0, 1.0);
    (ShapeHit { t: t as f32, u: clamped(u), v: clamped(v) }, is_hit)
}

/// Reshetov (2019), "Cool Patches": the ray meets the line at `u` where `((a(u) − o) × d) · (b(u) − a(u)) = 0`, a
/// quadratic equation; in double precision, so that neighbours leave no gap that a float could find.
#[inline(never)]
fn intersect_twisted(
    corners: &[Vec3; 4],
    ray: &Ray,
    t_max: f32,
    accept: &mut impl FnMut(ShapeHit) -> bool,
) -> Option<ShapeHit> {
    let [p00, p10, p01, p11] = corners.map(Vec3::as_dvec3);
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (e00, e11) = (p01 - p00, p11 - p10);
    let a = (p10 - p00).cross(d).dot(e11 - e00);
    let c = (p00 - o).cross(d).dot(e00);
    let b = (p10 - o).cross(d).dot(e11) - (a + c);
    let largest = largest(corners);
    let hit = |u: f64| {
        // Also leaves out NaN.
        if !(-SLACK..=1.0 + SLACK).contains(&u) {
            return None;
        }
        let start = p00 + u * (p10 - p00);
        let across = p01 + u * (p11 - p01) - start;
        let delta = start - o;
        let perpendicular = d.cross(across);
        let scale = 1.0 / perpendicular.length_squared();
        let v = delta.cross(d).dot(perpendicular) * scale;
        let t = delta.cross(across).dot(perpendicular) * scale;
        let (hit, is_hit) = hit_at([t, u, v], largest, ray, t_max);
        is_hit.then_some(hit)
    };
    let mut hits = quadratic_roots(a, b, c).map(hit);
    if let [Some(first), Some(second)] = hits
        && second.t < first.t
    {
        hits.swap(0, 1);
    }
    hits.into_iter().flatten().find(|hit| accept(*hit))
}

/// How far outside [0, 1] a parameter still counts as inside: the rounding of double precision.
const SLACK: f64 = 1e-11;

/// Roots of `a·u² + b·u + c`, NaN where there are none or fewer.
fn quadratic_roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    if a == 0.0 {
        return [-c / b, f64::NAN];
    }
    let discriminant = b * b - 4.0 * a * c;
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [q / a, c / q]
}

/// Bilinear interpolation of values at the corners 00, 10, 01, 11.
#[inline(always)]
pub(super) fn bilerp<T: Copy + Mul<f32, Output = T> + Add<Output = T>>(
    uv: Vec2,
    [x00, x10, x01, x11]: [T; 4],
) -> T {
    let (u, v) = (uv.x, uv.y);
    let low = x00 * (1.0 - u) + x10 * u;
    let high = x01 * (1.0 - u) + x11 * u;
    low * (1.0 - v) + high * v
}

/// Derivatives by u and v of [`bilerp`].
#[inline(always)]
fn derivatives<T>(uv: Vec2, [x00, x10, x01, x11]: [T; 4]) -> [T; 2]
where
    T: Copy + Mul<f32, Output = T> + Add<Output = T> + std::ops::Sub<Output = T>,
{
    let (u, v) = (uv.x, uv.y);
    [(x10 - x00) * (1.0 - v) + (x11 - x01) * v, (x01 - x00) * (1.0 - u) + (x11 - x10) * u]
}
