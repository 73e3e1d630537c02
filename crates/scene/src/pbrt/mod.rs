//! The reader of pbrt-v4's scene format (<https://pbrt.org/fileformat-v4>): a stream of tokens over included files, directives
//! that change the graphics state or add an entity in the current state, and their parameters.

mod build;
mod directives;
mod load;
mod names;
mod number;
mod parameters;
mod state;
mod stream;
mod transforms;

use crate::{Description, Diagnostic, Diagnostics, FileResources, Resources, SourceMap, Span};
use build::Builder;
use load::Loaded;
use std::{collections::HashMap, path::Path, path::PathBuf};
use stream::{OpenFile, Stream, Token, TokenKind};

/// Reads a scene in pbrt-v4's format from disk, with all files that it includes, relative to its directory.
///
/// All faults found are collected; where [`Diagnostics::has_errors`] the description is what could be made out.
pub fn read_pbrt(path: &Path, sources: &mut SourceMap) -> (Description, Diagnostics) {
    let diagnostics = Diagnostics::new();
    let read = crate::resources::read_file(path).and_then(load::text_of);
    match read {
        Ok(text) => {
            let file = sources.add(path, text.clone());
            let identity = path.canonicalize().unwrap_or_else(|_| path.to_owned());
            let main = OpenFile::new(file, identity, text);
            let description = Parser::read(main, &FileResources::beside(path), sources, &diagnostics);
            (description, diagnostics)
        }
        Err(error) => {
            let message = format!("cannot read \"{}\": {}", path.display(), load::reason(&error));
            diagnostics.error(None, message);
            (Description::default(), diagnostics)
        }
    }
}

/// Reads a scene in pbrt-v4's format that is at hand as text; what it includes comes from `resources`.
pub fn read_pbrt_str(
    name: &str,
    text: &str,
    resources: &dyn Resources,
    sources: &mut SourceMap,
) -> (Description, Diagnostics) {
    let diagnostics = Diagnostics::new();
    match load::text_of(text.as_bytes().to_vec()) {
        Ok(text) => {
            let file = sources.add(name, text.clone());
            let main = OpenFile::new(file, resources.identity(name), text);
            let description = Parser::read(main, resources, sources, &diagnostics);
            (description, diagnostics)
        }
        Err(error) => {
            diagnostics.error(None, format!("cannot read \"{name}\": {}", load::reason(&error)));
            (Description::default(), diagnostics)
        }
    }
}

/// A fault that was reported; what it is part of cannot be read further.
#[derive(Debug)]
struct Reported;

/// The state of a reading.
struct Parser<'a> {
    sources: &'a mut SourceMap,
    resources: &'a dyn Resources,
    diagnostics: &'a Diagnostics,
    /// The tokens to come.
    stream: Stream,
    /// The streams that go on after the current import, outermost first.
    outer: Vec<Stream>,
    builder: Builder<'a>,
    /// The files read so far, by identity.
    loaded: HashMap<PathBuf, Loaded>,
    /// How many `Include` and `Import` directives were followed.
    inclusions: usize,
    /// The end of the token read last.
    last: Span,
    warned_of_transform_begin: bool,
}

impl<'a> Parser<'a> {
    fn read(
        main: OpenFile,
        resources: &'a dyn Resources,
        sources: &'a mut SourceMap,
        diagnostics: &'a Diagnostics,
    ) -> Description {
        let start = Span { file: main.file, start: 0, end: 0 };
        let mut parser = Self {
            sources,
            resources,
            diagnostics,
            stream: Stream::new(main),
            outer: Vec::new(),
            builder: Builder::new(diagnostics, start),
            loaded: HashMap::new(),
            inclusions: 0,
            last: start,
            warned_of_transform_begin: false,
        };
        parser.directives();
        let last = parser.last;
        parser.builder.finish(last)
    }

    /// The next token.
    fn next(&mut self) -> Option<Token> {
        let token = self.stream.next(self.diagnostics)?;
        self.last = token.span;
        Some(token)
    }

    /// The next token, which a directive needs.
    fn required(&mut self, what: &str, directive: &Token) -> Result<Token, Reported> {
        match self.next() {
            Some(token) if token.broken => Err(Reported),
            Some(token) => Ok(token),
            None => {
                let message = format!("the file ends where {} needs {what}", directive.text);
                self.fail(directive.span, message)
            }
        }
    }

    /// The next token, which must be a quoted string.
    fn string(&mut self, what: &str, directive: &Token) -> Result<Token, Reported> {
        let token = self.required(what, directive)?;
        if token.kind == TokenKind::String {
            return Ok(token);
        }
        let message = format!("{} needs {what} in quotes, found {}", directive.text, token.shown());
        let span = token.span;
        self.stream.hold(token);
        self.fail(span, message)
    }

    /// The next tokens, which must be numbers.
    fn numbers<const N: usize>(&mut self, directive: &Token) -> Result<[f32; N], Reported> {
        let mut values = [0.0; N];
        for (i, value) in values.iter_mut().enumerate() {
            let token = self.required(&format!("{N} numbers"), directive)?;
            let other = || format!("{} needs {N} numbers, found {} after {i}", directive.text, token.shown());
            *value = self.number(&token, other)?;
        }
        Ok(values)
    }

    /// The number that a token is; reports `other` where it is something else.
    fn number(&mut self, token: &Token, other: impl FnOnce() -> String) -> Result<f32, Reported> {
        let read = match token.kind {
            TokenKind::Word => number::parse_float(&token.text),
            _ => Err(number::NumberFault::NotANumber),
        };
        read.or_else(|fault| {
            let message = match fault {
                number::NumberFault::OutOfRange => {
                    format!("{} is beyond the range of numbers", token.shown())
                }
                _ => other(),
            };
            self.stream.hold(token.clone());
            self.fail(token.span, message)
        })
    }

    /// Reports a fault that ends the reading of a directive.
    fn fail<T>(&self, span: Span, message: String) -> Result<T, Reported> {
        self.diagnostics.push(Diagnostic::error(span, message));
        Err(Reported)
    }

    /// Goes on to the next word that is a directive.
    fn skip_to_directive(&mut self) {
        while let Some(token) = self.next() {
            if token.kind == TokenKind::Word && directives::is_directive(&token.text) {
                self.stream.hold(token);
                return;
            }
        }
    }
}
