use tenfold_math::{DVec2, ops};

/// A power spectrum over the integer frequencies of a square, the frequency zero in the middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The largest frequency; there are `2 · largest + 1` a side.
    pub largest: u32,
    /// The mean power, row by row from the most negative vertical frequency. 1 is that of what is independent.
    pub power: Vec<f64>,
}

impl Spectrum {
    /// The mean periodogram |Σ exp(−2πi k·x)|² / N of point sets in the unit square.
    pub fn of_points(sets: &[Vec<DVec2>], largest: u32) -> Self {
        let side = 2 * largest as usize + 1;
        let mut power = vec![0.0; side * side];
        for points in sets {
            let x: Vec<_> = points.iter().map(|p| waves(p.x, largest)).collect();
            let y: Vec<_> = points.iter().map(|p| waves(p.y, largest)).collect();
            half(largest, |kx, ky, i, opposite| {
                let at = |waves: &[Complex], k: i32| {
                    let w = waves[k.unsigned_abs() as usize];
                    if k < 0 { w.conjugate() } else { w }
                };
                let waves = x.iter().zip(&y).map(|(x, y)| at(x, kx).times(at(y, ky)));
                let sum = waves.fold(Complex::default(), Complex::plus);
                let p = sum.squared() / (points.len().max(1) * sets.len()) as f64;
                power[i] += p;
                if opposite != i {
                    power[opposite] += p;
                }
            });
        }
        Self { largest, power }
    }

    /// The mean periodogram of square pictures of `side` × `side` pixels of numbers with mean zero, over their variance.
    pub fn of_pictures(pictures: &[Vec<f64>], side: u32) -> Self {
        let largest = side / 2;
        let width = 2 * largest as usize + 1;
        let variance = pictures.iter().flatten().map(|v| v * v).sum::<f64>()
            / pictures.iter().flatten().count().max(1) as f64;
        let mut power = vec![0.0; width * width];
        let columns: Vec<_> = (0..side).map(|x| waves(f64::from(x) / f64::from(side), largest)).collect();
        let wave = |position: usize, k: i32| {
            let w = columns[position][k.unsigned_abs() as usize];
            if k < 0 { w.conjugate() } else { w }
        };
        for picture in pictures {
            // Row by row first: the transform of a picture is one of each row and then one of each column.
            let frequencies = -(largest as i32)..=largest as i32;
            let row = |pixels: &[f64]| -> Vec<Complex> {
                let one = |kx| {
                    let terms = pixels.iter().enumerate().map(|(x, v)| wave(x, kx).scaled(*v));
                    terms.fold(Complex::default(), Complex::plus)
                };
                frequencies.clone().map(one).collect()
            };
            let rows: Vec<Vec<Complex>> = picture.chunks(side as usize).map(row).collect();
            half(largest, |kx, ky, i, opposite| {
                let column = (kx + largest as i32) as usize;
                let terms = rows.iter().enumerate().map(|(y, row)| row[column].times(wave(y, ky)));
                let sum = terms.fold(Complex::default(), Complex::plus);
                let p = sum.squared() / (variance * (picture.len() * pictures.len()) as f64);
                power[i] += p;
                if opposite != i {
                    power[opposite] += p;
                }
            });
        }
        Self { largest, power }
    }

    /// Frequencies a side.
    pub fn side(&self) -> u32 {
        2 * self.largest + 1
    }

    /// The mean power over rings of frequencies of one width: (frequency, power), from 1 up to the largest.
    pub fn radial(&self) -> Vec<[f64; 2]> {
        let mut rings = vec![[0.0, 0.0]; self.largest as usize + 1];
        for (i, power) in self.power.iter().enumerate() {
            let k = |i: usize| (i % self.side() as usize) as f64 - f64::from(self.largest);
            let (kx, ky) = (k(i), k(i / self.side() as usize));
            let ring = (kx * kx + ky * ky).sqrt().round() as usize;
            if let Some(ring) = rings.get_mut(ring) {
                *ring = [ring[0] + power, ring[1] + 1.0];
            }
        }
        rings.iter().enumerate().skip(1).map(|(k, [sum, count])| [k as f64, sum / count]).collect()
    }
}

/// Calls with every frequency of one half plane, its place and that of its opposite, where real signals have the same power.
fn half(largest: u32, mut visit: impl FnMut(i32, i32, usize, usize)) {
    let (largest, side) = (largest as i32, 2 * largest as usize + 1);
    for ky in 0..=largest {
        for kx in -largest..=largest {
            if ky == 0 && kx < 0 {
                continue;
            }
            let place = |kx: i32, ky: i32| (ky + largest) as usize * side + (kx + largest) as usize;
            visit(kx, ky, place(kx, ky), place(-kx, -ky));
        }
    }
}

#[derive(Copy, Clone, Debug, Default)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
    fn times(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self { re: a.re * b.re - a.im * b.im, im: a.re * b.im + a.im * b.re }
    }
    fn scaled(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
    fn conjugate(self) -> Self {
        Self { im: -self.im, ..self }
    }
    fn squared(self) -> f64 {
        self.re * self.re + self.im * self.im
    }
}

/// exp(−2πi k x) for k from 0 to `largest`.
fn waves(x: f64, largest: u32) -> Vec<Complex> {
    let angle = |k: u32| -std::f64::consts::TAU * (f64::from(k) * x).fract();
    (0..=largest).map(angle).map(|a| Complex { re: ops::cos(a), im: ops::sin(a) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_has_power_where_its_dual_is() {
        // Of 4 × 4 points, all 16 agree at multiples of 4 and cancel elsewhere.
        let lattice: Vec<_> =
            (0..16).map(|i| DVec2::new(f64::from(i % 4), f64::from(i / 4)) / 4.0 + 0.1).collect();
        let spectrum = Spectrum::of_points(&[lattice.clone(), lattice], 5);
        for (i, p) in spectrum.power.iter().enumerate() {
            let (kx, ky) = (i as i32 % 11 - 5, i as i32 / 11 - 5);
            let expected = if kx % 4 == 0 && ky % 4 == 0 { 16.0 } else { 0.0 };
            assert!((p - expected).abs() < 1e-9, "{kx} {ky}: {p}");
        }
        let radial = spectrum.radial();
        assert_eq!(radial.len(), 5);
        assert!(radial[1][1].abs() < 1e-9 && radial[3][1] > 1.0);
    }

    #[test]
    fn a_wave_has_its_own_frequency_alone() {
        let side = 8;
        let wave =
            |i: u32| ops::cos(std::f64::consts::TAU * f64::from(2 * (i % side) + i / side) / f64::from(side));
        let spectrum = Spectrum::of_pictures(&[(0..side * side).map(wave).collect()], side);
        // The variance is ½ and half of all 64 pixels' power is at each of ±(2, 1).
        for (i, p) in spectrum.power.iter().enumerate() {
            let (kx, ky) = (i as i32 % 9 - 4, i as i32 / 9 - 4);
            let expected = if (kx, ky) == (2, 1) || (kx, ky) == (-2, -1) { 32.0 } else { 0.0 };
            assert!((p - expected).abs() < 1e-9, "{kx} {ky}: {p}");
        }
    }
}
