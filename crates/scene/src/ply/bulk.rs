//! Binary elements whose items all have the same size: all threads read them at once, piece by piece, from memory or from a file.

use super::header::{Element, Scalar};
use crate::LargeFile;
use bytemuck::{Zeroable, allocation::zeroed_vec};
use rayon::prelude::*;
use tenfold_math::{Vec2, Vec3};

/// Bytes in one piece of work, about: they fit the cache near the processor.
const PIECE: usize = 1 << 16;

/// Where items are.
#[derive(Copy, Clone)]
pub(super) enum Bytes<'a> {
    /// Here.
    Memory(&'a [u8]),
    /// In a file, behind so many bytes.
    File(&'a LargeFile, u64),
}

/// The items of an element, each of `stride` bytes.
#[derive(Copy, Clone)]
pub(super) struct Items<'a> {
    bytes: Bytes<'a>,
    count: usize,
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

/// Which numbers of an item are a vertex.
pub(super) struct Vertex {
    pub(super) position: [Field; 3],
    pub(super) normal: Option<[Field; 3]>,
    pub(super) uv: Option<[Field; 2]>,
}

/// Vertices: positions, normals and texture coordinates.
type Vertices = (Vec<Vec3>, Vec<Vec3>, Vec<Vec2>);

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
    /// The first `count` items of `bytes`, of which there are `held`; none where there are not as many.
    pub(super) fn new(
        bytes: Bytes<'a>,
        held: u64,
        count: u64,
        stride: usize,
        big_endian: bool,
    ) -> Option<Self> {
        let fit = count.checked_mul(stride as u64).is_some_and(|size| size <= held) && stride > 0;
        let count = usize::try_from(count).ok().filter(|_| fit)?;
        Some(Self { bytes, count, stride, big_endian })
    }

    /// How many bytes they take.
    pub(super) fn size(&self) -> usize {
        self.count * self.stride
    }

    /// Gives `convert` every item, and its place in each array: an empty array gets nothing, the others are as long as there are items. `None` where it
    /// refuses one, or the file cannot be read.
    fn convert<A: Send, B: Send, C: Send>(
        &self,
        (mut a, mut b, mut c): (&mut [A], &mut [B], &mut [C]),
        convert: impl Fn(&[u8], Option<&mut A>, Option<&mut B>, Option<&mut C>) -> Option<()> + Sync,
    ) -> Option<()> {
        fn take<'a, T>(from: &mut &'a mut [T], n: usize) -> std::slice::IterMut<'a, T> {
            let n = n.min(from.len());
            from.split_off_mut(..n).unwrap_or_default().iter_mut()
        }
        let n = (PIECE / self.stride).max(1);
        let pieces: Vec<_> = (0..self.count)
            .step_by(n)
            .map(|start| (start, take(&mut a, n), take(&mut b, n), take(&mut c, n)))
            .collect();
        pieces.into_par_iter().try_for_each_init(Vec::new, |buffer, (start, mut a, mut b, mut c)| {
            let (start, size) = (start * self.stride, n.min(self.count - start) * self.stride);
            let bytes = match self.bytes {
                Bytes::Memory(bytes) => &bytes[start..start + size],
                Bytes::File(file, before) => {
                    buffer.resize(size, 0);
                    file.read_at(before + start as u64, buffer).ok()?;
                    &buffer[..]
                }
            };
            bytes.chunks_exact(self.stride).try_for_each(|item| convert(item, a.next(), b.next(), c.next()))
        })
    }

    /// As many as there are items; none where they are `absent`.
    fn array<T: Zeroable>(&self, is_there: bool) -> Vec<T> {
        zeroed_vec(if is_there { self.count } else { 0 })
    }

    /// The vertices; `None` where one is not finite.
    pub(super) fn vertices(&self, vertex: &Vertex) -> Option<Vertices> {
        let fields = [
            Some(&vertex.position[..]),
            vertex.normal.as_ref().map(|n| &n[..]),
            vertex.uv.as_ref().map(|uv| &uv[..]),
        ];
        let are_floats = fields.into_iter().flatten().flatten().all(|field| field.scalar == Scalar::F32);
        match are_floats && !self.big_endian {
            true => self.vertices_of(vertex, |item, field| f32::from_le_bytes(bytes_at(item, field.at))),
            false => self.vertices_of(vertex, |item, field| field.float(item, self.big_endian)),
        }
    }

    fn vertices_of(&self, vertex: &Vertex, float: impl Fn(&[u8], Field) -> f32 + Sync) -> Option<Vertices> {
        let Vertex { position, normal, uv } = *vertex;
        let mut positions: Vec<Vec3> = self.array(true);
        let mut normals: Vec<Vec3> = self.array(normal.is_some());
        let mut uvs: Vec<Vec2> = self.array(uv.is_some());
        self.convert((&mut positions, &mut normals, &mut uvs), |item, to_position, to_normal, to_uv| {
            let p = Vec3::from(position.map(|field| float(item, field)));
            *to_position? = p;
            let mut is_finite = p.is_finite();
            if let (Some(to), Some(fields)) = (to_normal, normal) {
                *to = fields.map(|field| float(item, field)).into();
                is_finite &= to.is_finite();
            }
            if let (Some(to), Some(fields)) = (to_uv, uv) {
                *to = fields.map(|field| float(item, field)).into();
                is_finite &= to.is_finite();
            }
            is_finite.then_some(())
        })?;
        Some((positions, normals, uvs))
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

    /// The corners of all faces, `N` of each and all below `vertices`, and the numbers that they have. `None` where a face has others.
    pub(super) fn read<const N: usize>(
        &self,
        items: &Items<'_>,
        vertices: u64,
    ) -> Option<(Vec<[u32; N]>, Vec<i32>)>
    where
        [u32; N]: Zeroable,
    {
        let big_endian = items.big_endian;
        match (self.corners.scalar, self.index) {
            // Negative indices become large.
            (Scalar::U8, Scalar::I32 | Scalar::U32) if !big_endian => self.read_with(
                items,
                vertices,
                |item| item[self.corners.at].into(),
                |item, field| u32::from_le_bytes(bytes_at(item, field.at)),
            ),
            _ => self.read_with(
                items,
                vertices,
                |item| self.corners.integer(item, big_endian),
                |item, field| u32::try_from(field.integer(item, big_endian)).unwrap_or(u32::MAX),
            ),
        }
    }

    fn read_with<const N: usize>(
        &self,
        items: &Items<'_>,
        vertices: u64,
        length: impl Fn(&[u8]) -> i64 + Sync,
        index: impl Fn(&[u8], Field) -> u32 + Sync,
    ) -> Option<(Vec<[u32; N]>, Vec<i32>)>
    where
        [u32; N]: Zeroable,
    {
        let mut faces: Vec<[u32; N]> = items.array(true);
        let mut numbers: Vec<i32> = items.array(self.number.is_some());
        // What fits no index is past the last vertex, too: a file of 4 billion vertices has 48 GB.
        let most = u32::try_from(vertices).unwrap_or(u32::MAX);
        let first = self.corners.at + self.corners.scalar.size();
        let fields: [Field; N] =
            std::array::from_fn(|i| Field { at: first + i * self.index.size(), scalar: self.index });
        items.convert((&mut faces, &mut numbers, &mut [(); 0]), |item, to_face, to_number, _| {
            let face = fields.map(|field| index(item, field));
            *to_face? = face;
            if let (Some(to), Some(field)) = (to_number, self.number) {
                *to = field.integer(item, items.big_endian) as i32;
            }
            (length(item) == N as i64 && face.iter().all(|&i| i < most)).then_some(())
        })?;
        Some((faces, numbers))
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
    item[at..at + N].try_into().expect("as many bytes as were taken")
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
