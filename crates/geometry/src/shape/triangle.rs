use super::{ShapeHit, unit_cross};
use crate::{
    NormalCone, ReferencePoint, Shading, ShapeSample, SurfaceInteraction, SurfacePoint, TriangleMesh,
    mesh::is_degenerate,
    sample::{corner_weights, pdf_by_solid_angle},
};
use tenfold_math::{Bounds3, Frame, Ray, Vec2, Vec3, gamma, higher, lower};
use tenfold_sampling::warp::{SphericalTriangle, bilinear_pdf, sample_bilinear, sample_uniform_triangle};

/// Solid angles outside this range are sampled by area: directions to smaller triangles lose their digits, and
/// larger ones nearly fill the hemisphere, where sampling the scattering is better (pbrt's bounds).
const SPHERICAL_RANGE: std::ops::RangeInclusive<f32> = 3e-4..=6.22;
/// From more than so many times the length of its longer edge at a vertex, a triangle looks smaller than that: it has no more than half of the square of that length,
/// and no point of it is nearer than the vertex by more than that length.
const FAR: f32 = 43.0;
const _: () = assert!(1.02 < 2.0 * *SPHERICAL_RANGE.start() * (FAR - 1.0) * (FAR - 1.0));

/// A triangle of a mesh.
#[derive(Copy, Clone, Debug)]
pub struct Triangle<'a> {
    pub(super) mesh: &'a TriangleMesh,
    pub(super) index: usize,
}

impl<'a> Triangle<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh, index: usize) -> Self {
        Self { mesh, index }
    }

    /// Vertex positions.
    #[inline]
    pub fn positions(&self) -> [Vec3; 3] {
        self.mesh.positions(self.index)
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3::around(self.positions())
    }

    /// Unit normal by the order of the vertices; zero without area.
    #[inline(always)]
    fn vertex_order_normal(&self) -> Vec3 {
        vertex_order_normal(self.positions())
    }

    /// The geometric normal at barycentric weights `b`.
    fn normal(&self, b: [f32; 3]) -> Vec3 {
        let n = self.vertex_order_normal();
        match self.mesh.normals(self.index) {
            Some(normals) if n.dot(mix(b, normals)) < 0.0 => -n,
            Some(_) => n,
            None if self.mesh.flip => -n,
            None => n,
        }
    }

    pub(super) fn normal_cone(&self) -> NormalCone {
        let n = self.normal([1.0 / 3.0; 3]);
        // Interpolated normals on both sides of the plane turn the geometric one around within the triangle.
        let turns =
            self.mesh.normals(self.index).is_some_and(|normals| normals.iter().any(|ns| n.dot(*ns) < 0.0));
        if n == Vec3::ZERO || turns { NormalCone::EVERYWHERE } else { NormalCone::along(n) }
    }

    pub(super) fn area(&self) -> f32 {
        area(self.positions())
    }

    #[inline]
    pub(super) fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        mut accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        let p = self.positions();
        if is_degenerate(p) {
            return None;
        }
        RayShear::new(ray).intersect(p, t_max).filter(|hit| accept(*hit))
    }

    pub(super) fn uv(&self, _: &Ray, hit: &ShapeHit) -> Vec2 {
        mix(weights(hit.u, hit.v), self.mesh.uvs(self.index))
    }

    #[inline(always)]
    pub(super) fn interaction(&self, ray: &Ray, hit: &ShapeHit) -> SurfaceInteraction {
        let flat = FlatTriangle::at(self.positions(), hit.u, hit.v);
        let FlatTriangle { corners: p, weights: b } = flat;
        let order_n = flat.vertex_order_normal();
        let (uv, [dpdu, dpdv]) = if self.mesh.parts().uvs.is_none() {
            (flat.uv(), flat.derivatives())
        } else {
            let chart = self.chart();
            let derivatives = if chart.is_degenerate() {
                // Any tangents; turned as pbrt's, whose normal here is against the order of the vertices.
                let frame = Frame::from_z(-order_n);
                [frame.x, frame.y]
            } else {
                chart.derivatives(p)
            };
            (mix(b, chart.uvs), derivatives)
        };
        let mut surface = SurfaceInteraction::new(
            flat.p(),
            flat.p_error(),
            if self.mesh.flip { -order_n } else { order_n },
            uv,
            Vec2::new(hit.u, hit.v),
            [dpdu, dpdv, Vec3::ZERO, Vec3::ZERO],
            ray,
        );
        surface.face_index = self.mesh.face_index(self.index);
        if self.mesh.has_frames() {
            self.bend(&mut surface, b);
        }
        surface
    }

    #[inline]
    fn chart(&self) -> Chart {
        Chart::new(self.mesh.uvs(self.index))
    }

    /// Gives a surface the shading frame of vertex normals and tangents at barycentric weights `b`.
    fn bend(&self, surface: &mut SurfaceInteraction, b: [f32; 3]) {
        let chart = self.chart();
        let (normals, tangents) = (self.mesh.normals(self.index), self.mesh.tangents(self.index));
        let ns = normals.map_or(surface.n, |n| mix(b, n).normalize_or(surface.n));
        let tangent = tangents.map_or(surface.dpdu, |s| {
            let s = mix(b, s);
            if s.length_squared() == 0.0 { surface.dpdu } else { s }
        });
        let ts = ns.cross(tangent);
        let (ss, ts) = if ts.length_squared() > 0.0 {
            (ts.cross(ns), ts)
        } else {
            let frame = Frame::from_z(ns);
            (frame.x, frame.y)
        };
        let [dndu, dndv] = match normals {
            Some(normals) if !chart.is_degenerate() => chart.derivatives(normals),
            // The same arbitrary tangents as of the position.
            Some([n0, n1, n2]) => match (n2 - n0).cross(n1 - n0).try_normalize() {
                Some(dn) => {
                    let frame = Frame::from_z(dn);
                    [frame.x, frame.y]
                }
                None => [Vec3::ZERO; 2],
            },
            None => [Vec3::ZERO; 2],
        };
        if surface.n.dot(ns) < 0.0 {
            surface.n = -surface.n;
        }
        surface.shading = Shading { n: ns, dpdu: ss, dpdv: ts, dndu, dndv };
    }

    fn point(&self, b: [f32; 3], pdf: f32) -> ShapeSample {
        let p = self.positions();
        ShapeSample {
            p: mix(b, p),
            p_error: gamma(7) * mix(b.map(f32::abs), p.map(Vec3::abs)),
            n: self.normal(b),
            uv: mix(b, self.mesh.uvs(self.index)),
            param: Vec2::new(b[1], b[2]),
            pdf,
        }
    }

    pub(super) fn sample_area(&self, u: Vec2) -> Option<ShapeSample> {
        let pdf = 1.0 / self.area();
        pdf.is_finite().then(|| self.point(sample_uniform_triangle(u).to_array(), pdf))
    }

    pub(super) fn pdf_area(&self, _: &SurfacePoint) -> f32 {
        1.0 / self.area()
    }

    fn seen_from(&self, reference: &ReferencePoint) -> Option<SphericalTriangle> {
        let corners = self.positions();
        if is_far(&corners, reference.p) {
            return None;
        }
        SphericalTriangle::new(reference.p, corners).filter(|t| SPHERICAL_RANGE.contains(&t.solid_angle()))
    }

    pub(super) fn sample_from(&self, reference: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        let Some(triangle) = self.seen_from(reference) else {
            return self.sample_area(u)?.by_solid_angle(reference);
        };
        if reference.ns == Vec3::ZERO {
            let sample = triangle.sample(u)?;
            return Some(self.point(sample.barycentric.to_array(), sample.pdf));
        }
        let corners = self.corner_weights(reference);
        let u = sample_bilinear(u, corners);
        let sample = triangle.sample(u)?;
        Some(self.point(sample.barycentric.to_array(), sample.pdf * bilinear_pdf(u, corners)))
    }

    pub(super) fn pdf_from_point(&self, reference: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let to_light = point.p - reference.p;
        let Some(triangle) = self.seen_from(reference) else {
            return pdf_by_solid_angle(self.pdf_area(point), to_light, point.n);
        };
        if reference.ns == Vec3::ZERO {
            return triangle.pdf();
        }
        let u = triangle.invert(to_light.normalize_or(Vec3::Z));
        triangle.pdf() * bilinear_pdf(u, self.corner_weights(reference))
    }

    /// Weights of the corners of the unit square that [`SphericalTriangle`] maps to: its lower edge is the second vertex.
    fn corner_weights(&self, reference: &ReferencePoint) -> [f32; 4] {
        let cosine = |p: Vec3| reference.ns.dot((p - reference.p).normalize_or_zero());
        let [a, b, c] = self.positions().map(cosine);
        corner_weights(reference, [b, b, a, c])
    }
}

/// A point of a triangle by itself, without what a mesh adds to it.
#[derive(Copy, Clone, Debug)]
pub(crate) struct FlatTriangle {
    corners: [Vec3; 3],
    /// Barycentric.
    weights: [f32; 3],
}

impl FlatTriangle {
    /// The point with the barycentric weights `u` and `v` of the second and the third corner.
    #[inline(always)]
    pub(crate) fn at(corners: [Vec3; 3], u: f32, v: f32) -> Self {
        Self { corners, weights: weights(u, v) }
    }

    /// The point that [`sample_uniform_triangle`] chooses.
    #[inline(always)]
    pub(super) fn sample(corners: [Vec3; 3], u: Vec2) -> Self {
        Self { corners, weights: sample_uniform_triangle(u).to_array() }
    }

    /// The point.
    #[inline(always)]
    pub(crate) fn p(&self) -> Vec3 {
        mix(self.weights, self.corners)
    }

    /// Bound on its absolute error.
    #[inline(always)]
    pub(crate) fn p_error(&self) -> Vec3 {
        gamma(7) * mix(self.weights.map(f32::abs), self.corners.map(Vec3::abs))
    }

    /// Unit normal by the order of the corners; zero without area.
    #[inline(always)]
    pub(crate) fn vertex_order_normal(&self) -> Vec3 {
        vertex_order_normal(self.corners)
    }

    /// Texture coordinates where the mesh has none.
    #[inline(always)]
    pub(crate) fn uv(&self) -> Vec2 {
        let [_, b1, b2] = self.weights;
        Vec2::new(b1 + b2, b2)
    }

    /// Derivatives of the point by these: what [`Chart::derivatives`] would give, up to rounding.
    #[inline(always)]
    pub(crate) fn derivatives(&self) -> [Vec3; 2] {
        let [a, b, c] = self.corners;
        [b - a, c - b]
    }
}

/// Unit normal by the order of the corners; zero without area.
#[inline(always)]
fn vertex_order_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    unit_cross(b - a, c - a).unwrap_or_default()
}

/// The area of a triangle.
#[inline(always)]
pub(super) fn area([a, b, c]: [Vec3; 3]) -> f32 {
    (0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length_squared().sqrt()) as f32
}

/// Whether a triangle looks so small from `p` that it is sampled by area.
#[inline(always)]
pub(super) fn is_far(&[a, b, c]: &[Vec3; 3], p: Vec3) -> bool {
    let edge2 = b.distance_squared(a).max(c.distance_squared(a));
    p.distance_squared(a) > FAR * FAR * edge2
}

/// The texture coordinates over a triangle.
struct Chart {
    /// At the vertices.
    uvs: [Vec2; 3],
    /// Those of the first two less that of the third.
    duv: [Vec2; 2],
    determinant: f32,
}

impl Chart {
    #[inline]
    fn new(uvs: [Vec2; 3]) -> Self {
        let duv = [uvs[0] - uvs[2], uvs[1] - uvs[2]];
        Self { uvs, duv, determinant: duv[0].perp_dot(duv[1]) }
    }

    /// Whether the texture coordinates do not span the plane.
    #[inline]
    fn is_degenerate(&self) -> bool {
        !(self.determinant.abs() >= 1e-9)
    }

    /// Derivatives by u and v of what is linear over the triangle, from its values at the vertices.
    #[inline]
    fn derivatives(&self, [x0, x1, x2]: [Vec3; 3]) -> [Vec3; 2] {
        let ([d02, d12], [x02, x12]) = (self.duv, [x0 - x2, x1 - x2]);
        let s = 1.0 / self.determinant;
        [(x02 * d12.y - x12 * d02.y) * s, (x12 * d02.x - x02 * d12.x) * s]
    }
}

/// Barycentric weights from the second and third.
#[inline(always)]
fn weights(b1: f32, b2: f32) -> [f32; 3] {
    [1.0 - b1 - b2, b1, b2]
}

/// A weighted sum.
#[inline(always)]
fn mix<T: std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>>(b: [f32; 3], [x, y, z]: [T; 3]) -> T {
    x * b[0] + y * b[1] + z * b[2]
}

/// A ray turned into the space where it runs along z through the origin: what the watertight test of Woop, Benthin
/// and Wald (2013) wants.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct RayShear {
    pub(crate) origin: Vec3,
    /// The axes that become x, y and z; z is the one along which the ray runs fastest.
    pub(crate) axes: [usize; 3],
    /// Shear of x and y by z, and scale of z.
    pub(crate) shear: Vec3,
}

/// The axis along which a direction is fastest. Without branches: for rays in all directions they would go wrong as often as not.
#[inline(always)]
pub(crate) fn fastest_axis(d: Vec3) -> u32 {
    let d = d.abs();
    u32::from(!((d.x > d.y) & (d.x > d.z))) * (2 - u32::from(d.y > d.z))
}

/// The axes that become x, y and z where z was each. In memory, lest the compiler writes them anew for every ray.
static AXES: [[usize; 3]; 4] = [[1, 2, 0], [2, 0, 1], [0, 1, 2], [0, 1, 2]];

impl RayShear {
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> Self {
        let axis = fastest_axis(ray.direction);
        Self::known(ray.origin, axis as usize, Self::along(ray.direction, axis))
    }

    /// The ray from `origin` that runs fastest along `axis`, where its shear is known.
    #[inline(always)]
    pub(crate) fn known(origin: Vec3, axis: usize, shear: Vec3) -> Self {
        Self { origin, axes: AXES[axis & 3], shear }
    }

    /// The shear of rays in the direction `d`, which is fastest along `axis`.
    #[inline(always)]
    pub(crate) fn along(d: Vec3, axis: u32) -> Vec3 {
        let d = permuted(d, axis);
        Vec3::new(-d.x / d.z, -d.y / d.z, 1.0 / d.z)
    }

    /// The origin by its new axes.
    #[inline(always)]
    pub(crate) fn permuted_origin(&self) -> Vec3 {
        let origin = self.origin.to_array();
        Vec3::new(origin[self.axes[0]], origin[self.axes[1]], origin[self.axes[2]])
    }

    /// The triangle `p` against the ray. The vectorised test of the hierarchy does the same operations in the same order.
    ///
    /// Edge functions are differences of two rounded products. Rounding is monotonic, so their sign is right or
    /// zero; zero counts as inside for both neighbours of an edge: nothing leaks.
    pub(crate) fn intersect(&self, p: [Vec3; 3], t_max: f32) -> Option<ShapeHit> {
        let [kx, ky, kz] = self.axes;
        let triangle = ShearedTriangle::new(p.map(|p| {
            let p = p - self.origin;
            sheared_vertex(Vec3::new(p[kx], p[ky], p[kz]), self.shear)
        }));
        if !triangle.is_inside() {
            return None;
        }
        let triangle = if triangle.determinant() == 0.0 { triangle.by_exact_products() } else { triangle };
        if !triangle.is_inside() || triangle.determinant() == 0.0 {
            return None;
        }
        let (hit, is_in_front) = triangle.hit(self.shear.z);
        (is_in_front && hit.t < t_max).then_some(hit)
    }
}

/// A triangle in the space where a ray runs along z through the origin, before it is scaled along that axis.
#[derive(Copy, Clone, Debug)]
pub(crate) struct ShearedTriangle {
    pub(crate) vertices: [Vec3; 3],
    /// Twice the areas that the edges span with the ray: as the barycentric weights of the opposite vertices.
    pub(crate) edges: [f32; 3],
}

impl ShearedTriangle {
    #[inline(always)]
    pub(crate) fn new(vertices: [Vec3; 3]) -> Self {
        let edge = |a: Vec3, b: Vec3| a.x * b.y - a.y * b.x;
        Self { vertices, edges: opposite_edges(vertices, edge) }
    }

    /// The same where the edge functions cancelled.
    fn by_exact_products(&self) -> Self {
        let edge =
            |a: Vec3, b: Vec3| (f64::from(a.x) * f64::from(b.y) - f64::from(a.y) * f64::from(b.x)) as f32;
        Self { edges: opposite_edges(self.vertices, edge), ..*self }
    }

    /// Whether the ray's line passes within, borders included.
    #[inline(always)]
    pub(crate) fn is_inside(&self) -> bool {
        let [a, b, c] = self.edges;
        let lowest = lower(a, lower(b, c));
        let highest = higher(a, higher(b, c));
        (lowest >= 0.0) | (highest <= 0.0)
    }

    /// The sum of the edge functions.
    #[inline(always)]
    pub(crate) fn determinant(&self) -> f32 {
        let [a, b, c] = self.edges;
        (a + b) + c
    }

    /// Where the ray, whose scale along z is `scale`, meets it, and whether that is safely in front of the origin; without a meaning for a
    /// determinant of 0.
    #[inline(always)]
    pub(crate) fn hit(&self, scale: f32) -> (ShapeHit, bool) {
        let (e, v) = (self.edges, self.vertices);
        let z = [v[0].z * scale, v[1].z * scale, v[2].z * scale];
        let inv_det = 1.0 / self.determinant();
        let t = ((e[0] * z[0] + e[1] * z[1]) + e[2] * z[2]) * inv_det;
        (ShapeHit { t, u: e[1] * inv_det, v: e[2] * inv_det }, is_in_front(t, v, z, inv_det))
    }
}

/// The vertex that lies at `p`, by permuted axes, from the origin of a ray, in the space of [`ShearedTriangle`]s.
#[inline(always)]
pub(crate) fn sheared_vertex(p: Vec3, shear: Vec3) -> Vec3 {
    Vec3::new(p.x + shear.x * p.z, p.y + shear.y * p.z, p.z)
}

/// `v` by the axes that become x, y and z where a ray runs fastest along `axis`.
#[inline(always)]
pub(crate) fn permuted(v: Vec3, axis: u32) -> Vec3 {
    let by_axis = |x, y, z| {
        if axis == 0 {
            x
        } else if axis == 1 {
            y
        } else {
            z
        }
    };
    Vec3::new(by_axis(v.y, v.z, v.x), by_axis(v.z, v.x, v.y), by_axis(v.x, v.y, v.z))
}

/// The function of an edge, of the edges opposite to the vertices.
#[inline(always)]
fn opposite_edges(v: [Vec3; 3], edge: impl Fn(Vec3, Vec3) -> f32) -> [f32; 3] {
    [edge(v[1], v[2]), edge(v[2], v[0]), edge(v[0], v[1])]
}

/// Whether `t`, the mean of the vertices' ray parameters `z` weighted by the edge functions, is safely above 0.
///
/// It is where all vertices are in front, however thin the triangle looks: then no error of the weights can bring the mean
/// behind. Otherwise it must exceed its error, in the way of the pbrt book, 4th edition, §6.8.7: the weights shift the
/// mean by 3·δe/det of the range of `z`.
#[inline(always)]
fn is_in_front(t: f32, v: [Vec3; 3], z: [f32; 3], inv_det: f32) -> bool {
    let max = |a: f32, b: f32, c: f32| higher(higher(a.abs(), b.abs()), c.abs());
    let delta_t = gamma(8) * max(z[0], z[1], z[2]);
    let nearest = lower(z[0], lower(z[1], z[2]));
    let max_x = max(v[0].x, v[1].x, v[2].x);
    let max_y = max(v[0].y, v[1].y, v[2].y);
    let max_z = max(v[0].z, v[1].z, v[2].z);
    let delta_x = gamma(5) * (max_x + max_z);
    let delta_y = gamma(5) * (max_y + max_z);
    let delta_e = 2.0 * ((gamma(2) * max_x * max_y + delta_y * max_x) + delta_x * max_y);
    let range = higher(z[0], higher(z[1], z[2])) - nearest;
    (nearest > delta_t) | (t > delta_t + 3.0 * delta_e * range * inv_det.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeshParts;
    use tenfold_math::Transform;
    use tenfold_testkit::Rng;

    #[test]
    fn what_is_far_looks_small() {
        let mut rng = Rng::new(11);
        let mut small = 0;
        for _ in 0..2000 {
            let positions = (0..3).map(|_| rng.vec3()).collect::<Vec<_>>();
            let parts = MeshParts { positions, indices: vec![0, 1, 2], ..MeshParts::default() };
            let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
            let triangle = Triangle { mesh: &mesh, index: 0 };
            let [a, b, c] = triangle.positions();
            let edge = b.distance(a).max(c.distance(a));
            // Some of these are nearer, and some that are may look large enough.
            let from = a + rng.direction() * edge * FAR * (0.1 + 1.1 * rng.f32());
            let exact = SphericalTriangle::new(from, [a, b, c]);
            let seen = exact.filter(|t| SPHERICAL_RANGE.contains(&t.solid_angle()));
            assert_eq!(triangle.seen_from(&ReferencePoint::free(from, 0.0)), seen);
            small += u32::from(seen.is_none());
        }
        assert!((500..1900).contains(&small), "{small}");
    }
}
