use super::{
    Axis, COLORS, Scale,
    axis::Fitted,
    svg::{Anchor, Svg, text_width},
};

/// A point of a series.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
    /// The standard error of `y`; 0 where there is none.
    pub error: f64,
}

/// How a series is drawn.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line with a mark and an error bar at each point.
    Marks,
    /// A line.
    Line,
    /// A thin dashed line, to compare with.
    Dashes,
    /// Dots.
    Dots,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the legend calls them; nothing where empty.
    pub name: String,
    /// In the order in which lines connect them.
    pub points: Vec<Point>,
    /// How they are drawn.
    pub mark: Mark,
    /// Which colour, of [`COLORS`]; `None` for the soft one of secondary things.
    pub color: Option<usize>,
}

impl Series {
    /// A series without error bars, of pairs of x and y.
    pub fn new(name: &str, mark: Mark, color: usize, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().map(|[x, y]| Point { x, y, error: 0.0 }).collect();
        Self { name: name.to_owned(), points, mark, color: Some(color) }
    }

    fn class(&self) -> String {
        self.color.map_or("soft".to_owned(), |c| format!("c{}", c % COLORS))
    }
}

/// A plot with two axes: lines or dots.
///
/// ```
/// use tenfold_lab::plot::{Axis, Chart, Mark, Series};
///
/// let mut chart = Chart::new(Axis::log2("samples per pixel"), Axis::log("error"));
/// chart.series.push(Series::new("jittered", Mark::Marks, 0, [[1.0, 0.5], [4.0, 0.2]]));
/// assert!(chart.svg().starts_with("<svg"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn.
    pub series: Vec<Series>,
    /// Width and height of the area within the axes, in pixels.
    pub area: [f64; 2],
}

/// Room above the area and, without labels, at its sides.
const MARGIN: f64 = 14.0;
/// Room below for the ticks and the label.
const BELOW: f64 = 46.0;

impl Chart {
    /// An empty plot.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self { x, y, series: Vec::new(), area: [520.0, 340.0] }
    }

    /// An empty plot of the unit square.
    pub fn square(x: &str, y: &str, side: f64) -> Self {
        let unit = |label| Axis::linear(label).range(0.0, 1.0);
        Self { area: [side, side], ..Self::new(unit(x), unit(y)) }
    }

    /// The plot as an SVG element.
    pub fn svg(&self) -> String {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let x = self.x.fitted(points().map(|p| p.x));
        // Where error bars would reach to nothing on a logarithmic axis, they are cut.
        let reach = |p: &Point| {
            let low = if self.y.scale == Scale::Linear { p.y - p.error } else { p.y };
            [low, p.y + p.error]
        };
        let y = self.y.fitted(points().flat_map(reach));
        let ticks = [
            x.ticks((self.area[0] / 60.0).max(3.0) as usize),
            y.ticks((self.area[1] / 40.0).max(3.0) as usize),
        ];

        let widest = ticks[1].iter().map(|t| text_width(&t.label)).fold(0.0, f64::max);
        let left = 30.0 + widest;
        let named: Vec<&Series> = self.series.iter().filter(|s| !s.name.is_empty()).collect();
        let legend = named.iter().map(|s| text_width(&s.name)).fold(0.0, f64::max);
        let right = if named.is_empty() { MARGIN } else { legend + 50.0 };
        let [width, height] = self.area;
        let frame = Frame { x, y, origin: [left, MARGIN + height], size: self.area };
        let total = [left + width + right, MARGIN + f64::max(height + BELOW, named.len() as f64 * 20.0)];
        let mut svg = Svg::new(total[0], total[1], &format!("{} against {}", self.y.label, self.x.label));

        for tick in &ticks[0] {
            let at = left + tick.at * width;
            svg.line([at, MARGIN], [at, MARGIN + height], "line");
            svg.text([at, MARGIN + height + 18.0], Anchor::Middle, "soft", &tick.label);
        }
        for tick in &ticks[1] {
            let at = MARGIN + (1.0 - tick.at) * height;
            svg.line([left, at], [left + width, at], "line");
            svg.text([left - 7.0, at + 4.5], Anchor::End, "soft", &tick.label);
        }
        svg.frame([left, MARGIN], self.area, "soft");
        svg.text([left + 0.5 * width, MARGIN + height + 40.0], Anchor::Middle, "", &self.x.label);
        svg.turned_text([16.0, MARGIN + 0.5 * height], -90, Anchor::Middle, "", &self.y.label);
        for (i, series) in self.series.iter().enumerate() {
            frame.draw(&mut svg, series, i);
        }
        for (line, series) in named.iter().enumerate() {
            let at = [left + width + 14.0, MARGIN + 10.0 + 20.0 * line as f64];
            let shape = self.series.iter().position(|s| std::ptr::eq(s, *series)).unwrap_or(0);
            legend_entry(&mut svg, series, shape, at);
        }
        svg.finish()
    }
}

fn legend_entry(svg: &mut Svg, series: &Series, shape: usize, [x, y]: [f64; 2]) {
    let class = series.class();
    if series.mark != Mark::Dots {
        svg.polyline(&[[x, y], [x + 22.0, y]], &class, series.mark == Mark::Dashes);
    }
    match series.mark {
        Mark::Marks => svg.mark([x + 11.0, y], shape, &class),
        Mark::Dots => svg.dot([x + 11.0, y], 3.0, &class),
        Mark::Line | Mark::Dashes => {}
    }
    svg.text([x + 29.0, y + 4.5], Anchor::Start, "", &series.name);
}

/// The area within the axes.
struct Frame {
    x: Fitted,
    y: Fitted,
    /// The lower left corner.
    origin: [f64; 2],
    size: [f64; 2],
}

impl Frame {
    /// A place on the page, from 0 to 1 along each axis.
    fn on_page(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + x * self.size[0], self.origin[1] - y * self.size[1]]
    }

    /// Where a point stands, unless it is outside.
    fn at(&self, p: &Point) -> Option<[f64; 2]> {
        let at = [self.x.at(p.x)?, self.y.at(p.y)?];
        at.iter().all(|&v| Fitted::holds(v)).then(|| self.on_page(at))
    }

    fn draw(&self, svg: &mut Svg, series: &Series, shape: usize) {
        let class = series.class();
        let placed: Vec<_> = series.points.iter().filter_map(|p| Some((p, self.at(p)?))).collect();
        if series.mark != Mark::Dots && placed.len() > 1 {
            let line: Vec<_> = placed.iter().map(|(_, at)| *at).collect();
            svg.polyline(&line, &class, series.mark == Mark::Dashes);
        }
        let radius = if placed.len() > 600 { 1.2 } else { 2.0 };
        for (point, at) in placed {
            match series.mark {
                Mark::Marks => {
                    if point.error > 0.0 {
                        let end = |v| {
                            let v = self.y.at(v).unwrap_or(0.0).clamp(0.0, 1.0);
                            [at[0], self.on_page([0.0, v])[1]]
                        };
                        svg.line(end(point.y - point.error), end(point.y + point.error), &class);
                    }
                    svg.mark(at, shape, &class);
                }
                Mark::Dots => svg.dot(at, radius, &class),
                Mark::Line | Mark::Dashes => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stand_where_the_axes_say() {
        let mut chart = Chart::square("x", "y", 100.0);
        chart.series.push(Series::new(
            "",
            Mark::Dots,
            1,
            [[0.0, 0.0], [0.5, 1.0], [2.0, 0.5], [0.5, f64::NAN]],
        ));
        let svg = chart.svg();
        // The widest label of the vertical axis has three characters.
        let left = 30.0 + text_width("0.0");
        let expected = [(left, 114.0), (left + 50.0, 14.0)];
        for (x, y) in expected {
            assert!(svg.contains(&format!("cx=\"{x:.2}\" cy=\"{y:.2}\"")), "{svg}");
        }
        assert_eq!(svg.matches("<circle").count(), 2, "what is outside is not drawn");
        assert!(svg.contains("class=\"c1\"") && !svg.contains('#'), "colours are the page's");
    }

    #[test]
    fn error_bars_that_reach_below_zero_end_at_the_axis() {
        let mut chart = Chart::new(Axis::log("n"), Axis::log("error (%)").range(0.1, 10.0));
        let points = vec![Point { x: 1.0, y: 1.0, error: 2.0 }, Point { x: 10.0, y: 1.0, error: 0.0 }];
        chart.series.push(Series { name: "a".to_owned(), points, mark: Mark::Marks, color: None });
        assert!(!chart.svg().contains("NaN") && chart.svg().contains(">error (%)<"));
    }
}
