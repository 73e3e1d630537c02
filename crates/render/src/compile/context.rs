//! Shared state of the compile step: diagnostics, files and colours.

use crate::texture::SpectrumRole;
use std::{collections::HashMap, path::PathBuf, sync::Arc};
use tenfold_image::{ColorEncoding, Format, Image};
use tenfold_scene::{ColorSpace, Diagnostic, Diagnostics, Resources, Span, SpectrumValue, unpack};
use tenfold_spectrum::{
    Blackbody, PiecewiseLinear, Rgb, RgbAlbedo, RgbColorSpace, RgbIlluminant, RgbUnbounded, Spectrum, named,
    named_names, parse_spd,
};

/// Files are unpacked up to this size, in bytes: far above any sane scene's, far below what stops a machine.
pub(crate) const LARGEST_FILE: u64 = 16 << 30;

/// An image file as it was asked for: path and encoding of 8-bit values.
type ImageKey = (PathBuf, String);

/// Shared state of the compile step.
pub(crate) struct Context<'a> {
    /// Where faults go.
    pub(crate) diagnostics: &'a Diagnostics,
    /// Where files come from.
    pub(crate) resources: &'a dyn Resources,
    images: HashMap<ImageKey, Option<Arc<Image>>>,
    spectra: HashMap<PathBuf, Option<PiecewiseLinear>>,
}

impl<'a> Context<'a> {
    pub(crate) fn new(diagnostics: &'a Diagnostics, resources: &'a dyn Resources) -> Self {
        Self { diagnostics, resources, images: HashMap::new(), spectra: HashMap::new() }
    }

    /// Reports a thing that pbrt-v4 has and tenfold does not have yet.
    pub(crate) fn unsupported(&self, span: Span, what: &str) {
        self.diagnostics.error(span, format!("{what} is not supported yet"));
    }

    /// Reports a `family` (such as `material`) of unknown `kind`.
    pub(crate) fn unknown_kind<'n>(
        &self,
        span: Span,
        family: &str,
        kind: &str,
        known: impl IntoIterator<Item = &'n str>,
    ) {
        let message = format!("unknown {family} \"{kind}\"");
        self.diagnostics.push(Diagnostic::error(span, message).with_nearest(kind, known));
    }

    /// The bytes of a file, unpacked, named at `span`.
    pub(crate) fn file(&self, path: &str, span: Span) -> Option<Vec<u8>> {
        match self.resources.load(path).and_then(|bytes| unpack(bytes, LARGEST_FILE)) {
            Ok(bytes) => Some(bytes),
            Err(error) => {
                let place = self.resources.resolve(path);
                self.diagnostics.error(span, format!("cannot read \"{}\": {error}", place.display()));
                None
            }
        }
    }

    /// The image of a file named at `span`, its 8-bit values in `encoding`, or what the file says. Each file is read
    /// once, and a fault reported once.
    pub(crate) fn image(
        &mut self,
        path: &str,
        span: Span,
        encoding: Option<ColorEncoding>,
    ) -> Option<Arc<Image>> {
        let key = (self.resources.resolve(path), format!("{encoding:?}"));
        if let Some(known) = self.images.get(&key) {
            return known.clone();
        }
        let image = self.file(path, span).and_then(|bytes| {
            let hint = Format::from_path(path).ok();
            match Image::read_bytes(&bytes, hint, encoding) {
                Ok(image) => Some(Arc::new(image)),
                Err(error) => {
                    self.diagnostics.error(span, format!("cannot read the image \"{path}\": {error}"));
                    None
                }
            }
        });
        self.images.insert(key, image.clone());
        image
    }

    /// The spectrum that a parameter stands for. Faults are reported.
    pub(crate) fn spectrum(
        &mut self,
        parameter: &tenfold_scene::Spectrum<'_>,
        role: SpectrumRole,
    ) -> Option<Spectrum> {
        match parameter.value {
            SpectrumValue::Rgb(rgb) => {
                let space = color_space(parameter.color_space);
                let value = Rgb(rgb.into());
                Some(match role {
                    SpectrumRole::Albedo => {
                        if rgb.iter().any(|&c| c > 1.0) {
                            let message = "a reflectance lies between 0 and 1: larger values are taken as 1";
                            self.diagnostics.warning(parameter.span, message);
                        }
                        Spectrum::RgbAlbedo(RgbAlbedo::new(space, value))
                    }
                    SpectrumRole::Unbounded => Spectrum::RgbUnbounded(RgbUnbounded::new(space, value)),
                    SpectrumRole::Illuminant => Spectrum::RgbIlluminant(RgbIlluminant::new(space, value)),
                })
            }
            SpectrumValue::Blackbody(kelvin) => Some(Spectrum::Blackbody(Blackbody::new(kelvin))),
            SpectrumValue::Samples(samples) => match PiecewiseLinear::from_points(samples.to_vec()) {
                Ok(spectrum) => Some(Spectrum::PiecewiseLinear(spectrum)),
                Err(error) => {
                    self.diagnostics.error(parameter.span, error.to_string());
                    None
                }
            },
            SpectrumValue::Named(name) => named(name).or_else(|| self.spectrum_file(name, parameter.span)),
        }
    }

    /// The spectrum of a file of wavelengths and values.
    fn spectrum_file(&mut self, name: &str, span: Span) -> Option<Spectrum> {
        let place = self.resources.resolve(name);
        if let Some(known) = self.spectra.get(&place) {
            return known.clone().map(Spectrum::PiecewiseLinear);
        }
        let spectrum = match self.resources.load(name).and_then(|bytes| unpack(bytes, LARGEST_FILE)) {
            Err(error) => {
                let message = format!(
                    "\"{name}\" is neither a known spectrum nor a file that can be read ({}: {error})",
                    place.display()
                );
                let names = named_names().iter().copied();
                self.diagnostics.push(Diagnostic::error(span, message).with_nearest(name, names));
                None
            }
            Ok(bytes) => match parse_spd(&String::from_utf8_lossy(&bytes)) {
                Ok(spectrum) => Some(spectrum),
                Err(error) => {
                    self.diagnostics.error(span, format!("in the spectrum file \"{name}\": {error}"));
                    None
                }
            },
        };
        self.spectra.insert(place, spectrum.clone());
        spectrum.map(Spectrum::PiecewiseLinear)
    }
}

/// The colour space of a scene file's name for it.
pub(crate) fn color_space(space: ColorSpace) -> &'static RgbColorSpace {
    match space {
        ColorSpace::Srgb => RgbColorSpace::srgb(),
        ColorSpace::DciP3 => RgbColorSpace::dci_p3(),
        ColorSpace::Rec2020 => RgbColorSpace::rec2020(),
        ColorSpace::Aces2065_1 => RgbColorSpace::aces2065_1(),
    }
}
