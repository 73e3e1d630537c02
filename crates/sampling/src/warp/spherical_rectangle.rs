use tenfold_math::ops;
use tenfold_math::{DVec3, ONE_MINUS_EPSILON, Vec2, Vec3};

/// A rectangle as it is seen from a point, to be sampled uniformly in solid angle (Ureña, Fajardo and King 2013).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SphericalRectangle {
    /// Unit axes: along the edges, and normal with the rectangle on its negative side.
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
    /// The constant of the azimuthal angle (paper, eq. 8).
    k: f64,
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
        let solid_angle = area([x0, x1], [y0, y1], z0);
        if !(solid_angle > 0.0 && solid_angle.is_finite()) {
            return None;
        }

        // Normals of the planes through the point and the edges at y0, y1 and x0 (paper, eq. 4).
        let n0 = DVec3::new(0.0, z0, -y0).normalize();
        let n2 = DVec3::new(0.0, -z0, y1).normalize();
        let n3 = DVec3::new(z0, 0.0, -x0).normalize();
        let inner = |a: DVec3, b: DVec3| ops::acos((-a.dot(b)).clamp(-1.0, 1.0));
        let k = std::f64::consts::TAU - inner(n2, n3) - inner(n3, n0);
        Some(Self { x, y, z, x0, x1, y0, y1, z0, b0: n0.z, b1: n2.z, k, solid_angle })
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
        let (s, c) = ops::sin_cos(f64::from(u.x) * self.solid_angle + self.k);
        let f = (c * self.b0 - self.b1) / s;
        let cosine = 1f64.copysign(f) / (f * f + self.b0 * self.b0).sqrt();
        let cosine = if cosine.is_nan() { 0.0 } else { cosine.clamp(-1.0, 1.0) };
        let x = -cosine * self.z0 / (1.0 - cosine * cosine).max(0.0).sqrt();
        let x = if x.is_nan() { self.x0 } else { x.clamp(self.x0, self.x1) };

        // Along that line the sine of the elevation is uniform (eq. 16 to 18).
        let d = ops::hypot(x, self.z0);
        let (h0, h1) = (self.y0 / ops::hypot(d, self.y0), self.y1 / ops::hypot(d, self.y1));
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
        let d = ops::hypot(x, self.z0);
        let sine = |y: f64| y / ops::hypot(d, y);
        let (h0, h1) = (sine(self.y0), sine(self.y1));
        let u = area([self.x0, x], [self.y0, self.y1], self.z0) / self.solid_angle;
        Vec2::new(u as f32, ((sine(y) - h0) / (h1 - h0)) as f32)
            .clamp(Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON))
    }
}

/// Solid angle of the rectangle of these ranges in the plane at `z`.
fn area(x: [f64; 2], y: [f64; 2], z: f64) -> f64 {
    let corner = |x: f64, y: f64| ops::atan2(x * y, z.abs() * (x * x + y * y + z * z).sqrt());
    corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])
}
