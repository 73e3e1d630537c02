use flate2::read::MultiGzDecoder;
use std::{
    io::{self, Read},
    path::{Path, PathBuf},
};

/// Where the files that a scene names come from: the file system, or what a program carries along. Several are asked
/// for at once.
pub trait Resources: Sync {
    /// The bytes of a file, as they are stored (see [`unpack`]).
    ///
    /// # Errors
    /// Where the file is missing or cannot be read.
    fn load(&self, path: &str) -> io::Result<Vec<u8>>;

    /// The same file, to be read piece by piece, where memory for all of its bytes is worth saving: none where [`Resources::load`] is to be asked.
    fn large(&self, _path: &str) -> Option<LargeFile> {
        None
    }

    /// The place that a name in a scene stands for, for messages.
    fn resolve(&self, path: &str) -> PathBuf;

    /// A name that all names of one file share.
    fn identity(&self, path: &str) -> PathBuf {
        self.resolve(path)
    }
}

/// Files on disk. Like pbrt, names are relative to the directory of the scene file (not of the included file that
/// says the name), or else to the current directory.
#[derive(Clone, Debug)]
pub struct FileResources {
    root: PathBuf,
}

impl FileResources {
    /// The files beside a scene file.
    pub fn beside(scene: &Path) -> Self {
        Self { root: scene.parent().map(Path::to_path_buf).unwrap_or_default() }
    }

    /// The files below a directory.
    pub fn below(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }
}

impl Resources for FileResources {
    fn load(&self, path: &str) -> io::Result<Vec<u8>> {
        read_file(&self.resolve(path))
    }

    #[cfg(unix)]
    fn large(&self, path: &str) -> Option<LargeFile> {
        LargeFile::open(&self.resolve(path)).ok().filter(|file| file.len() > READ_AT_ONCE as u64)
    }

    fn resolve(&self, path: &str) -> PathBuf {
        let beside = self.root.join(path);
        if beside.exists() || !Path::new(path).exists() { beside } else { PathBuf::from(path) }
    }

    fn identity(&self, path: &str) -> PathBuf {
        let resolved = self.resolve(path);
        resolved.canonicalize().unwrap_or(resolved)
    }
}

/// A file on disk that several threads read pieces of.
#[derive(Debug)]
pub struct LargeFile {
    #[cfg_attr(not(unix), expect(dead_code, reason = "there are none"))]
    file: std::fs::File,
    len: u64,
}

impl LargeFile {
    /// A regular file.
    ///
    /// # Errors
    /// Where it is missing, cannot be read, or is another kind of file.
    pub fn open(path: &Path) -> io::Result<Self> {
        let len = size(path)?;
        Ok(Self { file: std::fs::File::open(path)?, len })
    }

    /// How many bytes there are.
    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// Fills `bytes` with those behind the first `before`.
    pub(crate) fn read_at(&self, before: u64, bytes: &mut [u8]) -> io::Result<()> {
        #[cfg(unix)]
        return std::os::unix::fs::FileExt::read_exact_at(&self.file, bytes, before);
        #[cfg(not(unix))]
        return Err(io::ErrorKind::Unsupported.into());
    }
}

/// Reads a regular file: devices and pipes may never end.
pub(crate) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let size = size(path)?;
    #[cfg(unix)]
    if size > READ_AT_ONCE as u64
        && let Ok(size) = usize::try_from(size)
    {
        return read_in_parts(path, size);
    }
    std::fs::read(path)
}

/// The size of a regular file.
fn size(path: &Path) -> io::Result<u64> {
    let metadata = std::fs::metadata(path)?;
    if metadata.is_file() { Ok(metadata.len()) } else { Err(io::Error::other("not a regular file")) }
}

/// Larger files are read in parts of this size, in bytes, by all threads: most of the time goes into memory that is used for the
/// first time.
#[cfg(unix)]
const READ_AT_ONCE: usize = 8 << 20;

#[cfg(unix)]
fn read_in_parts(path: &Path, size: usize) -> io::Result<Vec<u8>> {
    use rayon::prelude::*;
    use std::os::unix::fs::FileExt;

    let file = std::fs::File::open(path)?;
    let mut bytes = vec![0; size];
    bytes
        .par_chunks_mut(READ_AT_ONCE)
        .enumerate()
        .try_for_each(|(i, part)| file.read_exact_at(part, (i * READ_AT_ONCE) as u64))?;
    Ok(bytes)
}

/// Files that the program carries along, by name.
#[derive(Copy, Clone, Debug, Default)]
pub struct EmbeddedResources {
    files: &'static [(&'static str, &'static [u8])],
}

impl EmbeddedResources {
    /// The files of a table of names and bytes.
    pub const fn new(files: &'static [(&'static str, &'static [u8])]) -> Self {
        Self { files }
    }
}

impl Resources for EmbeddedResources {
    fn load(&self, path: &str) -> io::Result<Vec<u8>> {
        let found = self.files.iter().find(|(name, _)| *name == path);
        found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn resolve(&self, path: &str) -> PathBuf {
        PathBuf::from(path)
    }
}

/// The content of a file that may be packed by gzip; whether it is, its first bytes tell.
///
/// # Errors
/// Where the packed data are damaged or unpack to more than `limit` bytes.
pub fn unpack(bytes: Vec<u8>, limit: u64) -> io::Result<Vec<u8>> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(&bytes[..]).take(limit + 1).read_to_end(&mut unpacked)?;
    if unpacked.len() as u64 > limit {
        return Err(io::Error::other(format!("unpacks to more than {limit} bytes")));
    }
    Ok(unpacked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn gzip_is_known_by_its_first_bytes() {
        assert_eq!(unpack(packed(b"hello"), 10).unwrap(), b"hello");
        assert_eq!(unpack(b"hello".to_vec(), 10).unwrap(), b"hello");
    }

    #[test]
    fn bombs_and_damage_are_refused() {
        assert!(unpack(packed(&[0; 100_000]), 99_999).is_err());
        let mut damaged = packed(b"hello");
        damaged.truncate(12);
        assert!(unpack(damaged, 10).is_err());
    }

    #[test]
    fn large_files_are_read_in_parts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large");
        let bytes: Vec<u8> =
            (0..20_000_000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        std::fs::write(&path, &bytes).unwrap();
        assert!(FileResources::below(folder.path()).load("large").unwrap() == bytes);
        assert!(FileResources::below(folder.path()).load(".").is_err());
    }

    #[test]
    fn embedded_files_are_found_by_name() {
        let files = EmbeddedResources::new(&[("a.png", b"x")]);
        assert_eq!(files.load("a.png").unwrap(), b"x");
        assert_eq!(files.load("b.png").unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
