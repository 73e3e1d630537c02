//! Even reflectors side by side: what [`Bsdf`](crate::bxdf::Bsdf) does for a [`Diffuse`](crate::bxdf::Diffuse) surface, to the bit, in vector
//! instructions.

use super::{wave::EvenReflectors, weights::Scattering};
use crate::bxdf::{Diffuse, HORIZON};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Frame, Rays, Vec2s, Vec3s, WIDTH, offset_ray_origin, vectorized};
use tenfold_sampling::warp;
use tenfold_spectrum::N;

vectorized! {
    /// Scattering between the directions `wo` and `wi`.
    pub(super) fn evaluate(surfaces: &EvenReflectors, wo: &Vec3s, wi: &Vec3s, out: &mut Scattering) {
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
        surfaces: &EvenReflectors,
        wo: &Vec3s,
        from: &ReferencePoints,
        u: &Vec2s,
        rays: &mut Rays,
        out: &mut Scattering,
    ) {
        for i in 0..WIDTH {
            let frame = Frame::from_z_and_tangent(surfaces.n.get(i), surfaces.tangent.get(i));
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
fn set(surfaces: &EvenReflectors, slot: usize, reflects: bool, z: f32, cos: f32, out: &mut Scattering) {
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
    use crate::bxdf::{Bsdf, Bxdf};
    use tenfold_geometry::ReferencePoint;
    use tenfold_math::{Vec2, Vec3};
    use tenfold_spectrum::SampledSpectrum;
    use tenfold_testkit::Rng;

    #[test]
    fn slots_scatter_as_their_surfaces_do_by_themselves() {
        let mut rng = Rng::new(7);
        let mut counts = [0; 2];
        for _ in 0..300 {
            let mut surfaces = EvenReflectors::default();
            let (mut wo, mut wi, mut u) = (Vec3s::ZERO, Vec3s::ZERO, Vec2s::ZERO);
            let mut from = ReferencePoints::default();
            let bsdfs: [Bsdf<'_>; WIDTH] = std::array::from_fn(|slot| {
                let (n, tangent) = (rng.direction(), rng.direction());
                let reflectance = SampledSpectrum::from_fn(|_| rng.f32());
                surfaces.n.set(slot, n);
                surfaces.tangent.set(slot, tangent);
                surfaces.reflectance.set(slot, reflectance);
                // Some within the surface.
                let along = n.cross(tangent).normalize();
                wo.set(slot, if rng.below(20) == 0 { along } else { rng.direction() });
                wi.set(slot, rng.direction());
                u.set(slot, if rng.below(20) == 0 { Vec2::splat(0.5) } else { rng.vec2() });
                let p = rng.vec3();
                from.set(slot, ReferencePoint { p_error: 1e-6 * p, n, ..ReferencePoint::free(p, 0.25) });
                Bsdf::new(Frame::from_z_and_tangent(n, tangent), Bxdf::Diffuse(Diffuse::new(reflectance)))
            });
            let mut found = Scattering::default();
            evaluate(&surfaces, &wo, &wi, &mut found);
            for slot in 0..WIDTH {
                let alone = bsdfs[slot].eval_and_pdf(wo.get(slot), wi.get(slot));
                assert_eq!((found.f.get(slot), found.pdf.get(slot)), (alone.f, alone.pdf));
                assert_eq!(found.hero_pdf[slot], alone.pdf.lane(2));
                assert_eq!(found.cos[slot], wi.get(slot).dot(bsdfs[slot].frame().z).abs());
            }
            let mut rays = Rays::default();
            scatter(&surfaces, &wo, &from, &u, &mut rays, &mut found);
            for slot in 0..WIDTH {
                let alone = bsdfs[slot].sample(wo.get(slot), 0.0, u.get(slot), 0);
                counts[usize::from(alone.is_some())] += 1;
                let Some(alone) = alone else {
                    assert_eq!(found.hero_pdf[slot], 0.0);
                    continue;
                };
                assert_eq!(rays.get(slot), from.get(slot).spawn_ray(alone.wi));
                assert_eq!((found.f.get(slot), found.pdf.get(slot)), (alone.f, alone.pdf));
                assert_eq!(found.cos[slot], Vec3::dot(alone.wi, bsdfs[slot].frame().z).abs());
            }
        }
        assert!(counts[1] > 4000, "{counts:?}");
    }
}
