use std::{path::PathBuf, sync::Arc};
use tenfold_math::Id;

/// The files a scene was read from.
pub type FileId = Id<SourceFile>;

/// One file of a scene.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// Where it was found, or the name given to an embedded text.
    pub path: PathBuf,
    /// Its text, unpacked. Bytes that are not UTF-8 are replaced one by one, so that offsets stay true.
    pub text: Arc<str>,
}

/// A stretch of a file, in bytes.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// Offset of the first byte.
    pub start: u32,
    /// Offset of the byte after the last.
    pub end: u32,
}

impl Span {
    /// The stretch from the beginning of `self` to the end of `last`; `self` where `last` lies in another file.
    #[must_use]
    pub fn to(self, last: Span) -> Span {
        if self.file == last.file { Span { end: last.end.max(self.end), ..self } } else { self }
    }
}

/// A place for people: both numbers count from one, columns count characters.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// The line.
    pub line: u32,
    /// The column.
    pub column: u32,
}

/// All files that were read for a scene.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

impl SourceMap {
    /// A map without files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file. Spans reach to byte 2³² − 1: readers refuse longer texts.
    pub fn add(&mut self, path: impl Into<PathBuf>, text: impl Into<Arc<str>>) -> FileId {
        self.files.push(SourceFile { path: path.into(), text: text.into() });
        Id::new(self.files.len() - 1)
    }

    /// The file of an id of this map.
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.index()]
    }

    /// All files, in the order in which they were met.
    pub fn files(&self) -> impl ExactSizeIterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(i, f)| (Id::new(i), f))
    }

    /// The text of a span.
    pub fn text(&self, span: Span) -> &str {
        self.file(span.file).text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// Where a span begins.
    pub fn location(&self, span: Span) -> Location {
        let text = &self.file(span.file).text;
        let bytes = text.as_bytes();
        let before = &bytes[..(span.start as usize).min(bytes.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count();
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        // Every byte that does not continue a character begins one.
        let column = before[line_start..].iter().filter(|&&b| b & 0xc0 != 0x80).count();
        Location { line: line as u32 + 1, column: column as u32 + 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locations_count_lines_and_characters_from_one() {
        let mut map = SourceMap::new();
        let file = map.add("a.pbrt", "abc\r\nä é x\n");
        let at = |start| map.location(Span { file, start, end: start + 1 });
        assert_eq!(at(0), Location { line: 1, column: 1 });
        assert_eq!(at(2), Location { line: 1, column: 3 });
        assert_eq!(at(5), Location { line: 2, column: 1 });
        assert_eq!(at(11), Location { line: 2, column: 5 });
        assert_eq!(at(999), Location { line: 3, column: 1 });
    }
}
