//! Reflectance of smooth boundaries for unpolarised light.

use tenfold_math::Vec4;
use tenfold_spectrum::{N, SampledSpectrum};

/// Reflectance of a boundary between dielectrics (Fresnel's equations; pbrt book, §9.3.5).
///
/// `cos_i` is the cosine on the incident side, positive; `eta` the index of the far side over that of the
/// incident side. 1 under total internal reflection.
#[inline(always)]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta);
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let reflectance = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    if sin2_t >= 1.0 { 1.0 } else { reflectance }
}

/// [`fresnel_dielectric`] with an index for each lane.
#[inline]
pub fn fresnel_dielectric_lanes(cos_i: f32, eta: SampledSpectrum) -> SampledSpectrum {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let eta = eta.0;
    let sin2_t = Vec4::splat(1.0 - cos_i * cos_i) / (eta * eta);
    let total = sin2_t.cmpge(Vec4::ONE);
    let cos_t = (Vec4::ONE - sin2_t).max(Vec4::ZERO).map(f32::sqrt);
    let cos_i = Vec4::splat(cos_i);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let reflectance = (parallel * parallel + perpendicular * perpendicular) * 0.5;
    SampledSpectrum(Vec4::select(total, Vec4::ONE, reflectance))
}

/// Reflectance of a boundary from a dielectric to an absorbing medium of complex index `eta + i·k`, both relative
/// to the dielectric, per lane.
#[inline(always)]
pub fn fresnel_conductor(cos_i: f32, eta: SampledSpectrum, k: SampledSpectrum) -> SampledSpectrum {
    SampledSpectrum::new(fresnel_conductor_array(cos_i, eta.to_array(), k.to_array()))
}

/// [`fresnel_conductor`] of numbers that are not in a vector register.
///
/// Fresnel's equations with a complex index, written in real numbers with `a² + b² = |η² - sin²θ|`
/// (Born and Wolf 1999, §14.2).
#[inline(always)]
pub(crate) fn fresnel_conductor_array(cos_i: f32, eta: [f32; N], k: [f32; N]) -> [f32; N] {
    let cos_i = cos_i.clamp(0.0, 1.0);
    let cos2 = cos_i * cos_i;
    let sin2 = 1.0 - cos2;
    let reflectance = |lane: usize| {
        let (eta, k) = (eta[lane], k[lane]);
        let real = eta * eta - k * k - sin2;
        let imaginary = eta * k * 2.0;
        let modulus = root(real * real + imaginary * imaginary);
        let a = root((modulus + real) * 0.5);
        let s_even = modulus + cos2;
        let s_odd = a * (2.0 * cos_i);
        let rs = quotient(s_even - s_odd, s_even + s_odd);
        let p_even = cos2 * modulus + sin2 * sin2;
        let p_odd = s_odd * sin2;
        let rp = rs * quotient(p_even - p_odd, p_even + p_odd);
        (rs + rp) * 0.5
    };
    [reflectance(0), reflectance(1), reflectance(2), reflectance(3)]
}

/// Square root, of negative rounding errors 0.
#[inline(always)]
fn root(x: f32) -> f32 {
    x.max(0.0).sqrt()
}

/// Quotient, 1 where the divisor is 0 (grazing incidence on a medium of the same index).
#[inline(always)]
fn quotient(a: f32, b: f32) -> f32 {
    if b <= 0.0 { 1.0 } else { a / b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dielectric_has_its_closed_forms() {
        assert!((fresnel_dielectric(1.0, 1.5) - 0.04).abs() < 1e-7);
        assert_eq!(fresnel_dielectric(0.0, 1.5), 1.0);
        assert_eq!(fresnel_dielectric(0.3, 1.0 / 1.5), 1.0);
        assert!(fresnel_dielectric(0.3, 1.0) < 1e-12);
        // At Brewster's angle, tan θ = η, only the perpendicular component is reflected: ((η²-1)/(η²+1))² / 2.
        let eta = 1.5f32;
        let cos = 1.0 / (1.0 + eta * eta).sqrt();
        let want = 0.5 * ((eta * eta - 1.0) / (eta * eta + 1.0)).powi(2);
        assert!((fresnel_dielectric(cos, eta) - want).abs() < 1e-6);
    }

    #[test]
    fn dielectric_is_the_same_from_both_sides() {
        // Nearer to the critical angle the cosine inside has too few digits left.
        for i in 10..100 {
            let cos_i = i as f32 / 100.0;
            let cos_t = (1.0 - (1.0 - cos_i * cos_i) / 2.25).sqrt();
            let (above, below) = (fresnel_dielectric(cos_i, 1.5), fresnel_dielectric(cos_t, 1.0 / 1.5));
            assert!((above - below).abs() < 1e-5, "{above} {below}");
        }
    }

    #[test]
    fn lanes_equal_the_scalar() {
        let eta = SampledSpectrum::new([1.0, 1.33, 2.4, 0.6]);
        for i in 0..=50 {
            let cos = i as f32 / 50.0;
            let lanes = fresnel_dielectric_lanes(cos, eta);
            for lane in 0..4 {
                let scalar = fresnel_dielectric(cos, eta[lane]);
                // Grazing incidence on nothing is 0/0 in both.
                assert!((lanes[lane] - scalar).abs() < 1e-6, "{cos} {lane}: {} {scalar}", lanes[lane]);
            }
        }
    }

    #[test]
    fn conductor_without_absorption_is_a_dielectric() {
        let eta = SampledSpectrum::new([1.2, 1.33, 1.5, 2.4]);
        for i in 0..=50 {
            let cos = i as f32 / 50.0;
            let conductor = fresnel_conductor(cos, eta, SampledSpectrum::ZERO);
            let dielectric = fresnel_dielectric_lanes(cos, eta);
            assert!((conductor - dielectric).0.abs().max_element() < 2e-6, "{cos}");
        }
    }

    #[test]
    fn conductor_has_its_normal_reflectance_and_bounds() {
        let eta = SampledSpectrum::new([0.2, 1.1, 0.05, 1.0]);
        let k = SampledSpectrum::new([3.9, 2.5, 5.0, 0.0]);
        let want = SampledSpectrum::from_fn(|i| {
            ((eta[i] - 1.0).powi(2) + k[i] * k[i]) / ((eta[i] + 1.0).powi(2) + k[i] * k[i])
        });
        assert!((fresnel_conductor(1.0, eta, k) - want).0.abs().max_element() < 1e-6);
        for i in 0..=1000 {
            let f = fresnel_conductor(i as f32 / 1000.0, eta, k);
            assert!(f.is_finite() && f.min_component() >= -1e-6 && f.max_component() <= 1.0 + 1e-6);
        }
    }
}
