//! All lights of a scene.

use super::choice::{Entry, LightTree, MAX_LIGHTS, TreeSample};
use super::far::FarIrradiance;
use super::{Light, LightSample, LightStrategy, Role};
use tenfold_geometry::{ReferencePoint, ReferencePoints, SurfaceInteraction};
use tenfold_math::{Floats, Id, Slots, Vec2, Vec3};
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

/// All lights of a scene: which of them to sample, and what a path finds by itself.
///
/// Lights that are somewhere are chosen by a light tree, with bounds on what each group can send to the
/// point; those infinitely far away stand beside the tree as one candidate each. Every density is exact:
/// [`Lights::pdf_hit`] and [`Lights::pdf_escaped`] are what [`Lights::sample`] gives for the same point. The
/// importance of a light is 0 only where none of its light arrives that matters there ([`ReferencePoint::one_sided`]);
/// lights that emit nothing are never chosen.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    all: Vec<Light>,
    tree: LightTree,
    far: Vec<FarLight>,
    /// The same without what comes from all directions alike.
    uneven: Vec<FarLight>,
    skies: Vec<Id<Light>>,
}

/// A candidate beside the tree.
#[derive(Copy, Clone, Debug)]
struct FarLight {
    light: u32,
    irradiance: FarIrradiance,
}

/// The chances of the candidates beside each other: one for the tree, if it has any light to offer, and one
/// for each far light that has. A quarter of the probability goes to them evenly, so that one that only seems
/// faint (because the others are hidden) still gets its share, and the rest in proportion to their importance.
#[derive(Copy, Clone, Debug)]
struct Candidates {
    tree: f32,
    total: f32,
    count: f32,
}

/// What part of the probability candidates get evenly.
const EVENLY: f32 = 0.25;

impl Candidates {
    /// Probability of a candidate of this importance.
    #[inline]
    fn probability(&self, importance: f32) -> f32 {
        if importance <= 0.0 {
            return 0.0;
        }
        if self.count == 1.0 {
            return 1.0;
        }
        EVENLY / self.count + (1.0 - EVENLY) * (importance / self.total)
    }
}

/// A light that was chosen.
pub(super) struct Choice {
    pub(super) light: usize,
    pub(super) pmf: f32,
}

impl Lights {
    /// Prepares the choice among `lights`, whose ids are their indices. Takes O(n log n). Lights beyond 2²⁷
    /// are never sampled.
    pub fn build(lights: Vec<Light>) -> Self {
        let (mut entries, mut far, mut uneven) = (Vec::new(), Vec::new(), Vec::new());
        for (i, light) in lights.iter().enumerate().take(MAX_LIGHTS) {
            match light.role() {
                Role::Local(bounds) if bounds.intensity > 0.0 => {
                    entries.push(Entry { bounds, light: i as u32 });
                }
                Role::Far { whole, uneven: part } if whole.is_some() => {
                    let of = |irradiance| FarLight { light: i as u32, irradiance };
                    far.push(of(whole));
                    uneven.extend(part.map(of));
                }
                Role::Local(_) | Role::Far { .. } => {}
            }
        }
        let tree = LightTree::build(&mut entries, lights.len());
        let sky = |(i, l): (usize, &Light)| l.is_sky().then(|| Id::new(i));
        let skies = lights.iter().enumerate().filter_map(sky).collect();
        Self { all: lights, tree, far, uneven, skies }
    }

    /// How many lights there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is no light.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// How many lights [`Lights::sample`] by `strategy` chooses among: with one there is nothing to choose, with none nothing to sample.
    #[inline]
    pub fn sampled(&self, strategy: LightStrategy) -> usize {
        self.tree.len() + self.far(strategy).len()
    }

    /// The light of an id.
    #[inline]
    pub fn get(&self, light: Id<Light>) -> &Light {
        &self.all[light.index()]
    }

    /// The lights that rays meet when they leave the scene.
    #[inline]
    pub fn infinite(&self) -> &[Id<Light>] {
        &self.skies
    }

    /// Light that may arrive at `from`, by `u_choice` in `[0, 1)` and `u` in `[0, 1)²`, from a point that `strategy`
    /// chooses. `None` where no light can be found, or the attempt failed: an estimate of 0.
    #[inline]
    pub fn sample(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        u_choice: f32,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> Option<LightSample> {
        let choice = self.choose(strategy, from, u_choice)?;
        self.sample_chosen(strategy, &choice, from, u, w)
    }

    /// [`Lights::sample`] where the light is chosen.
    #[inline]
    pub(super) fn sample_chosen(
        &self,
        strategy: LightStrategy,
        choice: &Choice,
        from: &ReferencePoint,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> Option<LightSample> {
        let mut sample = self.all[choice.light].sample(strategy, from, u, w)?;
        sample.pdf *= choice.pmf;
        (sample.pdf > 0.0).then_some(sample)
    }

    /// The radiance, in W·m⁻²·sr⁻¹·nm⁻¹, that the area light `light` sends toward `wo` from the point `hit`
    /// of its surface.
    #[inline]
    pub fn emitted(
        &self,
        light: Id<Light>,
        hit: &SurfaceInteraction,
        wo: Vec3,
        w: &SampledWavelengths,
    ) -> SampledSpectrum {
        match self.get(light) {
            Light::Area(l) => l.emitted(hit.n, hit.uv, wo, w),
            _ => SampledSpectrum::ZERO,
        }
    }

    /// The density with which [`Lights::sample`] by `strategy` would have found, from `from`, the point `hit` on
    /// the area light `light` in the unit direction `wi`.
    #[inline]
    pub fn pdf_hit(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        light: Id<Light>,
        hit: &SurfaceInteraction,
        wi: Vec3,
    ) -> f32 {
        let Light::Area(l) = self.get(light) else { return 0.0 };
        if !l.emits_toward(hit.n, -wi) {
            return 0.0;
        }
        let pmf = self.pmf(strategy, from, light);
        if pmf == 0.0 { 0.0 } else { pmf * l.pdf(strategy, from, &hit.surface_point()) }
    }

    /// The radiance, in W·m⁻²·sr⁻¹·nm⁻¹, of the infinite light `light` from the unit `direction`.
    #[inline]
    pub fn escaped(&self, light: Id<Light>, direction: Vec3, w: &SampledWavelengths) -> SampledSpectrum {
        self.get(light).escaped(direction, w)
    }

    /// The density with which [`Lights::sample`] by `strategy` would have found, from `from`, the unit `direction` of
    /// the infinite light `light`.
    #[inline]
    pub fn pdf_escaped(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        light: Id<Light>,
        direction: Vec3,
    ) -> f32 {
        let pmf = self.pmf(strategy, from, light);
        if pmf == 0.0 { 0.0 } else { pmf * self.get(light).pdf_escaped(strategy, from, direction) }
    }

    /// The probability with which [`Lights::sample`] by `strategy` chooses `light` at `from`.
    #[inline]
    pub fn pmf(&self, strategy: LightStrategy, from: &ReferencePoint, light: Id<Light>) -> f32 {
        let (light, all_far) = (light.index(), self.far(strategy));
        if self.tree.contains(light) {
            let in_tree = self.tree.pmf(from, light);
            if all_far.is_empty() || in_tree == 0.0 {
                return in_tree;
            }
            let candidates = self.candidates(all_far, from);
            return candidates.probability(candidates.tree) * in_tree;
        }
        match all_far.iter().find(|far| far.light as usize == light) {
            Some(far) => self.candidates(all_far, from).probability(far.irradiance.at(from)),
            None => 0.0,
        }
    }

    /// The candidates beside the tree.
    #[inline]
    fn far(&self, strategy: LightStrategy) -> &[FarLight] {
        match strategy {
            LightStrategy::Complementary => &self.uneven,
            _ => &self.far,
        }
    }

    #[inline]
    fn candidates(&self, all_far: &[FarLight], from: &ReferencePoint) -> Candidates {
        let tree = self.tree.importance(from);
        let mut candidates = Candidates { tree, total: tree, count: if tree > 0.0 { 1.0 } else { 0.0 } };
        for far in all_far {
            let importance = far.irradiance.at(from);
            if importance > 0.0 {
                candidates.total += importance;
                candidates.count += 1.0;
            }
        }
        candidates
    }

    /// [`Lights::choose`] for the points `from` in `slots`: `take` is called for those that find a light.
    #[inline]
    pub(super) fn choose_for(
        &self,
        strategy: LightStrategy,
        slots: Slots,
        from: &ReferencePoints,
        u: &Floats,
        mut take: impl FnMut(usize, Choice),
    ) {
        if self.far(strategy).is_empty() {
            let of = |sample: TreeSample| Choice { light: sample.light as usize, pmf: sample.pmf };
            return self.tree.samples(slots, from, u, |slot, sample| take(slot, of(sample)));
        }
        for slot in slots {
            if let Some(choice) = self.choose(strategy, &from.get(slot), u[slot]) {
                take(slot, choice);
            }
        }
    }

    /// A light for the point `from`, by `u` in `[0, 1)`.
    #[inline]
    pub(super) fn choose(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        mut u: f32,
    ) -> Option<Choice> {
        let mut p_tree = 1.0;
        let all_far = self.far(strategy);
        if !all_far.is_empty() {
            let candidates = self.candidates(all_far, from);
            let mut chosen = None;
            for far in all_far {
                let pmf = candidates.probability(far.irradiance.at(from));
                if pmf > 0.0 {
                    chosen = Some(Choice { light: far.light as usize, pmf });
                    if u < pmf {
                        return chosen;
                    }
                    u -= pmf;
                }
            }
            p_tree = candidates.probability(candidates.tree);
            if p_tree == 0.0 {
                // Rounding alone leads past the last far light.
                return chosen;
            }
            u = (u / p_tree).clamp(0.0, tenfold_math::ONE_MINUS_EPSILON);
        }
        let chosen = self.tree.sample(from, u)?;
        Some(Choice { light: chosen.light as usize, pmf: p_tree * chosen.pmf })
    }
}
