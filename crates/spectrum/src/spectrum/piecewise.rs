//! Spectra given by points.

use std::sync::Arc;

use super::SAMPLES;
use crate::{LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths};

/// Why points do not make a piecewise linear spectrum.
#[derive(Copy, Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum PiecewiseError {
    /// No points at all.
    #[error("a spectrum needs at least one wavelength")]
    Empty,
    /// As many values as wavelengths are needed.
    #[error("{lambdas} wavelengths but {values} values")]
    LengthMismatch {
        /// Number of wavelengths given.
        lambdas: usize,
        /// Number of values given.
        values: usize,
    },
    /// The wavelength at `index` is not larger than the one before it.
    #[error("wavelengths must increase, but number {} does not", index + 1)]
    NotIncreasing {
        /// Index of the point, from 0.
        index: usize,
    },
    /// The wavelength or value at `index` is infinite or not a number.
    #[error("point {} is not finite", index + 1)]
    NotFinite {
        /// Index of the point, from 0.
        index: usize,
    },
}

/// Linear between points of increasing wavelength, 0 outside of them (pbrt-v4's semantics).
#[derive(Clone, PartialEq, Debug)]
pub struct PiecewiseLinear {
    /// (wavelength in nm, value), by increasing wavelength.
    points: Arc<[[f32; 2]]>,
    /// The slope from each point to the next; 0 after the last.
    slopes: Arc<[f32]>,
    /// For every whole nanometre of the rendered range the last point that is not beyond it, or the first: where to look for intervals.
    starts: Arc<[u32; SAMPLES]>,
}

impl PiecewiseLinear {
    /// From wavelengths in nm and the values there.
    ///
    /// # Errors
    /// Where the wavelengths are none, not as many as the values, not increasing, or a number is not finite.
    pub fn new(lambdas: Vec<f32>, values: Vec<f32>) -> Result<Self, PiecewiseError> {
        if lambdas.len() != values.len() {
            return Err(PiecewiseError::LengthMismatch { lambdas: lambdas.len(), values: values.len() });
        }
        Self::from_points(lambdas.into_iter().zip(values).map(|(l, v)| [l, v]).collect())
    }

    /// From (wavelength in nm, value) pairs.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_points(points: Vec<[f32; 2]>) -> Result<Self, PiecewiseError> {
        if points.is_empty() {
            return Err(PiecewiseError::Empty);
        }
        if let Some(index) = points.iter().position(|p| !(p[0].is_finite() && p[1].is_finite())) {
            return Err(PiecewiseError::NotFinite { index });
        }
        if let Some(i) = points.windows(2).position(|p| p[0][0] >= p[1][0]) {
            return Err(PiecewiseError::NotIncreasing { index: i + 1 });
        }
        Ok(Self::prepared(points))
    }

    /// From points that have been checked.
    fn prepared(points: Vec<[f32; 2]>) -> Self {
        let start = |i| interval(&points, LAMBDA_MIN + i as f32) as u32;
        let starts = Arc::new(std::array::from_fn(start));
        let slopes = points.windows(2).map(|p| (p[1][1] - p[0][1]) / (p[1][0] - p[0][0])).chain([0.0]);
        Self { starts, slopes: slopes.collect(), points: points.into() }
    }

    /// The same with the end values held constant out to beyond the rendered range, where the points do not cover
    /// it: what pbrt-v4 does with its named spectra.
    pub(crate) fn extended(&self) -> Self {
        let mut points = self.points.to_vec();
        if let Some(&[lambda, v]) = points.first().filter(|p| p[0] > LAMBDA_MIN) {
            points.insert(0, [LAMBDA_MIN.min(lambda) - 1.0, v]);
        }
        if let Some(&[lambda, v]) = points.last().filter(|p| p[0] < LAMBDA_MAX) {
            points.push([LAMBDA_MAX.max(lambda) + 1.0, v]);
        }
        Self::prepared(points)
    }

    /// A copy with all values times `factor`.
    pub fn scaled(&self, factor: f32) -> Self {
        Self::prepared(self.points.iter().map(|&[l, v]| [l, v * factor]).collect())
    }

    /// The points: (wavelength in nm, value), by increasing wavelength.
    pub fn points(&self) -> &[[f32; 2]] {
        &self.points
    }

    /// Value at a wavelength in nm.
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        let p = &self.points;
        let last = p.len() - 1;
        if !(p[0][0]..=p[last][0]).contains(&lambda) {
            return 0.0;
        }
        // The interval [i, i + 1] that holds lambda.
        let i = match self.starts.get((lambda - LAMBDA_MIN) as usize) {
            Some(&start) if lambda >= LAMBDA_MIN => {
                let beyond = p[start as usize + 1..].iter().take_while(|q| q[0] <= lambda).count();
                start as usize + beyond
            }
            _ => interval(p, lambda),
        };
        p[i][1] + (lambda - p[i][0]) * self.slopes[i]
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum::new(w.lambda().map(|lambda| self.eval(lambda)))
    }

    /// Largest value of the points.
    pub fn max_value(&self) -> f32 {
        self.points.iter().map(|p| p[1]).fold(f32::MIN, f32::max)
    }
}

/// The index of the last of `points` that is not beyond `lambda`; 0 where all are.
fn interval(points: &[[f32; 2]], lambda: f32) -> usize {
    points.partition_point(|q| q[0] <= lambda).saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::ops;

    #[test]
    fn linear_between_points_and_nothing_outside() {
        // Equidistant, and not.
        for (l, half) in [([400.0, 410.0, 420.0], 415.0), ([400.0, 410.0, 440.0], 425.0)] {
            let s = PiecewiseLinear::new(l.to_vec(), vec![1.0, 3.0, 2.0]).unwrap();
            for (lambda, want) in [
                (399.9, 0.0),
                (400.0, 1.0),
                (405.0, 2.0),
                (410.0, 3.0),
                (half, 2.5),
                (l[2], 2.0),
                (l[2] + 0.1, 0.0),
            ] {
                assert!((s.eval(lambda) - want).abs() < 1e-5, "{lambda}: {}", s.eval(lambda));
            }
            assert_eq!(s.eval(f32::NAN), 0.0);
            assert_eq!(s.max_value(), 3.0);
            assert_eq!(s.scaled(2.0).eval(410.0), 6.0);
            let e = s.extended();
            assert_eq!((e.eval(360.0), e.eval(830.0)), (1.0, 2.0));
        }
        let point = PiecewiseLinear::new(vec![500.0], vec![2.0]).unwrap();
        assert_eq!((point.eval(500.0), point.eval(500.1)), (2.0, 0.0));
    }

    #[test]
    fn intervals_are_those_of_a_search() {
        // Regular points; such as lie closer than whole nanometres, and on both sides of the rendered range.
        let regular: Vec<f32> = (0..61).map(|i| 300.0 + 10.0 * i as f32).collect();
        let uneven: Vec<f32> = (0..900).map(|i| 355.0 + 0.0007 * (i * i) as f32).collect();
        for lambdas in [regular, uneven, vec![361.0, 900.0], vec![100.0, 829.7, 829.9, 830.0]] {
            let values: Vec<f32> = lambdas.iter().map(|l| ops::sin(l * 0.05)).collect();
            let s = PiecewiseLinear::new(lambdas.clone(), values.clone()).unwrap();
            for i in 0..7000 {
                let lambda = 250.0 + 0.1 * i as f32;
                let want = match lambdas.partition_point(|l| *l <= lambda) {
                    0 => 0.0,
                    n if n == lambdas.len() => {
                        if lambda == lambdas[n - 1] {
                            values[n - 1]
                        } else {
                            0.0
                        }
                    }
                    n => {
                        let t = (lambda - lambdas[n - 1]) / (lambdas[n] - lambdas[n - 1]);
                        values[n - 1] * (1.0 - t) + values[n] * t
                    }
                };
                assert!((s.eval(lambda) - want).abs() < 1e-5, "{lambda}: {} {want}", s.eval(lambda));
            }
        }
    }

    #[test]
    fn faults_are_told() {
        let new = |l: &[f32], v: &[f32]| PiecewiseLinear::new(l.to_vec(), v.to_vec()).unwrap_err();
        assert_eq!(new(&[], &[]), PiecewiseError::Empty);
        assert_eq!(new(&[1.0], &[1.0, 2.0]), PiecewiseError::LengthMismatch { lambdas: 1, values: 2 });
        assert_eq!(new(&[1.0, 2.0, 2.0], &[0.0; 3]), PiecewiseError::NotIncreasing { index: 2 });
        assert_eq!(new(&[1.0, f32::NAN], &[0.0; 2]), PiecewiseError::NotFinite { index: 1 });
    }
}
