//! Pages: what came out of an experiment, as one HTML file that needs nothing else.
//!
//! There are no scripts, and no other files are needed. Colours follow the reader's choice of light or dark, and paper is
//! white. The page is well-formed XML, too.

mod encode;
mod grid;

pub(crate) use encode::base64;
pub use encode::escape;
pub use grid::{Grid, GridRow};

use crate::{Picture, Table};
use std::{
    fmt::Write as _,
    io::{self, Write as _},
    path::{Path, PathBuf},
};
use tenfold_image::write_atomic;

const STYLE: &str = include_str!("style.css");

/// A page, built from the top.
///
/// ```
/// use tenfold_lab::{Page, Table};
///
/// let mut page = Page::new("Noise of room.pbrt");
/// page.prose("Where it comes from.");
/// let mut shares = Table::new(["variable", "share"]);
/// shares.row(["lens".into(), 0.75.into()]);
/// page.table(&shares);
/// page.data("shares", shares);
/// assert!(page.html("noise").contains("noise-shares.csv"));
/// ```
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
    data: Vec<(String, Table)>,
}

/// A figure or a picture with a caption.
#[derive(Clone, Debug)]
pub struct Figure {
    content: String,
    caption: String,
}

impl Figure {
    /// A drawing, an `svg` element as [`crate::plot`] makes them. The caption is plain text.
    pub fn drawing(svg: &str, caption: &str) -> Self {
        Self { content: svg.to_owned(), caption: caption.to_owned() }
    }

    /// A picture, each of its pixels `scale` of the page's.
    pub fn picture(picture: &Picture, scale: u32, caption: &str) -> Self {
        let (width, height) = (picture.width * scale, picture.height * scale);
        let content = format!(
            "<img alt=\"{}\" width=\"{width}\" height=\"{height}\" src=\"{}\"/>",
            escape(caption),
            picture.data_uri()
        );
        Self { content, caption: caption.to_owned() }
    }

    fn html(&self) -> String {
        let caption = escape(&self.caption);
        format!("<figure>{}<figcaption>{caption}</figcaption></figure>\n", self.content)
    }
}

impl Page {
    /// An empty page.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), body: String::new(), data: Vec::new() }
    }

    /// Begins a section.
    pub fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escape(text));
    }

    /// Adds a paragraph of plain text.
    pub fn prose(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escape(text));
    }

    /// Adds a table for people to read. Numbers for programs are [`Page::data`].
    pub fn table(&mut self, table: &Table) {
        self.body.push_str(&table.html());
    }

    /// Adds a figure.
    pub fn figure(&mut self, figure: &Figure) {
        self.body.push_str(&figure.html());
    }

    /// Adds figures side by side, as far as there is room.
    pub fn figures(&mut self, figures: &[Figure]) {
        self.body.push_str("<div class=\"row\">\n");
        figures.iter().for_each(|figure| self.body.push_str(&figure.html()));
        self.body.push_str("</div>\n");
    }

    /// Adds a table of pictures.
    pub fn grid(&mut self, grid: &Grid) {
        self.body.push_str(&grid.html());
    }

    /// Adds numbers as a CSV file of that name, which is beside the page and within it. The first should have the name ""
    /// and gets that of the page.
    pub fn data(&mut self, name: &str, table: Table) {
        self.data.push((name.to_owned(), table));
    }

    /// The page as a file whose name, without its suffix, is `stem`.
    pub fn html(&self, stem: &str) -> String {
        let title = escape(&self.title);
        let mut out = format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <title>{title}</title>\n<style>\n{STYLE}</style></head>\n<body>\n<h1>{title}</h1>\n{}",
            self.body
        );
        out.push_str("<footer>");
        if !self.data.is_empty() {
            out.push_str("<p>The numbers: ");
            for (i, (name, table)) in self.data.iter().enumerate() {
                let file = csv_name(stem, name);
                let comma = if i > 0 { ", " } else { "" };
                let (content, file) = (base64(table.csv().as_bytes()), escape(&file));
                let _ = write!(
                    out,
                    "{comma}<a download=\"{file}\" href=\"data:text/csv;charset=utf-8;base64,{content}\">{file}</a>"
                );
            }
            out.push_str("</p>");
        }
        let _ =
            write!(out, "<p>Made by tenfold {}.</p></footer>\n</body></html>\n", env!("CARGO_PKG_VERSION"));
        out
    }

    /// Writes the page to `path` and its numbers beside it. Returns the paths of all files.
    ///
    /// # Errors
    /// The first fault of the file system, with the path of the file.
    pub fn write(&self, path: &Path) -> Result<Vec<PathBuf>, (PathBuf, io::Error)> {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let tables = self.data.iter().map(|(name, t)| (path.with_file_name(csv_name(&stem, name)), t.csv()));
        let files = std::iter::once((path.to_owned(), self.html(&stem))).chain(tables);
        files
            .map(|(path, text)| match write_atomic(&path, |file| file.write_all(text.as_bytes())) {
                Ok(()) => Ok(path),
                Err(error) => Err((path, error)),
            })
            .collect()
    }
}

/// The name of a file of numbers beside a page.
fn csv_name(stem: &str, name: &str) -> String {
    if name.is_empty() { format!("{stem}.csv") } else { format!("{stem}-{name}.csv") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_written_with_their_numbers() {
        let directory = tempfile::tempdir().unwrap();
        let mut table = Table::new(["x"]);
        table.row([0.1.into()]);
        let mut page = Page::new("A < B");
        page.data("", table.clone());
        page.data("more", table.clone());
        let files = page.write(&directory.path().join("p.html")).unwrap();
        let names: Vec<_> = files.iter().map(|f| f.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["p.html", "p.csv", "p-more.csv"]);
        assert_eq!(std::fs::read_to_string(&files[1]).unwrap(), "x\n0.1\n");
        let html = std::fs::read_to_string(&files[0]).unwrap();
        assert!(html.contains("<h1>A &lt; B</h1>") && html.contains(&base64(b"x\n0.1\n")));
        let (path, _) = page.write(&directory.path().join("missing/p.html")).unwrap_err();
        assert!(path.ends_with("missing/p.html"));
    }
}
