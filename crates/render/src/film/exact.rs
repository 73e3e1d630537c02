/// The largest magnitude of a sample's channel that a sum takes: 2⁵⁰.
pub const LARGEST_SAMPLE: f32 = (1u64 << 50) as f32;

/// Fixed-point quanta a unit: sums are exact multiples of 2⁻⁴⁴.
const QUANTA: f64 = (1u64 << 44) as f64;

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
