use tenfold_math::ops;

/// How numbers lie along an axis.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm, with ticks at powers of ten.
    Log,
    /// By their logarithm, with ticks at powers of two.
    Log2,
}

/// An axis of a plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it measures, with its unit: `time (s)`.
    pub label: String,
    /// How numbers lie along it.
    pub scale: Scale,
    /// From where to where; where `None`, all that is drawn fits.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis.
    pub fn log(label: &str) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// A logarithmic axis for counts that double.
    pub fn log2(label: &str) -> Self {
        Self { scale: Scale::Log2, ..Self::linear(label) }
    }

    /// The same axis from `low` to `high`.
    #[must_use]
    pub fn range(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// The axis with its ends, given all numbers that should fit.
    pub(super) fn fitted(&self, values: impl Iterator<Item = f64>) -> Fitted {
        let on = |v: f64| self.place(v);
        let [low, high] = match self.range {
            Some(range) => range.map(|v| on(v).unwrap_or(0.0)),
            None => {
                let places = values.filter_map(on);
                let [low, high] = places
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
                let margin = 0.04 * (high - low);
                [low - margin, high + margin]
            }
        };
        let [low, high] = if low.is_finite() && high.is_finite() { [low, high] } else { [0.0, 1.0] };
        // One number alone stands in the middle.
        let half = if high > low { 0.0 } else { 0.5 * f64::max(1.0, low.abs()) };
        Fitted { scale: self.scale, low: low - half, high: high + half }
    }

    fn place(&self, v: f64) -> Option<f64> {
        place(self.scale, v)
    }
}

/// Where a number stands on a scale, if it does.
fn place(scale: Scale, v: f64) -> Option<f64> {
    let place = match scale {
        Scale::Linear => v,
        Scale::Log if v > 0.0 => ops::log10(v),
        Scale::Log2 if v > 0.0 => ops::log2(v),
        _ => return None,
    };
    place.is_finite().then_some(place)
}

/// An axis with its ends.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Fitted {
    scale: Scale,
    low: f64,
    high: f64,
}

/// A number that an axis names.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Where, from 0 at the low end to 1.
    pub(super) at: f64,
    pub(super) label: String,
}

impl Fitted {
    /// Where `v` is, from 0 at the low end to 1 at the high one. `None` where no place is `v`'s.
    pub(super) fn at(&self, v: f64) -> Option<f64> {
        place(self.scale, v).map(|p| (p - self.low) / (self.high - self.low))
    }

    /// Whether a place lies between the ends.
    pub(super) fn holds(at: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&at)
    }

    /// At most about `most` numbers, evenly spaced.
    pub(super) fn ticks(&self, most: usize) -> Vec<Tick> {
        let span = self.high - self.low;
        match self.scale {
            Scale::Linear => {
                let step = nice_step(span / most as f64);
                let digits = (-ops::log10(step).floor()).clamp(0.0, 9.0) as usize;
                self.multiples(step).map(|v| self.tick(v, minus(format!("{v:.digits$}")))).collect()
            }
            Scale::Log if span < 2.2 => self.mantissas(),
            Scale::Log => {
                let step = (span / most as f64).ceil().max(1.0);
                self.multiples(step).map(|e| self.tick(e, power_of_ten(e as i32))).collect()
            }
            Scale::Log2 => {
                let step = (span / most as f64).ceil().max(1.0);
                let label =
                    |e: f64| if e.abs() < 40.0 { minus(ops::exp2(e).to_string()) } else { format!("2^{e}") };
                self.multiples(step).map(|e| self.tick(e, label(e))).collect()
            }
        }
    }

    fn tick(&self, place: f64, label: String) -> Tick {
        Tick { at: (place - self.low) / (self.high - self.low), label }
    }

    /// The multiples of `step` between the ends.
    fn multiples(&self, step: f64) -> impl Iterator<Item = f64> {
        let first = (self.low / step - 1e-9).ceil() as i64;
        let last = (self.high / step + 1e-9).floor() as i64;
        (first..=last).map(move |k| k as f64 * step)
    }

    /// Numbers of one digit, for a decade or two.
    fn mantissas(&self) -> Vec<Tick> {
        let span = self.high - self.low;
        let digits: &[f64] = match () {
            () if span < 0.3 => {
                &[1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0]
            }
            () if span < 0.7 => &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
            () => &[1.0, 2.0, 5.0],
        };
        let decades = self.low.floor() as i32..=self.high.floor() as i32;
        let all = decades.flat_map(|e| digits.iter().map(move |&d| (d, e)));
        let ticks = all.map(|(d, e)| self.tick(ops::log10(d) + f64::from(e), digit_and_power(d, e)));
        ticks.filter(|tick| Self::holds(tick.at)).collect()
    }
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
fn nice_step(least: f64) -> f64 {
    let decade = ops::powf(10.0, ops::log10(least).floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * decade >= least * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * decade
}

fn minus(text: String) -> String {
    // Of a zero below which the axis goes, the sign is an accident.
    let zero = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    if zero { text.replace('-', "") } else { text.replace('-', "−") }
}

fn power_of_ten(e: i32) -> String {
    if (-4..=5).contains(&e) { digit_and_power(1.0, e) } else { format!("10{}", superscript(e)) }
}

fn digit_and_power(digit: f64, e: i32) -> String {
    if !(-4..=5).contains(&e) {
        return format!("{digit}·10{}", superscript(e));
    }
    let more = usize::from(digit.fract() != 0.0);
    let decimals = (-e).max(0) as usize + if e <= 0 { more } else { 0 };
    format!("{:.decimals$}", digit * ops::powf(10.0, f64::from(e)))
}

fn superscript(n: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        c => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c.to_digit(10).unwrap_or(0) as usize],
    };
    n.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis, low: f64, high: f64) -> Vec<String> {
        axis.range(low, high).fitted(std::iter::empty()).ticks(6).into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(labels(Axis::linear("x"), 0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(
            labels(Axis::linear("x"), -0.03, 0.02),
            ["−0.03", "−0.02", "−0.01", "0.00", "0.01", "0.02"]
        );
        assert_eq!(labels(Axis::log("x"), 1e-3, 100.0), ["0.001", "0.01", "0.1", "1", "10", "100"]);
        assert_eq!(labels(Axis::log("x"), 1e-8, 1e-5), ["10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵"]);
        assert_eq!(labels(Axis::log("x"), 0.015, 0.11), ["0.02", "0.05", "0.1"]);
        assert_eq!(labels(Axis::log2("x"), 1.0, 64.0), ["1", "2", "4", "8", "16", "32", "64"]);
        assert_eq!(labels(Axis::log2("x"), 1.0, 4096.0).len(), 7);
    }

    #[test]
    fn all_numbers_fit_and_bad_ones_have_no_place() {
        let fitted = Axis::log("x").fitted([1.0, 100.0, 0.0, -1.0, f64::NAN].into_iter());
        assert!(fitted.at(1.0).unwrap() > 0.0 && fitted.at(100.0).unwrap() < 1.0);
        assert_eq!((fitted.at(0.0), fitted.at(f64::NAN)), (None, None));
        assert!((fitted.at(10.0).unwrap() - 0.5).abs() < 1e-12);
        for values in [vec![], vec![0.0], vec![7.0, 7.0]] {
            let fitted = Axis::linear("x").fitted(values.into_iter());
            assert!(!fitted.ticks(5).is_empty());
        }
    }
}
