use tenfold_math::{Mat3, Vec3};
use tenfold_spectrum::{Observer, SampledSpectrum, SampledWavelengths};

/// From spectral radiance to the film's linear RGB: the CIE 1931 observer, a matrix, and the exposure.
#[derive(Clone, Debug)]
pub struct Sensor {
    observer: &'static Observer,
    rgb_from_xyz: Mat3,
    imaging_ratio: f32,
    max_component: f32,
}

impl Sensor {
    /// The ideal sensor whose channels are the CIE 1931 matching functions, as pbrt-v4's `cie1931`:
    /// `imaging_ratio` is exposure time × ISO / 100; channels above `max_component` are scaled down to it.
    pub fn cie1931(rgb_from_xyz: Mat3, imaging_ratio: f32, max_component: f32) -> Self {
        Self { observer: Observer::cie1931(), rgb_from_xyz, imaging_ratio, max_component }
    }

    /// The same sensor, exposed `factor` times as long.
    #[must_use]
    pub fn exposed(&self, factor: f32) -> Self {
        Self { imaging_ratio: self.imaging_ratio * factor, ..self.clone() }
    }

    /// The response to radiance `l`, in linear RGB.
    #[inline]
    pub fn rgb(&self, l: SampledSpectrum, wavelengths: &SampledWavelengths) -> Vec3 {
        let mut xyz = self.observer.to_xyz(l, wavelengths).0 * self.imaging_ratio;
        let largest = xyz.max_element();
        if largest > self.max_component {
            xyz *= self.max_component / largest;
        }
        self.rgb_from_xyz * xyz
    }
}
