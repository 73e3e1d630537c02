//! The film: exact sums of samples, and the picture they make.
//!
//! One sample contributes to one pixel, and sums are kept in fixed point: addition is associative, so neither the
//! order of the samples nor the way a render is divided into tiles, threads or machines can change a bit.

mod bounds;
mod exact;
mod sensor;

pub use bounds::PixelBounds;
pub use exact::{ExactSum, LARGEST_SAMPLE};
pub use sensor::Sensor;
use tenfold_math::{Slots, UVec2, Vec3, Vec3s};

/// What a pixel has received so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct PixelSum {
    /// Sums of the three channels.
    rgb: [ExactSum; 3],
    /// Number of samples in the sums.
    samples: u32,
}

impl PixelSum {
    /// Adds a sample. Returns whether it was taken: a sample that is not finite, or larger than
    /// [`LARGEST_SAMPLE`], is left out, and does not count.
    #[inline]
    #[must_use]
    pub fn add(&mut self, rgb: Vec3) -> bool {
        if rgb.is_nan() || rgb.abs().max_element() > LARGEST_SAMPLE {
            return false;
        }
        self.rgb[0].add(rgb.x);
        self.rgb[1].add(rgb.y);
        self.rgb[2].add(rgb.z);
        self.samples += 1;
        true
    }

    /// Adds the samples in `slots`; those that [`PixelSum::add`] leaves out.
    #[inline]
    pub fn add_all(&mut self, rgb: &Vec3s, slots: Slots) -> Slots {
        let Some(sums) = exact::small_sums(rgb, slots) else {
            return slots.keep(|slot| !self.add(rgb.get(slot)));
        };
        self.rgb.iter_mut().zip(&sums).for_each(|(sum, more)| sum.merge(more));
        self.samples += slots.len() as u32;
        Slots::NONE
    }

    /// Adds everything that `other` has received.
    #[inline]
    pub fn merge(&mut self, other: &Self) {
        for (a, b) in self.rgb.iter_mut().zip(&other.rgb) {
            a.merge(b);
        }
        self.samples += other.samples;
    }

    /// Number of samples received.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The mean of the samples; black where there are none.
    pub fn mean(&self) -> Vec3 {
        Vec3::from_array(self.exact_mean().map(|v| v as f32))
    }

    /// The mean of the samples in double precision; black where there are none.
    pub fn exact_mean(&self) -> [f64; 3] {
        let n = self.samples.max(1) as f64;
        self.rgb.map(|sum| sum.to_f64() / n)
    }
}

/// The pixels within some bounds of the full picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Film {
    bounds: PixelBounds,
    pixels: Vec<PixelSum>,
}

impl Film {
    /// An empty film.
    pub fn new(bounds: PixelBounds) -> Self {
        Self { bounds, pixels: vec![PixelSum::default(); bounds.area()] }
    }

    /// The pixels covered.
    pub fn bounds(&self) -> PixelBounds {
        self.bounds
    }

    /// The pixel at `p`, which must lie within the bounds.
    #[inline]
    pub fn pixel(&self, p: UVec2) -> &PixelSum {
        &self.pixels[self.bounds.index(p)]
    }

    /// The pixel at `p`, which must lie within the bounds.
    #[inline]
    pub fn pixel_mut(&mut self, p: UVec2) -> &mut PixelSum {
        &mut self.pixels[self.bounds.index(p)]
    }

    /// Adds what another film, whose bounds lie within these, has received.
    pub fn merge(&mut self, other: &Self) {
        for p in other.bounds.pixels() {
            let index = self.bounds.index(p);
            self.pixels[index].merge(other.pixel(p));
        }
    }

    /// All pixels, row by row from the top.
    pub fn sums(&self) -> &[PixelSum] {
        &self.pixels
    }

    /// The mean of every pixel, row by row from the top: linear RGB.
    pub fn means(&self) -> Vec<Vec3> {
        self.pixels.iter().map(PixelSum::mean).collect()
    }

    /// Samples in the whole film.
    pub fn samples(&self) -> u64 {
        self.pixels.iter().map(|p| p.samples as u64).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::{WIDTH, vec3};

    #[test]
    fn the_sum_does_not_depend_on_order_or_grouping() {
        let samples: Vec<Vec3> = (0..1000u32)
            .map(|i| {
                let x = (i.wrapping_mul(2654435761) >> 8) as f32;
                vec3(x * 1e-9, x * 1e5, (x - 8e6) * 0.37)
            })
            .collect();
        let sum = |s: &mut dyn Iterator<Item = &Vec3>| {
            let mut pixel = PixelSum::default();
            s.for_each(|v| assert!(pixel.add(*v)));
            pixel
        };
        let whole = sum(&mut samples.iter());
        assert_eq!(whole, sum(&mut samples.iter().rev()));
        let mut parts = sum(&mut samples[700..].iter());
        parts.merge(&sum(&mut samples[..123].iter()));
        parts.merge(&sum(&mut samples[123..700].iter()));
        assert_eq!(whole, parts);
        let mean = samples.iter().map(|v| v.y as f64).sum::<f64>() / 1000.0;
        assert!((whole.mean().y as f64 / mean - 1.0).abs() < 1e-6);
    }

    #[test]
    fn slots_add_up_to_what_each_alone_does() {
        let ordinary = |i: usize| vec3(i as f32 * 0.37, -1e-13 * i as f32, 1e4 / (i + 1) as f32);
        for bad in [Vec3::ONE, Vec3::splat(-1e6), vec3(0.0, f32::NAN, 0.0), vec3(f32::INFINITY, 0.0, 0.0)] {
            let mut rgb = Vec3s::ZERO;
            (0..WIDTH).for_each(|i| rgb.set(i, if i % 6 == 2 { bad } else { ordinary(i) }));
            for slots in [Slots::first(WIDTH), Slots::first(11).keep(|i| i % 3 == 2), Slots::first(2)] {
                let (mut all, mut each) = (PixelSum::default(), PixelSum::default());
                let left_out = slots.keep(|i| !each.add(rgb.get(i)));
                assert_eq!((all.add_all(&rgb, slots), all), (left_out, each), "{bad} {slots:?}");
            }
        }
    }

    #[test]
    fn bad_samples_are_left_out() {
        let mut pixel = PixelSum::default();
        for bad in [vec3(f32::NAN, 0.0, 0.0), vec3(0.0, f32::INFINITY, 0.0), vec3(0.0, 0.0, -1e30)] {
            assert!(!pixel.add(bad));
        }
        assert!(pixel.add(Vec3::ONE) && pixel.samples() == 1 && pixel.mean() == Vec3::ONE);
    }
}
