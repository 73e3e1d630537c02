use tenfold_math::{Floats, Mat3, Vec3, Vec3s, WIDTH, vectorized};
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
        self.respond(self.xyz(l, wavelengths))
    }

    /// What the observer sees of radiance `l`: CIE XYZ, before the exposure.
    #[inline]
    pub fn xyz(&self, l: SampledSpectrum, wavelengths: &SampledWavelengths) -> Vec3 {
        self.observer.to_xyz(l, wavelengths).0
    }

    /// The response in each slot to what [`Sensor::xyz`] says there, times a weight: [`Sensor::rgb`] of many.
    #[inline]
    pub fn weighted_rgb(&self, xyz: &Vec3s, weight: &Floats) -> Vec3s {
        let mut rgb = Vec3s::ZERO;
        respond(self, xyz, weight, &mut rgb);
        rgb
    }

    /// Linear RGB from XYZ before the exposure.
    #[inline(always)]
    fn respond(&self, xyz: Vec3) -> Vec3 {
        let mut xyz = xyz * self.imaging_ratio;
        let largest = xyz.max_element();
        if largest > self.max_component {
            xyz *= self.max_component / largest;
        }
        self.rgb_from_xyz * xyz
    }
}

vectorized! {
    /// Weighted responses to the XYZ in each slot.
    fn respond(sensor: &Sensor, xyz: &Vec3s, weight: &Floats, out: &mut Vec3s) {
        for i in 0..WIDTH {
            out.set(i, sensor.respond(xyz.get(i)) * weight[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_have_the_response_to_each_alone() {
        let matrix = Mat3::from_cols_array(&[3.2, -1.0, 0.1, -1.5, 1.9, -0.2, -0.5, 0.04, 1.1]);
        // Some of the responses are limited.
        let sensor = Sensor::cie1931(matrix, 1.3, 2.0);
        let mut xyz = Vec3s::ZERO;
        let sample = |i: usize| {
            let w = SampledWavelengths::sample_visible(i as f32 / WIDTH as f32);
            (SampledSpectrum::from_fn(|lane| (i * lane) as f32 * 1e-3), w)
        };
        (0..WIDTH).for_each(|i| xyz.set(i, sensor.xyz(sample(i).0, &sample(i).1)));
        let weight = std::array::from_fn(|i| 1.0 - 0.1 * i as f32);
        let rgb = sensor.weighted_rgb(&xyz, &weight);
        for i in 0..WIDTH {
            assert_eq!(rgb.get(i), sensor.rgb(sample(i).0, &sample(i).1) * weight[i]);
        }
        let limited = (0..WIDTH).filter(|&i| 1.3 * xyz.get(i).max_element() > 2.0).count();
        assert!(0 < limited && limited < WIDTH, "{limited}");
    }
}
