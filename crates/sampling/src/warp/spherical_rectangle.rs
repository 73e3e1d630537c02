use tenfold_math::ops;
use tenfold_math::{ONE_MINUS_EPSILON, Vec2, Vec3};

/// A rectangle as it is seen from the origin, to be sampled uniformly in solid angle (Ureña, Fajardo and King 2013). It lies along x and
/// y in a plane of constant z.
///
/// The paper's angles between planes appear here as complex numbers: the corner at (x, y) in the plane at z has the number
/// |z| r + i x y, with r its distance, whose angle is its share of the solid angle. Products of them take the place of sums of arc
/// cosines.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SphericalRectangle {
    x: [f64; 2],
    y: [f64; 2],
    /// Distance of the plane.
    z: f64,
    /// Distances of the corners 00, 10, 01, 11.
    corners: [f64; 4],
    /// The complex number of the edge at the lower x.
    edge: [f64; 2],
    solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle of the given `size` along x and y whose lower corner in both is `corner`; `None` where it covers no solid angle.
    #[inline]
    pub fn new(corner: Vec3, size: Vec2) -> Option<Self> {
        let from = |low: f32, size: f32| [low.into(), f64::from(low) + f64::from(size)];
        let (x, y, z) = (from(corner.x, size.x), from(corner.y, size.y), f64::from(corner.z).abs());
        let distance = |x: f64, y: f64| (x * x + y * y + z * z).sqrt();
        let corners =
            [distance(x[0], y[0]), distance(x[1], y[0]), distance(x[0], y[1]), distance(x[1], y[1])];
        let number = |x: f64, y: f64, r: f64| [z * r, x * y];
        let edge = |x: f64, r: [f64; 2]| times_conjugate(number(x, y[1], r[1]), number(x, y[0], r[0]));
        let (near, far) = (edge(x[0], [corners[0], corners[2]]), edge(x[1], [corners[1], corners[3]]));
        let solid_angle = area(near, far);
        let new = Self { x, y, z, corners, edge: near, solid_angle };
        (solid_angle > 0.0 && solid_angle < std::f64::consts::TAU).then_some(new)
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

    /// Distances of the corners, in the order 00, 10, 01, 11.
    #[inline]
    pub fn corner_distances(&self) -> [f32; 4] {
        self.corners.map(|r| r as f32)
    }

    /// Where a uniform direction meets the rectangle, from 0 to 1 along both edges; its density is [`Self::pdf`].
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let Self { x: [x0, x1], y: [y0, y1], z, edge: [re, im], .. } = *self;
        let z2 = z * z;
        // Distances of the edges along x from the x axis; over them the paper's b0 and b1 are −y0 and y1.
        let (a0, a1) = ((z2 + y0 * y0).sqrt(), (z2 + y1 * y1).sqrt());
        let a = a0 * a1;
        // Sine and cosine of the azimuthal angle (eq. 8): that of −edge, whose length is a (x0² + z²), comes on top.
        let (s, c) = ops::sin_cos(f64::from(u.x) * self.solid_angle);
        let scale = -1.0 / ((x0 * x0 + z2) * a);
        let (s, c) = ((s * re + c * im) * scale, (c * re - s * im) * scale);
        // The line at x for which the part of the rectangle below it has the share u.x of the solid angle (eq. 9 to 13, times a).
        let f = -(c * y0 * a1 + y1 * a0);
        let s_z = s * z;
        let across = f * f - (s_z * a1) * (s_z * a1);
        let x = (s_z * a).abs().copysign(s_z * f) / across.max(0.0).sqrt();
        let x = clamp(x, x0, x1);

        // Along that line the sine of the elevation is uniform (eq. 16 to 18).
        let d2 = x * x + z2;
        let [h0, h1] = [y0, y1].map(|y| y / (d2 + y * y).sqrt());
        let h = h0 + f64::from(u.y) * (h1 - h0);
        let y = clamp(h * (d2 / (1.0 - h * h).max(0.0)).sqrt(), y0, y1);
        let share = |x: f64, [x0, x1]: [f64; 2]| ((x - x0) / (x1 - x0)) as f32;
        Vec2::new(share(x, self.x), share(y, self.y))
    }

    /// The numbers that [`Self::sample`] maps to `place` in the rectangle, from 0 to 1 along both edges.
    #[inline]
    pub fn invert(&self, place: Vec2) -> Vec2 {
        let Self { x: [x0, x1], y: [y0, y1], z, .. } = *self;
        let x = x0 + f64::from(place.x) * (x1 - x0);
        let y = y0 + f64::from(place.y) * (y1 - y0);
        let d2 = x * x + z * z;
        let [r0, r, r1] = [y0, y, y1].map(|y| (d2 + y * y).sqrt());
        let [h0, h, h1] = [y0 / r0, y / r, y1 / r1];
        let line = times_conjugate([z * r1, x * y1], [z * r0, x * y0]);
        Vec2::new((area(self.edge, line) / self.solid_angle) as f32, ((h - h0) / (h1 - h0)) as f32)
            .clamp(Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON))
    }
}

/// The nearest number from `low` to `high`; `low` for NaN.
#[inline]
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// The product of a complex number and the conjugate of another.
#[inline]
fn times_conjugate([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c + b * d, b * c - a * d]
}

/// Solid angle of a rectangle whose edges at the lower and upper x have these numbers: the angle of a product.
#[inline]
fn area(near: [f64; 2], far: [f64; 2]) -> f64 {
    let [re, im] = times_conjugate(far, near);
    let angle = ops::atan2(im, re);
    // Sums above π come out negative, and so do zeros by rounding.
    if angle < -1e-6 { angle + std::f64::consts::TAU } else { angle }
}
