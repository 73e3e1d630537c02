//! What a hierarchy is stored as.

use tenfold_math::{Bounds3, Vec3};

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// A node: the boxes of eight children, one row of eight floats for each of min x, max x, min y, max y, min z,
/// max z, and one row of child references; the last row begins with a bit for each child that is a leaf, and fills four cache lines. Floats are kept as bits so that a row can be chosen by
/// a masked index without a check.
#[derive(Copy, Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub(super) rows: [[u32; WIDTH]; 8],
}

impl Node {
    pub(super) const EMPTY: Self = {
        let (inf, neg) = (f32::INFINITY.to_bits(), f32::NEG_INFINITY.to_bits());
        let mut rows = [[inf; WIDTH]; 8];
        rows[1] = [neg; WIDTH];
        rows[3] = [neg; WIDTH];
        rows[5] = [neg; WIDTH];
        rows[6] = [Child::EMPTY.0; WIDTH];
        rows[7] = [0; WIDTH];
        Self { rows }
    };

    pub(super) fn set(&mut self, slot: usize, bounds: &Bounds3, child: Child) {
        for axis in 0..3 {
            self.rows[2 * axis][slot] = bounds.min[axis].to_bits();
            self.rows[2 * axis + 1][slot] = bounds.max[axis].to_bits();
        }
        self.rows[6][slot] = child.0;
        self.rows[7][0] |= u32::from(child.is_leaf()) << slot;
    }

    #[inline(always)]
    pub(super) fn row(&self, i: usize) -> &[f32; WIDTH] {
        bytemuck::cast_ref(&self.rows[i & 7])
    }

    #[inline(always)]
    pub(super) fn children(&self) -> &[u32; WIDTH] {
        &self.rows[6]
    }

    /// A bit for each child that is a leaf.
    #[inline(always)]
    pub(super) fn leaves(&self) -> u32 {
        self.rows[7][0]
    }
}

/// Reference to a node or a leaf: two bits of kind, thirty of index.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct Child(pub(super) u32);

/// What a [`Child`] refers to.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    /// A block of triangles.
    Triangles,
    /// A primitive that is not a triangle.
    Shape,
    /// A placement of another hierarchy.
    Placement,
}

impl Child {
    /// The first node.
    pub(super) const ROOT: Self = Self(0);
    /// No child; its box is empty, so that no ray gets here.
    pub(super) const EMPTY: Self = Self(u32::MAX);
    /// Indices are below this.
    pub(super) const LIMIT: usize = (1 << 30) - 1;

    pub(super) fn new(kind: Kind, index: usize) -> Self {
        debug_assert!(index < Self::LIMIT);
        Self((kind as u32) << 30 | index as u32)
    }

    #[inline(always)]
    pub(super) fn is_node(self) -> bool {
        self.0 >> 30 == Kind::Node as u32
    }

    /// Whether it is any kind of leaf.
    #[inline(always)]
    pub(super) fn is_leaf(self) -> bool {
        !self.is_node() & (self != Self::EMPTY)
    }

    #[inline(always)]
    pub(super) fn kind(self) -> Kind {
        match self.0 >> 30 {
            0 => Kind::Node,
            1 => Kind::Triangles,
            2 => Kind::Shape,
            _ => Kind::Placement,
        }
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 & 0x3fff_ffff) as usize
    }
}

/// Triangles of a block.
pub(super) const LANES: usize = 8;

/// A block of triangles, side by side, in six cache lines; unused lanes hold NaN, which no ray hits.
#[derive(Copy, Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
    /// Positions by axis, vertex, lane.
    pub(super) axes: [[[f32; LANES]; 3]; 3],
    /// Whose the lanes are.
    pub(super) ids: [LeafPrimitive; LANES],
    /// Keeps every byte initialised.
    padding: [u32; 8],
}

impl TriangleBlock {
    pub(super) const EMPTY: Self =
        Self { axes: [[[f32::NAN; LANES]; 3]; 3], ids: [LeafPrimitive::NONE; LANES], padding: [0; 8] };

    pub(super) fn set(&mut self, lane: usize, positions: &[Vec3; 3], id: LeafPrimitive) {
        for (axis, row) in self.axes.iter_mut().enumerate() {
            for (vertex, lanes) in row.iter_mut().enumerate() {
                lanes[lane] = positions[vertex][axis];
            }
        }
        self.ids[lane] = id;
    }
}

/// A primitive in a leaf: its geometry with the mask bit, and its index there.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) struct LeafPrimitive {
    geometry: u32,
    pub(crate) index: u32,
}

impl LeafPrimitive {
    const NONE: Self = Self { geometry: 0, index: 0 };

    pub(crate) fn new(geometry: u32, index: u32, masked: bool) -> Self {
        Self { geometry: geometry | u32::from(masked) << 31, index }
    }

    #[inline(always)]
    pub(crate) fn geometry(self) -> usize {
        (self.geometry & 0x7fff_ffff) as usize
    }

    #[inline(always)]
    pub(crate) fn is_masked(self) -> bool {
        self.geometry >> 31 != 0
    }

    /// The geometry, below 2³⁰, with the mask in the highest bit, and the index.
    pub(super) fn words(self) -> [u32; 2] {
        [self.geometry, self.index]
    }

    /// What [`LeafPrimitive::words`] gave.
    pub(super) fn from_words([geometry, index]: [u32; 2]) -> Self {
        Self { geometry, index }
    }
}
