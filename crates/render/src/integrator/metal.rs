//! Rough metals side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a [`Conductor`](crate::bxdf::Conductor), to the bit, in vector
//! instructions.

use super::{
    surfaces::{Surfaces, leave_if},
    weights::Scattering,
};
use crate::bxdf::{HORIZON, reflect, rough_conductor};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Rays, Vec2s, Vec3, Vec3s, WIDTH, vectorized};

vectorized! {
    /// Scattering between the directions `wo` and `wi`, in the slots that are `here`.
    pub(super) fn evaluate(here: &[bool; WIDTH], surfaces: &Surfaces, wo: &Vec3s, wi: &Vec3s, out: &mut Scattering) {
        for i in 0..WIDTH {
            let frame = surfaces.frame(i);
            let (o, w) = (frame.to_local(wo.get(i)), frame.to_local(wi.get(i)));
            set(here[i], i, surfaces, o, w, wi.get(i).dot(frame.z).abs(), out);
        }
    }
}

vectorized! {
    /// Rays that leave the surfaces `from`, in the slots that are `here`, in directions chosen by `u`.
    pub(super) fn scatter(
        here: &[bool; WIDTH],
        surfaces: &Surfaces,
        wo: &Vec3s,
        from: &ReferencePoints,
        u: &Vec2s,
        rays: &mut Rays,
        out: &mut Scattering,
    ) {
        for i in 0..WIDTH {
            let frame = surfaces.frame(i);
            let o = frame.to_local(wo.get(i));
            let w = reflect(o, surfaces.distribution[i].sample_visible(o, u.get(i)));
            let wi = frame.to_world(w);
            set(here[i], i, surfaces, o, w, wi.dot(frame.z).abs(), out);
            leave_if(here[i], i, from, wi, rays);
        }
    }
}

/// Sets value and density of scattering between the local directions `o` and `w`, the latter of which has the cosine `cos` in the world.
#[inline(always)]
fn set(is_here: bool, slot: usize, surfaces: &Surfaces, o: Vec3, w: Vec3, cos: f32, out: &mut Scattering) {
    let (eta, k) = (surfaces.eta.array(slot), surfaces.k.array(slot));
    let (f, pdf) = rough_conductor(surfaces.distribution[slot], eta, k, o, w);
    let scatters = (o.z.abs() >= HORIZON) & (w.z.abs() >= HORIZON);
    let of = |x: f32| if scatters { x } else { 0.0 };
    out.set_if(is_here, slot, f.map(of), of(pdf), cos);
}
