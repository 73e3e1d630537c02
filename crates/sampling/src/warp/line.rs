use tenfold_math::ops;
use tenfold_math::{ONE_MINUS_EPSILON, Vec2, lerp, sqr};

/// A number of `[0, 1)` with density proportional to the line from `a >= 0` at 0 to `b >= 0` at 1 (pbrt book §2.3.2);
/// uniform where both vanish.
#[inline]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    let sum = a + b;
    if sum <= 0.0 {
        return u;
    }
    // Scaled to a sum of one, so that squares neither overflow nor vanish.
    sample_scaled(u, a / sum, b / sum)
}

/// [`sample_linear`] for values whose squares are finite.
#[inline]
fn sample_scaled(u: f32, a: f32, b: f32) -> f32 {
    let denominator = a + lerp(u, sqr(a), sqr(b)).sqrt();
    if denominator > 0.0 { (u * (a + b) / denominator).min(ONE_MINUS_EPSILON) } else { 0.0 }
}

/// Density of [`sample_linear`].
#[inline]
pub fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    if !(0.0..=1.0).contains(&x) {
        0.0
    } else if a + b <= 0.0 {
        1.0
    } else {
        2.0 * lerp(x, a, b) / (a + b)
    }
}

/// The number that [`sample_linear`] maps to `x`.
#[inline]
pub fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    if a + b <= 0.0 { x } else { x * lerp(x, 2.0 * a, a + b) / (a + b) }
}

/// A point of the unit square with density proportional to the bilinear function whose values at
/// (0, 0), (1, 0), (0, 1), (1, 1) are the weights, none negative (pbrt book §2.4.3).
#[inline]
pub fn sample_bilinear(u: Vec2, w: [f32; 4]) -> Vec2 {
    let sum = w[0] + w[1] + w[2] + w[3];
    if sum <= 0.0 {
        return u;
    }
    let w = [w[0] / sum, w[1] / sum, w[2] / sum, w[3] / sum];
    let y = sample_scaled(u.y, w[0] + w[1], w[2] + w[3]);
    Vec2::new(sample_scaled(u.x, lerp(y, w[0], w[2]), lerp(y, w[1], w[3])), y)
}

/// Density of [`sample_bilinear`] per unit of area.
#[inline]
pub fn bilinear_pdf(p: Vec2, w: [f32; 4]) -> f32 {
    if !(0.0..=1.0).contains(&p.x) || !(0.0..=1.0).contains(&p.y) {
        return 0.0;
    }
    let sum = w[0] + w[1] + w[2] + w[3];
    if sum <= 0.0 {
        return 1.0;
    }
    4.0 * lerp(p.y, lerp(p.x, w[0], w[1]), lerp(p.x, w[2], w[3])) / sum
}

/// The numbers that [`sample_bilinear`] maps to `p`.
#[inline]
pub fn invert_bilinear(p: Vec2, w: [f32; 4]) -> Vec2 {
    Vec2::new(
        invert_linear(p.x, lerp(p.y, w[0], w[2]), lerp(p.y, w[1], w[3])),
        invert_linear(p.y, w[0] + w[1], w[2] + w[3]),
    )
}

/// A number of `(-radius, radius)` with the density of a tent: `(1 − |x| / radius) / radius`.
#[inline]
pub fn sample_tent(u: f32, radius: f32) -> f32 {
    if u < 0.5 { radius * ((2.0 * u).sqrt() - 1.0) } else { radius * (1.0 - (2.0 * (1.0 - u)).sqrt()) }
}

/// Density of [`sample_tent`].
#[inline]
pub fn tent_pdf(x: f32, radius: f32) -> f32 {
    (1.0 - x.abs() / radius).max(0.0) / radius
}

/// The number that [`sample_tent`] maps to `x`.
#[inline]
pub fn invert_tent(x: f32, radius: f32) -> f32 {
    let half = 0.5 * sqr(1.0 - (x.abs() / radius).min(1.0));
    if x < 0.0 { half } else { 1.0 - half }
}

/// A number of `[0, ∞)` with density `rate · exp(−rate · x)`.
#[inline]
pub fn sample_exponential(u: f32, rate: f32) -> f32 {
    -ops::ln_1p(-u) / rate
}

/// Density of [`sample_exponential`].
#[inline]
pub fn exponential_pdf(x: f32, rate: f32) -> f32 {
    if x < 0.0 { 0.0 } else { rate * ops::exp(-rate * x) }
}

/// The number that [`sample_exponential`] maps to `x`.
#[inline]
pub fn invert_exponential(x: f32, rate: f32) -> f32 {
    -ops::exp_m1(-rate * x)
}
