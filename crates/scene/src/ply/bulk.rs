//! Binary elements whose items all have the same size: all threads read them at once.

use super::{
    PlyError,
    header::{Element, Scalar},
};
use rayon::prelude::*;

/// Items in one piece of work, at least.
const GRAIN: usize = 1 << 13;

/// The items of an element, each of `stride` bytes.
#[derive(Copy, Clone)]
pub(super) struct Items<'a> {
    bytes: &'a [u8],
    stride: usize,
    big_endian: bool,
}

/// A number within an item.
#[derive(Copy, Clone)]
pub(super) struct Field {
    /// Where it begins, in bytes from the beginning of the item.
    pub(super) at: usize,
    pub(super) scalar: Scalar,
}

/// The faces of an element, all with the same number of corners.
pub(super) struct Faces {
    pub(super) stride: usize,
    /// Where the list of corners begins with its length.
    corners: Field,
    index: Scalar,
    /// The number of the face in the file it was made from.
    number: Option<Field>,
}

/// Where the properties of an element begin, and the size of an item: none where it has a list.
pub(super) fn layout(element: &Element) -> Option<(Vec<Field>, usize)> {
    let mut at = 0;
    let mut fields = Vec::with_capacity(element.properties.len());
    for property in &element.properties {
        if property.length.is_some() {
            return None;
        }
        fields.push(Field { at, scalar: property.scalar });
        at += property.scalar.size();
    }
    Some((fields, at))
}

impl<'a> Items<'a> {
    /// The first `count` items of `data`; none where there are not as many.
    pub(super) fn new(data: &'a [u8], count: u64, stride: usize, big_endian: bool) -> Option<Self> {
        let size = usize::try_from(count).ok()?.checked_mul(stride)?;
        let bytes = data.get(..size).filter(|_| stride > 0)?;
        Some(Self { bytes, stride, big_endian })
    }

    /// How many bytes they take.
    pub(super) fn size(&self) -> usize {
        self.bytes.len()
    }

    /// What `read` makes of every item.
    fn map<T: Send>(&self, read: impl Fn(&[u8]) -> T + Send + Sync) -> Vec<T> {
        self.bytes.par_chunks_exact(self.stride).with_min_len(GRAIN).map(read).collect()
    }

    /// Vectors of the numbers in `fields`.
    pub(super) fn vectors<T: From<[f32; N]> + Send, const N: usize>(&self, fields: [Field; N]) -> Vec<T> {
        if !self.big_endian && fields.iter().all(|field| field.scalar == Scalar::F32) {
            let at = fields.map(|field| field.at);
            return self.map(|item| T::from(at.map(|at| f32::from_le_bytes(bytes_at(item, at)))));
        }
        let big_endian = self.big_endian;
        self.map(|item| T::from(fields.map(|field| field.float(item, big_endian))))
    }
}

impl Faces {
    /// Faces of `corners` corners: none where an item may have another size for all that.
    pub(super) fn new(element: &Element, list: usize, number: Option<usize>, corners: usize) -> Option<Self> {
        let mut at = 0;
        let (mut begins, mut number_field) = (None, None);
        for (i, property) in element.properties.iter().enumerate() {
            match property.length {
                Some(length) if i == list => {
                    begins = Some((Field { at, scalar: length }, property.scalar));
                    at += length.size() + corners * property.scalar.size();
                }
                Some(_) => return None,
                None => {
                    if Some(i) == number {
                        number_field = Some(Field { at, scalar: property.scalar });
                    }
                    at += property.scalar.size();
                }
            }
        }
        let (corners, index) = begins?;
        Some(Self { stride: at, corners, index, number: number_field })
    }

    /// Whether all items have `corners` corners, so that none has another size than it should.
    pub(super) fn fit(&self, items: &Items<'_>, corners: usize) -> bool {
        let chunks = items.bytes.par_chunks_exact(self.stride).with_min_len(GRAIN);
        match self.corners.scalar {
            Scalar::U8 => chunks.all(|item| usize::from(item[self.corners.at]) == corners),
            _ => chunks.all(|item| self.corners.integer(item, items.big_endian) == corners as i64),
        }
    }

    /// The corners of all faces, below `vertices`.
    pub(super) fn corners<const N: usize>(
        &self,
        items: &Items<'_>,
        vertices: u64,
    ) -> Result<Vec<[u32; N]>, PlyError> {
        let first = self.corners.at + self.corners.scalar.size();
        let size = self.index.size();
        let corner = |item: &[u8], i: usize| {
            Field { at: first + i * size, scalar: self.index }.integer(item, items.big_endian)
        };
        // What fits no index is past the last vertex, too: a file of 4 billion vertices has 48 GB.
        let most = u32::try_from(vertices).unwrap_or(u32::MAX);
        let faces: Vec<[u32; N]> = match self.index {
            // Negative ones become large.
            Scalar::I32 | Scalar::U32 if !items.big_endian => items
                .map(|item| std::array::from_fn(|i| u32::from_le_bytes(bytes_at(item, first + i * size)))),
            _ => {
                items.map(|item| std::array::from_fn(|i| u32::try_from(corner(item, i)).unwrap_or(u32::MAX)))
            }
        };
        let bad = |face: &[u32; N]| face.iter().position(|&i| i >= most);
        match faces.par_iter().with_min_len(GRAIN).position_first(|face| bad(face).is_some()) {
            None => Ok(faces),
            Some(face) => {
                let item = &items.bytes[face * self.stride..][..self.stride];
                let index = corner(item, bad(&faces[face]).unwrap_or(0));
                Err(PlyError::IndexOutOfRange { face: face as u64, index, vertices })
            }
        }
    }

    /// The numbers of all faces, where they have some.
    pub(super) fn numbers(&self, items: &Items<'_>) -> Vec<i32> {
        let big_endian = items.big_endian;
        self.number.map(|field| items.map(|item| field.integer(item, big_endian) as i32)).unwrap_or_default()
    }
}

impl Field {
    /// The number in an item, as a float.
    #[inline]
    pub(super) fn float(self, item: &[u8], big_endian: bool) -> f32 {
        match self.scalar {
            Scalar::F32 => f32::from_le_bytes(ordered(item, self.at, big_endian)),
            Scalar::F64 => f64::from_le_bytes(ordered(item, self.at, big_endian)) as f32,
            _ => self.integer(item, big_endian) as f32,
        }
    }

    /// The number in an item, as an integer; fractions are cut off.
    #[inline]
    pub(super) fn integer(self, item: &[u8], big_endian: bool) -> i64 {
        let at = self.at;
        match self.scalar {
            Scalar::I8 => i8::from_le_bytes(bytes_at(item, at)).into(),
            Scalar::U8 => item[at].into(),
            Scalar::I16 => i16::from_le_bytes(ordered(item, at, big_endian)).into(),
            Scalar::U16 => u16::from_le_bytes(ordered(item, at, big_endian)).into(),
            Scalar::I32 => i32::from_le_bytes(ordered(item, at, big_endian)).into(),
            Scalar::U32 => u32::from_le_bytes(ordered(item, at, big_endian)).into(),
            Scalar::F32 => f32::from_le_bytes(ordered(item, at, big_endian)) as i64,
            Scalar::F64 => f64::from_le_bytes(ordered(item, at, big_endian)) as i64,
        }
    }
}

/// Some bytes of an item.
#[inline]
fn bytes_at<const N: usize>(item: &[u8], at: usize) -> [u8; N] {
    let mut bytes = [0; N];
    bytes.copy_from_slice(&item[at..at + N]);
    bytes
}

/// Some bytes of an item, the lowest first.
#[inline]
fn ordered<const N: usize>(item: &[u8], at: usize, big_endian: bool) -> [u8; N] {
    let mut bytes = bytes_at(item, at);
    if big_endian {
        bytes.reverse();
    }
    bytes
}
