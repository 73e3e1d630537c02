//! Shared state of the compile step: diagnostics, files and colours.

use super::mesh_files::MeshFiles;
use crate::texture::SpectrumRole;
use rayon::prelude::*;
use std::{collections::HashMap, path::PathBuf, sync::Arc};
use tenfold_image::{ColorEncoding, Format, Image};
use tenfold_scene::{
    ColorSpace, Diagnostic, Diagnostics, ParamSet, ParamValues, Resources, Span, SpectrumValue, unpack,
};
use tenfold_spectrum::{
    Blackbody, PiecewiseLinear, Rgb, RgbAlbedo, RgbColorSpace, RgbIlluminant, RgbUnbounded, Spectrum, named,
    named_names, parse_spd,
};

/// Files are unpacked up to this size, in bytes: far above any sane scene's, far below what stops a machine.
pub(crate) const LARGEST_FILE: u64 = 16 << 30;

/// An image file as it was asked for: which file, and the encoding of 8-bit values.
type ImageKey = (PathBuf, String);

/// What came of reading an image: the image, or what is to be told, or nothing any more where that has been told.
type ReadImage = Result<Arc<Image>, Option<String>>;

/// Shared state of the compile step.
pub(crate) struct Context<'a> {
    /// Where faults go.
    pub(crate) diagnostics: &'a Diagnostics,
    /// Where files come from.
    pub(crate) resources: &'a dyn Resources,
    images: HashMap<ImageKey, ReadImage>,
    spectra: HashMap<PathBuf, Option<PiecewiseLinear>>,
    /// The mesh files, once they have been read.
    pub(super) meshes: MeshFiles,
}

impl<'a> Context<'a> {
    pub(crate) fn new(diagnostics: &'a Diagnostics, resources: &'a dyn Resources) -> Self {
        Self {
            diagnostics,
            resources,
            images: HashMap::new(),
            spectra: HashMap::new(),
            meshes: MeshFiles::default(),
        }
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

    /// The image of a file named at `span`, its 8-bit values in `encoding`, or what the file says. Each file is read
    /// once, and a fault reported once.
    pub(crate) fn image(
        &mut self,
        path: &str,
        span: Span,
        encoding: Option<ColorEncoding>,
    ) -> Option<Arc<Image>> {
        let resources = self.resources;
        let read = self
            .images
            .entry(image_key(resources, path, encoding))
            .or_insert_with(|| read_image(resources, path, encoding).map_err(Some));
        match read {
            Ok(image) => Some(image.clone()),
            Err(untold) => {
                if let Some(message) = untold.take() {
                    self.diagnostics.error(span, message);
                }
                None
            }
        }
    }

    /// Reads images that will be asked for, several at once.
    pub(crate) fn read_images<'n>(&mut self, files: impl Iterator<Item = (&'n str, Option<ColorEncoding>)>) {
        let resources = self.resources;
        let wanted: HashMap<ImageKey, _> =
            files.map(|(path, encoding)| (image_key(resources, path, encoding), (path, encoding))).collect();
        let read = wanted
            .into_par_iter()
            .map(|(key, (path, encoding))| (key, read_image(resources, path, encoding).map_err(Some)));
        self.images.par_extend(read);
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

fn image_key(resources: &dyn Resources, path: &str, encoding: Option<ColorEncoding>) -> ImageKey {
    (resources.identity(path), format!("{encoding:?}"))
}

/// The image of a file, or what is wrong with it.
fn read_image(
    resources: &dyn Resources,
    path: &str,
    encoding: Option<ColorEncoding>,
) -> Result<Arc<Image>, String> {
    let bytes = read_file(resources, path)?;
    let image = Image::read_bytes(&bytes, Format::from_path(path).ok(), encoding);
    image.map(Arc::new).map_err(|error| format!("cannot read the image \"{path}\": {error}"))
}

/// The first string of a parameter, without a check of its type or number: for what is read ahead of the check.
pub(super) fn string_of<'p>(params: &'p ParamSet, name: &str) -> Option<&'p str> {
    match &params.get(name)?.values {
        ParamValues::Strings(strings) => strings.first().map(String::as_str),
        _ => None,
    }
}

/// The bytes of a file, unpacked, or why it cannot be read.
pub(super) fn read_file(resources: &dyn Resources, path: &str) -> Result<Vec<u8>, String> {
    resources
        .load(path)
        .and_then(|bytes| unpack(bytes, LARGEST_FILE))
        .map_err(|error| format!("cannot read \"{}\": {error}", resources.resolve(path).display()))
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
