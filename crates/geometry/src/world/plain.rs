//! Surfaces without shading frames of their own: what [`World::interaction`] tells of them, side by side.

use super::World;
use crate::{
    Hit, Primitive, Shape, ShapeHit,
    interaction::toward_origin,
    plain::{PlainHits, PlainSurface, PlainSurfaces},
    shape::FlatTriangle,
};
use tenfold_math::{Rays, Slots, Vec3s, WIDTH, vectorized};

/// With fewer hits of the same primitive, each is served by itself.
const WORTHWHILE: usize = 2;

/// Triangles that have been hit, in each slot.
#[derive(Copy, Clone, Debug, Default)]
struct Triangles {
    corners: [Vec3s; 3],
    flip: [bool; WIDTH],
}

impl World {
    /// What [`World::interaction`] tells of the surfaces that `rays` have hit, in those of `slots` where that is worthwhile: where they stand still
    /// and are triangles without normals, tangents and texture coordinates of their own, patches without normals, or whole round spheres.
    /// Returns these slots. Of spheres, texture coordinates are told in the slots `textured` alone.
    pub fn plain_surfaces(
        &self,
        slots: Slots,
        textured: Slots,
        rays: &Rays,
        hits: &[Option<Hit>; WIDTH],
        out: &mut PlainSurfaces,
    ) -> Slots {
        let (mut at, mut triangles) = (PlainHits::default(), Triangles::default());
        let (mut found, mut left) = (Slots::NONE, Slots::NONE);
        for slot in slots {
            let Some(hit) = hits[slot].filter(|hit| !hit.instance.is_some()) else { continue };
            let index = hit.primitive.index as usize;
            out.face_index[slot] = match &self.geometry(hit.primitive.geometry).shape {
                Shape::Triangles(mesh) if !mesh.has_frames() && mesh.parts().uvs.is_none() => {
                    let corners = mesh.positions(index);
                    triangles.corners.iter_mut().zip(corners).for_each(|(to, p)| to.set(slot, p));
                    triangles.flip[slot] = mesh.flip;
                    found.insert(slot);
                    mesh.face_index(index)
                }
                Shape::Patches(mesh) if mesh.parts().normals.is_none() => {
                    left.insert(slot);
                    mesh.face_index(index)
                }
                Shape::Sphere(sphere) if sphere.ball().is_some() => {
                    left.insert(slot);
                    0
                }
                _ => continue,
            };
            (at.t[slot], at.u[slot], at.v[slot]) = (hit.t, hit.u, hit.v);
        }
        if !found.is_empty() {
            triangle_surfaces(&triangles, &at, out);
        }
        while let Some(first) = left.into_iter().next()
            && let Some(Hit { primitive, .. }) = hits[first]
        {
            let same = left.keep(|slot| hits[slot].is_some_and(|hit| hit.primitive == primitive));
            left = left.without(same);
            if same.len() < WORTHWHILE {
                continue;
            }
            match self.primitive(primitive) {
                Primitive::Patch(patch) => found = found.or(patch.plain_surfaces(same, &at, out)),
                Primitive::Sphere(sphere) => {
                    sphere.plain_surfaces(same, rays, &at, out);
                    for slot in same.keep(|slot| textured.contains(slot)) {
                        let hit = ShapeHit { t: at.t[slot], u: 0.0, v: 0.0 };
                        out.uv.set(slot, sphere.uv(&rays.get(slot), &hit));
                    }
                    found = found.or(same);
                }
                Primitive::Disk(_) | Primitive::Cylinder(_) | Primitive::Triangle(_) => {}
            }
        }
        if !found.is_empty() {
            look_back(rays, &mut out.wo);
        }
        found
    }
}

vectorized! {
    /// The surfaces of triangles, in all slots.
    fn triangle_surfaces(triangles: &Triangles, at: &PlainHits, out: &mut PlainSurfaces) {
        for i in 0..WIDTH {
            let [a, b, c] = &triangles.corners;
            let hit = FlatTriangle::at([a.get(i), b.get(i), c.get(i)], at.u[i], at.v[i]);
            let n = hit.vertex_order_normal();
            let (p, p_error, uv, [dpdu, _]) = (hit.p(), hit.p_error(), hit.uv(), hit.derivatives());
            let n = if triangles.flip[i] { -n } else { n };
            out.set_if(true, i, PlainSurface { p, p_error, n, uv, dpdu });
        }
    }
}

vectorized! {
    /// Unit directions to where rays came from.
    fn look_back(rays: &Rays, wo: &mut Vec3s) {
        for i in 0..WIDTH {
            wo.set(i, toward_origin(&rays.get(i)));
        }
    }
}
