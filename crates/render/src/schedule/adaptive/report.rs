use super::Noise;

/// Why a render took no more samples.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The samples that the target was found to need have been taken.
    Target,
    /// No pixel may have more.
    MostSamples,
    /// There was no time for more.
    TimeLimit,
    /// The observer ended the render.
    Interrupted,
}

/// The noise of a picture, and how it came to be that.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseReport {
    /// The noise that was asked for.
    pub target: Option<f64>,
    /// The noise that there is; unknown where the render was ended too early to tell.
    pub reached: Option<Noise>,
    /// Why the render took no more samples.
    pub stop: Stop,
    /// The standard error of red, green, blue and luminance of each pixel, row by row from the top, where it is known.
    pub standard_errors: Option<Vec<[f32; 4]>>,
}
