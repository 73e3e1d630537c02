use crate::film::Film;
use tenfold_math::Vec3;

/// Means of a pixel over rounds, and their squared deviations (Welford 1962).
#[derive(Copy, Clone, Debug, Default)]
struct Moments {
    mean: f64,
    squares: f64,
}

impl Moments {
    /// Adds the value number `count`, counted from one.
    fn add(&mut self, x: f64, count: u32) {
        let delta = x - self.mean;
        self.mean += delta / f64::from(count);
        self.squares += delta * (x - self.mean);
    }

    /// Unbiased variance of one of `count` values.
    fn variance(&self, count: u32) -> f64 {
        self.squares / f64::from(count - 1)
    }
}

/// How the means of a pixel differ between rounds that are scrambled independently of each other.
#[derive(Clone, Debug)]
pub(super) struct RoundMoments {
    rounds: u32,
    /// Weights of red, green and blue in the luminance.
    luminance: [f64; 3],
    pixels: Vec<PixelMoments>,
}

#[derive(Copy, Clone, Debug, Default)]
struct PixelMoments {
    /// Red, green, blue, luminance, in all rounds.
    channels: [Moments; 4],
    /// Luminance in the even and in the odd rounds.
    halves: [Moments; 2],
}

impl RoundMoments {
    /// No rounds yet of `pixels` pixels.
    pub(super) fn new(pixels: usize, luminance: Vec3) -> Self {
        let luminance = luminance.as_dvec3().to_array();
        Self { rounds: 0, luminance, pixels: vec![PixelMoments::default(); pixels] }
    }

    /// Adds the means of a round. Rounds are to be added in order.
    pub(super) fn add(&mut self, round: &Film) {
        let half = (self.rounds % 2) as usize;
        self.rounds += 1;
        let in_half = self.rounds.div_ceil(2);
        for (pixel, sum) in self.pixels.iter_mut().zip(round.sums()) {
            let [r, g, b] = sum.exact_mean();
            let y = r * self.luminance[0] + g * self.luminance[1] + b * self.luminance[2];
            for (channel, value) in pixel.channels.iter_mut().zip([r, g, b, y]) {
                channel.add(value, self.rounds);
            }
            pixel.halves[half].add(y, in_half);
        }
    }

    /// How many rounds there are.
    pub(super) fn rounds(&self) -> u32 {
        self.rounds
    }

    /// The mean luminance of each pixel.
    pub(super) fn luminance(&self) -> Vec<f64> {
        self.pixels.iter().map(|p| p.channels[3].mean).collect()
    }

    /// Unbiased estimates of the variances of these means; `None` below two rounds.
    pub(super) fn variances(&self) -> Option<Vec<f64>> {
        let n = self.rounds;
        let of = |p: &PixelMoments| p.channels[3].variance(n) / f64::from(n);
        (n >= 2).then(|| self.pixels.iter().map(of).collect())
    }

    /// Differences of the two estimates of these variances from the even and the odd rounds; `None` below four rounds.
    pub(super) fn differences(&self) -> Option<Vec<f64>> {
        let n = self.rounds;
        let of = |p: &PixelMoments| {
            let [even, odd] = p.halves;
            (even.variance(n.div_ceil(2)) - odd.variance(n / 2)) / f64::from(n)
        };
        (n >= 4).then(|| self.pixels.iter().map(of).collect())
    }

    /// The standard error of red, green, blue and luminance; `None` below two rounds.
    pub(super) fn standard_errors(&self) -> Option<Vec<[f32; 4]>> {
        let n = self.rounds;
        let of = |p: &PixelMoments| p.channels.map(|c| (c.variance(n) / f64::from(n)).max(0.0).sqrt() as f32);
        (n >= 2).then(|| self.pixels.iter().map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::PixelBounds;
    use tenfold_math::{UVec2, vec3};

    #[test]
    fn moments_are_those_worked_out_by_hand() {
        let bounds = PixelBounds::full(UVec2::ONE);
        let mut moments = RoundMoments::new(1, vec3(0.25, 0.5, 0.25));
        assert!(moments.variances().is_none());
        // Luminances 1, 2, 3, 6: mean 3, variance 14/3; even ones 1 and 3, odd ones 2 and 6.
        for (i, grey) in [1.0, 2.0, 3.0, 6.0].into_iter().enumerate() {
            let mut film = Film::new(bounds);
            // Two samples each round.
            for offset in [-0.5, 0.5] {
                assert!(film.pixel_mut(UVec2::ZERO).add(Vec3::splat(grey + offset)));
            }
            moments.add(&film);
            assert_eq!(moments.rounds(), i as u32 + 1);
        }
        assert_eq!(moments.luminance(), [3.0]);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(moments.variances().unwrap()[0], 14.0 / 12.0));
        assert!(close(moments.differences().unwrap()[0], (2.0 - 8.0) / 4.0));
        let errors = moments.standard_errors().unwrap()[0];
        assert!(errors.iter().all(|e| (e * e - 7.0 / 6.0).abs() < 1e-6));
    }
}
