//! What is sorted into leaves: boxes with the primitives, or parts of triangles, that they hold.

use super::hull::Hull;
use crate::bvh::node::LeafPrimitive;
use tenfold_math::{Bounds3, Vec3};

/// What a leaf refers to.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    Triangle(LeafPrimitive),
    Shape(LeafPrimitive),
    /// Of this index.
    Placement(u32),
}

/// A box and what is in it, in 32 bytes: the words of the target take the components of the hull that mean nothing.
#[derive(Copy, Clone, Debug)]
#[repr(transparent)]
pub(crate) struct Reference(Hull);

/// Where in the hull the words are.
const GEOMETRY: usize = 3;
const INDEX: usize = 7;
/// Marks in the geometry's word, beside that of the mask, all but triangles.
const OTHER: u32 = 1 << 30;
/// The geometry of placements.
const PLACEMENT: u32 = u32::MAX >> 1;

impl Reference {
    #[inline]
    pub(crate) fn new(bounds: Bounds3, target: Target) -> Self {
        let [geometry, index] = match target {
            Target::Triangle(id) => id.words(),
            Target::Shape(id) => [id.words()[0] | OTHER, id.words()[1]],
            Target::Placement(index) => [PLACEMENT, index],
        };
        let mut hull = Hull::new(bounds);
        hull.0[GEOMETRY] = f32::from_bits(geometry);
        hull.0[INDEX] = f32::from_bits(index);
        Self(hull)
    }

    /// The same target with another box.
    pub(super) fn with_bounds(&self, bounds: Bounds3) -> Self {
        let mut hull = Hull::new(bounds);
        hull.0[GEOMETRY] = self.0.0[GEOMETRY];
        hull.0[INDEX] = self.0.0[INDEX];
        Self(hull)
    }

    /// The same with its number among all in place of its target's index: what kind of target it is can still be told, but not which.
    #[inline(always)]
    pub(super) fn with_number(&self, number: u32) -> Self {
        let mut hull = self.0;
        hull.0[INDEX] = f32::from_bits(number);
        Self(hull)
    }

    /// What [`Reference::with_number`] has put in.
    #[inline(always)]
    pub(super) fn number(&self) -> u32 {
        self.words()[1]
    }

    /// The words of the target.
    #[inline(always)]
    fn words(&self) -> [u32; 2] {
        [self.0.0[GEOMETRY].to_bits(), self.0.0[INDEX].to_bits()]
    }

    #[inline]
    pub(crate) fn target(&self) -> Target {
        let [geometry, index] = self.words();
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
        self.words()[0] & OTHER == 0
    }

    #[inline(always)]
    pub(in crate::bvh) fn hull(&self) -> &Hull {
        &self.0
    }

    /// A total order by the middle along an axis; ties by the target, then the box.
    pub(super) fn cmp_along(&self, other: &Self, axis: usize) -> std::cmp::Ordering {
        let middle = |r: &Self| r.0.0[axis] - r.0.0[axis + 4];
        let bits = |r: &Self| r.0.0.map(f32::to_bits);
        middle(self)
            .total_cmp(&middle(other))
            .then_with(|| self.words().cmp(&other.words()))
            .then_with(|| bits(self).cmp(&bits(other)))
    }
}
/// A box grown so that the rounding of the triangle test cannot reach out of it, where it is that of a triangle (or of a part of one) in a box of the given `size`.
///
/// The test shears vertices to the ray's axis: along each axis that errs by at most 5u of the distance travelled, which
/// the slab test allows for, and by 4u of the distance from the vertex to the ray, here the size of the triangle's box and its
/// slant (u = 2⁻²⁴).
#[inline(always)]
pub(crate) fn padded(b: Bounds3, size: f32) -> Bounds3 {
    let by = Vec3::splat(size * 1e-6);
    let ulp = f32::EPSILON;
    Bounds3 { min: b.min - by - b.min.abs() * ulp, max: b.max + by + b.max.abs() * ulp }
}
