use tenfold_math::lerp;
use tenfold_sampling::PiecewiseLinear1D;

/// When the shutter is open, and how far.
#[derive(Clone, Debug, PartialEq)]
pub struct Shutter {
    /// The instant of opening.
    pub open: f32,
    /// The instant of closing, after `open`.
    pub close: f32,
    /// How much light comes in between the two.
    pub curve: ShutterCurve,
}

/// How much light the shutter lets in, over the fraction of the interval that has passed. The picture is the mean over the
/// interval, weighted by the curve; the curve's own mean counts as one, so it does not change the exposure.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ShutterCurve {
    /// As much all the time.
    #[default]
    Box,
    /// As a function of the fraction, 0 to 1, that is linear from point to point.
    Linear(PiecewiseLinear1D),
}

/// An instant at which the picture is seen.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ShutterSample {
    /// The instant.
    pub time: f32,
    /// What the light seen then counts: the shutter's curve over the density of the sample. Its mean is one.
    pub weight: f32,
}

impl ShutterCurve {
    /// A curve that rises over the fraction `opening`, stays, and falls over the fraction `closing`; none where the two overlap or are
    /// negative.
    pub fn trapezoid(opening: f32, closing: f32) -> Option<Self> {
        if !(opening >= 0.0 && closing >= 0.0 && opening + closing <= 1.0) {
            return None;
        }
        if opening == 0.0 && closing == 0.0 {
            return Some(Self::Box);
        }
        Self::table(&[[0.0, 0.0], [opening, 1.0], [(1.0 - closing).max(opening), 1.0], [1.0, 0.0]])
    }

    /// A curve through pairs of a fraction of the interval and a weight, shut outside of the table. None where fractions fall or leave the
    /// interval, a weight is negative, or the shutter would be shut all the time.
    pub fn table(points: &[[f32; 2]]) -> Option<Self> {
        let inside = points.iter().all(|[x, f]| (0.0..=1.0).contains(x) && *f >= 0.0 && f.is_finite());
        PiecewiseLinear1D::new(points).filter(|_| inside).map(Self::Linear)
    }

    /// Density of the curve at a fraction of the interval.
    #[inline]
    pub fn density(&self, fraction: f32) -> f32 {
        match self {
            Self::Box => 1.0,
            Self::Linear(curve) => curve.pdf(fraction),
        }
    }

    /// The fractions between which the shutter is open.
    pub(super) fn support(&self) -> [f32; 2] {
        match self {
            Self::Box => [0.0, 1.0],
            Self::Linear(curve) => curve.support(),
        }
    }
}

impl Shutter {
    /// The instant at a fraction of the interval, whatever the curve.
    #[inline]
    pub fn instant(&self, fraction: f32) -> f32 {
        lerp(fraction, self.open, self.close)
    }

    /// An instant with the density of the curve. It goes forward with `u`, so whatever order there is in those numbers stays.
    #[inline]
    pub fn sample(&self, u: f32) -> ShutterSample {
        let fraction = match &self.curve {
            ShutterCurve::Box => u,
            ShutterCurve::Linear(curve) => curve.sample(u),
        };
        ShutterSample { time: self.instant(fraction), weight: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(curve: &ShutterCurve) -> f32 {
        let shutter = Shutter { open: 2.0, close: 6.0, curve: curve.clone() };
        (0..1000).map(|i| shutter.sample((i as f32 + 0.5) / 1000.0).time).sum::<f32>() / 1000.0
    }

    #[test]
    fn curves_have_the_mean_time_of_their_shape() {
        let trapezoid = |a, b| ShutterCurve::trapezoid(a, b).unwrap();
        assert_eq!(trapezoid(0.0, 0.0), ShutterCurve::Box);
        assert!((mean(&ShutterCurve::Box) - 4.0).abs() < 1e-4);
        assert!((mean(&trapezoid(0.5, 0.5)) - 4.0).abs() < 1e-4);
        // A triangle that falls has its centre at a third.
        assert!((mean(&trapezoid(0.0, 1.0)) - (2.0 + 4.0 / 3.0)).abs() < 1e-3);
        let twice = [[0.0, 1.0], [0.25, 1.0], [0.25, 0.0], [0.75, 0.0], [0.75, 3.0], [1.0, 3.0]];
        let table = ShutterCurve::table(&twice).unwrap();
        assert!((mean(&table) - (2.0 + 4.0 * (0.125 + 3.0 * 0.875) / 4.0)).abs() < 1e-3);
        assert_eq!((table.density(0.1), table.density(0.5), table.density(0.9)), (1.0, 0.0, 3.0));
        let part = ShutterCurve::table(&[[0.0, 0.0], [0.2, 0.0], [0.4, 1.0], [0.4, 0.0]]).unwrap();
        assert_eq!(part.support(), [0.2, 0.4]);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        for (opening, closing) in [(0.6, 0.6), (-0.1, 0.5), (f32::NAN, 0.0)] {
            assert_eq!(ShutterCurve::trapezoid(opening, closing), None);
        }
        for points in [
            vec![],
            vec![[0.5, 1.0]],
            vec![[0.0, 0.0], [1.0, 0.0]],
            vec![[0.0, 1.0], [0.0, 0.0], [1.0, 0.0]],
            vec![[0.5, 1.0], [0.2, 1.0]],
            vec![[0.0, 1.0], [1.5, 1.0]],
            vec![[0.0, 1.0], [1.0, -1.0]],
            vec![[0.0, 1.0], [1.0, f32::NAN]],
        ] {
            assert_eq!(ShutterCurve::table(&points), None, "{points:?}");
        }
    }
}
