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
use tenfold_math::gamma;

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
struct Slabs<V> {
    origin: [V; 3],
    inverse: [V; 3],
    /// The inverse for the planes where the ray leaves.
    inverse_far: [V; 3],
    /// The node's rows with the planes that the ray meets first and last on each axis.
    near: [usize; 3],
    far: [usize; 3],
}

/// Room for the rounding of the products that give distances to planes (Ize 2013) and of the triangle test (see `padded`): boxes seem longer
/// by this factor, and so does the way that the ray may go. So no rounding decides which hits are found.
pub(crate) const LONGER: f32 = 1.0 + 2.0 * gamma(8);

impl<V: Vector> Slabs<V> {
    #[inline(always)]
    fn new(course: &impl Course) -> Self {
        let ray = course.ray();
        let (d, [x, y, z]) = (ray.direction, course.inverse().to_array());
        let near = |axis: usize, d: f32| 2 * axis + (d.to_bits() >> 31) as usize;
        let near = [near(0, d.x), near(1, d.y), near(2, d.z)];
        Self {
            origin: [V::splat(ray.origin.x), V::splat(ray.origin.y), V::splat(ray.origin.z)],
            inverse: [V::splat(x), V::splat(y), V::splat(z)],
            inverse_far: [V::splat(x * LONGER), V::splat(y * LONGER), V::splat(z * LONGER)],
            near,
            far: [near[0] ^ 1, near[1] ^ 1, near[2] ^ 1],
        }
    }

    /// Which children's boxes the ray meets before `t_max`, and where it enters them.
    #[inline(always)]
    fn intersect(&self, node: &Node, t_max: f32) -> (u32, V) {
        let row = |row: usize, axis: usize| V::load(node.row(row)).sub(self.origin[axis]);
        let [x, y, z] = self.inverse;
        let near = row(self.near[0], 0).mul(x).max(row(self.near[1], 1).mul(y));
        let near = near.max(row(self.near[2], 2).mul(z).max(V::splat(0.0)));
        let [x, y, z] = self.inverse_far;
        let far = row(self.far[0], 0).mul(x).min(row(self.far[1], 1).mul(y));
        let far = far.min(row(self.far[2], 2).mul(z).min(V::splat(t_max * LONGER)));
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
        let Some(root) = self.nodes.first() else { return false };
        let slabs = Slabs::<S::F8>::new(ray);
        let (mut mask, mut near) = slabs.intersect(root, visitor.t_max());
        // Many rays miss everything: they should not pay for what follows.
        if mask == 0 {
            return false;
        }
        let shear = Shear::<S::F8>::new(ray.shear());
        let mut stack = Stack::new();
        let pop = |stack: &mut Stack, visitor: &W| match W::ANY {
            true => stack.pop_any(),
            false => stack.pop(visitor.t_max()),
        };
        let large = self.nodes.len() >= LARGE;
        let mut node = root;
        loop {
            let mut child = if mask == 0 {
                pop(&mut stack, visitor)
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
                self.prefetch::<S>(stack.top());
            }
            while !child.is_node() {
                let over = match child.kind() {
                    Kind::Triangles => Self::visit_triangles(&shear, &self.blocks[child.index()], visitor),
                    Kind::Shape => visitor.shape(self.shapes[child.index()]),
                    Kind::Placement if child == Child::EMPTY => return false,
                    Kind::Placement => visitor.placement(child.index()),
                    Kind::Node => false,
                };
                if over {
                    return true;
                }
                child = pop(&mut stack, visitor);
            }
            node = &self.nodes[child.index()];
            (mask, near) = slabs.intersect(node, visitor.t_max());
        }
    }

    /// Begins to load what a child refers to.
    #[inline(always)]
    fn prefetch<S: Simd>(&self, child: Child) {
        match child.kind() {
            Kind::Node => S::prefetch(&self.nodes[child.index()]),
            Kind::Triangles => S::prefetch(&self.blocks[child.index()]),
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
