//! Sines, cosines and arc tangents in a few dozen instructions, without branches but for arguments that nobody has.
//!
//! Only what IEEE 754 rounds exactly is used (`+ − × ÷` and comparisons), always in the same order: the same bits everywhere.
//! Both floats are computed in double precision.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI};

/// Angles beyond this go to the library: the argument would lose digits.
const MOST: f64 = 1e5;

/// Added to a number of less than 2⁵¹ and taken away again it leaves the nearest integer, whose lowest bits are those of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// π/2 in two parts, the first of 33 bits: exact times an integer of 20 (from FreeBSD's libm, `e_rem_pio2.c`).
const HALF_PI: [f64; 2] = [1.570_796_326_734_125_614_17e0, 6.077_100_506_506_192_249_32e-11];

/// An angle of at most [`MOST`] as one of `[-π/4, π/4]` and a number of quarter turns, of which the lowest bits count.
#[inline]
fn reduce(x: f64) -> (f64, u64) {
    let shifted = x * FRAC_2_PI + ROUNDER;
    let quarters = shifted - ROUNDER;
    ((x - quarters * HALF_PI[0]) - quarters * HALF_PI[1], shifted.to_bits())
}

/// Sine and cosine of an angle from those of its rest after `quarters` quarter turns.
#[inline]
fn turn([sin, cos]: [f64; 2], quarters: u64) -> (f64, f64) {
    let (s, c) = (sin.to_bits(), cos.to_bits());
    let swapped = (s ^ c) & (quarters & 1).wrapping_neg();
    let negative = |quarters: u64| (quarters & 2) << 62;
    let sin = f64::from_bits(s ^ swapped ^ negative(quarters));
    (sin, f64::from_bits(c ^ swapped ^ negative(quarters.wrapping_add(1))))
}

/// Two polynomials at once, the coefficients from the highest power down.
#[inline]
fn polynomials<const N: usize>(z: f64, coefficients: [[f64; 2]; N]) -> [f64; 2] {
    coefficients.into_iter().reduce(|p, c| [p[0] * z + c[0], p[1] * z + c[1]]).unwrap_or_default()
}

/// Sine and cosine to within a unit in the last place; beside multiples of π/2 other than 0 to within 10⁻¹⁸.
#[inline]
pub(super) fn sin_cos(x: f64) -> (f64, f64) {
    let is_usual = x.abs() <= MOST;
    if !is_usual {
        return (libm::sin(x), libm::cos(x));
    }
    let (r, quarters) = reduce(x);
    let z = r * r;
    // Coefficients of FreeBSD's libm, `k_sin.c` and `k_cos.c`.
    let [s, c] = polynomials(
        z,
        [
            [1.589_690_995_211_550_102_21e-10, -1.135_964_755_778_819_482_65e-11],
            [-2.505_076_025_340_686_341_95e-8, 2.087_572_321_298_174_827_90e-9],
            [2.755_731_370_707_006_767_89e-6, -2.755_731_435_139_066_330_35e-7],
            [-1.984_126_982_985_794_931_34e-4, 2.480_158_728_947_672_941_78e-5],
            [8.333_333_333_322_489_461_24e-3, -1.388_888_888_887_410_957_49e-3],
            [-1.666_666_666_666_663_243_48e-1, 4.166_666_666_666_660_190_37e-2],
        ],
    );
    turn([r + (r * z) * s, (1.0 - 0.5 * z) + (z * z) * c], quarters)
}

/// [`sin_cos`] to the precision of single floats.
#[inline]
pub(super) fn sin_cos_f32(x: f32) -> (f32, f32) {
    let is_usual = f64::from(x).abs() <= MOST;
    if !is_usual {
        return (libm::sin(x.into()) as f32, libm::cos(x.into()) as f32);
    }
    sin_cos_of_moderate(x)
}

/// Sine and cosine of an angle of at most 10⁵ radians, without branches: the bits of [`sin_cos`](super::sin_cos).
#[inline]
pub fn sin_cos_of_moderate(x: f32) -> (f32, f32) {
    let (r, quarters) = reduce(x.into());
    let z = r * r;
    // Coefficients of FreeBSD's libm, `k_sinf.c` and `k_cosf.c`.
    let [s, c] = polynomials(
        z,
        [
            [2.718_311_493_989_821_9e-6, 2.439_044_879_627_741_65e-5],
            [-1.983_933_483_603_096_6e-4, -1.388_676_377_460_993_00e-3],
            [8.333_329_385_889_463_2e-3, 4.166_662_332_373_903_7e-2],
            [-1.666_666_664_163_648_7e-1, -4.999_999_972_510_310_0e-1],
        ],
    );
    let (sin, cos) = turn([r + (r * z) * s, 1.0 + z * c], quarters);
    (sin as f32, cos as f32)
}

/// Sine and cosine of an angle in `[-π/4, π/4]`, each to within 2 units in the last place, in single precision throughout.
#[inline]
pub fn sin_cos_of_small(x: f32) -> (f32, f32) {
    let z = x * x;
    // Coefficients of the Cephes library's `sinf` and `cosf` (Moshier 1992).
    let s = (-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1;
    let c = (2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2;
    (x + (x * z) * s, (1.0 - 0.5 * z) + (z * z) * c)
}

/// `atan(t) / t - 1` over `t²` for `t²` up to `tan²(π/8)`: minimax, relative error of the arc tangent 1.4 · 10⁻¹⁶. From the highest
/// power down, odd and even powers side by side.
const ARC_TANGENT: [[f64; 2]; 5] = [
    [0.022_810_568_629_394_253_6, -0.044_879_750_637_976_339_3],
    [0.057_378_267_346_252_739_8, -0.066_498_733_187_134_245_9],
    [0.076_910_814_482_904_231_7, -0.090_908_541_213_609_216_3],
    [0.111_111_096_888_284_268_2, -0.142_857_142_669_727_548_7],
    [0.199_999_999_999_040_630_99, -0.333_333_333_333_332_522_74],
];

/// [`ARC_TANGENT`] with a relative error of 9 · 10⁻¹¹.
const ARC_TANGENT_F32: [[f64; 2]; 3] = [
    [0.050_602_892_067_735_786_6, -0.086_298_974_169_179_823_1],
    [0.110_721_507_111_392_891_9, -0.142_841_994_897_666_753_7],
    [0.199_999_782_991_428_292_7, -0.333_333_332_828_530_693_6],
];

/// The angle of the point `(x, y)` by such a polynomial; a coordinate is not zero, and neither is huge.
#[inline]
fn angle<const N: usize>(y: f64, x: f64, coefficients: [[f64; 2]; N]) -> f64 {
    // By symmetries to an angle of at most 45°, and then 22.5°.
    let (ax, ay) = (x.abs(), y.abs());
    let is_steep = ay > ax;
    let (near, far) = if is_steep { (ax, ay) } else { (ay, ax) };
    const TAN_PI_8: f64 = std::f64::consts::SQRT_2 - 1.0;
    let is_wide = near > TAN_PI_8 * far;
    let (numerator, denominator) = if is_wide { (near - far, near + far) } else { (near, far) };
    let t = numerator / denominator;
    let z = t * t;
    let [odd, even] = polynomials(z * z, coefficients);
    let a = t + (t * z) * (odd * z + even);
    let a = if is_wide { FRAC_PI_4 + a } else { a };
    let a = if is_steep { FRAC_PI_2 - a } else { a };
    let a = if x < 0.0 { PI - a } else { a };
    a.copysign(y)
}

/// The angle in `(-π, π]` of the point `(x, y)`, to within four units in the last place.
#[inline]
pub(super) fn atan2(y: f64, x: f64) -> f64 {
    let size = if y.abs() > x.abs() { y.abs() } else { x.abs() };
    let is_usual = size > 0.0 && size < 1e300;
    if !is_usual {
        return libm::atan2(y, x);
    }
    angle(y, x, ARC_TANGENT)
}

/// [`atan2`] to the precision of single floats.
#[inline]
pub(super) fn atan2_f32(y: f32, x: f32) -> f32 {
    if (x == 0.0 && y == 0.0) || !x.is_finite() || !y.is_finite() {
        return libm::atan2f(y, x);
    }
    angle(f64::from(y), f64::from(x), ARC_TANGENT_F32) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from −1 to 1, more of them near 0, and their ends.
    fn numbers() -> impl Iterator<Item = f64> {
        let spread = |i: i32| {
            let x = f64::from(i) / 500.0;
            x * x * x
        };
        (-500..=500).map(spread).chain([1e-12, -1e-30, 1e-200, 0.0, -0.0])
    }

    #[track_caller]
    fn close(value: f64, exact: f64, relative: f64, least: f64, what: &str) {
        let error = (value - exact).abs();
        assert!(error <= relative * exact.abs() + least, "{what}: {value}, not {exact}: {error:e}");
    }

    #[test]
    fn sines_and_cosines_are_the_librarys() {
        for scale in [1.0, 7.0, 100.0, 3e4, 1e5] {
            for x in numbers().map(|x| scale * x) {
                let ((s, c), what) = (sin_cos(x), x.to_string());
                close(s, libm::sin(x), 2.5e-16, 1e-18, &what);
                close(c, libm::cos(x), 2.5e-16, 1e-18, &what);
                let (x, (s, c)) = (x as f32, sin_cos_f32(x as f32));
                close(s.into(), libm::sin(x.into()), 7e-8, 1e-45, &what);
                close(c.into(), libm::cos(x.into()), 7e-8, 1e-45, &what);
            }
        }
        for x in numbers().map(|x| (FRAC_PI_4 * x) as f32) {
            let ((s, c), what) = (sin_cos_of_small(x), x.to_string());
            close(s.into(), libm::sin(x.into()), 2e-7, 1e-45, &what);
            close(c.into(), libm::cos(x.into()), 2e-7, 1e-45, &what);
        }
        for x in [1e6, 1e300, f64::INFINITY, f64::NAN] {
            let bits = |(s, c): (f64, f64)| [s, c].map(f64::to_bits);
            assert_eq!(bits(sin_cos(x)), bits((libm::sin(x), libm::cos(x))), "{x}");
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert!(sin_cos_f32(f32::INFINITY).0.is_nan() && sin_cos_f32(f32::NAN).1.is_nan());
    }

    #[test]
    fn arc_tangents_are_the_librarys() {
        for x in numbers() {
            for y in numbers() {
                let what = format!("({x}, {y})");
                let exact = libm::atan2(y, x);
                close(atan2(y, x), exact, 6e-16, 0.0, &what);
                assert_eq!(atan2(y, x).is_sign_negative(), exact.is_sign_negative(), "{what}");
                let (x, y) = (x as f32, y as f32);
                let exact = libm::atan2(y.into(), x.into());
                // Where the exact value is subnormal, so is its error.
                close(atan2_f32(y, x).into(), exact, 7e-8, 2e-45, &what);
            }
        }
        let huge = f64::MAX;
        for (y, x) in [(huge, huge), (f64::INFINITY, -1.0), (f64::NEG_INFINITY, f64::INFINITY), (1.0, huge)] {
            close(atan2(y, x), libm::atan2(y, x), 0.0, 0.0, "huge");
        }
        for (y, x) in [(f32::INFINITY, 1.0), (f32::MAX, f32::MAX), (-0.0, f32::NEG_INFINITY)] {
            let exact = libm::atan2(y.into(), x.into());
            close(atan2_f32(y, x).into(), exact, 7e-8, 0.0, "huge");
        }
        for (y, x) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, 0.0)] {
            assert!(atan2(y, x).is_nan() && atan2_f32(y as f32, x as f32).is_nan(), "{y} {x}");
        }
    }
}
