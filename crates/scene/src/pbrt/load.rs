//! Files: loading, includes and imports.

use super::{Parser, Reported, Stream, Token, stream::NOT_UTF8, stream::OpenFile};
use crate::{Diagnostic, FileId, Span, unpack};
use std::{io, path::Path, sync::Arc};

/// How deep files may include each other.
const MAX_DEPTH: usize = 64;
/// How many inclusions a scene may have in all: files that include each other many times multiply.
const MAX_INCLUSIONS: usize = 100_000;
/// How long a text may be, so that spans reach.
const MAX_LENGTH: u64 = u32::MAX as u64 - 1;

/// A file read before.
#[derive(Clone)]
pub(super) struct Loaded {
    file: FileId,
    text: Arc<str>,
}

/// The text of a file. Bytes that are not UTF-8 are replaced one by one by [`NOT_UTF8`]: in comments they do no harm.
pub(super) fn text_of(bytes: Vec<u8>) -> io::Result<Arc<str>> {
    let too_long = || io::Error::other("the text is longer than 4 GiB");
    let mut bytes = unpack(bytes, MAX_LENGTH)?;
    if bytes.len() as u64 > MAX_LENGTH {
        return Err(too_long());
    }
    if bytes.starts_with(&[0xfe, 0xff]) || bytes.starts_with(&[0xff, 0xfe]) {
        return Err(io::Error::other("the text is in UTF-16; pbrt's format is UTF-8"));
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        // A byte order mark; blanks keep the offsets true.
        bytes[..3].fill(b' ');
    }
    // The mark for what is not UTF-8 must have no other source.
    if bytes.contains(&(NOT_UTF8 as u8)) {
        bytes.iter_mut().filter(|b| **b == NOT_UTF8 as u8).for_each(|b| *b = 0xff);
    }
    loop {
        match String::from_utf8(bytes) {
            Ok(text) => return Ok(text.into()),
            Err(error) => {
                let error_at = error.utf8_error();
                let start = error_at.valid_up_to();
                bytes = error.into_bytes();
                let len = error_at.error_len().unwrap_or(bytes.len() - start);
                bytes[start..start + len].fill(NOT_UTF8 as u8);
            }
        }
    }
}

/// Why a file cannot be read, in words that do not depend on the system.
pub(super) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}

impl Parser<'_> {
    /// `Include`: the tokens of the file take the place of the directive.
    pub(super) fn include(&mut self, directive: &Token) -> Result<(), Reported> {
        let path = self.string("the name of a file", directive)?;
        let file = self.open(&path.text, path.span)?;
        self.stream.include(file);
        Ok(())
    }

    /// `Import`: the file is read by itself, in a copy of the graphics state that ends with it.
    pub(super) fn import(&mut self, directive: &Token) -> Result<(), Reported> {
        let path = self.string("the name of a file", directive)?;
        if !self.builder.in_world() {
            return self.fail(directive.span, "Import is allowed after WorldBegin only".to_owned());
        }
        let file = self.open(&path.text, path.span)?;
        let outer = std::mem::replace(&mut self.stream, Stream::new(file));
        self.outer.push(outer);
        let scope = self.builder.begin_import();
        // Depth is bounded by `MAX_DEPTH`.
        self.directives();
        self.builder.end_import(scope);
        if let Some(outer) = self.outer.pop() {
            self.stream = outer;
        }
        Ok(())
    }

    /// Loads a file for reading, unless it is open already or the inclusions are too many.
    fn open(&mut self, path: &str, span: Span) -> Result<OpenFile, Reported> {
        let identity = self.resources.identity(path);
        let open_files = || self.outer.iter().flat_map(Stream::files).chain(self.stream.files());
        if let Some(cycle) = open_files().position(|file| file.identity == identity) {
            let error = Diagnostic::error(span, format!("\"{path}\" includes itself"));
            let through: Vec<_> =
                open_files().skip(cycle).map(|f| name_of(&self.sources.file(f.file).path)).collect();
            self.diagnostics.push(match through.len() {
                1 => error,
                _ => error.with_help(format!("the circle is {} → {path}", through.join(" → "))),
            });
            return Err(Reported);
        }
        if open_files().count() > MAX_DEPTH {
            return self.fail(span, format!("files include each other more than {MAX_DEPTH} deep"));
        }
        self.inclusions += 1;
        if self.inclusions > MAX_INCLUSIONS {
            if self.inclusions == MAX_INCLUSIONS + 1 {
                self.diagnostics.error(span, format!("more than {MAX_INCLUSIONS} files are included"));
            }
            return Err(Reported);
        }
        let loaded = match self.loaded.get(&identity) {
            Some(loaded) => loaded.clone(),
            None => {
                let text = match self.resources.load(path).and_then(text_of) {
                    Ok(text) => text,
                    Err(error) => {
                        let place = self.resources.resolve(path);
                        let message = format!("cannot read \"{}\": {}", place.display(), reason(&error));
                        return self.fail(span, message);
                    }
                };
                let file = self.sources.add(self.resources.resolve(path), text.clone());
                self.loaded.insert(identity.clone(), Loaded { file, text: text.clone() });
                Loaded { file, text }
            }
        };
        Ok(OpenFile::new(loaded.file, identity, loaded.text))
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_are_not_utf8_keep_their_places() {
        assert_eq!(&*text_of(b"a\xffb\xc3".to_vec()).unwrap(), "a\u{1a}b\u{1a}");
        assert_eq!(&*text_of(b"\xef\xbb\xbfFilm \x1a".to_vec()).unwrap(), "   Film \u{1a}");
        assert!(text_of(b"\xff\xfeF\0".to_vec()).is_err());
        assert!(text_of(b"\x1f\x8b\x08nonsense".to_vec()).is_err());
    }
}
