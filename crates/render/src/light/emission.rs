//! Spectra of lights.

use tenfold_spectrum::{
    DenselySampled, LAMBDA_MAX, LAMBDA_MIN, SampledSpectrum, SampledWavelengths, Spectrum,
};

/// An emitted spectrum: a table at every nanometre, shared between lights, times a factor.
#[derive(Clone, Debug)]
pub struct Emission {
    spectrum: DenselySampled,
    /// [`visible_mean`] of the table, which many lights may share.
    mean: f32,
    /// Factor of the table.
    pub scale: f32,
}

impl Emission {
    /// `scale` times `spectrum`.
    pub fn new(spectrum: &Spectrum, scale: f32) -> Self {
        let spectrum = match spectrum {
            Spectrum::Dense(s) => s.clone(),
            s => DenselySampled::from_spectrum(s),
        };
        let mean = visible_mean(|lambda| spectrum.eval(lambda));
        Self { spectrum, mean, scale }
    }

    /// The same spectrum times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        Self { scale: self.scale * factor, ..self.clone() }
    }

    /// Values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        self.scale * self.spectrum.sample(w)
    }

    /// The mean over the visible wavelengths, weighted as paths choose them: by it lights are compared.
    pub fn visible_mean(&self) -> f32 {
        self.scale * self.mean
    }
}

/// The mean of a function of the wavelength in nm, weighted with the density by which paths choose wavelengths:
/// positive wherever a path can find light. By it lights are compared with each other.
pub(super) fn visible_mean(f: impl Fn(f32) -> f32) -> f32 {
    let steps = LAMBDA_MIN as u32..=LAMBDA_MAX as u32;
    let (mut sum, mut weights) = (0.0f64, 0.0f64);
    for lambda in steps.map(|l| l as f32) {
        let weight = f64::from(SampledWavelengths::visible_pdf(lambda));
        sum += weight * f64::from(f(lambda));
        weights += weight;
    }
    (sum / weights) as f32
}
