//! How stored 8-bit and 16-bit codes stand for linear values.

use tenfold_math::ops;

/// The transfer function between stored integer codes and linear values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorEncoding {
    /// The code over its maximum is the value.
    Linear,
    /// The piecewise curve of IEC 61966-2-1.
    Srgb,
    /// The value is the normalised code to this power; positive and finite.
    Gamma(f32),
}

impl ColorEncoding {
    /// Linear value of the normalised code `v` in [0, 1].
    pub fn decode(self, v: f32) -> f32 {
        match self {
            ColorEncoding::Linear => v,
            ColorEncoding::Srgb => srgb_to_linear(v),
            ColorEncoding::Gamma(gamma) => ops::powf(v, gamma),
        }
    }

    /// Normalised code of the linear value `v`, clamped to [0, 1]. NaN becomes 0.
    pub fn encode(self, v: f32) -> f32 {
        let v = if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) };
        match self {
            ColorEncoding::Linear => v,
            ColorEncoding::Srgb => linear_to_srgb(v),
            ColorEncoding::Gamma(gamma) => ops::powf(v, 1.0 / gamma),
        }
    }

    /// Nearest 8-bit code of the linear value `v`.
    pub fn encode_u8(self, v: f32) -> u8 {
        (self.encode(v) * 255.0).round() as u8
    }
}

/// Linear value of an sRGB-encoded one (IEC 61966-2-1), both in [0, 1].
pub fn srgb_to_linear(v: f32) -> f32 {
    let v = f64::from(v);
    (if v <= 0.04045 { v / 12.92 } else { ops::powf((v + 0.055) / 1.055, 2.4) }) as f32
}

/// sRGB-encoded value of a linear one (IEC 61966-2-1), both in [0, 1].
pub fn linear_to_srgb(v: f32) -> f32 {
    let v = f64::from(v);
    (if v <= 0.0031308 { v * 12.92 } else { 1.055 * ops::powf(v, 1.0 / 2.4) - 0.055 }) as f32
}

/// The linear values of all 256 codes of an encoding.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodeTable {
    encoding: ColorEncoding,
    values: Box<[f32; 256]>,
}

impl DecodeTable {
    /// Tabulates `encoding`.
    pub fn new(encoding: ColorEncoding) -> Self {
        let values = Box::new(std::array::from_fn(|code| encoding.decode(code as f32 / 255.0)));
        Self { encoding, values }
    }

    /// The encoding that was tabulated.
    pub fn encoding(&self) -> ColorEncoding {
        self.encoding
    }

    /// Linear value of `code`.
    #[inline]
    pub fn decode(&self, code: u8) -> f32 {
        self.values[usize::from(code)]
    }
}

/// Where the codes of an encoding begin: the same codes as [`ColorEncoding::encode_u8`] gives, without a power for each.
pub(crate) struct EncodeTable {
    /// The least linear values of the codes from 1.
    starts: Box<[f32; 255]>,
}

impl EncodeTable {
    /// Tabulates `encoding`.
    pub(crate) fn new(encoding: ColorEncoding) -> Self {
        let start = |index: usize| {
            // The floats from 0 to 1 are in the order of their bits.
            let (mut below, mut reached) = (0, 1f32.to_bits());
            while reached - below > 1 {
                let middle = below + (reached - below) / 2;
                let is_reached = usize::from(encoding.encode_u8(f32::from_bits(middle))) > index;
                *(if is_reached { &mut reached } else { &mut below }) = middle;
            }
            f32::from_bits(reached)
        };
        Self { starts: Box::new(std::array::from_fn(start)) }
    }

    /// Nearest code of the linear value `v`.
    #[inline]
    pub(crate) fn encode(&self, v: f32) -> u8 {
        self.starts.partition_point(|start| *start <= v) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ColorEncoding; 4] =
        [ColorEncoding::Linear, ColorEncoding::Srgb, ColorEncoding::Gamma(2.2), ColorEncoding::Gamma(0.8)];

    #[test]
    fn every_code_survives_decoding_and_encoding() {
        for encoding in ALL {
            let table = DecodeTable::new(encoding);
            for code in 0..=255 {
                assert_eq!(encoding.encode_u8(table.decode(code)), code, "{encoding:?}");
            }
        }
    }

    #[test]
    fn srgb_has_its_published_values() {
        // 18 % grey is code 118 in every table of the curve; mid code 188 is close to one half.
        assert!((srgb_to_linear(118.0 / 255.0) - 0.181164).abs() < 1e-6);
        assert!((srgb_to_linear(188.0 / 255.0) - 0.502886).abs() < 1e-6);
        assert_eq!(srgb_to_linear(1.0), 1.0);
        assert_eq!(linear_to_srgb(1.0), 1.0);
    }

    #[test]
    fn tabulated_codes_are_those_computed() {
        for encoding in ALL {
            let table = EncodeTable::new(encoding);
            let near_starts = table.starts.iter().flat_map(|s| [s.next_down(), *s, s.next_up()]);
            let spread = (0..200_000).map(|i| (i as f32 * 0.618_034).fract().powi(3));
            let odd = [0.0, -0.0, 1.0, -1.0, 2.0, 1e-40, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
            for v in near_starts.chain(spread).chain(odd) {
                assert_eq!(table.encode(v), encoding.encode_u8(v), "{encoding:?} {v}");
            }
        }
    }

    #[test]
    fn values_out_of_range_are_clamped() {
        for encoding in ALL {
            assert_eq!(encoding.encode_u8(f32::NAN), 0);
            assert_eq!(encoding.encode_u8(-1.0), 0);
            assert_eq!(encoding.encode_u8(f32::INFINITY), 255);
        }
    }
}
