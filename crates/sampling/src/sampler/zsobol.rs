use super::sobol::SobolSample;
use crate::hash::combine;
use tenfold_math::UVec2;

/// The sample `index` of a round of `count` in `pixel`, on the Z curve through all pixels' samples. `seed` is that of the round, `order` a hash
/// of the pixel and the round.
///
/// Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels".
#[inline]
pub(super) fn at(seed: u64, order: u64, pixel: UVec2, index: u32, count: u32) -> SobolSample {
    // The curve spans squares of 2¹⁶ pixels; pictures beyond that meet further, independent ones.
    let far = (u64::from(pixel.y >> 16) << 32) | u64::from(pixel.x >> 16);
    let seed = if far == 0 { seed } else { combine(seed, far) };
    // The most significant bit of the Morton code comes first, y before x.
    let mirrored = |v: u32| spread((v << 16).reverse_bits());
    SobolSample::new(seed, order, mirrored(pixel.y) | mirrored(pixel.x) << 1, index, count)
}

/// Moves bit k of 16 to bit 2k.
#[inline]
fn spread(v: u32) -> u32 {
    let v = (v | v << 8) & 0x00ff_00ff;
    let v = (v | v << 4) & 0x0f0f_0f0f;
    let v = (v | v << 2) & 0x3333_3333;
    (v | v << 1) & 0x5555_5555
}
