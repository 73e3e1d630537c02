use crate::page::escape;
use std::fmt::Write;

/// The part of the text that an anchor is at.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// An `svg` element that is being written. Lengths are pixels, y runs down; classes name colours of the page.
pub(super) struct Svg {
    out: String,
}

/// Pixels that a text takes at most, or nearly so: fonts differ.
pub(super) fn text_width(text: &str) -> f64 {
    7.3 * text.chars().count() as f64
}

impl Svg {
    pub(super) fn new(width: f64, height: f64, label: &str) -> Self {
        let out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
             height=\"{height:.0}\" role=\"img\" aria-label=\"{}\">\n",
            escape(label)
        );
        Self { out }
    }

    pub(super) fn finish(mut self) -> String {
        self.out.push_str("</svg>");
        self.out
    }

    pub(super) fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], class: &str) {
        let _ = writeln!(
            self.out,
            "<path class=\"{class}\" d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"currentColor\" fill=\"none\"/>"
        );
    }

    /// A line through all points.
    pub(super) fn polyline(&mut self, points: &[[f64; 2]], class: &str, dashed: bool) {
        let mut path = String::new();
        for (i, [x, y]) in points.iter().enumerate() {
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        let dashes = if dashed { " stroke-dasharray=\"6 4\"" } else { "" };
        let _ = writeln!(
            self.out,
            "<path class=\"{class}\" d=\"{path}\" stroke=\"currentColor\" stroke-width=\"1.8\" stroke-linejoin=\"round\" \
             fill=\"none\"{dashes}/>"
        );
    }

    pub(super) fn rect(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str, opacity: f64) {
        let _ = writeln!(
            self.out,
            "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             fill=\"currentColor\" fill-opacity=\"{opacity}\"/>"
        );
    }

    pub(super) fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str) {
        let _ = writeln!(
            self.out,
            "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             stroke=\"currentColor\" fill=\"none\"/>"
        );
    }

    pub(super) fn dot(&mut self, [x, y]: [f64; 2], radius: f64, class: &str) {
        let _ = writeln!(
            self.out,
            "<circle class=\"{class}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"currentColor\"/>"
        );
    }

    /// The mark number `shape` of six: circle, square, triangle, diamond, cross, ring.
    pub(super) fn mark(&mut self, [x, y]: [f64; 2], shape: usize, class: &str) {
        let path = match shape % 6 {
            0 => return self.dot([x, y], 3.5, class),
            1 => "m-3.2 -3.2h6.4v6.4h-6.4z",
            2 => "m0 -4.4l4.2 7.4h-8.4z",
            3 => "m0 -4.6l4.6 4.6l-4.6 4.6l-4.6 -4.6z",
            4 => "m-3.6 -3.6l7.2 7.2m0 -7.2l-7.2 7.2",
            _ => "m-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0",
        };
        let fill = if shape % 6 < 4 { "currentColor" } else { "none" };
        let _ = writeln!(
            self.out,
            "<path class=\"{class}\" d=\"M{x:.1} {y:.1}{path}\" stroke=\"currentColor\" stroke-width=\"1.5\" fill=\"{fill}\"/>"
        );
    }

    pub(super) fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, class: &str, text: &str) {
        self.turned_text([x, y], 0, anchor, class, text);
    }

    /// Text turned about its anchor, by degrees.
    pub(super) fn turned_text(
        &mut self,
        [x, y]: [f64; 2],
        degrees: i32,
        anchor: Anchor,
        class: &str,
        text: &str,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if degrees == 0 {
            String::new()
        } else {
            format!(" transform=\"rotate({degrees} {x:.1} {y:.1})\"")
        };
        let _ = writeln!(
            self.out,
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"currentColor\"{turn}>{}</text>",
            escape(text)
        );
    }
}
