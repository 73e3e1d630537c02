use tenfold_math::ops;
use tenfold_math::{DVec3, ONE_MINUS_EPSILON, Vec2, Vec3};

/// A triangle as it is seen from a point, to be sampled uniformly in solid angle (Arvo 1995).
///
/// All in double precision and without Arvo's arc cosines: both coordinates follow from half-angle formulas that stay exact
/// for triangles that look small, down to about 1e-12 steradians.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SphericalTriangle {
    /// Unit vectors to the vertices.
    a: DVec3,
    b: DVec3,
    c: DVec3,
    /// Unit tangent at `a` of the arc to `c`.
    tangent: DVec3,
    /// Sine and cosine of the angle at `a`.
    sin_alpha: f64,
    cos_alpha: f64,
    /// Tangent of half the arc from `a` to `b`.
    tan_half_ab: f64,
    solid_angle: f64,
    /// The triangle itself, seen from the point: first vertex and edges.
    v0: DVec3,
    e1: DVec3,
    e2: DVec3,
}

/// A sample of a [`SphericalTriangle`].
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TrianglePoint {
    /// Unit vector from the point to the triangle.
    pub direction: Vec3,
    /// Barycentric coordinates of the point hit; they sum to one.
    pub barycentric: Vec3,
    /// Density per steradian.
    pub pdf: f32,
}

impl SphericalTriangle {
    /// The triangle `vertices` seen from `from`; `None` where it covers no solid angle, or `from` lies on it.
    pub fn new(from: Vec3, vertices: [Vec3; 3]) -> Option<Self> {
        let [v0, v1, v2] = vertices.map(|v| v.as_dvec3() - from.as_dvec3());
        let (a, b, c) = (v0.try_normalize()?, v1.try_normalize()?, v2.try_normalize()?);
        let (e1, e2) = (v1 - v0, v2 - v0);
        let solid_angle = solid_angle(a, b, c);
        // The planes through a and the other two; their angle is the one at a.
        let (ab, ac) = (a.cross(b - a), a.cross(c - a));
        let (sin_alpha, cos_alpha) = (ab.cross(ac).length(), ab.dot(ac));
        let length = ops::hypot(sin_alpha, cos_alpha);
        let tangent = ac.cross(a).try_normalize()?;
        let tan_half_ab = (b - a).length() / (b + a).length();
        let new = Self {
            a,
            b,
            c,
            tangent,
            sin_alpha: sin_alpha / length,
            cos_alpha: cos_alpha / length,
            tan_half_ab,
            solid_angle,
            v0,
            e1,
            e2,
        };
        let good = solid_angle > 0.0 && length > 0.0 && tan_half_ab.is_finite() && tan_half_ab > 0.0;
        (good && solid_angle.is_finite()).then_some(new)
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

    /// A uniform direction to the triangle.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Option<TrianglePoint> {
        // The point c' of the arc from a to c for which the triangle (a, b, c') has the share u.x of the area A:
        // tan(A / 2) (1 + t cos α) = t sin α with t = tan(ab / 2) tan(ac' / 2) (Todhunter 1886, art. 103).
        let (sin_half, cos_half) = ops::sin_cos(0.5 * f64::from(u.x) * self.solid_angle);
        let denominator = self.tan_half_ab * (self.sin_alpha * cos_half - self.cos_alpha * sin_half);
        // The tangent of half of ac' as a fraction; sine and cosine of the whole from it.
        let norm = sin_half * sin_half + denominator * denominator;
        if norm <= 0.0 {
            return None;
        }
        let cos_arc = (denominator * denominator - sin_half * sin_half) / norm;
        let sin_arc = 2.0 * sin_half * denominator / norm;
        let c = self.a * cos_arc + self.tangent * sin_arc;

        // Along the arc from b to c' the versine is uniform.
        let chord = c - self.b;
        let versine = f64::from(u.y) * 0.5 * chord.length_squared();
        let tangent = (chord - self.b * self.b.dot(chord)).normalize_or_zero();
        let w =
            (self.b * (1.0 - versine) + tangent * (versine * (2.0 - versine)).max(0.0).sqrt()).normalize();

        // Where the ray meets the plane (Möller and Trumbore 1997).
        let p = w.cross(self.e2);
        let determinant = self.e1.dot(p);
        let s = -self.v0;
        let (b1, b2) = (s.dot(p) / determinant, w.dot(s.cross(self.e1)) / determinant);
        if !(b1.is_finite() && b2.is_finite()) {
            return None;
        }
        let (b1, b2) = (b1.clamp(0.0, 1.0), b2.clamp(0.0, 1.0));
        let excess = (b1 + b2).max(1.0);
        let (b1, b2) = ((b1 / excess) as f32, (b2 / excess) as f32);
        let barycentric = Vec3::new((1.0 - b1 - b2).max(0.0), b1, b2);
        Some(TrianglePoint { direction: w.as_vec3(), barycentric, pdf: self.pdf() })
    }

    /// The numbers that [`Self::sample`] maps to the unit vector `direction`, which must lie within.
    pub fn invert(&self, direction: Vec3) -> Vec2 {
        let w = direction.as_dvec3().normalize();
        // c' is where the great circles through b and w and through a and c meet.
        let ac = self.a.cross(self.c - self.a);
        let Some(c) = self.b.cross(w - self.b).cross(ac).try_normalize() else {
            return Vec2::ZERO;
        };
        let c = if c.dot(self.a + self.c) < 0.0 { -c } else { c };
        let x = solid_angle(self.a, self.b, c) / self.solid_angle;
        let y = (w - self.b).length_squared() / (c - self.b).length_squared();
        Vec2::new(x as f32, y as f32).clamp(Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON))
    }
}

/// Van Oosterom and Strackee 1983, with the triple product taken of differences.
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let volume = a.dot((b - a).cross(c - a)).abs();
    2.0 * ops::atan2(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
