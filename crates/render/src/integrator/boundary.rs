//! Rough boundaries of transparent bodies side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a
//! [`Dielectric`](crate::bxdf::Dielectric) that disperses nothing, to the bit, in vector instructions.

use super::{
    surfaces::{Surfaces, leave_if},
    weights::Scattering,
};
use crate::bxdf::{HORIZON, InterfaceDirection};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Floats, Rays, Vec2s, Vec3, Vec3s, WIDTH, vectorized};
use tenfold_spectrum::N;

vectorized! {
    /// Scattering between the directions `wo` and `wi`, in the slots that are `here`.
    pub(super) fn evaluate(here: &[bool; WIDTH], surfaces: &Surfaces, wo: &Vec3s, wi: &Vec3s, out: &mut Scattering) {
        for i in 0..WIDTH {
            let frame = surfaces.frame(i);
            let (o, w) = (frame.to_local(wo.get(i)), frame.to_local(wi.get(i)));
            set(here[i], i, true, surfaces, o, w, wi.get(i).dot(frame.z).abs(), out);
        }
    }
}

vectorized! {
    /// Rays that leave the surfaces `from`, in the slots that are `here`, in directions chosen by `u_lobe` and `u`. What passes has `eta_scale` multiplied by the
    /// square of the relative index.
    pub(super) fn scatter(
        here: &[bool; WIDTH],
        surfaces: &Surfaces,
        wo: &Vec3s,
        from: &ReferencePoints,
        u_lobe: &Floats,
        u: &Vec2s,
        rays: &mut Rays,
        eta_scale: &mut Floats,
        out: &mut Scattering,
    ) {
        for i in 0..WIDTH {
            let frame = surfaces.frame(i);
            let interface = &surfaces.interface[i];
            let o = frame.to_local(wo.get(i));
            let InterfaceDirection { wi: w, reflected, exists } = interface.sample(o, u_lobe[i], u.get(i));
            let wi = frame.to_world(w);
            set(here[i], i, exists, surfaces, o, w, wi.dot(frame.z).abs(), out);
            leave_if(here[i], i, from, wi, rays);
            let eta = interface.eta_from(o);
            eta_scale[i] *= if here[i] & !reflected { eta * eta } else { 1.0 };
        }
    }
}

/// Sets value and density of scattering between the local directions `o` and `w`, if there is any; the latter has the cosine `cos` in the world.
#[inline(always)]
fn set(
    is_here: bool,
    slot: usize,
    exists: bool,
    surfaces: &Surfaces,
    o: Vec3,
    w: Vec3,
    cos: f32,
    out: &mut Scattering,
) {
    let scattering = surfaces.interface[slot].radiance(o, w);
    let scatters = exists & (o.z.abs() >= HORIZON) & (w.z.abs() >= HORIZON);
    let of = |x: f32| if scatters { x } else { 0.0 };
    out.set_if(is_here, slot, [of(scattering.f); N], of(scattering.pdf), cos);
}
