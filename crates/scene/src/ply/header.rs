//! The header: which elements there are, and what properties they have.

use super::PlyError;

/// How the numbers are stored.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// The size in binary files, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the number, or of the items of the list.
    pub(super) scalar: Scalar,
    /// The type of the length, of a list.
    pub(super) length: Option<Scalar>,
}

/// One kind of item.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The fewest bytes that an item can take.
    pub(super) fn min_size(&self, format: Format) -> u64 {
        let size = |p: &Property| match format {
            // A digit and a blank; the last item of a file may lack the blank.
            Format::Ascii => 2,
            _ => p.length.unwrap_or(p.scalar).size() as u64,
        };
        self.properties.iter().map(size).sum()
    }
}

/// The header of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) format: Format,
    pub(super) elements: Vec<Element>,
    /// Where the data begin.
    pub(super) body: usize,
}

/// Reads the header.
pub(super) fn parse(bytes: &[u8]) -> Result<Header, PlyError> {
    let mut lines = Lines { bytes, position: 0, line: 0 };
    if lines.next()? != "ply" {
        return Err(PlyError::NotPly);
    }
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let text = match lines.next() {
            Err(PlyError::NotPly) => return Err(lines.fault("this is not text")),
            other => other?,
        };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match *words {
            ["format", name, _] => {
                format = Some(match name {
                    "ascii" => Format::Ascii,
                    "binary_little_endian" => Format::LittleEndian,
                    "binary_big_endian" => Format::BigEndian,
                    _ => return Err(lines.fault(&format!("unknown format \"{name}\""))),
                });
            }
            ["element", name, count] => {
                let Ok(count) = count.parse::<u64>() else {
                    return Err(lines.fault(&format!("\"{count}\" is no number of items")));
                };
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, scalar, name] => {
                let length = Some(lines.scalar(length)?);
                lines.property(&mut elements, length, scalar, name)?;
            }
            ["property", scalar, name] => lines.property(&mut elements, None, scalar, name)?,
            ["comment" | "obj_info", ..] | [] => {}
            ["end_header"] => break,
            _ => return Err(lines.fault(&format!("\"{text}\" means nothing"))),
        }
    }
    let format = format.ok_or_else(|| lines.fault("the header has no line \"format\""))?;
    Ok(Header { format, elements, body: lines.position })
}

/// The lines of the header; they end with a line feed, a carriage return or both.
struct Lines<'a> {
    bytes: &'a [u8],
    position: usize,
    line: usize,
}

impl<'a> Lines<'a> {
    /// No line of a header is longer.
    const MAX_LENGTH: usize = 4096;

    fn next(&mut self) -> Result<&'a str, PlyError> {
        self.line += 1;
        let rest = &self.bytes[self.position..];
        let within = &rest[..rest.len().min(Self::MAX_LENGTH)];
        let Some(end) = within.iter().position(|b| matches!(b, b'\n' | b'\r')) else {
            return Err(if self.line == 1 { PlyError::NotPly } else { PlyError::UnfinishedHeader });
        };
        let both = rest[end] == b'\r' && rest.get(end + 1) == Some(&b'\n');
        self.position += end + if both { 2 } else { 1 };
        let text = &rest[..end];
        if text.starts_with(b"comment") || text.starts_with(b"obj_info") {
            // Comments may be in any encoding.
            return Ok("");
        }
        std::str::from_utf8(text).map(str::trim_ascii_end).map_err(|_| PlyError::NotPly)
    }

    fn fault(&self, message: &str) -> PlyError {
        PlyError::Header { line: self.line, message: message.chars().take(200).collect() }
    }

    fn scalar(&self, name: &str) -> Result<Scalar, PlyError> {
        Scalar::from_name(name).ok_or_else(|| self.fault(&format!("unknown type \"{name}\"")))
    }

    fn property(
        &self,
        elements: &mut [Element],
        length: Option<Scalar>,
        scalar: &str,
        name: &str,
    ) -> Result<(), PlyError> {
        let scalar = self.scalar(scalar)?;
        let Some(element) = elements.last_mut() else {
            return Err(self.fault("a property before the first element"));
        };
        element.properties.push(Property { name: name.to_owned(), scalar, length });
        Ok(())
    }
}
