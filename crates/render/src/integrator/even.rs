//! Even reflectors side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a [`Diffuse`](crate::bxdf::Diffuse) surface, to the bit, in vector
//! instructions.

use super::wave::EvenReflectors;
use crate::bxdf::{Diffuse, HORIZON};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Floats, Frame, Rays, Vec2s, Vec3s, WIDTH, offset_ray_origin, vectorized};
use tenfold_sampling::warp;

/// Pairs of directions at even reflectors.
#[derive(Debug, Default)]
pub(super) struct EvenScattering {
    /// Density of the second direction from the first, in solid angle: 0 where nothing is reflected.
    pub(super) pdf: Floats,
    /// |cos| of the second direction.
    pub(super) cos: Floats,
}

vectorized! {
    /// Scattering between the directions `wo` and `wi`.
    pub(super) fn evaluate(surfaces: &EvenReflectors, wo: &Vec3s, wi: &Vec3s, out: &mut EvenScattering) {
        for i in 0..WIDTH {
            let n = surfaces.n.get(i);
            let (o, w) = (wo.get(i).dot(n), wi.get(i).dot(n));
            let reflects = (o.abs() >= HORIZON) & (w.abs() >= HORIZON) & ((o > 0.0) == (w > 0.0));
            out.pdf[i] = if reflects { Diffuse::density(w) } else { 0.0 };
            out.cos[i] = w.abs();
        }
    }
}

vectorized! {
    /// Rays that leave the surfaces `from` in directions chosen by `u`.
    pub(super) fn scatter(
        surfaces: &EvenReflectors,
        wo: &Vec3s,
        from: &ReferencePoints,
        u: &Vec2s,
        rays: &mut Rays,
        out: &mut EvenScattering,
    ) {
        for i in 0..WIDTH {
            let frame = Frame::from_z_and_tangent(surfaces.n.get(i), surfaces.tangent.get(i));
            let side = wo.get(i).dot(frame.z);
            let mut local = warp::sample_cosine_hemisphere(u.get(i));
            local.z = local.z.copysign(side);
            let wi = frame.to_world(local);
            let reflects = (side.abs() >= HORIZON) & (local.z.abs() >= HORIZON);
            out.pdf[i] = if reflects { Diffuse::density(local.z) } else { 0.0 };
            out.cos[i] = wi.dot(frame.z).abs();
            rays.origin.set(i, offset_ray_origin(from.p.get(i), from.p_error.get(i), from.n.get(i), wi));
            rays.direction.set(i, wi);
            rays.time[i] = from.time[i];
        }
    }
}
