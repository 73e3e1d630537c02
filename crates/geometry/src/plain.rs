//! Surfaces without shading frames of their own where rays have hit them, side by side.

use tenfold_math::{Floats, Vec2, Vec2s, Vec3, Vec3s, WIDTH};

/// What shading needs of surfaces without shading frames of their own, in each slot: see
/// [`SurfaceInteraction`](crate::SurfaceInteraction).
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PlainSurfaces {
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

/// What shapes tell of [`PlainSurfaces`].
#[derive(Copy, Clone, Debug)]
pub(crate) struct PlainSurface {
    pub(crate) p: Vec3,
    pub(crate) p_error: Vec3,
    pub(crate) n: Vec3,
    pub(crate) uv: Vec2,
    pub(crate) dpdu: Vec3,
}

impl PlainSurfaces {
    /// Sets the surface in a slot if it `is_there`.
    #[inline(always)]
    pub(crate) fn set_if(&mut self, is_there: bool, slot: usize, new: PlainSurface) {
        let chosen = |new, old| if is_there { new } else { old };
        self.p.set(slot, chosen(new.p, self.p.get(slot)));
        self.p_error.set(slot, chosen(new.p_error, self.p_error.get(slot)));
        self.n.set(slot, chosen(new.n, self.n.get(slot)));
        self.dpdu.set(slot, chosen(new.dpdu, self.dpdu.get(slot)));
        self.uv.set(slot, if is_there { new.uv } else { self.uv.get(slot) });
    }
}

/// Where rays have hit primitives, in each slot: see [`Hit`](crate::Hit).
#[derive(Copy, Clone, Debug, Default)]
pub(crate) struct PlainHits {
    pub(crate) t: Floats,
    pub(crate) u: Floats,
    pub(crate) v: Floats,
}
