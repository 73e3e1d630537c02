//! Elementary functions that give the same bits on every machine.
//!
//! The standard library's come from the platform's C library, whose last digits differ between systems and even between
//! processors (glibc has variants with fused multiply-add). These are the `libm` crate's, plain Rust that is rounded the same
//! everywhere; those that every sample needs are our own, in fewer instructions. Square roots are exact as they are, and need no
//! substitute.

mod trigonometry;

pub use trigonometry::{sin_cos_of_moderate, sin_cos_of_small};

/// A float with elementary functions: `f32` and `f64`.
pub trait Float: Copy {
    #[doc(hidden)]
    fn apply(self, f32_: impl FnOnce(f32) -> f32, f64_: impl FnOnce(f64) -> f64) -> Self;
    #[doc(hidden)]
    fn apply2(
        self,
        other: Self,
        f32_: impl FnOnce(f32, f32) -> f32,
        f64_: impl FnOnce(f64, f64) -> f64,
    ) -> Self;
    #[doc(hidden)]
    fn sin_cos(self) -> (Self, Self);
}

impl Float for f32 {
    #[inline]
    fn apply(self, f32_: impl FnOnce(f32) -> f32, _: impl FnOnce(f64) -> f64) -> Self {
        f32_(self)
    }
    #[inline]
    fn apply2(
        self,
        other: Self,
        f32_: impl FnOnce(f32, f32) -> f32,
        _: impl FnOnce(f64, f64) -> f64,
    ) -> Self {
        f32_(self, other)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        trigonometry::sin_cos_f32(self)
    }
}

impl Float for f64 {
    #[inline]
    fn apply(self, _: impl FnOnce(f32) -> f32, f64_: impl FnOnce(f64) -> f64) -> Self {
        f64_(self)
    }
    #[inline]
    fn apply2(
        self,
        other: Self,
        _: impl FnOnce(f32, f32) -> f32,
        f64_: impl FnOnce(f64, f64) -> f64,
    ) -> Self {
        f64_(self, other)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        trigonometry::sin_cos(self)
    }
}

macro_rules! functions {
    ($($name:ident $f32_:ident $f64_:ident $text:literal),* $(,)?) => {
        $(#[doc = $text]
        #[inline]
        pub fn $name<F: Float>(x: F) -> F {
            x.apply(libm::$f32_, libm::$f64_)
        })*
    };
}

functions! {
    sin sinf sin "Sine of an angle in radians.",
    cos cosf cos "Cosine of an angle in radians.",
    tan tanf tan "Tangent of an angle in radians.",
    asin asinf asin "Angle in `[-π/2, π/2]` with this sine.",
    acos acosf acos "Angle in `[0, π]` with this cosine.",
    atan atanf atan "Angle in `[-π/2, π/2]` with this tangent.",
    sinh sinhf sinh "Hyperbolic sine.",
    cosh coshf cosh "Hyperbolic cosine.",
    tanh tanhf tanh "Hyperbolic tangent.",
    atanh atanhf atanh "Number with this hyperbolic tangent.",
    exp expf exp "`e` to the power of a number.",
    exp2 exp2f exp2 "Two to the power of a number.",
    exp_m1 expm1f expm1 "`exp(x) - 1`, precise near zero.",
    ln logf log "Natural logarithm.",
    ln_1p log1pf log1p "`ln(1 + x)`, precise near zero.",
    log2 log2f log2 "Logarithm to base two.",
    log10 log10f log10 "Logarithm to base ten.",
    cbrt cbrtf cbrt "Cube root.",
}

/// Sine and cosine of an angle in radians.
#[inline]
pub fn sin_cos<F: Float>(x: F) -> (F, F) {
    x.sin_cos()
}

/// The angle in `(-π, π]` of the point `(x, y)`.
#[inline]
pub fn atan2<F: Float>(y: F, x: F) -> F {
    y.apply2(x, trigonometry::atan2_f32, trigonometry::atan2)
}

/// The largest integer that is not above `x`: that of the standard library without a call and without branches.
#[inline]
pub fn floor(x: f32) -> f32 {
    // From here on floats are integers: added and taken away it leaves the nearest one.
    const INTEGERS: f32 = 8_388_608.0;
    let nearest = ((x.abs() + INTEGERS) - INTEGERS).copysign(x);
    let below = if nearest > x { nearest - 1.0 } else { nearest };
    if x.abs() < INTEGERS { below } else { x }
}

/// `x` to the power of `y`.
#[inline]
pub fn powf<F: Float>(x: F, y: F) -> F {
    x.apply2(y, libm::powf, libm::pow)
}

/// `√(x² + y²)` without overflow on the way.
#[inline]
pub fn hypot<F: Float>(x: F, y: F) -> F {
    x.apply2(y, libm::hypotf, libm::hypot)
}

/// Natural logarithm of a positive normal number, to about 2 units in the last place; without meaning for all others. It has no
/// branches, so the lanes of vectors take it together.
///
/// The exponent, and a polynomial for the rest in `[√½, √2)`: that of `logf` of the Cephes library (Moshier 1992).
#[inline(always)]
pub fn ln_of_normal(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 9] = [
        7.037_683_6e-2,
        -1.151_461e-1,
        1.167_699_9e-1,
        -1.242_014_1e-1,
        1.424_932_3e-1,
        -1.666_805_8e-1,
        2.000_071_5e-1,
        -2.499_999_4e-1,
        3.333_333_1e-1,
    ];
    let bits = x.to_bits();
    let exponent = bits.wrapping_sub(std::f32::consts::FRAC_1_SQRT_2.to_bits()) as i32 >> 23;
    let rest = f32::from_bits(bits.wrapping_sub((exponent << 23) as u32));
    let (e, f) = (exponent as f32, rest - 1.0);
    let square = f * f;
    let series = COEFFICIENTS.iter().fold(0.0, |sum, &c| sum * f + c) * f * square;
    // The logarithm of two in two parts, the larger of which makes exact products.
    f + (series - 2.121_944_4e-4 * e - 0.5 * square) + 0.693_359_375 * e
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_below_are_the_standard_librarys() {
        let near = |x: f32| [x.next_down(), x, x.next_up()];
        let numbers = (0..=u32::MAX).step_by(99_991).map(f32::from_bits);
        let edges = [0.0, 0.5, 1.0, 1.5, 2.5, 4_194_304.5, 8_388_607.5, 8_388_608.0, 1e30, f32::INFINITY];
        let edges = edges.into_iter().flat_map(near).flat_map(|x| [x, -x]);
        for x in numbers.chain(edges).filter(|x| !x.is_nan()) {
            assert_eq!(floor(x).to_bits(), x.floor().to_bits(), "{x}");
        }
        assert!(floor(f32::NAN).is_nan());
    }

    /// A change of these bits changes pictures.
    #[test]
    fn bits_are_pinned() {
        let x = 0.7f32;
        let values = [sin(x), cos(x), exp(x), ln(x), atan2(x, 0.3), powf(x, 2.2), acos(x)];
        let pinned = [1059384179, 1061407923, 1073799507, 3199639066, 1066744924, 1055497052, 1061920578];
        assert_eq!(values.map(f32::to_bits), pinned);
        let exact =
            [0.644_217_67, 0.764_842_2, 2.013_752_7, -0.356_674_97, 1.165_904_5, 0.456_263_4, 0.795_398_85];
        for (value, exact) in values.iter().zip(exact) {
            assert!((value / exact - 1.0f32).abs() < 2e-7, "{value} {exact}");
        }
    }

    #[test]
    fn logarithms_of_normal_numbers_are_exact_to_two_units() {
        let mut worst = 0f64;
        for bits in (f32::MIN_POSITIVE.to_bits()..f32::MAX.to_bits()).step_by(7001) {
            let x = f32::from_bits(bits);
            let got = ln_of_normal(x);
            let exact = ln(f64::from(x));
            let unit = f64::from((exact as f32).abs().max(f32::MIN_POSITIVE)) * f64::from(f32::EPSILON);
            worst = worst.max((f64::from(got) - exact).abs() / unit);
        }
        assert!(worst < 2.0, "{worst}");
        assert_eq!(ln_of_normal(1.0), 0.0);
    }
}
