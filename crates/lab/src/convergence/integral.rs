use tenfold_math::{Vec2, ops};
use tenfold_sampling::{Dimension, PixelSample};

/// An integral over the unit cube whose value is known: 1.
#[derive(Copy, Clone, Debug)]
pub struct Integral {
    /// The name.
    pub name: &'static str,
    /// What is integrated, in words.
    pub about: &'static str,
    /// The integrand at a sample.
    pub at: fn(&PixelSample<'_>) -> f64,
}

impl Integral {
    /// The smooth one over one pair.
    pub const SMOOTH_2D: Self = Self {
        name: "smooth-2d",
        about: "The product of e^u, over the two numbers of one pair (the point on a light), divided by its integral (e − 1)².",
        at: |s| pair(s, Dimension::light_point(0)),
    };

    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::SMOOTH_2D,
        Self {
            name: "smooth-4d",
            about: "The product of e^u over the four numbers of two pairs (the point on the lens and that on a light), divided by \
                    its integral (e − 1)⁴.",
            at: |s| pair(s, Dimension::LENS) * pair(s, Dimension::light_point(0)),
        },
        Self {
            name: "smooth-10d",
            about: "The product of e^u over the ten variables of distributed ray tracing (four pairs: pixel, lens, light, direction of \
                    scattering; two numbers alone: time and wavelength), divided by its integral (e − 1)¹⁰.",
            at: |s| {
                let pairs = [
                    Dimension::PIXEL,
                    Dimension::LENS,
                    Dimension::light_point(0),
                    Dimension::scatter_direction(0),
                ];
                let alone = factor(s.get_1d(Dimension::TIME)) * factor(s.get_1d(Dimension::WAVELENGTH));
                pairs.into_iter().map(|d| pair(s, d)).product::<f64>() * alone
            },
        },
        Self {
            name: "disk-2d",
            about: "1 within the quarter of a disk of radius 0.8 about a corner of the square of one pair (the point on a light) and 0 \
                    beyond its edge, divided by its integral 0.16 π.",
            at: |s| {
                let u = s.get_2d(Dimension::light_point(0)).as_dvec2();
                if u.length_squared() < 0.64 { 1.0 / (0.16 * std::f64::consts::PI) } else { 0.0 }
            },
        },
    ];

    /// The integral of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|integral| integral.name == name)
    }
}

fn pair(sample: &PixelSample<'_>, dimension: Dimension) -> f64 {
    let Vec2 { x, y } = sample.get_2d(dimension);
    factor(x) * factor(y)
}

/// eᵘ over its mean, e − 1.
fn factor(u: f32) -> f64 {
    ops::exp(f64::from(u)) / (std::f64::consts::E - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::UVec2;
    use tenfold_sampling::{Sampler, SamplerKind};

    #[test]
    fn every_integral_is_one() {
        for integral in Integral::ALL {
            let sampler = Sampler::new(SamplerKind::Independent, 1, 5);
            let n = 40_000;
            let values: Vec<f64> = (0..n).map(|i| (integral.at)(&sampler.at(UVec2::ZERO, i))).collect();
            let mean = values.iter().sum::<f64>() / f64::from(n);
            let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / f64::from(n - 1);
            // Four tests at four standard errors: a false alarm in 4000.
            assert!((mean - 1.0).abs() < 4.0 * (variance / f64::from(n)).sqrt(), "{}: {mean}", integral.name);
        }
    }
}
