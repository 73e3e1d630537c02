//! Traversal: nearest boxes first, with a stack of fixed size.

use super::{
    Bvh, STACK,
    node::{Child, Kind, LeafPrimitive, Node, WIDTH},
    simd::{Portable, Simd, Vector},
    triangles::Shear,
};
use crate::{ShapeHit, shape::RayShear};
use tenfold_math::{Ray, gamma};

/// Which instructions to use. The results are the same.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// What every machine has.
    Portable,
    /// AVX2. Only [`Level::detect`] makes it.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2Token),
}

/// Proof that this machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) struct Avx2Token(());

impl Level {
    /// The best that this machine has.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            return Self::Avx2(Avx2Token(()));
        }
        Self::Portable
    }
}

/// What happens at the leaves. Distances are limits that only ever shrink.
pub(crate) trait Visitor {
    /// Whether the traversal may end at the first hit.
    const ANY: bool;

    /// How far the ray still goes.
    fn t_max(&self) -> f32;

    /// A triangle is hit before [`Visitor::t_max`]. Returns whether the traversal is over.
    fn triangle(&mut self, id: LeafPrimitive, hit: ShapeHit) -> bool;

    /// The ray comes to a primitive that is not a triangle. Returns whether the traversal is over.
    fn shape(&mut self, id: LeafPrimitive) -> bool;

    /// The ray comes to a placement. Returns whether the traversal is over.
    fn placement(&mut self, index: usize) -> bool;
}

/// A ray prepared for boxes.
struct Slabs<V> {
    origin: [V; 3],
    inverse: [V; 3],
    /// The node's rows with the planes that the ray meets first and last on each axis.
    near: [usize; 3],
    far: [usize; 3],
}

impl<V: Vector<WIDTH>> Slabs<V> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        // A ray along a slab gets a tiny slope instead of an infinite inverse, whose product with 0 would be NaN.
        let tiny = 1e-18 * d.abs().max_element();
        let inverse = |d: f32| 1.0 / if d.abs() < tiny { tiny.copysign(d) } else { d };
        let near = |axis: usize| 2 * axis + usize::from(d[axis].is_sign_negative());
        let near = [near(0), near(1), near(2)];
        Self {
            origin: [V::splat(ray.origin.x), V::splat(ray.origin.y), V::splat(ray.origin.z)],
            inverse: [V::splat(inverse(d.x)), V::splat(inverse(d.y)), V::splat(inverse(d.z))],
            near,
            far: near.map(|row| row ^ 1),
        }
    }

    /// Which children's boxes the ray meets before `t_max`, and where it enters them.
    #[inline(always)]
    fn intersect(&self, node: &Node, t_max: f32) -> (u32, [f32; WIDTH]) {
        let plane = |rows: [usize; 3], axis: usize| {
            V::load(node.row(rows[axis])).sub(self.origin[axis]).mul(self.inverse[axis])
        };
        let near = plane(self.near, 0).max(plane(self.near, 1)).max(plane(self.near, 2)).max(V::splat(0.0));
        let far = plane(self.far, 0).min(plane(self.far, 1)).min(plane(self.far, 2));
        // Room for the rounding of these products (Ize 2013) and of the triangle test (see `padded`).
        let far = far.mul(V::splat(1.0 + 2.0 * gamma(8))).min(V::splat(t_max));
        (near.le(far), near.to_array())
    }
}

/// Children that wait: the distance to the box above the reference, so that integers sort by distance.
struct Stack {
    entries: [u64; STACK],
    height: usize,
}

impl Stack {
    /// Puts all children in the mask but the nearest on the stack, the nearest on top, and returns the nearest. There
    /// must be one. For any hit at all, their order does not matter.
    #[inline(always)]
    fn push_children(&mut self, node: &Node, (mut mask, t): (u32, [f32; WIDTH]), any: bool) -> Child {
        let mut next = || {
            let slot = mask.trailing_zeros() as usize & (WIDTH - 1);
            mask &= mask.wrapping_sub(1);
            (u64::from(t[slot].to_bits()) << 32 | u64::from(node.child(slot).0), mask)
        };
        let (mut nearest, mut left) = next();
        let base = self.height;
        while left != 0 {
            let (other, rest) = next();
            left = rest;
            let (low, high) = if other < nearest { (other, nearest) } else { (nearest, other) };
            nearest = low;
            let mut at = self.height;
            while !any && at > base && self.entries[at - 1] < high {
                self.entries[at] = self.entries[at - 1];
                at -= 1;
            }
            self.entries[at] = high;
            self.height += 1;
        }
        Child(nearest as u32)
    }

    /// The next child that is nearer than `t_max`.
    #[inline(always)]
    fn pop(&mut self, t_max: f32) -> Option<Child> {
        while self.height > 0 {
            self.height -= 1;
            let top = self.entries[self.height];
            if f32::from_bits((top >> 32) as u32) < t_max {
                return Some(Child(top as u32));
            }
        }
        None
    }
}

impl Bvh {
    /// Follows `ray` through the hierarchy, nearest boxes first, until the visitor says that it is over. Returns whether
    /// it did.
    #[inline]
    pub(crate) fn traverse<W: Visitor>(&self, level: Level, ray: &Ray, visitor: &mut W) -> bool {
        match level {
            Level::Portable => self.traverse_with::<Portable, W>(ray, visitor),
            // SAFETY: the token proves that the machine has AVX2.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => unsafe { self.traverse_avx2(ray, visitor) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn traverse_avx2<W: Visitor>(&self, ray: &Ray, visitor: &mut W) -> bool {
        self.traverse_with::<super::simd::Avx2, W>(ray, visitor)
    }

    #[inline(always)]
    fn traverse_with<S: Simd, W: Visitor>(&self, ray: &Ray, visitor: &mut W) -> bool {
        if self.root == Child::EMPTY {
            return false;
        }
        let slabs = Slabs::<S::F8>::new(ray);
        // Many rays miss everything: they should not pay for what follows.
        let first = match self.root.is_node() {
            true => slabs.intersect(&self.nodes[self.root.index()], visitor.t_max()),
            false => (1, [0.0; WIDTH]),
        };
        if first.0 == 0 {
            return false;
        }
        let shear = Shear::<S::Triangles>::new(RayShear::new(ray));
        let mut stack = Stack { entries: [0; STACK], height: 0 };
        let mut child = match self.root.is_node() {
            true => stack.push_children(&self.nodes[self.root.index()], first, W::ANY),
            false => self.root,
        };
        loop {
            while child.is_node() {
                let node = &self.nodes[child.index()];
                let hits = slabs.intersect(node, visitor.t_max());
                if hits.0 == 0 {
                    child = Child::EMPTY;
                    break;
                }
                child = stack.push_children(node, hits, W::ANY);
            }
            if child != Child::EMPTY {
                let over = match child.kind() {
                    Kind::Node => false,
                    Kind::Triangles => self.visit_triangles(&shear, child.index(), visitor),
                    Kind::Shape => visitor.shape(self.shapes[child.index()]),
                    Kind::Placement => visitor.placement(child.index()),
                };
                if over {
                    return true;
                }
            }
            child = match stack.pop(visitor.t_max()) {
                Some(child) => child,
                None => return false,
            };
        }
    }

    #[inline(always)]
    fn visit_triangles<V: Vector<{ super::LANES }>>(
        &self,
        shear: &Shear<V>,
        block: usize,
        visitor: &mut impl Visitor,
    ) -> bool {
        let Some(hits) = shear.intersect(&self.blocks[block], visitor.t_max()) else { return false };
        let mut lanes = hits.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize & (super::LANES - 1);
            lanes &= lanes - 1;
            let hit = ShapeHit { t: hits.t[lane], u: hits.u[lane], v: hits.v[lane] };
            if hit.t < visitor.t_max() && visitor.triangle(self.ids[block][lane], hit) {
                return true;
            }
        }
        false
    }
}
