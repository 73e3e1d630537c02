use super::sobol::SobolSample;

/// The sample `index` of a round of `count` whose seed, that of the pixel, every dimension shuffles anew
/// (Burley 2020, "Practical Hash-based Owen Scrambling").
#[inline]
pub(super) fn at(seed: u64, index: u32, count: u32) -> SobolSample {
    SobolSample::new(seed, 0, 0, index, count)
}
