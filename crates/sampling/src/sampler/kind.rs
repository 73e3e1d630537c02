/// The family of samplers.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum SamplerKind {
    /// Every number by itself, from a hash.
    Independent,
    /// A jittered grid for every variable, in an order of its own for every pixel and dimension.
    Stratified,
    /// Owen-scrambled Sobol' points padded by dimension, their order over pixels along a shuffled Z curve, so that errors
    /// of neighbouring pixels differ (blue noise; Ahmed and Wonka 2020).
    #[default]
    ZSobol,
    /// Owen-scrambled Sobol' points padded by dimension, every pixel by itself (Burley 2020).
    PaddedSobol,
    /// Every number by itself in strata of its own, as many as there are samples, in an order of its own for every pixel and
    /// dimension: hidden sampling (Cook, Porter and Carpenter 1984), Latin hypercubes.
    NRooks,
    /// Correlated multi-jittered pairs (Kensler 2013): a jittered grid whose points are N rooks, too. Single numbers as in `NRooks`.
    MultiJittered,
    /// Owen-scrambled Halton points in bases 2 and 3, padded by dimension.
    Halton,
}

/// A sampler for one that another program names.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Mapped {
    /// The nearest kind.
    pub kind: SamplerKind,
    /// What to tell the user, where it is not the same kind.
    pub note: Option<&'static str>,
}

impl SamplerKind {
    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::Independent,
        Self::Stratified,
        Self::ZSobol,
        Self::PaddedSobol,
        Self::NRooks,
        Self::MultiJittered,
        Self::Halton,
    ];

    /// The name.
    pub const fn name(self) -> &'static str {
        self.names()[0]
    }

    /// All names, which are pbrt's where it has one, the first the one to be shown.
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Independent => &["independent"],
            Self::Stratified => &["jittered", "stratified"],
            Self::ZSobol => &["zsobol", "blue-noise", "blue-noise-sobol"],
            Self::PaddedSobol => &["sobol", "paddedsobol"],
            Self::NRooks => &["n-rooks"],
            Self::MultiJittered => &["multi-jittered"],
            Self::Halton => &["halton"],
        }
    }

    /// All names of all kinds.
    pub fn all_names() -> impl Iterator<Item = &'static str> {
        Self::ALL.into_iter().flat_map(|kind| kind.names().iter().copied())
    }

    /// The kind of that name, or the nearest to the sampler of that name in pbrt-v4; `None` where there is none.
    /// pbrt's `sobol` takes all dimensions from one sequence, its `paddedsobol` pairs by pairs, which is the one here.
    pub fn from_pbrt(name: &str) -> Option<Mapped> {
        if let Some(kind) = Self::ALL.into_iter().find(|k| k.names().contains(&name)) {
            return Some(Mapped { kind, note: None });
        }
        // Progressive multi-jittered (0, 2) points (Christensen, Kensler and Kilpatrick 2018) have the strata of Owen-scrambled
        // Sobol' pairs, and no more.
        let note = "the sampler \"pmj02bn\" is replaced by \"sobol\", whose pairs have the same strata";
        (name == "pmj02bn").then_some(Mapped { kind: Self::PaddedSobol, note: Some(note) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_name_means_one_kind() {
        let mut seen = HashSet::new();
        for kind in SamplerKind::ALL {
            for name in kind.names() {
                assert_eq!(SamplerKind::from_pbrt(name), Some(Mapped { kind, note: None }));
                assert!(seen.insert(name));
            }
        }
        assert!(SamplerKind::all_names().all(|name| seen.contains(&name)));
        for (name, kind) in [("sobol", SamplerKind::PaddedSobol), ("jittered", SamplerKind::Stratified)] {
            assert_eq!(SamplerKind::from_pbrt(name).unwrap().kind, kind);
        }
        let mapped = SamplerKind::from_pbrt("pmj02bn").unwrap();
        assert!(mapped.kind == SamplerKind::PaddedSobol && mapped.note.unwrap().contains("pmj02bn"));
        assert_eq!(SamplerKind::from_pbrt("random"), None);
    }
}
