//! Spectra given by points.

use std::sync::Arc;

use super::{SAMPLES, dense_index};
use crate::{LAMBDA_MAX, LAMBDA_MIN, N, SampledSpectrum, SampledWavelengths};

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
    /// The pieces of which all wavelengths are made up, also those outside the points, and an end that none reaches.
    pieces: Arc<[Piece]>,
    /// The piece in which the wavelengths begin whose nearest whole nanometre is this one of the rendered range.
    starts: Arc<[u32; SAMPLES]>,
}

/// A line over all wavelengths from the first on.
#[derive(Copy, Clone, PartialEq, Debug)]
struct Piece {
    first: f32,
    /// The value there.
    value: f32,
    slope: f32,
}

impl Piece {
    /// Zero from a wavelength on.
    fn zero(first: f32) -> Self {
        Self { first, value: 0.0, slope: 0.0 }
    }
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
        let mut pieces = vec![Piece::zero(f32::MIN)];
        pieces.extend(points.windows(2).map(|p| {
            let ([l0, v0], [l1, v1]) = (p[0], p[1]);
            Piece { first: l0, value: v0, slope: (v1 - v0) / (l1 - l0) }
        }));
        if let Some(&[first, value]) = points.last() {
            // The last point counts by itself.
            pieces.extend([Piece { first, value, slope: 0.0 }, Piece::zero(first.next_up())]);
        }
        pieces.push(Piece::zero(f32::INFINITY));
        let start = |i| piece_at(&pieces, LAMBDA_MIN - 0.5 + i as f32) as u32;
        let starts = Arc::new(std::array::from_fn(start));
        Self { starts, pieces: pieces.into(), points: points.into() }
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
        self.eval_near(dense_index(lambda), lambda)
    }

    /// Value at a wavelength in nm with this [`dense_index`].
    #[inline]
    fn eval_near(&self, nearest: usize, lambda: f32) -> f32 {
        let pieces = &self.pieces;
        let mut i = match self.starts.get(nearest) {
            Some(&start) => start as usize,
            None if lambda.is_finite() => piece_at(pieces, lambda),
            None => return 0.0,
        };
        // Within a nanometre there is rarely more than one point, but on which side of it is not foreseen: no branch for that.
        i += usize::from(pieces[i + 1].first <= lambda);
        while pieces[i + 1].first <= lambda {
            i += 1;
        }
        let Piece { first, value, slope } = pieces[i];
        value + (lambda - first) * slope
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        let (nearest, lambda) = (w.nearest(), w.lambda());
        // A plain loop, which unlike a function for each lane is inlined.
        let mut values = [0.0; N];
        for lane in 0..N {
            values[lane] = self.eval_near(nearest[lane], lambda[lane]);
        }
        SampledSpectrum::new(values)
    }

    /// Largest value of the points.
    pub fn max_value(&self) -> f32 {
        self.points.iter().map(|p| p[1]).fold(f32::MIN, f32::max)
    }
}

/// The index of the last of `pieces` that does not begin beyond `lambda`.
fn piece_at(pieces: &[Piece], lambda: f32) -> usize {
    pieces.partition_point(|piece| piece.first <= lambda).saturating_sub(1)
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
