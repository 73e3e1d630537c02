//! Pixel reconstruction filters, by importance sampling.
//!
//! A sample belongs to exactly one pixel: instead of splatting a sample over every pixel whose filter covers it,
//! each pixel draws the positions of its samples from its own filter (Ernst et al. 2006, "Filter Importance
//! Sampling"). All filters here are separable, so the two axes are drawn apart.

mod profile;
mod tabulated;

pub use profile::Profile;
use tabulated::Tabulated;
use tenfold_math::{Floats, Slots, Vec2, Vec2s, WIDTH, vec2};
use tenfold_sampling::warp;

/// A position relative to the centre of the pixel, with its weight.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FilterSample {
    /// Offset from the centre of the pixel, in pixels.
    pub offset: Vec2,
    /// `f / (pdf · ∫f)`: one where the filter is sampled perfectly, negative on negative lobes. Its mean is one.
    pub weight: f32,
}

/// What a [`FilterSample`] says, in each slot.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FilterSamples {
    /// See [`FilterSample::offset`].
    pub offset: Vec2s,
    /// See [`FilterSample::weight`].
    pub weight: Floats,
}

/// A separable pixel filter.
#[derive(Clone, Debug)]
pub struct Filter {
    radius: Vec2,
    x: Axis,
    y: Axis,
}

#[derive(Clone, Debug)]
enum Axis {
    Box,
    Triangle,
    Tabulated(Tabulated),
}

impl Filter {
    /// The filter `profile(x / radius.x) · profile(y / radius.y)` that covers `±radius` pixels; `None` where its
    /// integral is not a positive number, so that it averages nothing.
    pub fn new(profile: Profile, radius: Vec2) -> Option<Self> {
        let axis = |radius: f32| {
            Some(match profile {
                Profile::Box => Axis::Box,
                Profile::Triangle => Axis::Triangle,
                _ => Axis::Tabulated(Tabulated::new(|x| profile.eval(x, radius), radius)?),
            })
        };
        Some(Self { radius, x: axis(radius.x)?, y: axis(radius.y)? })
    }

    /// Half the extent on each axis, in pixels.
    pub fn radius(&self) -> Vec2 {
        self.radius
    }

    /// Draws a position from two uniform numbers.
    #[inline]
    pub fn sample(&self, u: Vec2) -> FilterSample {
        let (x, wx) = self.x.sample(u.x, self.radius.x);
        let (y, wy) = self.y.sample(u.y, self.radius.y);
        FilterSample { offset: vec2(x, y), weight: wx * wy }
    }

    /// [`Filter::sample`] of each of `slots`.
    #[inline]
    pub fn samples(&self, slots: Slots, u: &Vec2s) -> FilterSamples {
        let mut samples = FilterSamples { offset: Vec2s::ZERO, weight: [1.0; WIDTH] };
        let mut weight = [1.0; WIDTH];
        self.x.samples(slots, &u.x, self.radius.x, &mut samples.offset.x, &mut samples.weight);
        self.y.samples(slots, &u.y, self.radius.y, &mut samples.offset.y, &mut weight);
        (0..WIDTH).for_each(|i| samples.weight[i] *= weight[i]);
        samples
    }
}

impl Axis {
    /// Position and weight.
    #[inline(always)]
    fn sample(&self, u: f32, radius: f32) -> (f32, f32) {
        match self {
            Self::Box => ((2.0 * u - 1.0) * radius, 1.0),
            Self::Triangle => (warp::sample_tent(u, radius), 1.0),
            Self::Tabulated(table) => table.sample(u),
        }
    }

    /// Positions and weights in each of `slots`.
    #[inline]
    fn samples(&self, slots: Slots, u: &Floats, radius: f32, x: &mut Floats, weight: &mut Floats) {
        if let Self::Box = self {
            // The usual, in a loop without branches.
            (0..WIDTH).for_each(|i| (x[i], weight[i]) = Self::Box.sample(u[i], radius));
        } else {
            slots.for_each(|i| (x[i], weight[i]) = self.sample(u[i], radius));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::ops;

    /// ∫ g f / ∫ f by the midpoint rule in one dimension.
    fn exact(profile: Profile, radius: f32, g: impl Fn(f64) -> f64) -> f64 {
        let n = 200_000;
        let (mut sum, mut norm) = (0.0, 0.0);
        for i in 0..n {
            let x = radius as f64 * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
            let f = profile.eval(x as f32, radius) as f64;
            sum += g(x) * f;
            norm += f;
        }
        sum / norm
    }

    #[test]
    fn samples_reproduce_the_moments_of_every_filter() {
        let profiles = [
            (Profile::Box, 0.5),
            (Profile::Triangle, 2.0),
            (Profile::Gaussian { sigma: 0.5 }, 1.5),
            (Profile::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }, 2.0),
            (Profile::Sinc { tau: 3.0 }, 4.0),
        ];
        for (profile, radius) in profiles {
            let filter = Filter::new(profile, Vec2::splat(radius)).unwrap();
            let n = 1 << 16;
            let (mut mean, mut second, mut cosine) = (0f64, 0f64, 0f64);
            for i in 0..n {
                // A lattice: its error is far below the tolerance.
                let u = vec2((i as f32 + 0.5) / n as f32, (i * 7919 % n) as f32 / n as f32);
                let s = filter.sample(u);
                assert!(s.offset.abs().max_element() <= radius * 1.0001);
                mean += s.weight as f64;
                second += s.weight as f64 * (s.offset.x as f64).powi(2);
                cosine += s.weight as f64 * ops::cos(s.offset.x as f64);
            }
            let n = n as f64;
            assert!((mean / n - 1.0).abs() < 2e-3, "{profile:?} {}", mean / n);
            assert!((second / n - exact(profile, radius, |x| x * x)).abs() < 3e-3, "{profile:?}");
            assert!((cosine / n - exact(profile, radius, ops::cos)).abs() < 3e-3, "{profile:?}");
        }
    }

    #[test]
    fn slots_have_the_samples_of_each_alone() {
        for profile in [Profile::Box, Profile::Triangle, Profile::Mitchell { b: 0.3, c: 0.4 }] {
            let filter = Filter::new(profile, vec2(2.0, 1.5)).unwrap();
            let mut u = Vec2s::ZERO;
            (0..WIDTH).for_each(|i| u.set(i, vec2(i as f32 / 16.0, (i * 7 % 16) as f32 / 16.0)));
            let samples = filter.samples(Slots::first(WIDTH), &u);
            for i in 0..WIDTH {
                let alone = FilterSample { offset: samples.offset.get(i), weight: samples.weight[i] };
                assert_eq!(filter.sample(u.get(i)), alone, "{profile:?}");
            }
        }
    }

    #[test]
    fn negative_lobes_carry_negative_weights() {
        let filter = Filter::new(Profile::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 }, Vec2::splat(2.0)).unwrap();
        assert!((0..1000).any(|i| filter.sample(vec2(i as f32 / 1000.0, 0.5)).weight < 0.0));
    }
}
