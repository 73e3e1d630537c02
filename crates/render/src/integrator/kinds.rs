//! Scattering at surfaces of all kinds that are computed side by side.

use super::{boundary, even, metal, surfaces::Surfaces, vertices::Vertices, weights::Scattering};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Floats, Rays, Vec2s, Vec3s};

/// Scattering between the directions `wo` and `wi`, in the slots of these `vertices`; anything in the others.
pub(super) fn evaluate(
    surfaces: &Surfaces,
    vertices: &Vertices,
    wo: &Vec3s,
    wi: &Vec3s,
    out: &mut Scattering,
) {
    // The first may write to the slots of those that follow.
    if !vertices.even.is_empty() {
        even::evaluate(surfaces, wo, wi, out);
    }
    if !vertices.boundary.is_empty() {
        boundary::evaluate(&vertices.boundary.flags(), surfaces, wo, wi, out);
    }
    if !vertices.metal.is_empty() {
        metal::evaluate(&vertices.metal.flags(), surfaces, wo, wi, out);
    }
}

/// Rays that leave the surfaces, at the points `from`, in directions chosen by `u_lobe` and `u`, in the slots of these `vertices`; anything in the
/// others. What enters a body has `eta_scale` multiplied by its squared index.
pub(super) fn scatter(
    surfaces: &Surfaces,
    vertices: &Vertices,
    wo: &Vec3s,
    from: &ReferencePoints,
    u_lobe: &Floats,
    u: &Vec2s,
    rays: &mut Rays,
    eta_scale: &mut Floats,
    out: &mut Scattering,
) {
    if !vertices.even.is_empty() {
        even::scatter(surfaces, wo, from, u, rays, out);
    }
    if !vertices.boundary.is_empty() {
        boundary::scatter(&vertices.boundary.flags(), surfaces, wo, from, u_lobe, u, rays, eta_scale, out);
    }
    if !vertices.metal.is_empty() {
        metal::scatter(&vertices.metal.flags(), surfaces, wo, from, u, rays, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bxdf::{Bsdf, Bxdf, Conductor, Dielectric, Diffuse, Interface, TrowbridgeReitz, WideBxdf};
    use tenfold_geometry::ReferencePoint;
    use tenfold_math::{Frame, Vec2, WIDTH};
    use tenfold_spectrum::SampledSpectrum;
    use tenfold_testkit::Rng;

    /// A scattering function, as it is computed side by side and by itself.
    fn bxdf(kind: usize, rng: &mut Rng) -> (WideBxdf, Bxdf<'static>) {
        let distribution = TrowbridgeReitz::new(0.01 + 0.5 * rng.f32(), 0.01 + 0.5 * rng.f32());
        let spectrum = SampledSpectrum::from_fn(|_| 0.05 + rng.f32());
        match kind {
            0 => (WideBxdf::Diffuse(spectrum), Bxdf::Diffuse(Diffuse::new(spectrum))),
            1 => {
                let eta = 0.6 + rng.f32();
                let alone = Dielectric::new(SampledSpectrum::splat(eta), distribution);
                (WideBxdf::Dielectric(Interface::new(eta, distribution)), Bxdf::Dielectric(alone))
            }
            _ => {
                let metal = Conductor::new(spectrum, spectrum * 4.0, distribution);
                (WideBxdf::Conductor(metal), Bxdf::Conductor(metal))
            }
        }
    }

    #[test]
    fn slots_scatter_as_their_surfaces_do_by_themselves() {
        let mut rng = Rng::new(7);
        // By kind: samples that failed, were reflected and were transmitted; directions that scatter nothing, and something.
        let (mut samples, mut values) = ([[0; 3]; 3], [[0; 2]; 3]);
        for _ in 0..600 {
            let (mut surfaces, mut vertices) = (Surfaces::default(), Vertices::default());
            let (mut wo, mut wi, mut u) = (Vec3s::ZERO, Vec3s::ZERO, Vec2s::ZERO);
            let mut from = ReferencePoints::default();
            let u_lobe: Floats = std::array::from_fn(|_| rng.f32());
            let kinds: [usize; WIDTH] = std::array::from_fn(|_| rng.below(3));
            let bsdfs: [Bsdf<'_>; WIDTH] = std::array::from_fn(|slot| {
                let (wide, alone) = bxdf(kinds[slot], &mut rng);
                [&mut vertices.even, &mut vertices.boundary, &mut vertices.metal][kinds[slot]].insert(slot);
                let (n, tangent) = (rng.direction(), rng.direction());
                surfaces.set(slot, [n, tangent], &wide);
                // Some within the surface.
                let along = n.cross(tangent).normalize();
                wo.set(slot, if rng.below(20) == 0 { along } else { rng.direction() });
                wi.set(slot, rng.direction());
                u.set(slot, if rng.below(20) == 0 { Vec2::splat(0.5) } else { rng.vec2() });
                let p = rng.vec3();
                from.set(slot, ReferencePoint { p_error: 1e-6 * p, n, ..ReferencePoint::free(p, 0.25) });
                Bsdf::new(Frame::from_z_and_tangent(n, tangent), alone)
            });
            let mut found = Scattering::default();
            evaluate(&surfaces, &vertices, &wo, &wi, &mut found);
            for slot in 0..WIDTH {
                let alone = bsdfs[slot].eval_and_pdf(wo.get(slot), wi.get(slot));
                assert_eq!((found.f.get(slot), found.pdf.get(slot)), (alone.f, alone.pdf));
                assert_eq!(found.hero_pdf[slot], alone.pdf.lane(2));
                assert_eq!(found.cos[slot], wi.get(slot).dot(bsdfs[slot].frame().z).abs());
                values[kinds[slot]][usize::from(found.hero_pdf[slot] > 0.0)] += 1;
            }
            let (mut rays, mut eta_scale) = (Rays::default(), [3.0; WIDTH]);
            scatter(&surfaces, &vertices, &wo, &from, &u_lobe, &u, &mut rays, &mut eta_scale, &mut found);
            for slot in 0..WIDTH {
                let counts = &mut samples[kinds[slot]];
                let Some(alone) = bsdfs[slot].sample(wo.get(slot), u_lobe[slot], u.get(slot), 0) else {
                    assert_eq!(found.hero_pdf[slot], 0.0);
                    counts[0] += 1;
                    continue;
                };
                counts[if alone.lobe.is_reflective() { 1 } else { 2 }] += 1;
                assert_eq!(rays.get(slot), from.get(slot).spawn_ray(alone.wi));
                assert_eq!((found.f.get(slot), found.pdf.get(slot)), (alone.f, alone.pdf));
                assert_eq!(found.hero_pdf[slot], alone.pdf.lane(2));
                assert_eq!(found.cos[slot], alone.wi.dot(bsdfs[slot].frame().z).abs());
                assert_eq!(eta_scale[slot], 3.0 * (alone.eta * alone.eta));
            }
        }
        let [_, boundary, _] = samples;
        assert!(samples.iter().all(|s| s[0] > 20 && s[1] > 500) && boundary[2] > 500, "{samples:?}");
        assert!(values.iter().flatten().all(|&count| count > 500), "{values:?}");
    }
}
