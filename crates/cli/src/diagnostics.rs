//! Scene faults, told to people: with an excerpt of the file on a terminal, else one line each.

use ariadne::{Color, Config, IndexType, Label, Report, ReportKind, Source};
use std::{
    io::{IsTerminal, Write},
    ops::Range,
};
use tenfold_scene::{Diagnostic, Diagnostics, Severity, SourceMap, Span};

/// Longer stretches of a file are not shown, in bytes: nobody reads a line of a megabyte.
const LONGEST_EXCERPT: usize = 2000;

/// Excerpts are made of lines up to this one: those before it are made up, empty, so that the number is right.
const LAST_EXCERPT: u32 = 100_000;

/// Prints one line, or several, to standard error. Where nobody listens there is nobody to tell.
pub(crate) fn say(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints all findings at or above a severity.
pub(crate) fn print(diagnostics: &Diagnostics, sources: &SourceMap, least: Severity) {
    let rich = std::io::stderr().is_terminal();
    for diagnostic in diagnostics.to_vec().iter().filter(|d| d.severity >= least) {
        let placed = placed(diagnostic, sources);
        match excerpt(&placed, sources) {
            Some(excerpt) if rich => print_excerpt(&placed, sources, &excerpt),
            _ => plain_lines(&placed, sources).iter().for_each(|line| say(line)),
        }
    }
    if diagnostics.dropped() > 0 {
        say(&format!("... and {} more", diagnostics.dropped()));
    }
}

/// The finding with a place: that of one about the scene as a whole is where its file ends.
pub(crate) fn placed(diagnostic: &Diagnostic, sources: &SourceMap) -> Diagnostic {
    let mut diagnostic = diagnostic.clone();
    if diagnostic.span.is_none() {
        diagnostic.span = sources.files().next().map(|(file, source)| {
            let end = source.text.trim_end().len() as u32;
            Span { file, start: end, end }
        });
    }
    diagnostic
}

/// The finding and its further places, a line each.
fn plain_lines(diagnostic: &Diagnostic, sources: &SourceMap) -> Vec<String> {
    let notes = diagnostic.notes.iter().map(|note| Diagnostic::note(note.span, note.message.clone()));
    std::iter::once(diagnostic.clone()).chain(notes).map(|d| d.plain(sources)).collect()
}

/// The line in which a span begins, with an empty line for each before it, and where the span lies in this text.
#[derive(Debug, PartialEq)]
struct Excerpt {
    text: String,
    /// The span, in bytes of the text.
    marked: Range<usize>,
}

/// The line in which the span of a finding begins; `None` where there is none, or it is not to be shown.
fn excerpt(diagnostic: &Diagnostic, sources: &SourceMap) -> Option<Excerpt> {
    let span = diagnostic.span?;
    let text = &*sources.file(span.file).text;
    let at = (span.start as usize).min(text.len());
    let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
    let end = text[at..].find('\n').map_or(text.len(), |i| at + i);
    let line = sources.location(span).line;
    if end - start > LONGEST_EXCERPT || line > LAST_EXCERPT {
        return None;
    }
    let before = line as usize - 1;
    let in_excerpt = |offset: usize| before + offset.clamp(at, end) - start;
    Some(Excerpt {
        text: "\n".repeat(before) + &text[start..end],
        marked: in_excerpt(at)..in_excerpt(span.end as usize),
    })
}

fn print_excerpt(diagnostic: &Diagnostic, sources: &SourceMap, excerpt: &Excerpt) {
    let Some(span) = diagnostic.span else { return };
    let name = sources.file(span.file).path.display().to_string();
    let (kind, color) = match diagnostic.severity {
        Severity::Error => (ReportKind::Error, Color::Red),
        Severity::Warning => (ReportKind::Warning, Color::Yellow),
        Severity::Note => (ReportKind::Custom("Note", Color::Cyan), Color::Cyan),
    };
    let place = (name.as_str(), excerpt.marked.clone());
    let label = Label::new(place.clone()).with_color(color);
    let mut report = Report::build(kind, place)
        .with_config(Config::default().with_index_type(IndexType::Byte))
        .with_message(&diagnostic.message)
        .with_label(label.with_message(diagnostic.help.as_deref().unwrap_or("here")));
    for note in &diagnostic.notes {
        let at = note.span.map(|s| (sources.file(s.file).path.display(), sources.location(s)));
        let at = at.map_or(String::new(), |(p, l)| format!(" ({p}:{}:{})", l.line, l.column));
        report = report.with_note(format!("{}{at}", note.message));
    }
    let source = Source::from(excerpt.text.as_str());
    let mut text = Vec::new();
    if report.finish().write((name.as_str(), source), &mut text).is_ok() {
        say(String::from_utf8_lossy(&text).trim_end());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excerpts_are_the_line_of_the_span() {
        let mut sources = SourceMap::new();
        let file = sources.add("a.pbrt", "one\ntwo three\nfour\n");
        let at = |start, end| excerpt(&Diagnostic::error(Span { file, start, end }, "x"), &sources);
        let expected = Excerpt { text: "\ntwo three".to_owned(), marked: 5..10 };
        assert_eq!(at(8, 13), Some(expected));
        assert_eq!(at(8, 17).unwrap().marked, 5..10);
        assert_eq!(at(19, 19), Some(Excerpt { text: "\n\n\n".to_owned(), marked: 3..3 }));
        let long = sources.add("b.pbrt", "x ".repeat(100_000));
        let span = Span { file: long, start: 7, end: 9 };
        assert_eq!(excerpt(&Diagnostic::error(span, "x"), &sources), None);
    }

    #[test]
    fn findings_without_a_place_get_the_end_of_the_file() {
        let mut sources = SourceMap::new();
        sources.add("a.pbrt", "one\ntwo\n\n");
        let lines = plain_lines(&placed(&Diagnostic::error(None, "no camera"), &sources), &sources);
        assert_eq!(lines, ["a.pbrt:2:4: error: no camera"]);
        let nowhere = placed(&Diagnostic::error(None, "x"), &SourceMap::new());
        assert_eq!(plain_lines(&nowhere, &SourceMap::new()), ["error: x"]);
    }
}
