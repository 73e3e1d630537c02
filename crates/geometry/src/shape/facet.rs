//! Triangles without what meshes add to them: those that are far are sampled side by side.

use super::triangle::{FlatTriangle, Triangle, area, is_far};
use crate::{ReferencePoints, ShapeSamples, sample::pdf_by_solid_angle};
use tenfold_math::{Vec2s, Vec3, Vec3s, WIDTH, vectorized};

/// A triangle that has its vertices to itself, and no normals of theirs.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Facet<'a> {
    corners: &'a [Vec3; 3],
    /// Whether its normal is against the order of the corners.
    flip: bool,
}

impl<'a> Facet<'a> {
    /// The triangle, where it is one.
    #[inline]
    pub(super) fn of(Triangle { mesh, index }: &Triangle<'a>) -> Option<Self> {
        // Normals of vertices may turn it around.
        if mesh.parts().normals.is_some() {
            return None;
        }
        Some(Self { corners: mesh.separate_positions(*index)?, flip: mesh.flip })
    }

    /// Whether it looks so small from a point that it is sampled by area.
    #[inline]
    pub fn is_far(&self, p: Vec3) -> bool {
        is_far(self.corners, p)
    }
}

/// A [`Facet`] in each slot.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Facets {
    corners: [Vec3s; 3],
    flip: [bool; WIDTH],
}

impl Facets {
    /// Sets the facet in a slot.
    #[inline(always)]
    pub fn set(&mut self, slot: usize, facet: Facet<'_>) {
        self.corners.iter_mut().zip(facet.corners).for_each(|(corners, &corner)| corners.set(slot, corner));
        self.flip[slot] = facet.flip;
    }

    /// [`Primitive::sample_from`](crate::Primitive::sample_from) for the facet and the point in each slot, from which it must be far; with a density of 0 in place of `None`.
    pub fn samples_from(&self, references: &ReferencePoints, u: &Vec2s, out: &mut ShapeSamples) {
        samples_from(self, references, u, out);
    }
}

vectorized! {
    /// See [`Facets::samples_from`].
    fn samples_from(facets: &Facets, references: &ReferencePoints, u: &Vec2s, out: &mut ShapeSamples) {
        for i in 0..WIDTH {
            let corners = facets.corners.each_ref().map(|corners| corners.get(i));
            let point = FlatTriangle::sample(corners, u.get(i));
            let (p, n) = (point.p(), point.vertex_order_normal());
            let n = if facets.flip[i] { -n } else { n };
            out.p.set(i, p);
            out.p_error.set(i, point.p_error());
            out.n.set(i, n);
            out.pdf[i] = pdf_by_solid_angle(1.0 / area(corners), p - references.p.get(i), n);
        }
    }
}
