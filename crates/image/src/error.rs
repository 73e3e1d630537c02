//! What can go wrong between an image and a file.

use crate::format::{Format, UnknownFormat};
use std::fmt;
use std::path::{Path, PathBuf};

/// A failure to read or write an image, with the file it concerns.
#[derive(Debug, thiserror::Error)]
pub struct ImageError {
    /// The file, where there is one (none for bytes in memory).
    pub path: Option<PathBuf>,
    /// What was wrong.
    pub kind: ImageErrorKind,
}

/// What was wrong with an image or its file.
#[derive(Debug, thiserror::Error)]
pub enum ImageErrorKind {
    /// The operating system refused.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// Neither the content nor the suffix tells the format.
    #[error("{0}")]
    UnknownFormat(#[from] UnknownFormat),
    /// The content breaks the rules of its format.
    #[error("damaged {format} file: {what}")]
    Malformed {
        /// The format the content was read as.
        format: Format,
        /// What the decoder found.
        what: String,
    },
    /// The content is beyond what is supported.
    #[error("unsupported {format} image: {what} (expected {expected})")]
    Unsupported {
        /// The format of the file.
        format: Format,
        /// What was found.
        what: String,
        /// What would have been accepted.
        expected: String,
    },
    /// The file claims more pixels than it can hold.
    #[error(
        "the {format} file of {file_bytes} bytes claims {width} × {height} pixels (expected at most {limit} bytes of pixels)"
    )]
    TooLarge {
        /// The format of the file.
        format: Format,
        /// Claimed width in pixels.
        width: u64,
        /// Claimed height in pixels.
        height: u64,
        /// Length of the file.
        file_bytes: u64,
        /// The largest size in bytes that was accepted for it.
        limit: u64,
    },
    /// Sizes do not fit together.
    #[error(
        "an image of {width} × {height} pixels and {channels} channels needs {expected} values, found {found}"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Channels of a pixel.
        channels: usize,
        /// Values that the size asks for.
        expected: u64,
        /// Values that were given.
        found: u64,
    },
    /// Channels are missing, repeated or not accepted.
    #[error("the image has the channels {found} (expected {expected})", found = .found.join(", "))]
    Channels {
        /// The channels of the image.
        found: Vec<String>,
        /// What was asked of them.
        expected: String,
    },
    /// A metadata attribute cannot be stored.
    #[error("the attribute `{name}` cannot be stored: {why}")]
    Attribute {
        /// Name of the attribute.
        name: String,
        /// What is wrong with it.
        why: String,
    },
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.path {
            Some(path) => write!(f, "{}: {}", path.display(), self.kind),
            None => write!(f, "{}", self.kind),
        }
    }
}

impl ImageErrorKind {
    /// This fault, said of the file at `path`.
    pub(crate) fn at(self, path: &Path) -> ImageError {
        ImageError { path: Some(path.to_path_buf()), kind: self }
    }

    pub(crate) fn malformed(format: Format, what: impl fmt::Display) -> Self {
        ImageErrorKind::Malformed { format, what: what.to_string() }
    }

    pub(crate) fn unsupported(format: Format, what: impl fmt::Display, expected: impl fmt::Display) -> Self {
        ImageErrorKind::Unsupported { format, what: what.to_string(), expected: expected.to_string() }
    }
}

impl From<ImageErrorKind> for ImageError {
    fn from(kind: ImageErrorKind) -> Self {
        ImageError { path: None, kind }
    }
}
