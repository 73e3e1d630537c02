//! Boxes as the builder handles them.

use crate::bvh::simd::Vector;
use tenfold_math::{Bounds3, Vec3};

/// A box in one vector: the low corner and the *negated* high corner, so that the union of two is the minimum of all components. The fourth and
/// the last component mean nothing.
#[derive(Copy, Clone, Debug)]
#[repr(C, align(32))]
pub(in crate::bvh) struct Hull(pub(super) [f32; 8]);

impl Hull {
    pub(in crate::bvh) const EMPTY: Self = Self([f32::INFINITY; 8]);

    #[inline(always)]
    pub(in crate::bvh) fn new(bounds: Bounds3) -> Self {
        let Bounds3 { min, max } = bounds;
        Self([min.x, min.y, min.z, 0.0, -max.x, -max.y, -max.z, 0.0])
    }

    #[inline(always)]
    pub(in crate::bvh) fn bounds(&self) -> Bounds3 {
        let [x, y, z, _, a, b, c, _] = self.0;
        Bounds3 { min: Vec3::new(x, y, z), max: -Vec3::new(a, b, c) }
    }

    #[inline(always)]
    pub(in crate::bvh) fn union(&self, b: &Self) -> Self {
        Self(std::array::from_fn(|i| if self.0[i] < b.0[i] { self.0[i] } else { b.0[i] }))
    }

    /// What is in both; `None` where nothing is.
    pub(super) fn intersection(&self, b: &Self) -> Option<Self> {
        let both = Self(std::array::from_fn(|i| if self.0[i] > b.0[i] { self.0[i] } else { b.0[i] }));
        (0..3).all(|axis| both.0[axis] <= -both.0[axis + 4]).then_some(both)
    }

    /// Half the surface area; for what is not empty.
    #[inline(always)]
    pub(in crate::bvh) fn half_area(&self) -> f32 {
        let [x, y, z, _, a, b, c, _] = self.0;
        let (x, y, z) = (x + a, y + b, z + c);
        x * y + y * z + z * x
    }

    #[inline(always)]
    pub(super) fn load<V: Vector>(&self) -> V {
        V::load(&self.0)
    }

    #[inline(always)]
    pub(super) fn store<V: Vector>(v: V) -> Self {
        Self(v.to_array())
    }
}

/// The doubled middle of a hull, as a hull of no extent.
#[inline(always)]
pub(super) fn middle<V: Vector>(hull: V) -> V {
    let hull = hull.corners();
    hull.sub(hull.swap_halves())
}
