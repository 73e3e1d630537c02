//! Numbers for people.

/// A count with three digits and a prefix: `987`, `1.23 M`.
pub(crate) fn count(n: f64) -> String {
    let scaled = [(1e12, " T"), (1e9, " G"), (1e6, " M"), (1e3, " k")];
    let Some((unit, prefix)) = scaled.into_iter().find(|(unit, _)| n >= unit * 0.9995) else {
        return format!("{n:.0}");
    };
    let n = n / unit;
    let digits = if n < 9.995 { 2 } else { usize::from(n < 99.95) };
    format!("{n:.digits$}{prefix}")
}

/// A small number with three digits: `0.0123`, `1.23`.
pub(crate) fn digits(x: f64) -> String {
    let leading = if x > 0.0 { (-tenfold_math::ops::log10(x)).ceil().clamp(0.0, 12.0) } else { 0.0 };
    format!("{x:.0$}", leading as usize + 2)
}

/// Bytes: `12.3 MB`.
pub(crate) fn bytes(n: u64) -> String {
    let text = count(n as f64);
    if text.contains(' ') { format!("{text}B") } else { format!("{text} B") }
}

/// A time span: `0.42 s`, `12.3 s`, `3 min 07 s`, `2 h 05 min`.
pub(crate) fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown time".to_owned();
    }
    if seconds < 9.995 {
        return format!("{seconds:.2} s");
    }
    if seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    match whole / 3600 {
        0 => format!("{} min {:02} s", whole / 60, whole % 60),
        hours => format!("{hours} h {:02} min", whole % 3600 / 60),
    }
}

/// A number and its noun: `1 error`, `2 errors`.
pub(crate) fn plural(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_three_digits() {
        let shown = [0.0, 7.0, 999.0, 999.6, 1234.0, 99_960.0, 1.5e6, 2.34e10].map(count);
        assert_eq!(shown, ["0", "7", "999", "1.00 k", "1.23 k", "100 k", "1.50 M", "23.4 G"]);
        assert_eq!([bytes(12), bytes(12_300_000)], ["12 B", "12.3 MB"]);
    }

    #[test]
    fn small_numbers_have_three_digits() {
        let shown = [0.0, 1.234, 0.5678, 0.012_345, 0.000_98].map(digits);
        assert_eq!(shown, ["0.00", "1.23", "0.568", "0.0123", "0.000980"]);
    }

    #[test]
    fn durations_grow_coarser() {
        let shown = [0.418, 12.34, 59.96, 187.0, 7512.0].map(duration);
        assert_eq!(shown, ["0.42 s", "12.3 s", "1 min 00 s", "3 min 07 s", "2 h 05 min"]);
    }

    #[test]
    fn nouns_agree() {
        assert_eq!([plural(1, "error"), plural(2, "error")], ["1 error", "2 errors"]);
    }
}
