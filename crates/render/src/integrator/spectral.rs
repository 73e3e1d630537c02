use tenfold_spectrum::{N, SampledSpectrum};

/// What becomes of a path's other wavelengths where glass sends each its own way.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum DispersionRule {
    /// Each wavelength goes on along a path of its own.
    #[default]
    Split,
    /// Only the hero goes on, with the weight of all, as in pbrt-v4: kept for comparison.
    Terminate,
}

/// The wavelengths that a path carries: a non-empty subset of the lanes, one of which, the hero, decides where the
/// path goes. The hero must be equally likely to be any lane of the subset.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Lanes {
    /// One in the lanes carried, zero in the others.
    mask: SampledSpectrum,
    count: u8,
    hero: u8,
}

impl Lanes {
    /// All lanes. Wavelengths are drawn by rotation, which treats all lanes alike: the first may be the hero.
    pub(super) const ALL: Self = Self { mask: SampledSpectrum::ONE, count: N as u8, hero: 0 };

    /// One lane.
    pub(super) fn one(lane: usize) -> Self {
        Self::subset(1 << lane, 0.0)
    }

    /// The lanes whose bits are set, with a hero that `u` chooses uniformly among them.
    pub(super) fn subset(bits: u8, u: f32) -> Self {
        let count = bits.count_ones() as usize;
        debug_assert!(count > 0);
        let chosen = ((u * count as f32) as usize).min(count - 1);
        let hero = (0..N).filter(|lane| bits >> lane & 1 == 1).nth(chosen).unwrap_or(0);
        let mask = SampledSpectrum::from_fn(|lane| (bits >> lane & 1) as f32);
        Self { mask, count: count as u8, hero: hero as u8 }
    }

    /// The lane that decides.
    #[inline]
    pub(super) fn hero(&self) -> usize {
        self.hero as usize
    }

    /// Number of lanes carried.
    #[inline]
    pub(super) fn count(&self) -> usize {
        self.count as usize
    }

    /// Whether `lane` is carried.
    #[inline]
    pub(super) fn carries(&self, lane: usize) -> bool {
        self.mask.lane(lane) != 0.0
    }

    /// One in the lanes carried, zero in the others.
    #[inline]
    pub(super) fn mask(&self) -> SampledSpectrum {
        self.mask
    }

    /// The mean over the lanes carried of `x`, which is zero in the others.
    #[inline]
    pub(super) fn mean(&self, x: SampledSpectrum) -> f32 {
        x.sum() / self.count as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hero_is_uniform_over_the_subset() {
        let mut seen = [0; N];
        for i in 0..300 {
            let lanes = Lanes::subset(0b1101, i as f32 / 300.0);
            assert!(lanes.count() == 3 && lanes.carries(lanes.hero()) && !lanes.carries(1));
            seen[lanes.hero()] += 1;
        }
        assert_eq!(seen, [100, 0, 100, 100]);
        assert_eq!(Lanes::ALL.mean(SampledSpectrum::splat(3.0)), 3.0);
        assert_eq!(Lanes::one(2).mean(Lanes::one(2).mask()), 1.0);
    }
}
