use std::f32::consts::{SQRT_2, TAU};
use tenfold_math::ops;
use tenfold_math::{Vec2, sqr};

/// The error function, to about 1e-15: its series (Abramowitz and Stegun 7.1.6) below 3, the continued fraction of its
/// complement (7.1.14) above.
pub fn erf(x: f64) -> f64 {
    let square = x * x;
    if x.abs() < 3.0 {
        let (mut term, mut sum, mut n) = (x, x, 0.5);
        while term.abs() > 1e-17 * sum.abs() {
            n += 1.0;
            term *= square / n;
            sum += term;
        }
        std::f64::consts::FRAC_2_SQRT_PI * ops::exp(-square) * sum
    } else if x.abs() < 6.0 {
        let y = x.abs();
        let fraction = (1..=60).rev().fold(y, |f, n| y + 0.5 * f64::from(n) / f);
        (1.0 - 0.5 * std::f64::consts::FRAC_2_SQRT_PI * ops::exp(-square) / fraction).copysign(x)
    } else if x.is_nan() {
        x
    } else {
        1f64.copysign(x)
    }
}

/// The inverse of the error function in single precision (Giles 2010, "Approximating the erfinv Function", table 5).
#[inline]
fn erf_inverse(x: f32) -> f32 {
    let horner = |w: f32, c: [f32; 9]| c.into_iter().reduce(|p, c| p * w + c).unwrap_or(0.0);
    let w = -ops::ln(((1.0 - x) * (1.0 + x)).max(f32::MIN_POSITIVE));
    x * if w < 5.0 {
        horner(
            w - 2.5,
            [
                2.810_226_36e-8,
                3.432_739_39e-7,
                -3.523_387_7e-6,
                -4.391_506_54e-6,
                2.185_808_7e-4,
                -1.253_725_03e-3,
                -4.177_681_64e-3,
                0.246_640_727,
                1.501_409_41,
            ],
        )
    } else {
        horner(
            w.sqrt() - 3.0,
            [
                -2.002_142_57e-4,
                1.009_505_58e-4,
                1.349_343_22e-3,
                -3.673_428_44e-3,
                5.739_507_73e-3,
                -7.622_461_3e-3,
                9.438_870_47e-3,
                1.001_674_06,
                2.832_976_82,
            ],
        )
    }
}

/// A normal number, by the inverse of its distribution function. `u = 0`, whose image is −∞, counts as half the
/// smallest step of uniform numbers.
#[inline]
pub fn sample_normal(u: f32, mean: f32, sigma: f32) -> f32 {
    let u = u.max(0.5 / (1u32 << 24) as f32);
    mean + SQRT_2 * sigma * erf_inverse(2.0 * u - 1.0)
}

/// Density of the normal distribution.
#[inline]
pub fn normal_pdf(x: f32, mean: f32, sigma: f32) -> f32 {
    ops::exp(-0.5 * sqr((x - mean) / sigma)) / (sigma * TAU.sqrt())
}

/// The number that [`sample_normal`] maps to `x`.
#[inline]
pub fn invert_normal(x: f32, mean: f32, sigma: f32) -> f32 {
    (0.5 + 0.5 * erf(f64::from(x - mean) / (f64::from(sigma) * std::f64::consts::SQRT_2))) as f32
}

/// Two independent normal numbers (Box and Muller 1958).
#[inline]
pub fn sample_two_normals(u: Vec2, mean: f32, sigma: f32) -> Vec2 {
    let r = sigma * (-2.0 * ops::ln_1p(-u.x)).sqrt();
    let (s, c) = ops::sin_cos(TAU * u.y);
    Vec2::splat(mean) + r * Vec2::new(c, s)
}

/// The normal distribution around zero cut off at `±radius`.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct TruncatedNormal {
    sigma: f32,
    radius: f32,
    /// Probability of the untruncated distribution within the radius.
    mass: f32,
}

impl TruncatedNormal {
    /// For positive `sigma` and `radius`.
    pub fn new(sigma: f32, radius: f32) -> Self {
        let mass = erf(f64::from(radius) / (f64::from(sigma) * std::f64::consts::SQRT_2)) as f32;
        Self { sigma, radius, mass }
    }

    /// A number of `[-radius, radius]`.
    #[inline]
    pub fn sample(&self, u: f32) -> f32 {
        let x = SQRT_2 * self.sigma * erf_inverse((2.0 * u - 1.0) * self.mass);
        x.clamp(-self.radius, self.radius)
    }

    /// Its density.
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        if x.abs() > self.radius { 0.0 } else { normal_pdf(x, 0.0, self.sigma) / self.mass }
    }

    /// The number that [`Self::sample`] maps to `x`.
    #[inline]
    pub fn invert(&self, x: f32) -> f32 {
        0.5 + (invert_normal(x, 0.0, self.sigma) - 0.5) / self.mass
    }
}
