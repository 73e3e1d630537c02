//! Numbers as pbrt writes them.

/// Why a word is no number.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum NumberFault {
    /// It is something else.
    NotANumber,
    /// It is a number, but not a whole one.
    NotWhole,
    /// It is too large.
    OutOfRange,
}

/// Reads a floating-point number: decimal with or without fraction and exponent, or hexadecimal and whole. As in pbrt,
/// `nan` and `inf` are no numbers.
pub(super) fn parse_float(word: &str) -> Result<f32, NumberFault> {
    let digits = word.strip_prefix(['+', '-']).unwrap_or(word);
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Err(NumberFault::NotANumber);
    }
    let value = match word.parse::<f32>() {
        Ok(value) => value,
        Err(_) => parse_hexadecimal(word, digits)?,
    };
    if value.is_finite() { Ok(value) } else { Err(NumberFault::OutOfRange) }
}

fn parse_hexadecimal(word: &str, digits: &str) -> Result<f32, NumberFault> {
    let digits =
        digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")).ok_or(NumberFault::NotANumber)?;
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return Err(NumberFault::NotANumber);
    }
    let value = u64::from_str_radix(digits, 16).map_err(|_| NumberFault::OutOfRange)? as f32;
    Ok(if word.starts_with('-') { -value } else { value })
}

/// Reads a whole decimal number of 32 bits.
pub(super) fn parse_integer(word: &str) -> Result<i32, NumberFault> {
    word.parse::<i32>().map_err(|error| match error.kind() {
        std::num::IntErrorKind::PosOverflow | std::num::IntErrorKind::NegOverflow => NumberFault::OutOfRange,
        _ if parse_float(word).is_ok() => NumberFault::NotWhole,
        _ => NumberFault::NotANumber,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_in_all_spellings() {
        for (word, value) in [
            ("0", 0.0),
            ("7", 7.0),
            ("007", 7.0),
            ("-3", -3.0),
            ("+3", 3.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("-.5e1", -5.0),
            ("1e3", 1000.0),
            ("1E+3", 1000.0),
            ("2.5e-3", 0.0025),
            ("0x1F", 31.0),
            ("-0x10", -16.0),
            ("123456789012345678901234567890", 1.2345679e29),
            ("1e-60", 0.0),
        ] {
            assert_eq!(parse_float(word), Ok(value), "{word}");
        }
        for word in
            ["", ".", "-", "+", "e5", "1e", "nan", "NaN", "inf", "-inf", "infinity", "1,5", "1f", "0x", "--1"]
        {
            assert_eq!(parse_float(word), Err(NumberFault::NotANumber), "{word}");
        }
        assert_eq!(parse_float("1e39"), Err(NumberFault::OutOfRange));
        assert_eq!(parse_float("0xfffffffffffffffff"), Err(NumberFault::OutOfRange));
    }

    #[test]
    fn integers_are_whole_and_have_32_bits() {
        assert_eq!(parse_integer("-2147483648"), Ok(i32::MIN));
        assert_eq!(parse_integer("+12"), Ok(12));
        assert_eq!(parse_integer("2147483648"), Err(NumberFault::OutOfRange));
        assert_eq!(parse_integer("1.0"), Err(NumberFault::NotWhole));
        assert_eq!(parse_integer("1e3"), Err(NumberFault::NotWhole));
        assert_eq!(parse_integer("x"), Err(NumberFault::NotANumber));
        assert_eq!(parse_integer("-"), Err(NumberFault::NotANumber));
    }
}
