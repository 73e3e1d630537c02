//! From the scene that the command line names to the one that renders.

use crate::{
    diagnostics,
    embedded::Embedded,
    failure::Failure,
    progress::{Reporter, json},
    units::plural,
};
use std::{borrow::Cow, ffi::OsStr, io::Read, path::Path, time::Instant};
use tenfold_render::{
    compile::{coarsen, compile},
    scene::Scene,
};
use tenfold_scene::{
    Description, Diagnostics, EmbeddedResources, FileResources, Resources, Severity, SourceMap, read_pbrt,
    read_pbrt_str,
};

/// Suffixes of scene formats of other programs, which people may try.
const FOREIGN: [&str; 12] =
    ["blend", "fbx", "glb", "gltf", "lxs", "obj", "ply", "rib", "usd", "usda", "usdc", "xml"];

/// A scene that renders.
pub(crate) struct Loaded {
    /// It.
    pub(crate) scene: Scene,
    /// What it is called.
    pub(crate) name: String,
    /// Seconds that reading took.
    pub(crate) read_seconds: f64,
    /// Seconds that compiling took, with the files that the scene names and the hierarchies.
    pub(crate) compile_seconds: f64,
    /// Shapes, materials, textures and lights in the file.
    pub(crate) counts: Counts,
}

impl Loaded {
    /// What it is called, without the folder.
    pub(crate) fn short_name(&self) -> Cow<'_, str> {
        let file = Path::new(&self.name).file_name();
        file.map_or(Cow::Borrowed(self.name.as_str()), OsStr::to_string_lossy)
    }
}

/// How much a scene file holds.
#[derive(Copy, Clone, Debug, Default)]
pub(crate) struct Counts {
    /// Shapes, those of objects once.
    pub(crate) shapes: usize,
    /// Uses of objects.
    pub(crate) instances: usize,
    /// Materials.
    pub(crate) materials: usize,
    /// Textures.
    pub(crate) textures: usize,
}

impl Counts {
    fn of(description: &Description) -> Self {
        let in_objects: usize = description.objects.iter().map(|object| object.shapes.len()).sum();
        Self {
            shapes: description.shapes.len() + in_objects,
            instances: description.instances.len(),
            materials: description.materials.len(),
            textures: description.textures.len(),
        }
    }
}

/// Reads and compiles the scene at `path`, `embedded` where there is none, and tells of its faults. Its picture is
/// made coarser where it has more than `most_pixels`.
pub(crate) fn load(
    path: Option<&Path>,
    embedded: &'static Embedded,
    quiet: bool,
    reporter: &Reporter,
    most_pixels: Option<u32>,
) -> Result<Loaded, Failure> {
    let start = Instant::now();
    let mut sources = SourceMap::new();
    let source = Source::of(path, embedded)?;
    let (mut description, diagnostics) = source.read(&mut sources);
    if let Some(most) = most_pixels {
        coarsen(&mut description, most);
    }
    let read_seconds = start.elapsed().as_secs_f64();
    tracing::info!("read {} in {read_seconds:.3} s", source.name());

    let start = Instant::now();
    // A scene that cannot be read would be reported again and again for what it lacks.
    let broken = diagnostics.has_errors();
    let scene = if broken { None } else { compile(&description, source.resources().as_ref(), &diagnostics) };
    let compile_seconds = start.elapsed().as_secs_f64();
    tracing::info!("compiled it in {compile_seconds:.3} s");

    report(&diagnostics, &sources, quiet, reporter);
    match scene {
        Some(scene) if !diagnostics.has_errors() => Ok(Loaded {
            scene,
            name: source.name(),
            read_seconds,
            compile_seconds,
            counts: Counts::of(&description),
        }),
        _ => {
            let errors = plural(diagnostics.count(Severity::Error), "error");
            Err(Failure::Wrong(format!("{errors} in {}: nothing was rendered", source.name())))
        }
    }
}

fn report(diagnostics: &Diagnostics, sources: &SourceMap, quiet: bool, reporter: &Reporter) {
    let least = if quiet { Severity::Error } else { Severity::Note };
    diagnostics::print(diagnostics, sources, least);
    if matches!(reporter, Reporter::Json(_)) {
        diagnostics.to_vec().iter().for_each(|d| json::diagnostic(&diagnostics::placed(d, sources), sources));
    }
}

/// Where a scene comes from.
enum Source<'a> {
    Embedded(&'static Embedded),
    StandardInput(String),
    File(&'a Path),
}

impl<'a> Source<'a> {
    fn of(path: Option<&'a Path>, embedded: &'static Embedded) -> Result<Self, Failure> {
        let Some(path) = path else { return Ok(Self::Embedded(embedded)) };
        if path.as_os_str() == "-" {
            let mut bytes = Vec::new();
            std::io::stdin()
                .read_to_end(&mut bytes)
                .map_err(|error| Failure::Wrong(format!("cannot read standard input: {error}")))?;
            return match String::from_utf8(bytes) {
                Ok(text) => Ok(Self::StandardInput(text)),
                Err(_) => Err(Failure::Wrong("standard input is not a text in UTF-8".to_owned())),
            };
        }
        let suffix = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if FOREIGN.contains(&suffix.as_str()) {
            let path = path.display();
            return Err(Failure::Wrong(format!(
                "{path}: scenes in .{suffix} files cannot be read; tenfold reads those of pbrt-v4 (.pbrt)"
            )));
        }
        Ok(Self::File(path))
    }

    fn name(&self) -> String {
        match self {
            Self::Embedded(scene) => scene.name.to_owned(),
            Self::StandardInput(_) => "standard input".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }

    fn read(&self, sources: &mut SourceMap) -> (Description, Diagnostics) {
        let resources = self.resources();
        match self {
            Self::Embedded(scene) => read_pbrt_str(scene.name, scene.text, resources.as_ref(), sources),
            Self::StandardInput(text) => read_pbrt_str(&self.name(), text, resources.as_ref(), sources),
            Self::File(path) => read_pbrt(path, sources),
        }
    }

    fn resources(&self) -> Box<dyn Resources> {
        match self {
            Self::Embedded(scene) => Box::new(EmbeddedResources::new(scene.files)),
            Self::StandardInput(_) => Box::new(FileResources::below("")),
            Self::File(path) => Box::new(FileResources::beside(path)),
        }
    }
}
