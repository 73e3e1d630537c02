use std::f32::consts::PI;
use tenfold_math::ops;

/// The shape of a filter along one axis; `x` is the offset from the centre in pixels.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Profile {
    /// Constant.
    Box,
    /// Linear down to zero at the radius.
    Triangle,
    /// A Gaussian of standard deviation `sigma` pixels, lowered to reach zero at the radius.
    Gaussian {
        /// Standard deviation, in pixels.
        sigma: f32,
    },
    /// The cubic family of Mitchell and Netravali 1988, stretched over the radius.
    Mitchell {
        /// Blur.
        b: f32,
        /// Ringing; `b + 2c = 1` is recommended.
        c: f32,
    },
    /// A sinc windowed by a wider one (Lanczos), `tau` lobes over the radius.
    Sinc {
        /// Number of lobes that the window leaves.
        tau: f32,
    },
}

impl Profile {
    /// The unnormalised value at `x`, zero beyond `radius`.
    pub fn eval(self, x: f32, radius: f32) -> f32 {
        let x = x.abs();
        if x > radius {
            return 0.0;
        }
        match self {
            Self::Box => 1.0,
            Self::Triangle => radius - x,
            Self::Gaussian { sigma } => (gaussian(x, sigma) - gaussian(radius, sigma)).max(0.0),
            Self::Mitchell { b, c } => mitchell(2.0 * x / radius, b, c),
            Self::Sinc { tau } => sinc(x) * sinc(x / tau),
        }
    }
}

fn gaussian(x: f32, sigma: f32) -> f32 {
    ops::exp(-x * x / (2.0 * sigma * sigma))
}

/// The piecewise cubic on `[0, 2]` (Mitchell and Netravali 1988, eq. 8).
fn mitchell(x: f32, b: f32, c: f32) -> f32 {
    let (x2, x3) = (x * x, x * x * x);
    if x <= 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + (6.0 - 2.0 * b)) / 6.0
    } else if x <= 2.0 {
        ((-b - 6.0 * c) * x3 + (6.0 * b + 30.0 * c) * x2 + (-12.0 * b - 48.0 * c) * x + (8.0 * b + 24.0 * c))
            / 6.0
    } else {
        0.0
    }
}

/// `sin(πx) / (πx)`.
fn sinc(x: f32) -> f32 {
    let t = PI * x;
    if t.abs() < 1e-4 { 1.0 - t * t / 6.0 } else { ops::sin(t) / t }
}
