//! Pictures and their files.

use crate::{args::Args, embedded, failure::Failure, layers::Layer};
use std::{
    collections::BTreeMap,
    io,
    path::{Path, PathBuf},
};
use tenfold_image::{Attribute, Format, Image, Metadata, PngDepth, Window, WriteOptions, write_atomic};
use tenfold_render::{
    scene::Scene,
    schedule::{Frozen, Render, RenderSettings},
};
use tenfold_spectrum::RgbColorSpace;

/// A file to be written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Target {
    /// Where.
    pub(crate) path: PathBuf,
    /// What its suffix tells.
    format: Format,
}

impl Target {
    /// A file whose suffix names a format that can be written.
    pub(crate) fn new(path: &Path) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::Wrong(format!("cannot write {}: {why}", path.display()));
        match Format::from_path(path) {
            Ok(format) if format.is_writable() => Ok(Self { path: path.to_owned(), format }),
            Ok(format) => Err(wrong(format!("{format} files are only read; write .exr, .png, .pfm or .hdr"))),
            Err(unknown) => Err(wrong(unknown.to_string())),
        }
    }

    /// Whether it can hold layers.
    pub(crate) fn is_exr(&self) -> bool {
        self.format == Format::Exr
    }

    /// Whether a file can be put there, found out before hours are spent on its content.
    pub(crate) fn check_writable(&self) -> Result<(), Failure> {
        check_writable(&self.path)
    }

    /// Writes the picture.
    pub(crate) fn write(&self, picture: &Picture<'_>, png16: bool) -> Result<(), String> {
        let png_depth = if png16 { PngDepth::Sixteen } else { PngDepth::Eight };
        let options = WriteOptions { png_depth, ..WriteOptions::default() };
        let image = picture.image(self.format).map_err(|error| error.to_string())?;
        image.write(&self.path, &options).map_err(|error| error.to_string())
    }
}

/// Whether a file can be put at `path`, found out before hours are spent on its content.
pub(crate) fn check_writable(path: &Path) -> Result<(), Failure> {
    let failed =
        |why: &dyn std::fmt::Display| Failure::Failed(format!("cannot write {}: {why}", path.display()));
    if path.is_dir() {
        return Err(failed(&"it is a directory"));
    }
    // A temporary file is made beside it, as it will be for the picture, and given up.
    match write_atomic(path, |_| Err::<(), _>(Trial::Possible)) {
        Err(Trial::Impossible(error)) if error.kind() == io::ErrorKind::NotFound => {
            Err(failed(&"there is no such directory"))
        }
        Err(Trial::Impossible(error)) => Err(failed(&error)),
        Ok(()) | Err(Trial::Possible) => Ok(()),
    }
}

/// How an attempt to make a file ended.
enum Trial {
    Possible,
    Impossible(io::Error),
}

impl From<io::Error> for Trial {
    fn from(error: io::Error) -> Self {
        Self::Impossible(error)
    }
}

/// The files that the command line names.
pub(crate) fn asked_for(args: &Args) -> Result<Vec<Target>, Failure> {
    args.outfile.iter().map(|path| Target::new(path)).collect()
}

/// The file to write where the command line names none: the one that the scene says.
pub(crate) fn default_target(args: &Args, scene: &Scene) -> Result<Target, Failure> {
    if args.scene.is_none() {
        return Target::new(Path::new(embedded::PICTURE));
    }
    let name = scene.film.filename.as_deref().filter(|name| !name.is_empty());
    Target::new(Path::new(name.unwrap_or("tenfold.exr")))
}

/// A render as a picture with its story.
pub(crate) struct Picture<'a> {
    /// What was rendered.
    pub(crate) scene: &'a Scene,
    /// What the scene is called.
    pub(crate) scene_name: &'a str,
    /// How it was rendered.
    pub(crate) settings: &'a RenderSettings,
    /// What came out.
    pub(crate) render: &'a Render,
    /// What EXR files hold besides.
    pub(crate) layers: &'a [Layer],
}

impl Picture<'_> {
    /// The picture as a file of `format` stores it: linear RGB in the film's colour space, but for PNG files, whose
    /// codes are sRGB's.
    fn image(&self, format: Format) -> Result<Image, tenfold_image::ImageErrorKind> {
        let space = self.scene.film.color_space;
        let bounds = self.render.film.bounds();
        let mut pixels = self.render.film.means();
        if format == Format::Png && space.name() != RgbColorSpace::srgb().name() {
            let to_srgb = space.to(RgbColorSpace::srgb());
            pixels.iter_mut().for_each(|rgb| *rgb = to_srgb * *rgb);
        }
        let mut parts = vec![(&["R", "G", "B"][..], pixels.iter().flat_map(|rgb| rgb.to_array()).collect())];
        if format == Format::Exr {
            parts.extend(self.layers.iter().map(|layer| (layer.channels(), layer.values(self.render))));
        }
        let channels = parts.iter().flat_map(|(names, _)| names.iter().copied());
        let mut image =
            Image::from_f32(bounds.size().x, bounds.size().y, channels, interleaved(&parts, pixels.len()))?;
        let [red, green, blue] = space.primaries();
        let resolution = self.scene.film.resolution;
        image.metadata = Metadata {
            chromaticities: Some([red, green, blue, space.white()]),
            origin: (bounds.min.x as i32, bounds.min.y as i32),
            display_window: Some(Window { x: 0, y: 0, width: resolution.x, height: resolution.y }),
            attributes: self.attributes(),
        };
        Ok(image)
    }

    fn attributes(&self) -> BTreeMap<String, Attribute> {
        let statistics = &self.render.statistics;
        let mut attributes = BTreeMap::from([
            ("software", Attribute::Text(concat!("tenfold ", env!("CARGO_PKG_VERSION")).to_owned())),
            ("scene", Attribute::Text(latin1(self.scene_name))),
            ("seed", Attribute::Text(self.settings.seed.to_string())),
            ("sampler", Attribute::Text(self.settings.sampling.to_string())),
            ("strategy", Attribute::Text(self.settings.strategy())),
            ("samplesPerPixel", Attribute::I32(self.samples_per_pixel().min(i32::MAX as u32) as i32)),
            ("renderTimeSeconds", Attribute::F32(statistics.seconds as f32)),
        ]);
        let frozen: Vec<_> = self.settings.frozen().iter().map(Frozen::to_string).collect();
        if !frozen.is_empty() {
            attributes.insert("frozen", Attribute::Text(frozen.join(",")));
        }
        if !self.render.complete {
            attributes.insert("interruptedAfterSamples", Attribute::Text(statistics.samples.to_string()));
        }
        if let Some(report) = &self.render.noise {
            let texts = [("noise", report.reached.map(|n| n.value)), ("noiseTarget", report.target)];
            attributes.extend(texts.into_iter().filter_map(|(k, v)| Some((k, Attribute::F32(v? as f32)))));
        }
        attributes.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    /// Those of every pixel, or in the mean where pixels differ.
    fn samples_per_pixel(&self) -> u32 {
        let film = &self.render.film;
        match self.render.noise {
            None => self.settings.spp,
            Some(_) => (film.samples() as f64 / film.bounds().area().max(1) as f64).round() as u32,
        }
    }
}

/// The values of several sets of channels of `pixels` pixels, pixel by pixel.
fn interleaved(parts: &[(&[&str], Vec<f32>)], pixels: usize) -> Vec<f32> {
    let of_pixel =
        |p: usize| parts.iter().flat_map(move |(names, values)| &values[p * names.len()..][..names.len()]);
    (0..pixels).flat_map(of_pixel).copied().collect()
}

/// A text as attributes can hold it.
fn latin1(text: &str) -> String {
    text.chars().map(|c| if (c as u32) < 256 { c } else { '?' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suffixes_decide() {
        assert!(Target::new(Path::new("a.exr")).is_ok());
        for (path, part) in [("a.jpg", "only read"), ("a.exe", ".exr"), ("a", "suffix")] {
            let failure = Target::new(Path::new(path)).unwrap_err();
            assert!(failure.code() == 2 && failure.message().contains(part), "{failure:?}");
        }
    }

    #[test]
    fn unwritable_places_are_found_at_once() {
        let directory = tempfile::tempdir().unwrap();
        let target = |name: &str| Target::new(&directory.path().join(name)).unwrap();
        assert_eq!(target("a.exr").check_writable(), Ok(()));
        assert_eq!(target("no/a.exr").check_writable().unwrap_err().code(), 1);
        std::fs::create_dir(directory.path().join("b.exr")).unwrap();
        assert_eq!(target("b.exr").check_writable().unwrap_err().code(), 1);
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn attributes_keep_to_their_alphabet() {
        assert_eq!(latin1("é→x"), "é?x");
    }
}
