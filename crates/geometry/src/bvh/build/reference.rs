//! What is sorted into leaves: boxes with the primitives, or parts of triangles, that they hold.

use crate::bvh::node::LeafPrimitive;
use glam::Vec4;
use tenfold_math::{Bounds3, Vec3};

/// A box whose corners fill vectors of four; the last components mean nothing.
#[derive(Copy, Clone, Debug)]
pub(super) struct Box4 {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

impl Box4 {
    pub(super) const EMPTY: Self = Self { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };

    #[inline(always)]
    pub(super) fn union(self, b: Self) -> Self {
        Self { low: self.low.min(b.low), high: self.high.max(b.high) }
    }

    #[inline(always)]
    pub(super) fn include(self, p: Vec4) -> Self {
        Self { low: self.low.min(p), high: self.high.max(p) }
    }

    /// Half the surface area; 0 where empty.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let d = (self.high - self.low).max(Vec4::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    pub(super) fn bounds(&self) -> Bounds3 {
        Bounds3 { min: self.low.truncate(), max: self.high.truncate() }
    }
}

/// What a leaf refers to.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Triangle(LeafPrimitive),
    Shape(LeafPrimitive),
    /// Of this index.
    Placement(u32),
}

/// A box and what is in it, in 32 bytes: the words of the target take the last components of the corners.
#[derive(Copy, Clone, Debug)]
pub(crate) struct Reference {
    low: Vec4,
    high: Vec4,
}

/// Marks in the geometry's word, beside that of the mask, all but triangles.
const OTHER: u32 = 1 << 30;
/// The geometry of placements.
const PLACEMENT: u32 = u32::MAX >> 1;

impl Reference {
    pub(crate) fn new(bounds: Bounds3, target: Target) -> Self {
        let [geometry, index] = match target {
            Target::Triangle(id) => id.words(),
            Target::Shape(id) => [id.words()[0] | OTHER, id.words()[1]],
            Target::Placement(index) => [PLACEMENT, index],
        };
        Self {
            low: bounds.min.extend(f32::from_bits(geometry)),
            high: bounds.max.extend(f32::from_bits(index)),
        }
    }

    /// The same target with another box.
    pub(super) fn with_bounds(&self, bounds: Bounds3) -> Self {
        Self { low: bounds.min.extend(self.low.w), high: bounds.max.extend(self.high.w) }
    }

    pub(crate) fn target(&self) -> Target {
        let [geometry, index] = [self.low.w.to_bits(), self.high.w.to_bits()];
        match geometry {
            PLACEMENT => Target::Placement(index),
            _ if geometry & OTHER != 0 => {
                Target::Shape(LeafPrimitive::from_words([geometry & !OTHER, index]))
            }
            _ => Target::Triangle(LeafPrimitive::from_words([geometry, index])),
        }
    }

    #[inline(always)]
    pub(super) fn is_triangle(&self) -> bool {
        self.low.w.to_bits() & OTHER == 0
    }

    #[inline(always)]
    pub(super) fn bounds(&self) -> Box4 {
        Box4 { low: self.low, high: self.high }
    }

    /// Twice the middle of the box.
    #[inline(always)]
    pub(super) fn middle(&self) -> Vec4 {
        self.low + self.high
    }

    /// A total order by the middle along an axis; ties by the target, then the box.
    pub(super) fn cmp_along(&self, other: &Self, axis: usize) -> std::cmp::Ordering {
        let words = |r: &Self| (r.low.to_array().map(f32::to_bits), r.high.to_array().map(f32::to_bits));
        self.middle()[axis].total_cmp(&other.middle()[axis]).then_with(|| words(self).cmp(&words(other)))
    }
}

/// A box grown so that the rounding of the triangle test cannot reach out of it, where it is that of a triangle (or of a part of one) in a box of the given `size`.
///
/// The test shears vertices to the ray's axis: along each axis that errs by at most 5u of the distance travelled, which
/// the slab test allows for, and by 4u of the distance from the vertex to the ray, here the size of the triangle's box and its
/// slant (u = 2⁻²⁴).
pub(crate) fn padded(b: Bounds3, size: f32) -> Bounds3 {
    let by = Vec3::splat(size * 1e-6);
    let ulp = f32::EPSILON;
    Bounds3 { min: b.min - by - b.min.abs() * ulp, max: b.max + by + b.max.abs() * ulp }
}
