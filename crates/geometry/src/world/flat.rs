//! Flat surfaces where rays have hit them, side by side.

use super::World;
use crate::{Hit, Shape, interaction::toward_origin, shape::FlatTriangle};
use tenfold_math::{Floats, Rays, Slots, Vec2s, Vec3s, WIDTH, vectorized};

/// What shading needs of flat surfaces without shading frames of their own, in each slot: see
/// [`SurfaceInteraction`](crate::SurfaceInteraction).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct FlatSurfaces {
    /// The points.
    pub p: Vec3s,
    /// Bounds on their absolute errors.
    pub p_error: Vec3s,
    /// Unit geometric normals, which are those for shading.
    pub n: Vec3s,
    /// Texture coordinates.
    pub uv: Vec2s,
    /// Derivatives of the positions by texture u.
    pub dpdu: Vec3s,
    /// Unit directions to where the rays came from.
    pub wo: Vec3s,
    /// The faces of the meshes' files.
    pub face_index: [u32; WIDTH],
}

/// Triangles that have been hit, in each slot.
#[derive(Copy, Clone, Debug, Default)]
struct FlatHits {
    corners: [Vec3s; 3],
    u: Floats,
    v: Floats,
    flip: [bool; WIDTH],
}

impl World {
    /// What [`World::interaction`] tells of the surfaces that `rays` have hit, in those of `slots` where they are triangles that stand still,
    /// without normals, tangents and texture coordinates of their own. Returns these slots.
    pub fn flat_surfaces(
        &self,
        slots: Slots,
        rays: &Rays,
        hits: &[Option<Hit>; WIDTH],
        out: &mut FlatSurfaces,
    ) -> Slots {
        let mut flat = FlatHits::default();
        let mut found = Slots::NONE;
        for slot in slots {
            let Some(hit) = &hits[slot] else { continue };
            let Shape::Triangles(mesh) = &self.geometry(hit.primitive.geometry).shape else { continue };
            if hit.instance.is_some() || mesh.has_frames() || mesh.parts().uvs.is_some() {
                continue;
            }
            let triangle = hit.primitive.index as usize;
            flat.corners.iter_mut().zip(mesh.positions(triangle)).for_each(|(to, p)| to.set(slot, p));
            (flat.u[slot], flat.v[slot], flat.flip[slot]) = (hit.u, hit.v, mesh.flip);
            out.face_index[slot] = mesh.face_index(triangle);
            found.insert(slot);
        }
        if !found.is_empty() {
            shade(&flat, rays, out);
        }
        found
    }
}

vectorized! {
    /// The surfaces of triangles.
    fn shade(hits: &FlatHits, rays: &Rays, out: &mut FlatSurfaces) {
        for i in 0..WIDTH {
            let corners = [hits.corners[0].get(i), hits.corners[1].get(i), hits.corners[2].get(i)];
            let hit = FlatTriangle::at(corners, hits.u[i], hits.v[i]);
            let n = hit.vertex_order_normal();
            out.p.set(i, hit.p());
            out.p_error.set(i, hit.p_error());
            out.n.set(i, if hits.flip[i] { -n } else { n });
            out.uv.set(i, hit.uv());
            out.dpdu.set(i, hit.derivatives()[0]);
            out.wo.set(i, toward_origin(&rays.get(i)));
        }
    }
}
