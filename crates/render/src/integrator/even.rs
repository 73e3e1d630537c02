//! Even reflectors side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a [`Diffuse`](crate::bxdf::Diffuse) surface, to the bit, in vector
//! instructions.

use super::{surfaces::Surfaces, weights::Scattering};
use crate::bxdf::{Diffuse, HORIZON};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Rays, Vec2s, Vec3s, WIDTH, offset_ray_origin, vectorized};
use tenfold_sampling::warp;
use tenfold_spectrum::N;

vectorized! {
    /// Scattering between the directions `wo` and `wi`.
    pub(super) fn evaluate(surfaces: &Surfaces, wo: &Vec3s, wi: &Vec3s, out: &mut Scattering) {
        for i in 0..WIDTH {
            let n = surfaces.n.get(i);
            let (o, w) = (wo.get(i).dot(n), wi.get(i).dot(n));
            let reflects = (o.abs() >= HORIZON) & (w.abs() >= HORIZON) & ((o > 0.0) == (w > 0.0));
            set(surfaces, i, reflects, w, w.abs(), out);
        }
    }
}

vectorized! {
    /// Rays that leave the surfaces `from` in directions chosen by `u`.
    pub(super) fn scatter(
        surfaces: &Surfaces,
        wo: &Vec3s,
        from: &ReferencePoints,
        u: &Vec2s,
        rays: &mut Rays,
        out: &mut Scattering,
    ) {
        for i in 0..WIDTH {
            let frame = surfaces.frame(i);
            let side = wo.get(i).dot(frame.z);
            let mut local = warp::sample_cosine_hemisphere(u.get(i));
            local.z = local.z.copysign(side);
            let wi = frame.to_world(local);
            let reflects = (side.abs() >= HORIZON) & (local.z.abs() >= HORIZON);
            set(surfaces, i, reflects, local.z, wi.dot(frame.z).abs(), out);
            rays.origin.set(i, offset_ray_origin(from.p.get(i), from.p_error.get(i), from.n.get(i), wi));
            rays.direction.set(i, wi);
            rays.time[i] = from.time[i];
        }
    }
}

/// Sets value and density of a direction with the cosine `z`, which is `cos` in the world.
#[inline(always)]
fn set(surfaces: &Surfaces, slot: usize, reflects: bool, z: f32, cos: f32, out: &mut Scattering) {
    let pdf = if reflects { Diffuse::density(z) } else { 0.0 };
    let value = |reflectance: f32| if reflects { Diffuse::value(reflectance) } else { 0.0 };
    out.f.set_array(slot, surfaces.reflectance.array(slot).map(value));
    out.pdf.set_array(slot, [pdf; N]);
    out.hero_pdf[slot] = pdf;
    out.cos[slot] = cos;
}
