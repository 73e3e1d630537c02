use super::{
    CombineStrategy, Sample, even,
    path::{Path, Waiting},
    spectral::Lanes,
    surfaces::Surfaces,
    vertices::Vertices,
    weights::{WaveWeights, Weights},
};
use crate::bxdf::{Bsdf, WideBxdf};
use tenfold_geometry::{PlainSurfaces, ReferencePoint, ReferencePoints};
use tenfold_math::{Floats, Rays, Slots, Vec2s, Vec3, Vec3s, WIDTH};
use tenfold_sampling::{Dimension, SampleGroup};
use tenfold_spectrum::{SampledSpectrum, Spectra, SpectraToEvaluate};

/// Paths side by side, each in the slot of its sample, which take every step together: what is the same for all of them is done in vector
/// instructions.
#[derive(Debug)]
pub(super) struct Wave<'a> {
    pub(super) paths: [Path; WIDTH],
    /// Whether all have come equally far.
    in_step: bool,
    pub(super) weights: WaveWeights,
    /// The wavelengths of the samples, in nm.
    pub(super) lambda: Spectra,
    /// Where the paths go next.
    pub(super) rays: Rays,
    /// Their last vertices.
    pub(super) from: ReferencePoints,
    /// Unit directions from there to where they came from.
    pub(super) wo: Vec3s,
    /// The surfaces at these vertices, where their scattering is computed side by side.
    pub(super) surfaces: Surfaces,
    /// How light is scattered at the others.
    pub(super) bsdfs: [Option<Bsdf<'a>>; WIDTH],
}

impl Default for Wave<'_> {
    fn default() -> Self {
        Self {
            paths: [Path::from_camera(); WIDTH],
            in_step: true,
            weights: WaveWeights::default(),
            lambda: Spectra::ZERO,
            rays: Rays::default(),
            from: ReferencePoints::default(),
            wo: Vec3s::ZERO,
            surfaces: Surfaces::default(),
            bsdfs: [const { None }; WIDTH],
        }
    }
}

impl Wave<'_> {
    /// Puts the paths of `samples` that start at the camera, with the first of `rays`, into the first slots.
    #[inline]
    pub(super) fn start(&mut self, samples: &[Sample<'_>], rays: &Rays) -> Slots {
        self.paths = [Path::from_camera(); WIDTH];
        (0..WIDTH).for_each(|slot| self.weights.set(slot, &Weights::ONE, &Lanes::ALL));
        samples.iter().enumerate().for_each(|(i, s)| self.lambda.set_array(i, s.wavelengths.lambda()));
        self.rays = *rays;
        self.in_step = true;
        Slots::first(samples.len())
    }

    /// Takes the last of each sample's `waiting` paths.
    pub(super) fn resume(&mut self, waiting: &mut Vec<Waiting>) -> Slots {
        self.in_step = false;
        let mut last = [None; WIDTH];
        waiting.iter().enumerate().for_each(|(i, w)| last[w.slot] = Some(i));
        let mut slots = Slots::NONE;
        for (slot, i) in last.into_iter().enumerate() {
            let Some(Waiting { path, weights, ray, from, .. }) = i.map(|i| waiting[i]) else { continue };
            self.paths[slot] = path;
            self.weights.set(slot, &weights, &path.lanes);
            self.rays.set(slot, ray);
            self.from.set(slot, from);
            slots.insert(slot);
        }
        let mut i = 0..;
        waiting.retain(|w| i.next() != last[w.slot]);
        slots
    }

    /// The number of a dimension at the vertices where paths are, for those in `slots`.
    #[inline]
    pub(super) fn numbers_1d(
        &self,
        group: &SampleGroup<'_>,
        slots: Slots,
        dimension: impl Fn(u16) -> Dimension,
    ) -> Floats {
        if self.in_step
            && let Some(first) = slots.into_iter().next()
        {
            return group.get_1d(slots, dimension(self.paths[first].bounce));
        }
        let mut numbers = [0.0; WIDTH];
        for slot in slots {
            numbers[slot] = group[slot].get_1d(dimension(self.paths[slot].bounce));
        }
        numbers
    }

    /// Both numbers of a dimension at the vertices where paths are, for those in `slots`.
    #[inline]
    pub(super) fn numbers_2d(
        &self,
        group: &SampleGroup<'_>,
        slots: Slots,
        dimension: impl Fn(u16) -> Dimension,
    ) -> Vec2s {
        if self.in_step
            && let Some(first) = slots.into_iter().next()
        {
            return group.get_2d(slots, dimension(self.paths[first].bounce));
        }
        let mut numbers = Vec2s::ZERO;
        for slot in slots {
            numbers.set(slot, group[slot].get_2d(dimension(self.paths[slot].bounce)));
        }
        numbers
    }

    /// [`Path::carried`] of the path in a slot.
    #[inline]
    pub(super) fn carried(
        &self,
        slot: usize,
        combine: CombineStrategy,
        emitted: SampledSpectrum,
        light_pdf: impl FnOnce() -> f32,
    ) -> SampledSpectrum {
        self.paths[slot].carried(&self.weights.get(slot), combine, emitted, light_pdf)
    }

    /// Puts the path in a slot at a surface with the scattering function `bxdf`, whose shading frame has these `axes`: z, and what x is nearest to. At a
    /// black one it ends.
    #[inline(always)]
    pub(super) fn arrive_at(
        &mut self,
        slot: usize,
        from: ReferencePoint,
        wo: Vec3,
        axes: [Vec3; 2],
        bxdf: &WideBxdf,
        vertices: &mut Vertices,
    ) {
        let (slots, transmits) = match bxdf {
            WideBxdf::Diffuse(reflectance) if reflectance.is_black() => return,
            WideBxdf::Diffuse(_) => (&mut vertices.even, false),
            WideBxdf::Dielectric(_) => (&mut vertices.boundary, true),
            WideBxdf::Conductor(_) => (&mut vertices.metal, false),
        };
        slots.insert(slot);
        self.from.set(slot, if transmits { from } else { from.seen_from(wo) });
        self.wo.set(slot, wo);
        self.surfaces.set(slot, axes, bxdf);
    }

    /// Puts the paths in `slots` where they `met` even reflectors of these albedos. Those at black ones end.
    #[inline]
    pub(super) fn arrive_at_even(
        &mut self,
        slots: Slots,
        met: &PlainSurfaces,
        albedos: &SpectraToEvaluate,
        vertices: &mut Vertices,
    ) {
        albedos.evaluate(&self.lambda, &mut self.surfaces.reflectance);
        let mut found = slots.masks();
        even::arrive(met, &self.rays.time, &mut found, &mut self.surfaces, &mut self.from, &mut self.wo);
        for slot in slots.keep(|slot| found[slot] != 0) {
            self.from.one_sided[slot] = true;
            vertices.even.insert(slot);
        }
    }
}
