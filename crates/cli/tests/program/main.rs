//! The program as a whole: what goes in, what comes out, and how it ends.

mod broken;
mod command_line;
mod determinism;
mod lab;
mod noise;
mod pictures;
mod protocol;

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;
use tenfold_image::Image;

/// A small scene with smooth and rough glass, metal, a texture, a light with an area, motion and a lens.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 23 "integer yresolution" 17 "string filename" "named.exr"
Sampler "zsobol" "integer pixelsamples" 3
Integrator "path" "integer maxdepth" 6
PixelFilter "gaussian"
LookAt 0 1.5 5  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.05 "float focaldistance" 5
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.3 0.4 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
  Shape "trianglemesh" "point3 P" [ -1 4 -1  1 4 -1  1 4 1  -1 4 1 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
  "rgb tex1" [ 0.8 0.7 0.6 ] "rgb tex2" [ 0.1 0.2 0.3 ]
AttributeBegin
  Material "diffuse" "texture reflectance" "checks"
  Shape "bilinearmesh" "point3 P" [ -5 0 -5  5 0 -5  -5 0 5  5 0 5 ]
AttributeEnd
AttributeBegin
  Translate -1 0.6 0
  ActiveTransform EndTime Translate 0.2 0.1 0 ActiveTransform All
  Material "conductor" "float roughness" 0.2
  Shape "sphere" "float radius" 0.6
AttributeEnd
AttributeBegin
  Translate 0.5 0.6 0.5
  Material "dielectric" "spectrum eta" "glass-SF11"
  Shape "sphere" "float radius" 0.6
AttributeEnd
"#;

/// A directory with the scene `scene.pbrt`, in which the program runs.
struct Place {
    directory: TempDir,
}

/// How a run ended.
struct Run {
    code: Option<i32>,
    out: String,
    err: String,
}

impl Place {
    fn new() -> Self {
        Self::with(SCENE)
    }

    fn with(scene: &str) -> Self {
        let place = Self { directory: tempfile::tempdir().unwrap() };
        place.add("scene.pbrt", scene);
        place
    }

    fn add(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tenfold"));
        command.current_dir(self.directory.path());
        command
    }

    /// Runs the program with arguments that hold no blanks.
    fn run(&self, line: &str) -> Run {
        Run::from(self.command().args(line.split_whitespace()).output().unwrap())
    }

    /// Runs the program, which must succeed.
    fn succeed(&self, line: &str) -> Run {
        let run = self.run(line);
        assert_eq!(run.code, Some(0), "{line}:\n{}", run.err);
        run
    }

    /// Renders the scene with some options, and reads the picture.
    fn picture(&self, options: &str) -> Image {
        self.succeed(&format!("scene.pbrt -q -o out.exr {options}"));
        self.read("out.exr")
    }

    fn read(&self, name: &str) -> Image {
        Image::read(self.path(name)).unwrap()
    }

    /// The names of all files.
    fn files(&self) -> Vec<String> {
        files(self.directory.path())
    }
}

fn files(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }
}
