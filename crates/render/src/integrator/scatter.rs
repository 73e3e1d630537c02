//! Where paths go on to, and whether.

use super::{
    PathTracer, Sample, Workspace, kinds,
    path::{Path, Waiting},
    spectral::Lanes,
    vertices::Vertices,
    weights::{Weights, advance},
};
use crate::bxdf::{Bsdf, BsdfSample, Lobe};
use tenfold_geometry::ReferencePoint;
use tenfold_math::{Slots, Vec3, WIDTH};
use tenfold_sampling::{Dimension, SampleGroup, Variable};
use tenfold_spectrum::N;

impl<'a> PathTracer<'a> {
    /// Sends the paths on; the slots of those that go on.
    pub(super) fn scatter(
        &self,
        vertices: &Vertices,
        group: &SampleGroup<'_>,
        samples: &[Sample<'_>],
        workspace: &mut Workspace<'a>,
    ) -> Slots {
        let Workspace { wave, scattering, pending, .. } = workspace;
        let together = vertices.other.without(vertices.parting);
        let u = wave.numbers_2d(group, vertices.wide().or(together), Dimension::scatter_direction);
        let choosing = together.keep(|slot| wave.bsdfs[slot].as_ref().is_some_and(Bsdf::chooses_lobe));
        let u_lobe = wave.numbers_1d(group, vertices.boundary.or(choosing), Dimension::scatter_lobe);
        let (surfaces, rays) = (&wave.surfaces, &mut wave.rays);
        let eta_scale = &mut wave.weights.eta_scale;
        kinds::scatter(surfaces, vertices, &wave.wo, &wave.from, &u_lobe, &u, rays, eta_scale, scattering);
        let mut scattered = vertices.wide().keep(|slot| scattering.hero_pdf[slot] > 0.0);
        for slot in vertices.other {
            let Some(bsdf) = &wave.bsdfs[slot] else { continue };
            let path = &mut wave.paths[slot];
            let (wo, from) = (wave.wo.get(slot), wave.from.get(slot));
            if vertices.parting.contains(slot) {
                self.part(slot, path, &wave.weights.get(slot), wo, &from, bsdf, &samples[slot], pending);
                continue;
            }
            let Some(s) = &bsdf.sample(wo, u_lobe[slot], u.get(slot), path.lanes.hero()) else { continue };
            scattering.set(slot, s.f, s.pdf, path.lanes.hero(), s.wi.dot(bsdf.frame().z).abs());
            wave.weights.eta_scale[slot] *= s.eta * s.eta;
            path.specular = s.lobe.is_specular();
            wave.rays.set(slot, from.spawn_ray(s.wi));
            scattered.insert(slot);
        }
        let mut carried = [0.0; WIDTH];
        advance(&mut wave.weights, scattering, &mut carried);
        vertices.wide().for_each(|slot| wave.paths[slot].specular = false);
        let mut chances = [0.0; WIDTH];
        for slot in scattered {
            let path = &mut wave.paths[slot];
            path.bounce += 1;
            chances[slot] = survival(path, carried[slot], &samples[slot]);
        }
        let at_stake = scattered.keep(|slot| chances[slot] > 0.0 && chances[slot] < 1.0);
        let u = wave.numbers_1d(group, at_stake, Dimension::roulette);
        at_stake.for_each(|slot| wave.weights.strengthen(slot, chances[slot]));
        scattered.keep(|slot| survives(chances[slot], || u[slot]))
    }

    /// Sends every lane of a settled path its own way. Lanes that are reflected stay together: reflection does not
    /// disperse.
    fn part(
        &self,
        slot: usize,
        path: &Path,
        weights: &Weights,
        wo: Vec3,
        from: &ReferencePoint,
        bsdf: &Bsdf<'_>,
        sample: &Sample<'_>,
        pending: &mut Vec<Waiting>,
    ) {
        let mut push = |lanes: Lanes, mut weights: Weights, s: &BsdfSample| {
            let specular = s.lobe.is_specular();
            let path = Path { lanes, bounce: path.bounce + 1, specular };
            weights.eta_scale *= s.eta * s.eta;
            let chance = survival(&path, weights.carried(&lanes), sample);
            if survives(chance, || sample.sampler.get_1d(Dimension::roulette(path.bounce))) {
                weights.beta /= chance;
                pending.push(Waiting { slot, path, weights, ray: from.spawn_ray(s.wi), from: *from });
            }
        };
        // All lanes use the same random numbers: as dispersion tends to zero, so do their differences.
        let u_lobe = sample.sampler.get_1d(Dimension::scatter_lobe(path.bounce));
        let u = sample.sampler.get_2d(Dimension::scatter_direction(path.bounce));
        let mut reflected = 0u8;
        let mut reflection: Option<BsdfSample> = None;
        for lane in (0..N).filter(|&lane| path.lanes.carries(lane)) {
            let Some(s) = bsdf.sample(wo, u_lobe, u, lane) else { continue };
            if s.lobe.contains(Lobe::REFLECTION) && s.lobe.is_specular() {
                reflected |= 1 << lane;
                // Per lane its own weight and probability, whichever lanes were reflected.
                let joint = reflection.get_or_insert(s);
                joint.f.set_lane(lane, s.f.lane(lane));
                joint.pdf.set_lane(lane, s.pdf.lane(lane));
                continue;
            }
            let lanes = Lanes::one(lane);
            let mut child = weights.with_lanes(&lanes);
            child.advance(s.f, s.pdf, s.pdf.lane(lane), s.wi.dot(bsdf.frame().z).abs());
            push(lanes, child, &s);
        }
        if let Some(s) = reflection {
            let u_hero = sample.sampler.get_1d(Dimension::hero(path.bounce));
            let lanes = Lanes::subset(reflected, u_hero);
            let mut child = weights.with_lanes(&lanes);
            // Each lane was reflected by its own choice: its own probability divides it, and nothing is left to weigh.
            child.beta = (child.beta * s.f * s.wi.dot(bsdf.frame().z).abs()).safe_div(s.pdf);
            push(lanes, child, &s);
        }
    }
}

/// What paths must carry to go on in any case.
const SAFE: f32 = 0.25;

/// Russian roulette (Arvo and Kirk 1990): ends paths that carry little, and strengthens the others in turn.
///
/// Most of the cost of a path is in its first vertices, and most of the noise of roulette comes from ending paths that carry much:
/// chances in proportion to what is carried, up to 1 at a quarter, were the best of those tried.
///
/// The chance with which a path that carries `carried` at most goes on.
#[inline]
fn survival(path: &Path, carried: f32, sample: &Sample<'_>) -> f32 {
    if carried == 0.0 {
        return 0.0;
    }
    if path.bounce < 2 || carried >= SAFE || sample.sampler.held(Variable::Roulette).is_some() {
        return 1.0;
    }
    (carried / SAFE).max(0.05)
}

/// Whether a path goes on whose chance that is; those that go on in any case need no number.
#[inline]
fn survives(chance: f32, u: impl FnOnce() -> f32) -> bool {
    chance == 1.0 || u() < chance
}
