use crate::{SourceMap, Span};
use std::{fmt, sync::Mutex};

/// How bad a finding is.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Probably not what was meant; the scene can be rendered.
    Warning,
    /// The scene cannot be rendered as it is.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

/// A further place that belongs to a finding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What is to be said of it.
    pub message: String,
    /// The place.
    pub span: Option<Span>,
}

/// One finding about a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// What was found, in one line.
    pub message: String,
    /// Where.
    pub span: Option<Span>,
    /// What to do about it.
    pub help: Option<String>,
    /// Further places.
    pub notes: Vec<Note>,
}

impl Diagnostic {
    fn new(severity: Severity, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self { severity, message: message.into(), span: span.into(), help: None, notes: Vec::new() }
    }

    /// An error.
    pub fn error(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, span, message)
    }

    /// A warning.
    pub fn warning(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, span, message)
    }

    /// A note.
    pub fn note(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, span, message)
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the nearest of the known names as help, where one is near.
    #[must_use]
    pub fn with_nearest<'n>(self, name: &str, known: impl IntoIterator<Item = &'n str>) -> Self {
        match nearest(name, known) {
            Some(near) => self.with_help(format!("did you mean \"{near}\"?")),
            None => self,
        }
    }

    /// Adds a further place.
    #[must_use]
    pub fn with_note(mut self, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        self.notes.push(Note { message: message.into(), span: span.into() });
        self
    }

    /// The finding in one line, as compilers print it: `file:line:column: error: message (help)`.
    pub fn plain(&self, sources: &SourceMap) -> String {
        let mut line = String::new();
        if let Some(span) = self.span {
            let at = sources.location(span);
            line = format!("{}:{}:{}: ", sources.file(span.file).path.display(), at.line, at.column);
        }
        line += &format!("{}: {}", self.severity, self.message);
        if let Some(help) = &self.help {
            line += &format!(" ({help})");
        }
        line
    }
}

/// A collector of findings.
///
/// It is filled through a shared reference, also from several threads. Of every severity it keeps the first
/// [`Diagnostics::LIMIT`] and counts the rest, so that a broken file of a gigabyte stays readable.
#[derive(Debug, Default)]
pub struct Diagnostics {
    inner: Mutex<Inner>,
}

#[derive(Clone, Debug, Default)]
struct Inner {
    list: Vec<Diagnostic>,
    counts: [usize; 3],
}

impl Diagnostics {
    /// How many findings of one severity are kept.
    pub const LIMIT: usize = 100;

    /// A collector without findings.
    pub fn new() -> Self {
        Self::default()
    }

    fn inner(&self) -> std::sync::MutexGuard<'_, Inner> {
        // A panic elsewhere leaves the list as it was: complete.
        self.inner.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Adds a finding.
    pub fn push(&self, diagnostic: Diagnostic) {
        let mut inner = self.inner();
        let count = &mut inner.counts[diagnostic.severity as usize];
        *count += 1;
        if *count <= Self::LIMIT {
            inner.list.push(diagnostic);
        }
    }

    /// Adds an error.
    pub fn error(&self, span: impl Into<Option<Span>>, message: impl Into<String>) {
        self.push(Diagnostic::error(span, message));
    }

    /// Adds a warning.
    pub fn warning(&self, span: impl Into<Option<Span>>, message: impl Into<String>) {
        self.push(Diagnostic::warning(span, message));
    }

    /// Adds everything that another collector found.
    pub fn append(&self, other: Diagnostics) {
        let other = other.inner.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        let mut kept = [0; 3];
        for diagnostic in other.list {
            kept[diagnostic.severity as usize] += 1;
            self.push(diagnostic);
        }
        let mut inner = self.inner();
        for (count, (theirs, kept)) in inner.counts.iter_mut().zip(other.counts.into_iter().zip(kept)) {
            *count += theirs - kept;
        }
    }

    /// Whether there is an error.
    pub fn has_errors(&self) -> bool {
        self.count(Severity::Error) > 0
    }

    /// How many findings of a severity there were, kept or not.
    pub fn count(&self, severity: Severity) -> usize {
        self.inner().counts[severity as usize]
    }

    /// How many findings were counted but not kept.
    pub fn dropped(&self) -> usize {
        let inner = self.inner();
        inner.counts.iter().sum::<usize>() - inner.list.len()
    }

    /// The findings kept, in the order in which they were made.
    pub fn to_vec(&self) -> Vec<Diagnostic> {
        self.inner().list.clone()
    }
}

/// The candidate that a misspelt name probably stands for: the nearest by Damerau's distance, if no more than a third
/// of the letters (and one at least) differ, letters' case aside.
pub fn nearest<'n>(name: &str, candidates: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if name.len() > 100 {
        return None;
    }
    let name = name.to_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .filter(|(distance, c)| *distance <= (name.chars().count().max(c.chars().count()) / 3).max(1))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_must_be_near() {
        let shapes = ["sphere", "disk", "cylinder", "trianglemesh"];
        assert_eq!(nearest("spehre", shapes), Some("sphere"));
        assert_eq!(nearest("Disk", shapes), Some("disk"));
        assert_eq!(nearest("triangelmesh", shapes), Some("trianglemesh"));
        assert_eq!(nearest("teapot", shapes), None);
        assert_eq!(nearest("", ["x"]), Some("x"));
    }

    #[test]
    fn floods_are_counted_not_kept() {
        let (all, part) = (Diagnostics::new(), Diagnostics::new());
        for i in 0..250 {
            part.error(None, format!("{i}"));
        }
        all.warning(None, "w");
        all.append(part);
        assert_eq!(all.count(Severity::Error), 250);
        assert_eq!(all.to_vec().len(), 101);
        assert_eq!(all.dropped(), 150);
        assert!(all.has_errors());
    }

    #[test]
    fn one_line_names_place_and_help() {
        let mut map = SourceMap::new();
        let file = map.add("s.pbrt", "a\nbc");
        let d = Diagnostic::error(Span { file, start: 3, end: 4 }, "bad").with_nearest("sper", ["spher"]);
        assert_eq!(d.plain(&map), "s.pbrt:2:2: error: bad (did you mean \"spher\"?)");
    }
}
