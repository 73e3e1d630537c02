//! What files hold of a pixel besides its colour.

use crate::failure::Failure;
use clap::ValueEnum;
use tenfold_render::schedule::Render;

/// Numbers of every pixel that EXR files can hold besides its colour.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Layer {
    /// How many samples its colour is the mean of
    Samples,
    /// The standard error of its colour and its luminance
    Error,
}

impl Layer {
    /// The names of its channels.
    pub(crate) fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Samples => &["samples.Y"],
            Self::Error => &["error.R", "error.G", "error.B", "error.Y"],
        }
    }

    /// Its values, pixel by pixel. Errors that are not known are infinite.
    pub(crate) fn values(self, render: &Render) -> Vec<f32> {
        match self {
            Self::Samples => render.film.sums().iter().map(|sum| sum.samples() as f32).collect(),
            Self::Error => match render.noise.as_ref().and_then(|n| n.standard_errors.as_ref()) {
                Some(errors) => errors.iter().flatten().copied().collect(),
                None => vec![f32::INFINITY; render.film.sums().len() * self.channels().len()],
            },
        }
    }
}

/// Each layer once, where a render that measures its noise or not can give them and a file that is EXR or not can hold them.
pub(crate) fn checked(
    asked: &[Layer],
    measures_noise: bool,
    writes_exr: bool,
) -> Result<Vec<Layer>, Failure> {
    if asked.contains(&Layer::Error) && !measures_noise {
        return Err(Failure::Wrong(
            "--layers error goes with --noise or --time-limit: renders with --spp do not measure it"
                .to_owned(),
        ));
    }
    if !asked.is_empty() && !writes_exr {
        return Err(Failure::Wrong("--layers goes with a picture in an EXR file".to_owned()));
    }
    let all = [Layer::Samples, Layer::Error];
    Ok(all.into_iter().filter(|layer| asked.contains(layer)).collect())
}
