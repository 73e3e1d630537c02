//! Tests of the readers through the public interface.

mod faults;
mod files;
mod grammar;
mod mutations;
mod parameters;
mod ply;

use std::{collections::HashMap, io, path::PathBuf};
use tenfold_scene::{Description, Diagnostics, Resources, SourceMap, read_pbrt_str};

/// Files in memory.
#[derive(Default)]
struct Files(HashMap<&'static str, Vec<u8>>);

impl Files {
    fn new<const N: usize>(files: [(&'static str, &str); N]) -> Self {
        Self(files.into_iter().map(|(name, text)| (name, text.as_bytes().to_vec())).collect())
    }
}

impl Resources for Files {
    fn load(&self, path: &str) -> io::Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn resolve(&self, path: &str) -> PathBuf {
        PathBuf::from(path)
    }
}

/// Reads a scene called `s` that has these files, and gives the findings as lines.
fn read_with(files: &Files, text: &str) -> (Description, Vec<String>) {
    let mut sources = SourceMap::new();
    let (description, diagnostics) = read_pbrt_str("s", text, files, &mut sources);
    (description, lines(&diagnostics, &sources))
}

/// Reads a scene without files.
fn read(text: &str) -> (Description, Vec<String>) {
    read_with(&Files::default(), text)
}

/// Reads a scene that must have no fault.
fn read_clean(text: &str) -> Description {
    let (description, found) = read(text);
    assert_eq!(found, [""; 0], "{text}");
    description
}

/// Reads the world of a scene, which begins on line 1, and gives the findings.
fn world_findings(text: &str) -> Vec<String> {
    read(&format!("WorldBegin {text}")).1
}

fn lines(diagnostics: &Diagnostics, sources: &SourceMap) -> Vec<String> {
    diagnostics.to_vec().iter().map(|d| d.plain(sources)).collect()
}
