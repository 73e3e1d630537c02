use super::permute::permute;
use super::stratum;
use crate::hash::{combine, mix_bits};
use tenfold_math::Vec2;

/// A sample of N rooks: every number is stratified into as many strata as the round has samples, and meets those of the other
/// dimensions in an order of its own.
///
/// Cook, Porter and Carpenter 1984, "Distributed Ray Tracing", relate the strata of different variables by random
/// permutations, hidden from each other; Shirley 1991, "Discrepancy as a Quality Measure for Sample Distributions", names
/// pairs of them after rooks that do not threaten each other on the N × N board (Latin hypercubes; McKay, Beckman and Conover 1979).
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct NRooksSample {
    /// That of the pixel and the round.
    pub(super) seed: u64,
    pub(super) index: u32,
    /// Samples in the round.
    pub(super) count: u32,
}

impl NRooksSample {
    /// `bits` give the place in the stratum.
    #[inline]
    pub(super) fn get_1d(&self, key: u32, bits: u64) -> f32 {
        self.rook(combine(self.seed, u64::from(key)), bits as u32)
    }

    #[inline]
    pub(super) fn get_2d(&self, key: u32, bits: u64) -> Vec2 {
        let h = combine(self.seed, u64::from(key));
        let g = mix_bits(h ^ 0x6a09_e667_f3bc_c908);
        Vec2::new(self.rook(h, bits as u32), self.rook(g, (bits >> 32) as u32))
    }

    #[inline]
    fn rook(&self, order: u64, jitter: u32) -> f32 {
        let cell = permute(self.index, self.count, order);
        stratum::point(u64::from(cell), u64::from(self.count), jitter)
    }
}
