use crate::page::escape;
use std::fmt::Write;

/// One entry of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A word.
    Text(String),
    /// A count.
    Count(u64),
    /// A number: shown with three significant digits, kept with all.
    Number(f64),
    /// A number and its standard error, which are two columns of a CSV file; NaN where it is not known.
    Measured(f64, f64),
    /// Nothing.
    Empty,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<u64> for Cell {
    fn from(n: u64) -> Self {
        Self::Count(n)
    }
}

impl From<u32> for Cell {
    fn from(n: u32) -> Self {
        Self::Count(n.into())
    }
}

impl From<f64> for Cell {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

/// Columns with names, and rows of as many cells.
///
/// ```
/// use tenfold_lab::Table;
///
/// let mut table = Table::new(["sampler", "error"]);
/// table.row(["zsobol".into(), 0.25.into()]);
/// assert_eq!(table.csv(), "sampler,error\nzsobol,0.25\n");
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    pub fn new<S: Into<String>>(columns: impl IntoIterator<Item = S>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// Adds a row, filled up with empty cells or cut to the number of columns.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        let mut cells: Vec<Cell> = cells.into_iter().collect();
        cells.resize(self.columns.len(), Cell::Empty);
        self.rows.push(cells);
    }

    /// The names of the columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The rows, each with a cell for every column.
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// As comma-separated values (RFC 4180, with line feeds). A column with measured cells is followed by one of their standard
    /// errors.
    pub fn csv(&self) -> String {
        let measured = |c: usize| self.rows.iter().any(|row| matches!(row[c], Cell::Measured(..)));
        let doubled: Vec<bool> = (0..self.columns.len()).map(measured).collect();
        let mut out = String::new();
        let mut line = |cells: Vec<String>| {
            out.push_str(&cells.join(","));
            out.push('\n');
        };
        let mut header = Vec::new();
        for (name, &doubled) in self.columns.iter().zip(&doubled) {
            header.push(quoted(name));
            header.extend(doubled.then(|| quoted(&format!("{name} standard error"))));
        }
        line(header);
        for row in &self.rows {
            let mut cells = Vec::new();
            for (cell, &doubled) in row.iter().zip(&doubled) {
                let (value, error) = match cell {
                    Cell::Text(text) => (quoted(text), String::new()),
                    Cell::Count(n) => (n.to_string(), String::new()),
                    Cell::Number(x) => (x.to_string(), String::new()),
                    Cell::Measured(x, error) if error.is_nan() => (x.to_string(), String::new()),
                    Cell::Measured(x, error) => (x.to_string(), error.to_string()),
                    Cell::Empty => Default::default(),
                };
                cells.push(value);
                cells.extend(doubled.then_some(error));
            }
            line(cells);
        }
        out
    }

    /// As an HTML table.
    pub fn html(&self) -> String {
        let mut out = String::from("<div class=\"wide\"><table><thead><tr>");
        for name in &self.columns {
            let _ = write!(out, "<th>{}</th>", escape(name));
        }
        out.push_str("</tr></thead><tbody>\n");
        for row in &self.rows {
            out.push_str("<tr>");
            for cell in row {
                let _ = match cell {
                    Cell::Text(text) => write!(out, "<td>{}</td>", escape(text)),
                    Cell::Count(n) => write!(out, "<td class=\"number\">{n}</td>"),
                    Cell::Number(x) => write!(out, "<td class=\"number\">{}</td>", shown(*x)),
                    Cell::Measured(x, error) if !error.is_finite() => {
                        write!(out, "<td class=\"number\">{}</td>", shown(*x))
                    }
                    Cell::Measured(x, error) => write!(
                        out,
                        "<td class=\"number\">{} <span class=\"error\">± {}</span></td>",
                        shown_to(*x, *error),
                        shown_to(*error, *error)
                    ),
                    Cell::Empty => write!(out, "<td></td>"),
                };
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody></table></div>\n");
        out
    }
}

/// A field of a CSV file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// A number with three significant digits.
pub(crate) fn shown(x: f64) -> String {
    rounded(x, 2 - decade(x))
}

/// A number with so many digits that two of its `error` show.
fn shown_to(x: f64, error: f64) -> String {
    rounded(x, if error.is_finite() { 1 - decade(error) } else { 2 - decade(x) })
}

/// A number with so many digits after the point.
fn rounded(x: f64, digits: i32) -> String {
    if !x.is_finite() {
        return "–".to_owned();
    }
    let text = match digits {
        _ if x == 0.0 => "0".to_owned(),
        7.. => format!("{x:.2e}"),
        _ => format!("{x:.*}", digits.max(0) as usize),
    };
    text.replace('-', "−")
}

/// The exponent of the first digit.
fn decade(x: f64) -> i32 {
    if x == 0.0 { 0 } else { tenfold_math::ops::log10(x.abs()).floor() as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_keeps_every_digit_and_quotes() {
        let mut table = Table::new(["a, b", "x"]);
        table.row(["say \"no\"".into(), Cell::Measured(0.1 + 0.2, 1e-9)]);
        table.row([7u64.into()]);
        let expected =
            "\"a, b\",x,x standard error\n\"say \"\"no\"\"\",0.30000000000000004,0.000000001\n7,,\n";
        assert_eq!(table.csv(), expected);
    }

    #[test]
    fn html_shows_what_means_something() {
        let mut table = Table::new(["<"]);
        table.row([Cell::Measured(0.123456, 0.00234)]);
        let html = table.html();
        assert!(html.contains("<th>&lt;</th>") && html.contains("0.1235 <") && html.contains("± 0.0023<"));
    }

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 1.0, -0.98765, 123.456, 0.00123456, 4.2e-9, 98765.0, f64::NAN].map(shown);
        assert_eq!(shown, ["0", "1.00", "−0.988", "123", "0.00123", "4.20e−9", "98765", "–"]);
    }
}
