//! Tokens of a file and of the files that it includes, as one stream.

use super::number::{ends_word, parse_float, parse_integer, scan_float, scan_integer};
use crate::{Diagnostics, FileId, Span};
use std::{path::PathBuf, sync::Arc};

/// A character that no text contains: it stands for a byte that is not UTF-8.
pub(super) const NOT_UTF8: char = '\u{1a}';

/// What a token is.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A directive, a number, `true` or `false`.
    Word,
    /// A quoted string.
    String,
    /// `[`
    Open,
    /// `]`
    Close,
}

/// A token.
#[derive(Clone, Debug)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    /// The word, or the content of the string with its escapes resolved.
    pub(super) text: String,
    pub(super) span: Span,
    /// Whether a fault of it was reported already.
    pub(super) broken: bool,
}

impl Token {
    /// The token for a message.
    pub(super) fn shown(&self) -> String {
        // Nobody reads on after a few words.
        let mut text: String = self.text.chars().take(40).collect();
        if text.len() < self.text.len() {
            text.push('…');
        }
        match self.kind {
            TokenKind::String => format!("the string \"{text}\""),
            _ => format!("`{text}`"),
        }
    }
}

/// A file that is being read.
#[derive(Debug)]
pub(super) struct OpenFile {
    pub(super) file: FileId,
    pub(super) identity: PathBuf,
    text: Arc<str>,
    position: usize,
}

impl OpenFile {
    pub(super) fn new(file: FileId, identity: PathBuf, text: Arc<str>) -> Self {
        Self { file, identity, text, position: 0 }
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span { file: self.file, start: start as u32, end: end as u32 }
    }

    /// Goes to the beginning of the next token; `None` at the end of the file.
    fn skip_blanks(&mut self) -> Option<u8> {
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(self.position)? {
                b' ' | b'\n' | b'\t' | b'\r' => self.position += 1,
                b'#' => {
                    let rest = &bytes[self.position..];
                    self.position +=
                        rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
                }
                &b => return Some(b),
            }
        }
    }

    /// The end of the word that begins here.
    fn word_end(&self) -> usize {
        let rest = &self.text.as_bytes()[self.position..];
        self.position + rest.iter().position(|b| ends_word(Some(b))).unwrap_or(rest.len())
    }

    fn next(&mut self, diagnostics: &Diagnostics) -> Option<Token> {
        let first = self.skip_blanks()?;
        let start = self.position;
        let (kind, end) = match first {
            b'"' => return Some(self.string(diagnostics)),
            b'[' => (TokenKind::Open, start + 1),
            b']' => (TokenKind::Close, start + 1),
            _ => (TokenKind::Word, self.word_end()),
        };
        self.position = end;
        let text = self.text[start..end].to_owned();
        let span = self.span(start, end);
        let broken = text.contains(NOT_UTF8);
        if broken {
            diagnostics.error(span, "this is not text in UTF-8");
        }
        Some(Token { kind, text, span, broken })
    }

    /// The quoted string that begins here.
    fn string(&mut self, diagnostics: &Diagnostics) -> Token {
        let start = self.position;
        let bytes = self.text.as_bytes();
        let mut at = start + 1;
        let mut text = String::new();
        let mut plain_from = at;
        let mut broken = false;
        let closed = loop {
            match bytes.get(at) {
                Some(b'"') => break true,
                None | Some(b'\n') => break false,
                Some(b'\\') => {
                    text += &self.text[plain_from..at];
                    // An escaped character is ASCII, so the byte after it begins a character.
                    match bytes.get(at + 1).and_then(|&b| unescape(b)) {
                        Some(c) => text.push(c),
                        None => {
                            broken = true;
                            let message =
                                "unknown escape in a string: `\\` goes before one of b f n r t \\ ' \"";
                            diagnostics.error(self.span(at, at + 1), message);
                            at += 1;
                            plain_from = at;
                            continue;
                        }
                    }
                    at += 2;
                    plain_from = at;
                }
                Some(_) => at += 1,
            }
        };
        text += &self.text[plain_from..at];
        self.position = if closed { at + 1 } else { at };
        let span = self.span(start, self.position);
        if !closed {
            diagnostics.error(span, "this string is not closed: strings end on the line where they begin");
        } else if text.contains(NOT_UTF8) {
            diagnostics.error(span, "this string is not text in UTF-8");
        }
        let broken = broken || !closed || text.contains(NOT_UTF8);
        Token { kind: TokenKind::String, text, span, broken }
    }

    /// Takes values as long as the words that follow can be read: by `scan`, which is given the text from there and
    /// tells the length of the word it has read, or else by `read`.
    fn take_while<T>(
        &mut self,
        values: &mut Vec<T>,
        scan: impl Fn(&[u8]) -> Option<(T, usize)>,
        read: impl Fn(&str) -> Option<T>,
    ) {
        while let Some(first) = self.skip_blanks() {
            if matches!(first, b'"' | b'[' | b']') {
                return;
            }
            // Mostly one blank stands between numbers that are quick to read.
            let bytes = self.text.as_bytes();
            let mut at = self.position;
            while let Some((value, length)) = scan(&bytes[at..]) {
                values.push(value);
                at += length;
                at += usize::from(matches!(bytes.get(at), Some(b' ' | b'\n')));
            }
            if at > self.position {
                self.position = at;
                continue;
            }
            let end = self.word_end();
            let Some(value) = read(&self.text[self.position..end]) else { return };
            values.push(value);
            self.position = end;
        }
    }
}

fn unescape(b: u8) -> Option<char> {
    Some(match b {
        b'b' => '\u{8}',
        b'f' => '\u{c}',
        b'n' => '\n',
        b'r' => '\r',
        b't' => '\t',
        b'\\' | b'\'' | b'"' => b as char,
        _ => return None,
    })
}

/// The tokens of a file; those of a file that it includes come where the directive stands.
#[derive(Debug)]
pub(super) struct Stream {
    files: Vec<OpenFile>,
    held: Option<Token>,
}

impl Stream {
    pub(super) fn new(file: OpenFile) -> Self {
        Self { files: vec![file], held: None }
    }

    /// Goes on with another file, and comes back at its end.
    pub(super) fn include(&mut self, file: OpenFile) {
        self.files.push(file);
    }

    /// The files that are open, outermost first.
    pub(super) fn files(&self) -> &[OpenFile] {
        &self.files
    }

    /// The next token; `None` at the end of the outermost file.
    pub(super) fn next(&mut self, diagnostics: &Diagnostics) -> Option<Token> {
        if let Some(token) = self.held.take() {
            return Some(token);
        }
        while let Some(file) = self.files.last_mut() {
            if let Some(token) = file.next(diagnostics) {
                return Some(token);
            }
            self.files.pop();
        }
        None
    }

    /// Gives a token back: it is the next again.
    pub(super) fn hold(&mut self, token: Token) {
        debug_assert!(self.held.is_none());
        self.held = Some(token);
    }

    /// Takes all floats up to the first token that is none, or to the end of the file.
    pub(super) fn take_floats(&mut self, values: &mut Vec<f32>) {
        if let (None, Some(file)) = (&self.held, self.files.last_mut()) {
            file.take_while(values, scan_float, |word| parse_float(word).ok());
        }
    }

    /// Takes all integers up to the first token that is none, or to the end of the file.
    pub(super) fn take_integers(&mut self, values: &mut Vec<i32>) {
        if let (None, Some(file)) = (&self.held, self.files.last_mut()) {
            file.take_while(values, scan_integer, |word| parse_integer(word).ok());
        }
    }
}
