//! Spectrum files.

use crate::PiecewiseLinear;

/// What is wrong with a spectrum file, and where.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct SpdError {
    /// Line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub what: String,
}

/// Reads a spectrum file: pairs of a wavelength in nm and a value, separated by white space, wavelengths increasing; `#`
/// starts a comment that runs to the end of its line.
///
/// # Errors
/// Where something is not a finite number, a value is missing, the wavelengths do not increase, or there are none.
pub fn parse_spd(text: &str) -> Result<PiecewiseLinear, SpdError> {
    let fault = |line: usize, what: String| Err(SpdError { line, what });
    let mut points: Vec<[f32; 2]> = Vec::new();
    let mut pending: Option<f32> = None;
    let mut last_line = 1;
    for (i, full) in text.lines().enumerate() {
        last_line = i + 1;
        let body = full.split_once('#').map_or(full, |(before, _)| before);
        for word in body.split_whitespace() {
            let Some(v) = word.parse().ok().filter(|v: &f32| v.is_finite()) else {
                return fault(last_line, format!("`{word}` is not a finite number"));
            };
            let Some(lambda) = pending.take() else {
                if let Some(&[before, _]) = points.last().filter(|p| p[0] >= v) {
                    return fault(last_line, format!("wavelengths must increase, but {v} follows {before}"));
                }
                pending = Some(v);
                continue;
            };
            points.push([lambda, v]);
        }
    }
    if let Some(lambda) = pending {
        return fault(last_line, format!("wavelength {lambda} has no value"));
    }
    PiecewiseLinear::from_points(points).or_else(|e| fault(last_line, e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_points_and_comments() {
        let s = parse_spd("# a glass\n400 1.5 # blue\n\n500\t1.25\r\n600.5 1e0").unwrap();
        assert_eq!(s.points(), [[400.0, 1.5], [500.0, 1.25], [600.5, 1.0]]);
        // As in pbrt-v4, pairs need not keep to lines.
        assert_eq!(parse_spd("400 1 500\n2").unwrap().points(), [[400.0, 1.0], [500.0, 2.0]]);
    }

    #[test]
    fn tells_the_line_of_a_fault() {
        for (text, line, part) in [
            ("400 1\n500 x", 2, "`x`"),
            ("400 1\n500 inf", 2, "`inf`"),
            ("400 1\n# note\n400 2", 3, "increase"),
            ("400 1\n500", 2, "no value"),
            ("# nothing\n", 1, "at least one"),
            ("", 1, "at least one"),
        ] {
            let e = parse_spd(text).unwrap_err();
            assert_eq!(e.line, line, "{text}");
            assert!(e.to_string().contains(part), "{e}");
        }
    }
}
