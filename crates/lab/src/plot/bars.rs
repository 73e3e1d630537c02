use super::{
    Axis, COLORS,
    axis::Fitted,
    svg::{Anchor, Svg, text_width},
};

/// Bars beside each other that have a name together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What they are of.
    pub name: String,
    /// The length and its standard error (0 where there is none) of each.
    pub bars: Vec<[f64; 2]>,
}

/// A bar chart: horizontal bars in groups, so that long names are legible.
///
/// ```
/// use tenfold_lab::plot::{Axis, Bars, Group};
///
/// let groups = vec![Group { name: "lens".to_owned(), bars: vec![[0.4, 0.02], [0.5, 0.02]] }];
/// let bars = Bars { axis: Axis::linear("share of the variance"), names: vec!["alone".into(), "in all".into()], groups };
/// assert!(bars.svg().starts_with("<svg"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// What lengths measure. Bars begin at 0 on linear axes.
    pub axis: Axis,
    /// What the bars of a group are, in their order; the legend. Empty where each group has one bar.
    pub names: Vec<String>,
    /// From the top.
    pub groups: Vec<Group>,
}

const WIDTH: f64 = 440.0;
const BAR: f64 = 15.0;
const GAP: f64 = 9.0;

impl Bars {
    /// The chart as an SVG element.
    pub fn svg(&self) -> String {
        let ends = self.groups.iter().flat_map(|g| &g.bars).flat_map(|[v, e]| [v - e, v + e]);
        let fitted = self.axis.fitted(ends.chain([0.0]));
        let left = 14.0 + self.groups.iter().map(|g| text_width(&g.name)).fold(0.0, f64::max);
        let legend = self.names.iter().map(|n| text_width(n)).fold(0.0, f64::max);
        let right = if self.names.is_empty() { 24.0 } else { legend + 44.0 };
        let heights = self.groups.iter().map(|g| g.bars.len().max(1) as f64 * BAR + GAP);
        let top = 8.0;
        let height = f64::max(heights.clone().sum::<f64>() + GAP, self.names.len() as f64 * 20.0);
        let mut svg = Svg::new(left + WIDTH + right, top + height + 46.0, &self.axis.label);
        for tick in fitted.ticks(6) {
            let x = left + tick.at * WIDTH;
            svg.line([x, top], [x, top + height], "line");
            svg.text([x, top + height + 18.0], Anchor::Middle, "soft", &tick.label);
        }
        svg.text([left + 0.5 * WIDTH, top + height + 40.0], Anchor::Middle, "", &self.axis.label);

        let mut y = top + GAP;
        for (group, height) in self.groups.iter().zip(heights) {
            let middle = y + 0.5 * (height - GAP);
            svg.text([left - 8.0, middle + 4.5], Anchor::End, "", &group.name);
            for (i, &bar) in group.bars.iter().enumerate() {
                draw(&mut svg, &fitted, left, y + BAR * i as f64, bar, &format!("c{}", i % COLORS));
            }
            y += height;
        }
        let zero = left + fitted.at(0.0).unwrap_or(0.0).clamp(0.0, 1.0) * WIDTH;
        svg.line([zero, top], [zero, top + height], "soft");
        for (i, name) in self.names.iter().enumerate() {
            let at = [left + WIDTH + 16.0, top + 4.0 + 20.0 * i as f64];
            svg.rect(at, [14.0, 12.0], &format!("c{}", i % COLORS), 1.0);
            svg.text([at[0] + 20.0, at[1] + 10.5], Anchor::Start, "", name);
        }
        svg.finish()
    }
}

fn draw(svg: &mut Svg, fitted: &Fitted, left: f64, y: f64, [value, error]: [f64; 2], class: &str) {
    let x = |v: f64| left + fitted.at(v).unwrap_or(0.0).clamp(0.0, 1.0) * WIDTH;
    if !value.is_finite() {
        return;
    }
    let (a, b) = (x(f64::min(value, 0.0)), x(f64::max(value, 0.0)));
    svg.rect([a, y + 1.0], [b - a, BAR - 2.0], class, 1.0);
    if error > 0.0 {
        let (low, high, y) = (x(value - error), x(value + error), y + 0.5 * BAR);
        svg.line([low, y], [high, y], "");
        for end in [low, high] {
            svg.line([end, y - 3.0], [end, y + 3.0], "");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_as_long_as_their_numbers() {
        let group = |name: &str, v: f64| Group { name: name.to_owned(), bars: vec![[v, 0.0]] };
        let groups = vec![group("a", 0.5), group("b", 1.0), group("c", f64::NAN)];
        let bars = Bars { axis: Axis::linear("share").range(0.0, 1.0), names: vec![], groups };
        let svg = bars.svg();
        assert!(svg.contains("width=\"220.0\"") && svg.contains("width=\"440.0\""), "{svg}");
        assert_eq!(svg.matches("<rect").count(), 2);
        assert!(svg.contains(">share<") && svg.contains(">a<"));
    }
}
