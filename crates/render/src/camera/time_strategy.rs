use super::{Shutter, ShutterCurve, ShutterSample};
use std::{fmt, sync::Arc};
use tenfold_math::{Bounds3, Floats, Slots, Vec3, WIDTH};
use tenfold_sampling::PiecewiseConstant1D;

/// How the instant is chosen at which the picture is seen. The picture is the same for all, the noise is not.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TimeStrategy {
    /// By the light that the shutter lets in: all samples count alike.
    #[default]
    Shutter,
    /// Uniformly along the path of something that moves.
    Path(Arc<PathTimes>),
}

impl TimeStrategy {
    /// An instant while `shutter` is open.
    #[inline]
    pub fn sample(&self, shutter: &Shutter, u: f32) -> ShutterSample {
        match self {
            Self::Shutter => shutter.sample(u),
            Self::Path(path) => path.sample(shutter, u),
        }
    }

    /// [`TimeStrategy::sample`] of each of `slots`: the instants, and their weights.
    #[inline]
    pub fn samples(&self, slots: Slots, shutter: &Shutter, u: &Floats) -> (Floats, Floats) {
        let (mut time, mut weight) = ([0.0; WIDTH], [1.0; WIDTH]);
        if *self == Self::Shutter && shutter.curve == ShutterCurve::Box {
            // The usual, in a loop without branches.
            (0..WIDTH).for_each(|i| time[i] = shutter.instant(u[i]));
        } else {
            for i in slots {
                ShutterSample { time: time[i], weight: weight[i] } = self.sample(shutter, u[i]);
            }
        }
        (time, weight)
    }
}

/// As the command line takes it: `shutter`, `path:ball`.
impl fmt::Display for TimeStrategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shutter => f.write_str("shutter"),
            Self::Path(path) => write!(f, "path:{}", path.name),
        }
    }
}

/// Instants at which a place `s(t)` is anywhere on its path with the same probability: their density is in proportion to its speed
/// `|s'(t)|`, and the weight of a sample, the shutter's curve over that density, to `1 / |s'(t)|`.
///
/// The path is tabulated, and samples have exactly the density of the table: however coarse, it does not bias the picture. Where the
/// place rests its path alone would never ask what there is to see; so the density is nowhere below [`Self::FLOOR`] of
/// its mean, before it is normalised.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTimes {
    name: String,
    /// Over the fractions of the shutter's interval while it is open.
    density: PiecewiseConstant1D,
}

impl PathTimes {
    /// The least density, as a part of its mean.
    pub const FLOOR: f32 = 0.05;

    const CELLS: usize = 1024;

    /// The times of the place that is at `place(t)` at the time `t`, while `shutter` is open. None where it stays where it is.
    pub fn new(name: &str, place: impl Fn(f32) -> Vec3, shutter: &Shutter) -> Option<Self> {
        let [from, to] = shutter.curve.support();
        let fraction = |i: usize| from + (to - from) * (i as f32 / Self::CELLS as f32);
        let places: Vec<Vec3> = (0..=Self::CELLS).map(|i| place(shutter.instant(fraction(i)))).collect();
        // Rounding makes places of their own out of one.
        let path = Bounds3::around(places.iter().copied());
        let rounding = 1e-5 * path.min.abs().max(path.max.abs()).max_element();
        if path.diagonal().max_element() <= rounding {
            return None;
        }
        let steps: Vec<f32> = places.windows(2).map(|p| p[0].distance(p[1])).collect();
        let mean = steps.iter().map(|&step| f64::from(step)).sum::<f64>() / Self::CELLS as f64;
        let floor = (f64::from(Self::FLOOR) * mean) as f32;
        let steps: Vec<f32> = steps.into_iter().map(|step| step.max(floor)).collect();
        Some(Self { name: name.to_owned(), density: PiecewiseConstant1D::with_range(&steps, from, to) })
    }

    /// An instant. It goes forward with `u`.
    #[inline]
    pub fn sample(&self, shutter: &Shutter, u: f32) -> ShutterSample {
        let sample = self.density.sample(u);
        ShutterSample {
            time: shutter.instant(sample.x),
            weight: shutter.curve.density(sample.x) / sample.pdf,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ShutterCurve;

    fn shutter(curve: ShutterCurve) -> Shutter {
        Shutter { open: 1.0, close: 3.0, curve }
    }

    #[test]
    fn places_are_uniform_along_the_path_and_means_those_of_time() {
        // A place that speeds up steadily, and then rests for the last quarter.
        let way = |t: f32| ((t - 1.0) / 1.5).min(1.0).powi(2);
        let curves = [
            ShutterCurve::Box,
            ShutterCurve::trapezoid(0.5, 0.5).unwrap(),
            ShutterCurve::table(&[[0.2, 1.0], [0.4, 0.0], [0.4, 2.0], [0.9, 2.0]]).unwrap(),
        ];
        for curve in curves {
            let shutter = shutter(curve);
            let path = PathTimes::new("it", |t| Vec3::new(0.0, way(t), 2.0), &shutter).unwrap();
            const N: u32 = 20_000;
            let samples: Vec<_> =
                (0..N).map(|i| path.sample(&shutter, (i as f32 + 0.5) / N as f32)).collect();
            assert!(samples.windows(2).all(|s| s[0].time <= s[1].time));
            let mean = |f: &dyn Fn(&ShutterSample) -> f32| {
                samples.iter().map(|s| f64::from(f(s))).sum::<f64>() / f64::from(N)
            };
            let by_shutter =
                (0..N).map(|i| f64::from(shutter.sample((i as f32 + 0.5) / N as f32).time)).sum::<f64>();
            assert!((mean(&|s| s.weight) - 1.0).abs() < 2e-3, "{}", mean(&|s| s.weight));
            assert!((mean(&|s| s.weight * s.time) - by_shutter / f64::from(N)).abs() < 5e-3);
        }
        let shutter = shutter(ShutterCurve::Box);
        let path = PathTimes::new("it", |t| Vec3::new(0.0, way(t), 2.0), &shutter).unwrap();
        // The floor takes a part of the samples: to the rest in proportion to their length, where they are fast enough.
        let half = (1..2000).map(|i| path.sample(&shutter, i as f32 / 2000.0).time);
        let below = half.filter(|t| way(*t) < 0.5).count() as f32 / 2000.0;
        assert!((below - 0.5).abs() < 0.02, "{below}");
        assert!(path.sample(&shutter, 0.999).time > 2.5);
    }

    #[test]
    fn slots_have_the_times_of_each_alone() {
        for curve in [ShutterCurve::Box, ShutterCurve::trapezoid(0.2, 0.5).unwrap()] {
            let shutter = shutter(curve);
            let path = PathTimes::new("it", |t| Vec3::X * t * t, &shutter).unwrap();
            for strategy in [TimeStrategy::Shutter, TimeStrategy::Path(Arc::new(path))] {
                let u = std::array::from_fn(|i| i as f32 / WIDTH as f32);
                let (time, weight) = strategy.samples(Slots::first(WIDTH), &shutter, &u);
                for i in 0..WIDTH {
                    let alone = ShutterSample { time: time[i], weight: weight[i] };
                    assert_eq!(strategy.sample(&shutter, u[i]), alone, "{strategy}");
                }
            }
        }
    }

    #[test]
    fn what_stays_in_place_has_no_path() {
        let shutter = shutter(ShutterCurve::Box);
        assert_eq!(PathTimes::new("it", |_| Vec3::ONE, &shutter), None);
        let rounded = |t: f32| Vec3::ONE * if t > 2.0 { 1.0 } else { 1.0f32.next_up() };
        assert_eq!(PathTimes::new("it", rounded, &shutter), None);
    }
}
