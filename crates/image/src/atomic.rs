//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes the file at `path` by way of a temporary one beside it, which takes its name once it is complete and on
/// disk. So a reader never sees half a file, and a failure leaves what was there before. A `path` that is a symbolic
/// link keeps being one; one that is a device or a pipe is written directly.
///
/// # Errors
/// Those of `write`, and those of the file system as `E::from(io::Error)`. The temporary file is removed.
pub fn write_atomic<T, E: From<io::Error>>(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<T, E>,
) -> Result<T, E> {
    // The target of a link, so that the rename does not replace the link itself.
    let path = fs::canonicalize(path.as_ref()).unwrap_or_else(|_| path.as_ref().to_path_buf());
    if fs::metadata(&path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        let mut writer = BufWriter::new(OpenOptions::new().write(true).open(&path)?);
        let value = write(&mut writer)?;
        writer.flush()?;
        return Ok(value);
    }
    let (file, temporary) = create_beside(&path)?;
    let temporary = RemoveOnDrop(Some(temporary));
    let mut writer = BufWriter::with_capacity(1 << 16, file);
    let value = write(&mut writer)?;
    writer.flush()?;
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Ok(existing) = fs::metadata(&path) {
        file.set_permissions(existing.permissions())?;
    }
    file.sync_all()?;
    drop(file);
    temporary.rename_to(&path)?;
    Ok(value)
}

/// A new empty file in the directory of `path`.
fn create_beside(path: &Path) -> io::Result<(File, PathBuf)> {
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "the path does not end in a file name"))?;
    for attempt in 0..1000 {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{attempt}.tmp", std::process::id()));
        let temporary = path.with_file_name(hidden);
        // Read access too: the EXR writer seeks back, and some file systems then want it.
        match OpenOptions::new().read(true).write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((file, temporary)),
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e),
        }
    }
    Err(io::Error::new(ErrorKind::AlreadyExists, "no free name for a temporary file"))
}

/// Removes a file when dropped, unless it was renamed.
struct RemoveOnDrop(Option<PathBuf>);

impl RemoveOnDrop {
    fn rename_to(mut self, path: &Path) -> io::Result<()> {
        if let Some(temporary) = &self.0 {
            fs::rename(temporary, path)?;
            self.0 = None;
        }
        Ok(())
    }
}

impl Drop for RemoveOnDrop {
    fn drop(&mut self) {
        if let Some(temporary) = &self.0 {
            // A failure to clean up must not hide the failure that led here.
            let _ = fs::remove_file(temporary);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        fs::read_dir(directory).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_complete_file_takes_its_name() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("x.txt");
        write_atomic(&path, |w| w.write_all(b"one")).unwrap();
        write_atomic(&path, |w| w.write_all(b"two")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(names(directory.path()), ["x.txt"]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("x.txt");
        fs::write(&path, "before").unwrap();
        let failed: io::Result<()> = write_atomic(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("stop"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "stop");
        assert_eq!(fs::read(&path).unwrap(), b"before");
        assert_eq!(names(directory.path()), ["x.txt"]);
    }

    #[test]
    fn a_panic_removes_the_temporary_file() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("x.txt");
        let caught = std::panic::catch_unwind(|| {
            write_atomic(&path, |_| -> io::Result<()> { std::panic::resume_unwind(Box::new(())) })
        });
        assert!(caught.is_err());
        assert!(names(directory.path()).is_empty());
    }

    #[test]
    fn missing_directories_are_reported() {
        let directory = tempfile::tempdir().unwrap();
        let failed: io::Result<()> = write_atomic(directory.path().join("no/x.txt"), |_| Ok(()));
        assert_eq!(failed.unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links() {
        let directory = tempfile::tempdir().unwrap();
        let (target, link) = (directory.path().join("target"), directory.path().join("link"));
        fs::write(&target, "before").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        write_atomic(&link, |w| w.write_all(b"after")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&target).unwrap(), b"after");
    }
}
