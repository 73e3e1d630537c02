use super::escape;
use crate::Picture;
use std::fmt::Write;

/// A table of pictures.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// What the columns are.
    pub columns: Vec<String>,
    /// From the top.
    pub rows: Vec<GridRow>,
}

/// Pictures of a kind.
#[derive(Clone, Debug)]
pub struct GridRow {
    /// What they are called.
    pub name: String,
    /// More on them.
    pub about: String,
    /// One for each column, with a caption.
    pub cells: Vec<(Picture, String)>,
}

impl Grid {
    pub(super) fn html(&self) -> String {
        let mut out = String::from("<div class=\"wide\"><table class=\"grid\"><thead><tr><th></th>");
        for column in &self.columns {
            let _ = write!(out, "<th>{}</th>", escape(column));
        }
        out.push_str("</tr></thead><tbody>\n");
        for row in &self.rows {
            let (name, about) = (escape(&row.name), escape(&row.about));
            let _ = write!(out, "<tr><th>{name}<p>{about}</p></th>");
            for (picture, caption) in &row.cells {
                let (width, height, caption) = (picture.width, picture.height, escape(caption));
                let _ = write!(
                    out,
                    "<td><img alt=\"{name}: {caption}\" width=\"{width}\" height=\"{height}\" src=\"{}\"/>{caption}</td>",
                    picture.data_uri()
                );
            }
            out.push_str("</tr>\n");
        }
        out.push_str("</tbody></table></div>\n");
        out
    }
}
