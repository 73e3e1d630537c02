//! File formats, told by suffix or by content.

use std::fmt;
use std::path::Path;

/// A file format of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// OpenEXR: read and written.
    Exr,
    /// PNG: read and written.
    Png,
    /// JPEG: read.
    Jpeg,
    /// Radiance RGBE: read and written.
    Hdr,
    /// Portable float map: read and written.
    Pfm,
    /// Truevision TGA: read.
    Tga,
    /// Windows bitmap: read.
    Bmp,
}

/// A suffix that names no known format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct UnknownFormat {
    /// The suffix, lower case, without its dot; empty where there is none.
    pub suffix: String,
    /// The known format whose suffix is nearest in spelling, if one is near.
    pub nearest: Option<Format>,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 7] =
        [Format::Exr, Format::Png, Format::Jpeg, Format::Hdr, Format::Pfm, Format::Tga, Format::Bmp];

    /// The suffixes of the format, the customary one first.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Format::Exr => &["exr"],
            Format::Png => &["png"],
            Format::Jpeg => &["jpg", "jpeg"],
            Format::Hdr => &["hdr", "pic", "rgbe"],
            Format::Pfm => &["pfm"],
            Format::Tga => &["tga"],
            Format::Bmp => &["bmp"],
        }
    }

    /// Whether [`crate::Image::write`] can make such files.
    pub fn is_writable(self) -> bool {
        match self {
            Format::Exr | Format::Png | Format::Hdr | Format::Pfm => true,
            Format::Jpeg | Format::Tga | Format::Bmp => false,
        }
    }

    /// The format named by the suffix of `path`, in either case.
    ///
    /// # Errors
    /// [`UnknownFormat`] with the nearest known one where the suffix is missing or unknown.
    pub fn from_path(path: impl AsRef<Path>) -> Result<Format, UnknownFormat> {
        let suffix = path.as_ref().extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let spellings = || Self::ALL.iter().flat_map(|&f| f.suffixes().iter().map(move |&s| (f, s)));
        if let Some((format, _)) = spellings().find(|(_, s)| *s == suffix) {
            return Ok(format);
        }
        let nearest = spellings()
            .map(|(format, s)| (strsim::damerau_levenshtein(s, &suffix), format))
            .filter(|&(distance, _)| distance <= 2 && distance < suffix.chars().count())
            .min_by_key(|&(distance, _)| distance)
            .map(|(_, format)| format);
        Err(UnknownFormat { suffix, nearest })
    }

    /// The format whose magic number `bytes` start with (TGA has none).
    pub fn from_magic(bytes: &[u8]) -> Option<Format> {
        const MAGIC: [(&[u8], Format); 8] = [
            (&[0x76, 0x2f, 0x31, 0x01], Format::Exr),
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (&[0xff, 0xd8, 0xff], Format::Jpeg),
            (b"#?RADIANCE", Format::Hdr),
            (b"#?RGBE", Format::Hdr),
            (b"PF", Format::Pfm),
            (b"Pf", Format::Pfm),
            (b"BM", Format::Bmp),
        ];
        MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|&(_, format)| format)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::Exr => "EXR",
            Format::Png => "PNG",
            Format::Jpeg => "JPEG",
            Format::Hdr => "HDR",
            Format::Pfm => "PFM",
            Format::Tga => "TGA",
            Format::Bmp => "BMP",
        })
    }
}

impl fmt::Display for UnknownFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.suffix.is_empty() {
            write!(f, "the file name has no suffix that tells an image format")?;
        } else {
            write!(f, "`.{}` is not a known image format", self.suffix)?;
        }
        match self.nearest {
            Some(format) => write!(f, " (did you mean `.{}`?)", format.suffixes()[0]),
            None => {
                let known: Vec<_> = Format::ALL.iter().map(|f| format!(".{}", f.suffixes()[0])).collect();
                write!(f, " (expected {})", known.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suffixes_are_known_in_either_case() {
        assert_eq!(Format::from_path("a/b.EXR"), Ok(Format::Exr));
        assert_eq!(Format::from_path("x.tar.jpeg"), Ok(Format::Jpeg));
    }

    #[test]
    fn unknown_suffixes_name_the_nearest() {
        let e = Format::from_path("x.exe").unwrap_err();
        assert_eq!(e.nearest, Some(Format::Exr));
        assert_eq!(e.to_string(), "`.exe` is not a known image format (did you mean `.exr`?)");
        assert_eq!(Format::from_path("x.pgn").unwrap_err().nearest, Some(Format::Png));
        assert_eq!(Format::from_path("x.document").unwrap_err().nearest, None);
        let e = Format::from_path("noname").unwrap_err();
        assert_eq!((e.suffix.as_str(), e.nearest), ("", None));
        assert!(e.to_string().contains(".exr, .png"));
    }
}
