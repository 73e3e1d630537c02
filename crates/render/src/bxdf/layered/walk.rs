use tenfold_math::ops;
use tenfold_math::{Vec2, Vec3};
use tenfold_sampling::hash::{mix_bits, unit_f32};
use tenfold_spectrum::SampledSpectrum;

use super::Layered;
use crate::bxdf::coat_table::attenuation;
use crate::bxdf::coated_diffuse::geometric_series;
use crate::bxdf::interface::{Interface, InterfaceSample};
use crate::bxdf::phase::HenyeyGreenstein;

/// Random numbers of one evaluation: SplitMix64 (Steele, Lea and Flood 2014) from a hash of its arguments.
pub(super) struct WalkRng(u64);

impl WalkRng {
    pub(super) fn new(wo: Vec3, wi: Vec3, seed: u64) -> Self {
        let mut state = Self(seed);
        for v in [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z] {
            state.0 = state.next() ^ u64::from(v.to_bits());
        }
        Self(state.next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix_bits(self.0)
    }

    /// In `[0, 1)`.
    fn f32(&mut self) -> f32 {
        unit_f32((self.next() >> 32) as u32)
    }

    fn vec2(&mut self) -> Vec2 {
        let bits = self.next();
        Vec2::new(unit_f32((bits >> 32) as u32), unit_f32(bits as u32))
    }
}

/// A walk of particles from `wo` through the coat, between the boundaries, and out to `wi`; both directions above.
pub(super) struct Walk<'a> {
    pub(super) layered: &'a Layered,
    /// The coat at the walk's wavelength.
    pub(super) interface: Interface,
    pub(super) wo: Vec3,
    pub(super) wi: Vec3,
}

impl Walk<'_> {
    /// One unbiased estimate of the BSDF below the coat's own reflection, times η².
    pub(super) fn run(&self, rng: &mut WalkRng) -> SampledSpectrum {
        let slab = &self.layered.slab;
        let (thickness, albedo) = (slab.thickness, slab.albedo);
        let phase = self.layered.has_medium().then(|| HenyeyGreenstein::new(slab.g));
        let mut sum = SampledSpectrum::ZERO;

        let Some(entered) = self.interface.sample_transmission(self.wo, rng.vec2()) else { return sum };
        // A direction toward which light leaves through the coat to `wi`: one for all connections of the walk.
        let leaving = self.interface.sample_transmission(self.wi, rng.vec2());

        let mut beta = SampledSpectrum::splat(entered.weight);
        let mut w = entered.wi;
        // Depth below the coat.
        let mut depth = 0.0;
        for step in 0..slab.max_depth {
            if step > 3 {
                let survival = beta.max_component();
                if survival < 0.25 {
                    if rng.f32() >= survival {
                        break;
                    }
                    beta /= survival;
                }
            }
            if w.z == 0.0 {
                break;
            }

            if let Some(phase) = &phase {
                let distance = -ops::ln(1.0 - rng.f32()) * w.z.abs();
                let next = if w.z < 0.0 { depth + distance } else { depth - distance };
                if next > 0.0 && next < thickness {
                    depth = next;
                    beta *= albedo;
                    if let Some(leaving) = &leaving {
                        sum += beta * self.scattered(phase, leaving, w, depth, slab.max_depth - 1 - step);
                    }
                    w = phase.sample(-w, rng.vec2());
                    sum += beta * self.escape(w, phase.density(-w, w), depth);
                    continue;
                }
                depth = if w.z < 0.0 { thickness } else { 0.0 };
            } else {
                beta *= attenuation(thickness, w);
                depth = if w.z < 0.0 { thickness } else { 0.0 };
            }

            if w.z > 0.0 {
                let Some(s) = self.interface.sample_reflection(-w, rng.vec2()) else { break };
                beta *= s.weight;
                w = s.wi;
            } else {
                let base = &self.layered.base;
                if let (Some(leaving), false) = (&leaving, base.is_smooth()) {
                    let b = base.scattering(-w, -leaving.wi);
                    sum += beta * b.f * self.connection(leaving, b.pdf.lane(0), thickness);
                }
                let Some(s) = base.sample(-w, rng.vec2()) else { break };
                let pdf = s.pdf.lane(0);
                beta *= s.f * (s.wi.z.abs() / pdf);
                w = s.wi;
                let pdf = if base.is_smooth() { f32::INFINITY } else { pdf };
                sum += beta * self.escape(w, pdf, thickness);
            }
            if beta.is_black() {
                break;
            }
        }
        sum
    }

    /// Value of scattering by the medium from the direction of travel `w` at `depth`, and leaving without any more of it.
    ///
    /// Where both boundaries are smooth, paths that go on by mirror reflections alone end in a delta: no later
    /// connection finds them. They all travel along `leaving` or its mirror image, and sum to geometric series, cut
    /// where the walk's `remaining` steps end.
    fn scattered(
        &self,
        phase: &HenyeyGreenstein,
        leaving: &InterfaceSample,
        w: Vec3,
        depth: f32,
        remaining: u32,
    ) -> SampledSpectrum {
        let up = -leaving.wi;
        let p = phase.density(-w, up);
        let direct = p / up.z * self.connection(leaving, p, depth);
        let base = &self.layered.base;
        if !(self.interface.is_smooth() && base.is_smooth()) {
            return SampledSpectrum::splat(direct);
        }
        let thickness = self.layered.slab.thickness;
        let down = Vec3::new(up.x, up.y, -up.z);
        let crossing = attenuation(thickness, up);
        let mirror = base.albedo(up);
        let mirrored = phase.density(-w, down) / up.z * leaving.weight * attenuation(thickness - depth, up);
        // From the coat back to it: reflected there, attenuated twice, reflected by the base.
        let cycle = mirror * ((1.0 - leaving.weight) * crossing * crossing);
        direct * geometric_series(cycle, remaining / 2 + 1)
            + mirror * (mirrored * crossing) * geometric_series(cycle, remaining.div_ceil(2))
    }

    /// Weight of the connection along `leaving` from `depth`, where scattering would sample it with density `other`.
    fn connection(&self, leaving: &InterfaceSample, other: f32, depth: f32) -> f32 {
        let share = if self.interface.is_smooth() { 1.0 } else { power_heuristic(leaving.pdf, other) };
        share * leaving.weight * attenuation(depth, leaving.wi)
    }

    /// Value of going out to `wi` at once along the scattered direction `w`, sampled with density `pdf` at `depth`.
    ///
    /// The other strategy samples `-w` from `wi`, so its density `p(wi → -w)` is the one to weigh against. *Deviation:*
    /// pbrt-v4 (`exitPDF` in `LayeredBxDF::f`) takes `p(-w → wi)`, which is smaller by
    /// `η² cos θ' G₁(wi) / (cos θ G₁(w))`. Its weights sum to more than one, and its values of light seen through a rough
    /// coat come out brighter: for a Lambertian base under η = 1.5 by 2 to 5 % at α = 0.1, 7 to 13 % at α = 0.4.
    /// It also gives up a walk that finds no direction `leaving`, which has the other sign and is rarer.
    fn escape(&self, w: Vec3, pdf: f32, depth: f32) -> f32 {
        if w.z <= 0.0 || self.interface.is_smooth() {
            return 0.0;
        }
        let out = self.interface.transmission(self.wi, -w);
        if out.f == 0.0 {
            return 0.0;
        }
        power_heuristic(pdf, out.pdf) * out.f * attenuation(depth, w)
    }
}

/// Share of the first of two strategies (Veach 1997, §9.2.4); an infinite density is a delta's.
#[inline]
fn power_heuristic(a: f32, b: f32) -> f32 {
    if a.is_infinite() {
        return 1.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
