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

/// The powers of ten that a double holds exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Whether a word ends before this byte, or with the text.
#[inline]
pub(super) fn ends_word(byte: Option<&u8>) -> bool {
    matches!(byte, None | Some(b' ' | b'\n' | b'\t' | b'\r' | b'"' | b'[' | b']'))
}

/// The digits that begin at `at`, added to those of `value`, and where they end. More than 19 digits overflow.
#[inline]
fn digits(bytes: &[u8], mut at: usize, mut value: u64) -> (u64, usize) {
    while let Some(digit) = bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
        value = value.wrapping_mul(10).wrapping_add(digit.into());
        at += 1;
    }
    (value, at)
}

/// A minus or a plus sign, if any: whether it is a minus, and where it ends.
#[inline]
fn sign(bytes: &[u8], at: usize) -> (bool, usize) {
    let sign = bytes.get(at);
    (sign == Some(&b'-'), at + usize::from(matches!(sign, Some(b'-' | b'+'))))
}

/// The number that begins a text, and its length, where it is one of the many that are quick to read; [`parse_float`] gives
/// the same for its word.
///
/// With at most 15 digits and a power of ten that are both exact in double precision, one operation gives the nearest
/// double (Clinger 1990, "How to Read Floating Point Numbers Accurately"). The nearest float to it is the nearest to the
/// number as well, unless the double lies in the middle of two floats.
#[inline]
pub(super) fn scan_float(bytes: &[u8]) -> Option<(f32, usize)> {
    let (negative, start) = sign(bytes, 0);
    let (mut value, mut at) = digits(bytes, start, 0);
    let mut count = at - start;
    let mut exponent = 0;
    if bytes.get(at) == Some(&b'.') {
        let point = at + 1;
        (value, at) = digits(bytes, point, value);
        count += at - point;
        exponent = -i64::try_from(at - point).ok()?;
    }
    if count == 0 || count > 15 {
        return None;
    }
    if let Some(b'e' | b'E') = bytes.get(at) {
        let (below, first) = sign(bytes, at + 1);
        let (power, end) = digits(bytes, first, 0);
        if end == first || end - first > 4 {
            return None;
        }
        exponent += if below { -(power as i64) } else { power as i64 };
        at = end;
    }
    let power = *POWERS_OF_TEN.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 { value as f64 / power } else { value as f64 * power };
    // A double has 29 bits more than a float.
    let between = value.to_bits() & ((1 << 29) - 1) == 1 << 28;
    if between || !ends_word(bytes.get(at)) {
        return None;
    }
    Some((if negative { -value } else { value } as f32, at))
}

/// The integer that begins a text, and its length, where it has few digits; [`parse_integer`] gives the same for its word.
#[inline]
pub(super) fn scan_integer(bytes: &[u8]) -> Option<(i32, usize)> {
    let (negative, start) = sign(bytes, 0);
    let (value, end) = digits(bytes, start, 0);
    if end == start || end - start > 9 || !ends_word(bytes.get(end)) {
        return None;
    }
    let value = value as i32;
    Some((if negative { -value } else { value }, end))
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
    fn quick_numbers_are_the_same() {
        let same = |word: &str| {
            for rest in ["", " 1", "]", "\"", "\n"] {
                let text = format!("{word}{rest}");
                if let Some((value, length)) = scan_float(text.as_bytes()) {
                    assert_eq!(Ok(value.to_bits()), parse_float(word).map(f32::to_bits), "{word}");
                    assert_eq!(length, word.len());
                }
                if let Some((value, length)) = scan_integer(text.as_bytes()) {
                    assert_eq!((Ok(value), length), (parse_integer(word), word.len()), "{word}");
                }
            }
        };
        // Digits of all lengths at all places, with floats and middles of floats among them.
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state >> 20
        };
        let mut quick = 0;
        for i in 0..200_000 {
            let mantissa = random() % 10u64.pow(1 + i % 16);
            let decimals = (random() % 17) as usize;
            let float = f32::from_bits((0x3000_0000 + (random() as u32 & 0x1fff_ffff)) | 1);
            let above = f64::from(f32::from_bits(float.to_bits() + 1));
            let middle = 0.5 * (f64::from(float) + above);
            for word in [
                format!("{mantissa}"),
                format!("-{mantissa}e{}", decimals as i32 - 8),
                format!("{:.decimals$}", mantissa as f64 / 1e5),
                format!("{float}"),
                format!("{middle}"),
                format!("{middle:.7}"),
            ] {
                same(&word);
                quick += usize::from(scan_float(word.as_bytes()).is_some());
            }
        }
        assert!(quick > 600_000, "{quick}");
        for word in
            ["16777217", "33554434.0", "1e22", "1e23", "-0", "+1", "1.", ".5", "000000000000000000001"]
        {
            same(word);
        }
        for word in
            ["", ".", "-", "e5", "1e", "1e+", "nan", "1,5", "1f", "0x1F", "--1", "1#", "1e99999", "1.5.5"]
        {
            assert_eq!(scan_float(word.as_bytes()), None, "{word}");
            assert_eq!(scan_integer(word.as_bytes()), None, "{word}");
        }
        assert_eq!(scan_integer(b"1.0"), None);
        assert_eq!(scan_integer(b"2147483648"), None);
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
