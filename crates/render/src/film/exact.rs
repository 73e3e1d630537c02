use tenfold_math::{Slots, Vec3, Vec3s, WIDTH, vectorized};

/// The largest magnitude of a sample's channel that a sum takes: 2⁵⁰.
pub const LARGEST_SAMPLE: f32 = (1u64 << 50) as f32;

/// Fixed-point quanta a unit: sums are exact multiples of 2⁻⁴⁴.
const QUANTA: f64 = (1u64 << 44) as f64;

/// [`WIDTH`] samples of at most so much have a sum in 64 bits.
const SMALL: f32 = (1u64 << 14) as f32;

/// A sum of floats in 128-bit fixed point: 2⁻⁴⁴ is the quantum, and 2³³ samples of [`LARGEST_SAMPLE`] fit.
///
/// Each sample is rounded to the quantum on its own; from there on addition is exact, hence associative and
/// commutative.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct ExactSum(i128);

impl ExactSum {
    /// Adds a sample of at most [`LARGEST_SAMPLE`].
    #[inline]
    pub fn add(&mut self, x: f32) {
        let quanta = x as f64 * QUANTA;
        // Nearly every sample fits 64 bits, whose conversion is one instruction.
        self.0 += if quanta.abs() < i64::MAX as f64 { quanta as i64 as i128 } else { quanta as i128 };
    }

    /// Adds another sum.
    #[inline]
    pub fn merge(&mut self, other: &Self) {
        self.0 += other.0;
    }

    /// The sum, rounded to double precision.
    #[inline]
    pub fn to_f64(self) -> f64 {
        self.0 as f64 / QUANTA
    }
}

/// The sums of each channel in `slots`, where all of them are small.
#[inline]
pub(super) fn small_sums(rgb: &Vec3s, slots: Slots) -> Option<[ExactSum; 3]> {
    let (mut rgb, mut sums) = (*rgb, [0; 3]);
    Slots::first(WIDTH).without(slots).for_each(|slot| rgb.set(slot, Vec3::ZERO));
    add_small(&rgb, &mut sums).then(|| sums.map(|sum| ExactSum(sum.into())))
}

vectorized! {
    /// Adds up each channel, in quanta; false, and no sum, where one of them is not small.
    fn add_small(rgb: &Vec3s, sums: &mut [i64; 3]) -> bool {
        let mut are_small = true;
        for i in 0..WIDTH {
            are_small &= (rgb.x[i].abs() <= SMALL) & (rgb.y[i].abs() <= SMALL) & (rgb.z[i].abs() <= SMALL);
        }
        if are_small {
            for (channel, sum) in [&rgb.x, &rgb.y, &rgb.z].into_iter().zip(sums) {
                // SAFETY: what is small fits. Vectors have no instruction for conversions that saturate.
                *sum = channel.iter().map(|&x| unsafe { (f64::from(x) * QUANTA).to_int_unchecked::<i64>() }).sum();
            }
        }
        are_small
    }
}
