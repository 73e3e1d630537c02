use tenfold_math::ops;
use tenfold_math::{DVec3, ONE_MINUS_EPSILON, Vec2, Vec3};

/// A rectangle as it is seen from a point, to be sampled uniformly in solid angle (Ureña, Fajardo and King 2013).
///
/// The paper's angles between planes appear here as complex numbers: the corner at (x, y) in the plane at z has the number
/// |z| r + i x y, with r its distance, whose angle is its share of the solid angle. Products of them take the place of sums of arc
/// cosines.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SphericalRectangle {
    /// Unit axes: along the edges, and across with the rectangle on its negative side.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    /// The rectangle in these axes, seen from the point.
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    z0: f64,
    /// Cosines between the normal and the planes through the point and the edges at y0 and y1.
    b0: f64,
    b1: f64,
    /// Cosine and sine of the constant of the azimuthal angle (paper, eq. 8).
    k: [f64; 2],
    solid_angle: f64,
}

/// A sample of a [`SphericalRectangle`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RectanglePoint {
    /// Unit vector from the point to the rectangle.
    pub direction: Vec3,
    /// Place in the rectangle, from 0 to 1 along both edges.
    pub uv: Vec2,
    /// Density per steradian.
    pub pdf: f32,
}

impl SphericalRectangle {
    /// The rectangle with a `corner` and two perpendicular edges seen from `from`; `None` where it covers no solid angle.
    pub fn new(from: Vec3, corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Option<Self> {
        let (u, v) = (edge_u.as_dvec3(), edge_v.as_dvec3());
        let (x, y) = (u.try_normalize()?, v.try_normalize()?);
        let mut z = x.cross(y);
        let d = corner.as_dvec3() - from.as_dvec3();
        let mut z0 = d.dot(z);
        if z0 > 0.0 {
            z0 = -z0;
            z = -z;
        }
        let (x0, y0) = (d.dot(x), d.dot(y));
        let (x1, y1) = (x0 + u.length(), y0 + v.length());
        let near = [corner_number(x0, y0, z0), corner_number(x0, y1, z0)];
        let solid_angle = area(near, [corner_number(x1, y0, z0), corner_number(x1, y1, z0)]);
        if !(solid_angle > 0.0 && solid_angle.is_finite()) {
            return None;
        }
        // The angles between the planes through the edge at x0 and those at its ends have i times these numbers.
        let [re, im] = times_conjugate(near[1], near[0]);
        let scale = -1.0 / (re * re + im * im).sqrt();
        let k = [re * scale, im * scale];
        let (b0, b1) = (-y0 / (z0 * z0 + y0 * y0).sqrt(), y1 / (z0 * z0 + y1 * y1).sqrt());
        Some(Self { x, y, z, x0, x1, y0, y1, z0, b0, b1, k, solid_angle })
    }

    /// The unit cross product of the edges along u and v.
    #[inline]
    pub fn normal(&self) -> Vec3 {
        self.x.cross(self.y).as_vec3()
    }

    /// In steradians.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// Density per steradian of all directions within.
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A uniform direction to the rectangle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> RectanglePoint {
        // The edge-parallel line at x for which the part below it has the share u.x of the solid angle (eq. 9 to 13).
        let (s, c) = ops::sin_cos(f64::from(u.x) * self.solid_angle);
        let [cos_k, sin_k] = self.k;
        let (s, c) = (s * cos_k + c * sin_k, c * cos_k - s * sin_k);
        let f = c * self.b0 - self.b1;
        let across = f * f - s * s * (1.0 - self.b0 * self.b0);
        let x = -self.z0 * s * 1f64.copysign(f) / across.max(0.0).sqrt();
        let x = if x.is_nan() { self.x0 } else { x.clamp(self.x0, self.x1) };

        // Along that line the sine of the elevation is uniform (eq. 16 to 18).
        let d2 = x * x + self.z0 * self.z0;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (d, h0, h1) = (d2.sqrt(), sine(self.y0), sine(self.y1));
        let h = h0 + f64::from(u.y) * (h1 - h0);
        let y = (h * d / (1.0 - h * h).max(0.0).sqrt()).clamp(self.y0, self.y1);

        let direction = (self.x * x + self.y * y + self.z * self.z0).normalize();
        let uv = Vec2::new(
            ((x - self.x0) / (self.x1 - self.x0)) as f32,
            ((y - self.y0) / (self.y1 - self.y0)) as f32,
        );
        RectanglePoint { direction: direction.as_vec3(), uv, pdf: self.pdf() }
    }

    /// The numbers that [`Self::sample`] maps to the place `uv` in the rectangle.
    pub fn invert(&self, uv: Vec2) -> Vec2 {
        let x = self.x0 + f64::from(uv.x) * (self.x1 - self.x0);
        let y = self.y0 + f64::from(uv.y) * (self.y1 - self.y0);
        let d2 = x * x + self.z0 * self.z0;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (h0, h1) = (sine(self.y0), sine(self.y1));
        let edge = |x: f64| [corner_number(x, self.y0, self.z0), corner_number(x, self.y1, self.z0)];
        let u = area(edge(self.x0), edge(x)) / self.solid_angle;
        Vec2::new(u as f32, ((sine(y) - h0) / (h1 - h0)) as f32)
            .clamp(Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON))
    }
}

/// The number of a corner: see [`SphericalRectangle`].
#[inline]
fn corner_number(x: f64, y: f64, z: f64) -> [f64; 2] {
    [z.abs() * (x * x + y * y + z * z).sqrt(), x * y]
}

/// The product of a complex number and the conjugate of another.
#[inline]
fn times_conjugate([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c + b * d, b * c - a * d]
}

/// Solid angle of the rectangle whose edges at x0 and x1 have these corners, at y0 and y1: the angle of a product.
#[inline]
fn area(near: [[f64; 2]; 2], far: [[f64; 2]; 2]) -> f64 {
    let [re, im] = times_conjugate(times_conjugate(far[1], far[0]), times_conjugate(near[1], near[0]));
    let angle = ops::atan2(im, re);
    // Sums above π come out negative, and so do zeros by rounding.
    if angle < -1e-6 { angle + std::f64::consts::TAU } else { angle }
}
