//! The CIE 1931 standard observer, and integrals against it.

use std::sync::LazyLock;

use glam::DVec3;
use tenfold_math::Vec4;

use crate::spectrum::{SAMPLES, dense_index};
use crate::{LAMBDA_MIN, N, SampledSpectrum, SampledWavelengths, Spectrum, Xyz, data};

/// ∫ ȳ(λ) dλ over the rendered range, in nm: the luminance scale of pbrt-v4.
pub const CIE_Y_INTEGRAL: f32 = 106.856895;

static CIE1931: LazyLock<Observer> = LazyLock::new(|| {
    let mut table = Box::new([Vec4::ZERO; SAMPLES + 1]);
    for row in data::rows(include_str!("../data/cie1931.csv")) {
        if let (&[_, x, y, z], i @ 0..SAMPLES) = (row.as_slice(), dense_index(row[0])) {
            table[i] = Vec4::new(x, y, z, 0.0);
        }
    }
    Observer { table }
});

/// Colour matching functions x̄, ȳ, z̄, tabulated at 1 nm and looked up at the nearest nanometre.
#[derive(Debug)]
pub struct Observer {
    /// The three functions at every nanometre, and zeros for all wavelengths outside.
    table: Box<[Vec4; SAMPLES + 1]>,
}

impl Observer {
    /// The CIE 1931 2° standard observer.
    #[inline]
    pub fn cie1931() -> &'static Self {
        &CIE1931
    }

    /// (x̄, ȳ, z̄) at a wavelength in nm; 0 outside the rendered range.
    #[inline]
    pub fn matching(&self, lambda: f32) -> Xyz {
        Xyz(self.table[dense_index(lambda)].truncate())
    }

    /// One-sample estimate of ∫ L(λ) (x̄, ȳ, z̄)(λ) dλ: the mean over the lanes of L · (x̄, ȳ, z̄) / pdf, lanes of density 0
    /// counting as 0. **Not** divided by [`CIE_Y_INTEGRAL`]: as on pbrt-v4's film, where lights are scaled by
    /// 1 / [`photometric`] of their spectrum instead, so that a light of value 1 measures Y = 1.
    #[inline]
    pub fn to_xyz(&self, l: SampledSpectrum, w: &SampledWavelengths) -> Xyz {
        let weighted = l.safe_div(SampledSpectrum::new(w.pdf())).to_array();
        let nearest = w.nearest();
        let [a, b, c, d]: [Vec4; N] = std::array::from_fn(|i| self.table[nearest[i]] * weighted[i]);
        Xyz((((a + b) + (c + d)) * 0.25).truncate())
    }

    /// The Y of [`Self::to_xyz`] alone.
    #[inline]
    pub fn to_y(&self, l: SampledSpectrum, w: &SampledWavelengths) -> f32 {
        let y = SampledSpectrum::new(w.nearest().map(|i| self.table[i].y));
        (l * y).safe_div(SampledSpectrum::new(w.pdf())).average()
    }
}

/// ∫ (x̄, ȳ, z̄) s dλ by a sum over whole nanometres.
fn integral(s: &Spectrum) -> DVec3 {
    let steps = CIE1931.table[..SAMPLES].iter().enumerate();
    steps.map(|(i, m)| m.truncate().as_dvec3() * f64::from(s.eval(LAMBDA_MIN + i as f32))).sum()
}

/// ∫ ȳ(λ) s(λ) dλ by a sum over whole nanometres. Of an RGB illuminant only the illuminant counts, not the
/// colour and scale (pbrt-v4's convention for scaling lights).
pub fn photometric(s: &Spectrum) -> f32 {
    match s {
        Spectrum::RgbIlluminant(l) => integral(&Spectrum::Dense(l.illuminant.clone())).y as f32,
        _ => integral(s).y as f32,
    }
}

/// XYZ of a spectrum, divided by [`CIE_Y_INTEGRAL`]: the equal-energy spectrum of value 1 has Y = 1.
pub fn spectrum_to_xyz(s: &Spectrum) -> Xyz {
    Xyz((integral(s) / f64::from(CIE_Y_INTEGRAL)).as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LAMBDA_MAX;
    use tenfold_math::Vec3;

    #[test]
    fn the_table_is_whole() {
        let o = Observer::cie1931();
        let rows = &o.table[..SAMPLES];
        assert!(rows.iter().all(|v| v.y > 0.0));
        assert_eq!(o.table[SAMPLES], Vec4::ZERO);
        assert_eq!(o.matching(555.2).0, Vec3::new(0.5120501, 1.0, 0.005749999));
        assert_eq!(o.matching(359.0).0, Vec3::ZERO);
        assert_eq!(o.matching(831.0).0, Vec3::ZERO);
        assert!((photometric(&Spectrum::Constant(1.0)) - CIE_Y_INTEGRAL).abs() < 1e-4);
    }

    #[test]
    fn equal_energy_is_at_one_third() {
        let c = spectrum_to_xyz(&Spectrum::Constant(3.0)).chromaticity();
        assert!((c.x - 1.0 / 3.0).abs() < 2e-4 && (c.y - 1.0 / 3.0).abs() < 2e-4, "{c:?}");
    }

    /// Averages over equidistant `u` of the estimate against the sum over nanometres.
    #[test]
    fn estimates_average_to_the_integral() {
        let s = crate::named("stdillum-A").unwrap();
        let want = spectrum_to_xyz(&s).0 * CIE_Y_INTEGRAL;
        for sample in [SampledWavelengths::sample_visible, SampledWavelengths::sample_uniform] {
            let n = 20_000;
            let mut sum = DVec3::ZERO;
            let mut y = 0.0;
            for i in 0..n {
                let w = sample((i as f32 + 0.5) / n as f32);
                let l = s.sample(&w);
                sum += Observer::cie1931().to_xyz(l, &w).0.as_dvec3();
                y += f64::from(Observer::cie1931().to_y(l, &w));
            }
            let got = (sum / f64::from(n)).as_vec3();
            assert!(((got - want) / want).abs().max_element() < 1e-3, "{got} {want}");
            assert!((y / f64::from(n) - f64::from(got.y)).abs() < 1e-3);
        }
    }

    #[test]
    fn one_wavelength_measures_its_matching_functions() {
        let o = Observer::cie1931();
        let f = SampledWavelengths::fixed(LAMBDA_MAX);
        assert_eq!(o.to_xyz(SampledSpectrum::ONE, &f), o.matching(LAMBDA_MAX));
    }
}
