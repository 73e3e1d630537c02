//! Traversal: nearest boxes first, with a stack of fixed size.

use super::{
    Bvh,
    course::Course,
    node::{Child, Kind, LANES, LeafPrimitive, Node, TriangleBlock, WIDTH},
    simd::{Portable, Simd, Vector},
    stack::Stack,
    triangles::Shear,
};
use crate::ShapeHit;
use tenfold_math::{Vec3, gamma, prefetch};

/// Which instructions to use. The results are the same.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// What every machine has.
    Portable,
    /// AVX2, and the bit counting of the same processors. Only [`Level::detect`] makes it.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2Token),
}

/// Proof that this machine has AVX2, and what bit counting came with it.
#[cfg(target_arch = "x86_64")]
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(crate) struct Avx2Token(());

impl Level {
    /// The best that this machine has.
    pub(crate) fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as has;
            if has!("avx2") && has!("bmi1") && has!("lzcnt") && has!("popcnt") {
                return Self::Avx2(Avx2Token(()));
            }
        }
        Self::Portable
    }
}

/// What happens at the leaves. Distances are limits that only ever shrink.
pub(crate) trait Visitor {
    /// Whether the traversal may end at the first hit: the order does not matter then.
    const ANY: bool;

    /// How far the ray still goes, including that distance itself; above 0.
    fn t_max(&self) -> f32;

    /// A triangle is hit not beyond [`Visitor::t_max`]. Returns whether the traversal is over.
    fn triangle(&mut self, id: LeafPrimitive, hit: ShapeHit) -> bool;

    /// The ray comes to a primitive that is not a triangle. Returns whether the traversal is over.
    fn shape(&mut self, id: LeafPrimitive) -> bool;

    /// The ray comes to a placement. Returns whether the traversal is over.
    fn placement(&mut self, index: usize) -> bool;
}

/// A ray prepared for boxes.
#[derive(Copy, Clone)]
pub(super) struct Slabs {
    origin: Vec3,
    inverse: Vec3,
    /// The inverse for the planes where the ray leaves.
    inverse_far: Vec3,
    /// The node's rows with the planes that the ray meets first on each axis; the other of the two rows has those it meets last.
    near: [u32; 3],
}

/// Room for the rounding of the products that give distances to planes (Ize 2013) and of the triangle test (see `padded`): boxes seem longer
/// by this factor, and so does the way that the ray may go. So no rounding decides which hits are found.
pub(crate) const LONGER: f32 = 1.0 + 2.0 * gamma(8);

impl Slabs {
    #[inline(always)]
    pub(super) fn new(course: &impl Course) -> Self {
        let (ray, inverse) = (course.ray(), course.inverse());
        let near = |axis: u32, d: f32| 2 * axis + (d.to_bits() >> 31);
        let d = ray.direction;
        Self {
            origin: ray.origin,
            inverse,
            inverse_far: inverse * LONGER,
            near: [near(0, d.x), near(1, d.y), near(2, d.z)],
        }
    }

    /// Which children's boxes the ray meets before `t_max`, and where it enters them.
    #[inline(always)]
    pub(super) fn intersect<V: Vector>(&self, node: &Node, t_max: f32) -> (u32, V) {
        let splat = |v: Vec3| [V::splat(v.x), V::splat(v.y), V::splat(v.z)];
        let origin = splat(self.origin);
        let near_row = |axis: usize| V::load(node.row(self.near[axis] as usize)).sub(origin[axis]);
        let far_row = |axis: usize| V::load(node.row(self.near[axis] as usize ^ 1)).sub(origin[axis]);
        let [x, y, z] = splat(self.inverse);
        let near = near_row(0).mul(x).max(near_row(1).mul(y));
        let near = near.max(near_row(2).mul(z).max(V::splat(0.0)));
        let [x, y, z] = splat(self.inverse_far);
        let far = far_row(0).mul(x).min(far_row(1).mul(y));
        let far = far.min(far_row(2).mul(z).min(V::splat(t_max * LONGER)));
        (near.le(far), near)
    }
}

/// Hierarchies of more nodes are larger than the caches near the processor: children that wait are loaded ahead.
const LARGE: usize = 1 << 13;

impl Bvh {
    /// Follows `ray` through the hierarchy, nearest boxes first, until the visitor says that it is over. Returns whether
    /// it did.
    #[inline]
    pub(crate) fn traverse<W: Visitor>(&self, level: Level, ray: &impl Course, visitor: &mut W) -> bool {
        match level {
            Level::Portable => self.traverse_with::<Portable, W>(ray, visitor),
            // SAFETY: the token proves that the machine has AVX2.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => unsafe { self.traverse_avx2(ray, visitor) },
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,bmi1,lzcnt,popcnt")]
    fn traverse_avx2<W: Visitor>(&self, ray: &impl Course, visitor: &mut W) -> bool {
        self.traverse_with::<super::simd::Avx2, W>(ray, visitor)
    }

    #[inline(always)]
    fn traverse_with<S: Simd, W: Visitor>(&self, ray: &impl Course, visitor: &mut W) -> bool {
        !self.nodes.is_empty() && self.follow::<S, W>(Child::ROOT, ray, visitor)
    }

    /// Follows a ray through all below `root`, a node. Returns whether the visitor said that it is over.
    #[inline(always)]
    pub(super) fn follow<S: Simd, W: Visitor>(
        &self,
        root: Child,
        ray: &impl Course,
        visitor: &mut W,
    ) -> bool {
        let slabs = Slabs::new(ray);
        let mut node = &self.nodes[root.index()];
        let (mut mask, mut near) = slabs.intersect::<S::F8>(node, visitor.t_max());
        // Many rays miss everything: they should not pay for what follows.
        if mask == 0 {
            return false;
        }
        let shear = Shear::<S::F8>::new(ray.shear());
        let mut stack = Stack::new();
        let large = self.nodes.len() >= LARGE;
        loop {
            let mut child = if mask == 0 {
                Self::pop(&mut stack, visitor)
            } else if W::ANY {
                S::push(&mut stack, mask & (mask - 1), node.children());
                Child(node.children()[mask.trailing_zeros() as usize % WIDTH])
            } else if mask & (mask - 1) == 0 {
                Child(node.children()[mask.trailing_zeros() as usize % WIDTH])
            } else if mask.count_ones() == 2 {
                Child(stack.push_farther(mask, &near.to_array(), node.children()))
            } else {
                Child(S::push_sorted(&mut stack, mask, near, node.children()))
            };
            if large && mask & mask.wrapping_sub(1) != 0 {
                self.prefetch(stack.top());
            }
            while !child.is_node() {
                if child == Child::EMPTY {
                    return false;
                }
                if self.visit(child, &shear, visitor) {
                    return true;
                }
                child = Self::pop(&mut stack, visitor);
            }
            node = &self.nodes[child.index()];
            (mask, near) = slabs.intersect(node, visitor.t_max());
        }
    }

    /// The next child that waits; [`Child::EMPTY`] at the end.
    #[inline(always)]
    pub(super) fn pop<W: Visitor>(stack: &mut Stack, visitor: &W) -> Child {
        match W::ANY {
            true => stack.pop_any(),
            false => stack.pop(visitor.t_max()),
        }
    }

    /// Shows the visitor a leaf. Returns whether the traversal is over.
    #[inline(always)]
    pub(super) fn visit<V: Vector>(&self, leaf: Child, shear: &Shear<V>, visitor: &mut impl Visitor) -> bool {
        match leaf.kind() {
            Kind::Triangles => Self::visit_triangles(shear, &self.blocks[leaf.index()], visitor),
            Kind::Shape => visitor.shape(self.shapes[leaf.index()]),
            Kind::Placement => visitor.placement(leaf.index()),
            Kind::Node => false,
        }
    }

    /// Begins to load what a child refers to.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: Child) {
        match child.kind() {
            Kind::Node => prefetch(&self.nodes[child.index()]),
            Kind::Triangles => prefetch(&self.blocks[child.index()].axes),
            Kind::Shape | Kind::Placement => {}
        }
    }

    #[inline(always)]
    fn visit_triangles<V: Vector>(
        shear: &Shear<V>,
        block: &TriangleBlock,
        visitor: &mut impl Visitor,
    ) -> bool {
        let Some(hits) = shear.intersect(block, visitor.t_max()) else { return false };
        let mut lanes = hits.lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            let hit = ShapeHit { t: hits.t[lane], u: hits.u[lane], v: hits.v[lane] };
            if hit.t <= visitor.t_max() && visitor.triangle(block.ids[lane], hit) {
                return true;
            }
        }
        false
    }
}
