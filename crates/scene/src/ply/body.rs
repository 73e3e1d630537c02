//! The data behind the header.

use super::{
    PlyError, PlyMesh,
    bulk::{Bytes, Faces, Field, Items, Vertex, layout},
    header::{Element, Format, Header, Property, Scalar},
};
use crate::LargeFile;
use rayon::prelude::*;
use tenfold_math::{Vec2, Vec3};

/// The names that texture coordinates go by; the first pair found counts.
const UV_NAMES: [[&str; 2]; 4] =
    [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// Reads all elements.
pub(super) fn read(header: &Header, bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let data = &bytes[header.body..];
    match header.format {
        Format::Ascii => read_elements(header, Ascii { data }, bytes.len()),
        Format::LittleEndian => read_elements(header, Binary::<false> { data }, bytes.len()),
        Format::BigEndian => read_elements(header, Binary::<true> { data }, bytes.len()),
    }
}

/// Reads all elements piece by piece: `None` where that cannot be done, for whatever reason.
pub(super) fn read_pieces(header: &Header, file: &LargeFile) -> Option<PlyMesh> {
    let big_endian = match header.format {
        Format::Ascii => return None,
        Format::LittleEndian => false,
        Format::BigEndian => true,
    };
    let source = Pieces { file, position: header.body as u64, big_endian };
    read_elements(header, source, usize::try_from(file.len()).ok()?).ok()
}

fn read_elements<S: Source>(header: &Header, mut source: S, bytes: usize) -> Result<PlyMesh, PlyError> {
    // Nothing is allocated for what the file cannot hold. An ASCII file may lack the last blank.
    let held = source.remaining() + 1;
    for element in &header.elements {
        let size = element.min_size(header.format);
        if element.count.checked_mul(size).is_none_or(|need| need > held) {
            let (element, count) = (element.name.clone(), element.count);
            return Err(PlyError::TooLarge { element, count, bytes });
        }
    }
    let index_of = |name: &str, none| {
        header.elements.iter().position(|e| e.name == name && e.count > 0).ok_or(PlyError::Empty(none))
    };
    let (vertices, faces) = (index_of("vertex", "vertices")?, index_of("face", "faces")?);
    let mut mesh = PlyMesh::default();
    for (i, element) in header.elements.iter().enumerate() {
        if i == vertices {
            read_vertices(&mut source, element, &mut mesh)?;
        } else if i == faces {
            read_faces(&mut source, element, header.elements[vertices].count, &mut mesh)?;
        } else if !element.properties.is_empty() {
            for index in 0..element.count {
                element
                    .properties
                    .iter()
                    .try_for_each(|p| skip(&mut source, p))
                    .map_err(at(element, index))?;
            }
        }
    }
    Ok(mesh)
}

fn read_vertices<S: Source>(source: &mut S, element: &Element, mesh: &mut PlyMesh) -> Result<(), PlyError> {
    let find = |name: &str| element.properties.iter().position(|p| p.name == name);
    let mut slots: Vec<Option<usize>> = vec![None; element.properties.len()];
    for (slot, name) in ["x", "y", "z"].into_iter().enumerate() {
        let property = find(name).ok_or(PlyError::MissingProperty { element: "vertex", property: name })?;
        slots[property] = Some(slot);
    }
    let normal = ["nx", "ny", "nz"].map(find);
    let has_normals = normal.iter().all(Option::is_some);
    if has_normals {
        normal.into_iter().flatten().enumerate().for_each(|(i, property)| slots[property] = Some(3 + i));
    }
    let uv = UV_NAMES.into_iter().map(|pair| pair.map(find)).find(|pair| pair.iter().all(Option::is_some));
    if let Some(pair) = uv {
        pair.into_iter().flatten().enumerate().for_each(|(i, property)| slots[property] = Some(6 + i));
    }
    if let Some((p, _)) =
        element.properties.iter().zip(&slots).find(|(p, s)| s.is_some() && p.length.is_some())
    {
        return Err(PlyError::WrongShape(p.name.clone()));
    }

    if let Some((fields, stride)) = layout(element)
        && let Some(items) = source.items(element.count, stride)
    {
        let slot = |slot: usize| -> Field {
            fields[slots.iter().position(|s| *s == Some(slot)).unwrap_or_default()]
        };
        let vertex = Vertex {
            position: [slot(0), slot(1), slot(2)],
            normal: has_normals.then(|| [slot(3), slot(4), slot(5)]),
            uv: uv.map(|_| [slot(6), slot(7)]),
        };
        if let Some(vertices) = items.vertices(&vertex) {
            (mesh.positions, mesh.normals, mesh.uvs) = vertices;
            let size = items.size();
            source.pass(size);
            return Ok(());
        }
    }

    let count = element.count as usize;
    mesh.positions.reserve_exact(count);
    mesh.normals.reserve_exact(if has_normals { count } else { 0 });
    mesh.uvs.reserve_exact(if uv.is_some() { count } else { 0 });
    for index in 0..element.count {
        let mut values = [0f32; 8];
        for (property, slot) in element.properties.iter().zip(&slots) {
            match slot {
                Some(slot) => {
                    values[*slot] = source.float(property.scalar).map_err(at(element, index))?;
                }
                None => skip(source, property).map_err(at(element, index))?,
            }
        }
        if !values.iter().all(|v| v.is_finite()) {
            return Err(PlyError::NotFinite(index));
        }
        mesh.positions.push(Vec3::from_slice(&values));
        if has_normals {
            mesh.normals.push(Vec3::from_slice(&values[3..]));
        }
        if uv.is_some() {
            mesh.uvs.push(Vec2::from_slice(&values[6..]));
        }
    }
    Ok(())
}

fn read_faces<S: Source>(
    source: &mut S,
    element: &Element,
    vertices: u64,
    mesh: &mut PlyMesh,
) -> Result<(), PlyError> {
    let find = |name: &str| element.properties.iter().position(|p| p.name == name);
    let corners = find("vertex_indices")
        .or_else(|| find("vertex_index"))
        .ok_or(PlyError::MissingProperty { element: "face", property: "vertex_indices" })?;
    let number = find("face_indices");
    for (property, is_list) in [(Some(corners), true), (number, false)] {
        if let Some(p) = property.map(|i| &element.properties[i])
            && p.length.is_some() != is_list
        {
            return Err(PlyError::WrongShape(p.name.clone()));
        }
    }
    // Most meshes have triangles alone, or quadrilaterals alone.
    for n in [3, 4] {
        if let Some(faces) = Faces::new(element, corners, number, n)
            && let Some(items) = source.items(element.count, faces.stride)
        {
            let found = match n {
                3 => faces.read(&items, vertices).map(|(faces, numbers)| (faces, Vec::new(), numbers)),
                _ => faces.read(&items, vertices).map(|(faces, numbers)| (Vec::new(), faces, numbers)),
            };
            if let Some(found) = found {
                (mesh.triangles, mesh.quads, mesh.face_indices) = found;
                mesh.quads.par_iter_mut().for_each(|face| face.swap(2, 3));
                let size = items.size();
                source.pass(size);
                return Ok(());
            }
        }
    }

    mesh.triangles.reserve(element.count as usize);
    let mut quad_numbers = Vec::new();
    for index in 0..element.count {
        let mut n = 0;
        let mut face = [0u32; 4];
        let mut face_number = 0;
        for (i, property) in element.properties.iter().enumerate() {
            if i == corners {
                let length = property.length.unwrap_or(Scalar::U8);
                n = source.integer(length).map_err(at(element, index))?;
                if n != 3 && n != 4 {
                    return Err(PlyError::Polygon { face: index, corners: n });
                }
                for corner in &mut face[..n as usize] {
                    let vertex = source.integer(property.scalar).map_err(at(element, index))?;
                    *corner = u32::try_from(vertex)
                        .ok()
                        .filter(|v| u64::from(*v) < vertices)
                        .ok_or(PlyError::IndexOutOfRange { face: index, index: vertex, vertices })?;
                }
            } else if Some(i) == number {
                face_number = source.integer(property.scalar).map_err(at(element, index))? as i32;
            } else {
                skip(source, property).map_err(at(element, index))?;
            }
        }
        let [a, b, c, d] = face;
        let numbers = if n == 4 {
            mesh.quads.push([a, b, d, c]);
            &mut quad_numbers
        } else {
            mesh.triangles.push([a, b, c]);
            &mut mesh.face_indices
        };
        if number.is_some() {
            numbers.push(face_number);
        }
    }
    mesh.triangles.shrink_to_fit();
    mesh.face_indices.append(&mut quad_numbers);
    Ok(())
}

fn skip<S: Source>(source: &mut S, property: &Property) -> Result<(), Fault> {
    let count = match property.length {
        Some(length) => source.integer(length)?.max(0) as u64,
        None => 1,
    };
    source.skip(property.scalar, count)
}

/// Why a number cannot be read.
enum Fault {
    Truncated,
    NotANumber(String),
}

/// Says where a fault happened.
fn at(element: &Element, index: u64) -> impl Fn(Fault) -> PlyError {
    move |fault| {
        let element = element.name.clone();
        match fault {
            Fault::Truncated => PlyError::Truncated { element, index },
            Fault::NotANumber(word) => PlyError::NotANumber { element, index, word },
        }
    }
}

/// The numbers of a file, one after the other.
trait Source {
    /// How many bytes are left.
    fn remaining(&self) -> u64;

    /// The next items of `stride` bytes each: none where they are no bytes, or too few. What is wrong with them is found one by one.
    fn items(&self, count: u64, stride: usize) -> Option<Items<'_>>;

    /// Passes over bytes, of which as many must be there.
    fn pass(&mut self, bytes: usize);

    /// The next number, as a float.
    fn float(&mut self, scalar: Scalar) -> Result<f32, Fault>;

    /// The next number, as an integer; fractions are cut off.
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault>;

    /// Passes over numbers.
    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault>;
}

/// Binary numbers.
struct Binary<'a, const BIG: bool> {
    data: &'a [u8],
}

impl<const BIG: bool> Binary<'_, BIG> {
    /// The next number, an item by itself.
    #[inline]
    fn take(&mut self, scalar: Scalar) -> Result<(Field, &[u8]), Fault> {
        let (item, rest) = self.data.split_at_checked(scalar.size()).ok_or(Fault::Truncated)?;
        self.data = rest;
        Ok((Field { at: 0, scalar }, item))
    }
}

impl<const BIG: bool> Source for Binary<'_, BIG> {
    fn remaining(&self) -> u64 {
        self.data.len() as u64
    }

    fn items(&self, count: u64, stride: usize) -> Option<Items<'_>> {
        Items::new(Bytes::Memory(self.data), self.data.len() as u64, count, stride, BIG)
    }

    fn pass(&mut self, bytes: usize) {
        self.data = &self.data[bytes..];
    }

    #[inline]
    fn float(&mut self, scalar: Scalar) -> Result<f32, Fault> {
        let (number, item) = self.take(scalar)?;
        Ok(number.float(item, BIG))
    }

    #[inline]
    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault> {
        let (number, item) = self.take(scalar)?;
        Ok(number.integer(item, BIG))
    }

    #[inline]
    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Fault> {
        let bytes = usize::try_from(count).ok().and_then(|n| n.checked_mul(scalar.size()));
        self.data = bytes.and_then(|n| self.data.get(n..)).ok_or(Fault::Truncated)?;
        Ok(())
    }
}

/// Binary numbers in a file: elements whose items all have the same size, and nothing else.
struct Pieces<'a> {
    file: &'a LargeFile,
    /// How many bytes were passed.
    position: u64,
    big_endian: bool,
}

impl Source for Pieces<'_> {
    fn remaining(&self) -> u64 {
        self.file.len() - self.position
    }

    fn items(&self, count: u64, stride: usize) -> Option<Items<'_>> {
        let bytes = Bytes::File(self.file, self.position);
        Items::new(bytes, self.remaining(), count, stride, self.big_endian)
    }

    fn pass(&mut self, bytes: usize) {
        self.position += bytes as u64;
    }

    fn float(&mut self, _: Scalar) -> Result<f32, Fault> {
        Err(Fault::Truncated)
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, Fault> {
        Err(Fault::Truncated)
    }

    fn skip(&mut self, _: Scalar, _: u64) -> Result<(), Fault> {
        Err(Fault::Truncated)
    }
}

/// Numbers as words.
struct Ascii<'a> {
    data: &'a [u8],
}

impl<'a> Ascii<'a> {
    fn word(&mut self) -> Result<&'a str, Fault> {
        let data = self.data.trim_ascii_start();
        let end = data.iter().position(u8::is_ascii_whitespace).unwrap_or(data.len());
        let (word, rest) = data.split_at(end);
        self.data = rest;
        match std::str::from_utf8(word) {
            Ok("") => Err(Fault::Truncated),
            Ok(word) => Ok(word),
            Err(_) => {
                Err(Fault::NotANumber(String::from_utf8_lossy(&word[..word.len().min(40)]).into_owned()))
            }
        }
    }

    fn parse<T: std::str::FromStr>(word: &str) -> Result<T, Fault> {
        word.parse().map_err(|_| Fault::NotANumber(word.chars().take(40).collect()))
    }
}

impl Source for Ascii<'_> {
    fn remaining(&self) -> u64 {
        self.data.len() as u64
    }

    fn items(&self, _: u64, _: usize) -> Option<Items<'_>> {
        None
    }

    fn pass(&mut self, bytes: usize) {
        self.data = &self.data[bytes..];
    }

    fn float(&mut self, _: Scalar) -> Result<f32, Fault> {
        Self::parse(self.word()?)
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, Fault> {
        let word = self.word()?;
        word.parse().or_else(|_| Self::parse::<f64>(word).map(|value| value as i64))
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Fault> {
        (0..count).try_for_each(|_| self.word().map(|_| ()))
    }
}
