//! Light sampled for many points side by side.

use super::lights::{Choice, Lights};
use super::{DiffuseAreaLight, Light, LightSample, LightStrategy, ShadowRay};
use tenfold_geometry::{Balls, Facets, ReferencePoints, SHADOW_T_MAX, ShapeSamples, ray_between};
use tenfold_math::{Floats, Id, Rays, Slots, Vec2, Vec2s, Vec3s, WIDTH, prefetch, vectorized};
use tenfold_spectrum::{SampledWavelengths, Spectra};

/// With fewer points that see the same light, each is served by itself.
const WORTHWHILE: usize = 3;

/// What a [`LightSample`] says, and its shadow ray, in each slot that has one.
#[derive(Clone, Debug, Default)]
pub struct LightSamples {
    /// See [`LightSample::radiance`].
    pub radiance: Spectra,
    /// See [`LightSample::wi`].
    pub wi: Vec3s,
    /// See [`LightSample::pdf`].
    pub pdf: Floats,
    /// See [`LightSample::delta`].
    pub delta: [bool; WIDTH],
    /// See [`LightSample::shadow_ray`].
    pub shadow: Rays,
    /// See [`ShadowRay::t_max`].
    pub t_max: Floats,
    /// Room for points on lights, the lights that are balls, and those that are far triangles.
    points: ShapeSamples,
    balls: Balls,
    facets: Facets,
}

impl LightSamples {
    #[inline]
    fn set(&mut self, slot: usize, sample: &LightSample, shadow: ShadowRay) {
        self.radiance.set(slot, sample.radiance);
        self.wi.set(slot, sample.wi);
        self.pdf[slot] = sample.pdf;
        self.delta[slot] = sample.delta;
        self.shadow.set(slot, shadow.ray);
        self.t_max[slot] = shadow.t_max;
    }
}

impl Lights {
    /// [`Lights::sample`] for the points `from` in `slots`, and the slots for which there is light. The numbers of the slots are in
    /// `u_choice` and `u`, and `wavelengths` tells theirs.
    pub fn samples<'w>(
        &self,
        strategy: LightStrategy,
        slots: Slots,
        from: &ReferencePoints,
        u_choice: &Floats,
        u: &Vec2s,
        wavelengths: impl Fn(usize) -> &'w SampledWavelengths,
        out: &mut LightSamples,
    ) -> Slots {
        let mut choices = [const { Choice { light: 0, pmf: 0.0 } }; WIDTH];
        let (mut left, mut balls) = (Slots::NONE, Slots::NONE);
        self.choose_for(strategy, slots, from, u_choice, |slot, choice| {
            prefetch(self.get(Id::new(choice.light)));
            choices[slot] = choice;
            left.insert(slot);
        });
        let mut facets = [None; WIDTH];
        for slot in left {
            let Some(area) = self.area(&choices[slot]) else { continue };
            area.prefetch();
            if !area.is_sampled_evenly(strategy) {
                continue;
            }
            let primitive = area.primitive();
            facets[slot] = primitive.facet();
            if let Some(ball) = primitive.ball() {
                out.balls.set(slot, ball);
                balls.insert(slot);
            }
        }
        let mut lit = Slots::NONE;
        if balls.len() >= WORTHWHILE {
            let seen = out.balls.samples_from(balls, from, u, &mut out.points);
            lit = self.arriving(seen, &choices, from, &wavelengths, out);
            left = left.without(seen);
        }
        let far = left.keep(|slot| match facets[slot] {
            Some(facet) if facet.is_far(from.p.get(slot)) => {
                out.facets.set(slot, facet);
                true
            }
            _ => false,
        });
        if far.len() >= WORTHWHILE {
            out.facets.samples_from(from, u, &mut out.points);
            lit = lit.or(self.arriving(far, &choices, from, &wavelengths, out));
            left = left.without(far);
        }
        while let Some(first) = left.into_iter().next() {
            let light = choices[first].light;
            let same = left.keep(|slot| choices[slot].light == light);
            left = left.without(same);
            if same.len() >= WORTHWHILE
                && let Some(area) = self.area(&choices[first])
                && area.points_from(strategy, same, from, u, &mut out.points)
            {
                lit = lit.or(self.arriving(same, &choices, from, &wavelengths, out));
                continue;
            }
            for slot in same {
                let point = from.get(slot);
                let sample =
                    self.sample_chosen(strategy, &choices[slot], &point, u.get(slot), wavelengths(slot));
                if let Some(sample) = &sample {
                    out.set(slot, sample, sample.shadow_ray(&point));
                    lit.insert(slot);
                }
            }
        }
        lit
    }

    /// Light from the points that were sampled for `slots` on area lights that emit the same everywhere, and the slots for which there is any.
    fn arriving<'w>(
        &self,
        slots: Slots,
        choices: &[Choice; WIDTH],
        from: &ReferencePoints,
        wavelengths: impl Fn(usize) -> &'w SampledWavelengths,
        out: &mut LightSamples,
    ) -> Slots {
        let (mut seen, mut two_sided) = ([false; WIDTH], [false; WIDTH]);
        for slot in slots {
            if let Some(area) = self.area(&choices[slot]) {
                (seen[slot], two_sided[slot]) = (true, area.is_two_sided());
            }
        }
        aim(from, &two_sided, out, &mut seen);
        let mut lit = Slots::NONE;
        for slot in slots.keep(|slot| seen[slot]) {
            let Some(area) = self.area(&choices[slot]) else { continue };
            out.pdf[slot] = out.points.pdf[slot] * choices[slot].pmf;
            out.delta[slot] = area.is_invisible();
            let radiance = area.radiance(Vec2::ZERO, wavelengths(slot));
            out.radiance.set(slot, radiance);
            if out.pdf[slot] > 0.0 && !radiance.is_black() {
                lit.insert(slot);
            }
        }
        lit
    }

    /// A light that was chosen, where it is an area light.
    #[inline]
    fn area(&self, choice: &Choice) -> Option<&DiffuseAreaLight> {
        match self.get(Id::new(choice.light)) {
            Light::Area(area) => Some(area),
            _ => None,
        }
    }
}

vectorized! {
    /// Directions and shadow rays to points on a light, in the slots that are `seen`: it stays so where there is a point, and on a side that emits.
    fn aim(from: &ReferencePoints, two_sided: &[bool; WIDTH], out: &mut LightSamples, seen: &mut [bool; WIDTH]) {
        for i in 0..WIDTH {
            let (start, start_error, start_n) = (from.p.get(i), from.p_error.get(i), from.n.get(i));
            let (end, end_error, end_n) = (out.points.p.get(i), out.points.p_error.get(i), out.points.n.get(i));
            let to_light = end - start;
            let distance_squared = to_light.length_squared();
            let wi = to_light / distance_squared.sqrt();
            let shadow = ray_between(start, start_error, start_n, end, end_error, end_n, from.time[i]);
            // Other slots may have light of other kinds already.
            let was_seen = seen[i];
            out.wi.set(i, if was_seen { wi } else { out.wi.get(i) });
            let faces = two_sided[i] | (end_n.dot(-wi) > 0.0);
            seen[i] = was_seen & faces & (distance_squared != 0.0) & (out.points.pdf[i] > 0.0);
            out.shadow.set(i, if was_seen { shadow } else { out.shadow.get(i) });
            out.t_max[i] = if was_seen { SHADOW_T_MAX } else { out.t_max[i] };
        }
    }
}
