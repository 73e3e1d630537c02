//! Even reflectors side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a [`Diffuse`](crate::bxdf::Diffuse) surface, to the bit, in vector
//! instructions.

use super::{surfaces::Surfaces, weights::Scattering};
use crate::bxdf::{Diffuse, HORIZON};
use tenfold_geometry::{PlainSurfaces, ReferencePoints};
use tenfold_math::{Floats, Rays, Vec2s, Vec3s, WIDTH, offset_ray_origin, select, vectorized};
use tenfold_sampling::warp;
use tenfold_spectrum::N;

vectorized! {
    /// Even reflectors of the albedos set where paths `met` surfaces, and the points that light is seen from there, where `found` has all bits. It keeps them
    /// where reflectors are not black.
    pub(super) fn arrive(
        met: &PlainSurfaces,
        time: &Floats,
        found: &mut [u32; WIDTH],
        surfaces: &mut Surfaces,
        from: &mut ReferencePoints,
        wo: &mut Vec3s,
    ) {
        for i in 0..WIDTH {
            let mask = found[i];
            let (n, w) = (met.n.get(i), met.wo.get(i));
            from.p.set_where(mask, i, met.p.get(i));
            from.p_error.set_where(mask, i, met.p_error.get(i));
            from.n.set_where(mask, i, n);
            from.ns.set_where(mask, i, if n.dot(w) < 0.0 { -n } else { n });
            from.time[i] = select(mask, time[i], from.time[i]);
            wo.set_where(mask, i, w);
            surfaces.n.set_where(mask, i, n);
            surfaces.tangent.set_where(mask, i, met.dpdu.get(i));
            let reflectance = surfaces.reflectance.array(i).map(fraction);
            surfaces.reflectance.set_array(i, reflectance);
            let [a, b, c, d] = reflectance;
            let is_black = (a == 0.0) & (b == 0.0) & (c == 0.0) & (d == 0.0);
            found[i] = if is_black { 0 } else { mask };
        }
    }
}

/// What is left of an albedo within [0, 1], of none that is not a number: as [`SampledSpectrum::clamp`](tenfold_spectrum::SampledSpectrum::clamp).
#[inline(always)]
fn fraction(albedo: f32) -> f32 {
    let albedo = if albedo > 0.0 { albedo } else { 0.0 };
    if albedo < 1.0 { albedo } else { 1.0 }
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_geometry::ReferencePoint;
    use tenfold_spectrum::SampledSpectrum;
    use tenfold_testkit::Rng;

    #[test]
    fn slots_arrive_as_points_do_by_themselves() {
        let mut rng = Rng::new(8);
        let (mut met, mut from) = (PlainSurfaces::default(), ReferencePoints::default());
        let (mut surfaces, mut wo, mut time) = (Surfaces::default(), Vec3s::ZERO, [0.0; WIDTH]);
        for round in 0..100 {
            let albedos: [SampledSpectrum; WIDTH] = std::array::from_fn(|slot| {
                let [low, high] = [[0.0, 1.0], [-1.0, 2.0], [-2.0, -1.0], [0.0, 0.0]][slot % 4];
                SampledSpectrum::from_fn(|_| low + (high - low) * rng.f32())
            });
            for slot in 0..WIDTH {
                met.p.set(slot, rng.vec3());
                met.p_error.set(slot, rng.vec3());
                met.n.set(slot, rng.direction());
                met.dpdu.set(slot, rng.vec3());
                met.wo.set(slot, rng.direction());
                time[slot] = rng.f32();
                surfaces.reflectance.set(slot, albedos[slot]);
            }
            let here: [bool; WIDTH] = std::array::from_fn(|slot| (round + slot) % 3 != 0);
            let mut found = here.map(|is_here| u32::from(is_here).wrapping_neg());
            let (before, wo_before) = (from, wo);
            arrive(&met, &time, &mut found, &mut surfaces, &mut from, &mut wo);
            for slot in 0..WIDTH {
                let albedo = albedos[slot].clamp(0.0, 1.0);
                assert_eq!(found[slot] != 0, here[slot] && !albedo.is_black());
                let w = met.wo.get(slot);
                if !here[slot] {
                    assert_eq!((from.get(slot), wo.get(slot)), (before.get(slot), wo_before.get(slot)));
                    continue;
                }
                let (p, p_error, n) = (met.p.get(slot), met.p_error.get(slot), met.n.get(slot));
                let alone = ReferencePoint { p, p_error, n, ns: n, one_sided: true, time: time[slot] };
                from.one_sided[slot] = true;
                assert_eq!((from.get(slot), wo.get(slot)), (alone.seen_from(w), w));
                assert_eq!((surfaces.n.get(slot), surfaces.tangent.get(slot)), (n, met.dpdu.get(slot)));
                assert_eq!(surfaces.reflectance.get(slot), albedo);
            }
        }
    }
}
