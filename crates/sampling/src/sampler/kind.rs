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

    /// The name in scene files, which is pbrt's where it has one.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::ZSobol => "zsobol",
            Self::PaddedSobol => "paddedsobol",
            Self::NRooks => "n-rooks",
            Self::MultiJittered => "multi-jittered",
            Self::Halton => "halton",
        }
    }

    /// The kind of that name, or the nearest to the sampler of that name in pbrt-v4. `jittered` is another name of `stratified`.
    pub fn from_pbrt(name: &str) -> Option<Mapped> {
        if let Some(kind) = Self::ALL.into_iter().find(|k| k.name() == name) {
            return Some(Mapped { kind, note: None });
        }
        if name == "jittered" {
            return Some(Mapped { kind: Self::Stratified, note: None });
        }
        let note = match name {
            "sobol" => "the sampler \"sobol\" is replaced by \"zsobol\"",
            "pmj02bn" => "the sampler \"pmj02bn\" is replaced by \"zsobol\"",
            _ => return None,
        };
        Some(Mapped { kind: Self::ZSobol, note: Some(note) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_pbrt_map_to_the_nearest_kind() {
        for kind in SamplerKind::ALL {
            assert_eq!(SamplerKind::from_pbrt(kind.name()), Some(Mapped { kind, note: None }));
        }
        let jittered = Mapped { kind: SamplerKind::Stratified, note: None };
        assert_eq!(SamplerKind::from_pbrt("jittered"), Some(jittered));
        for name in ["sobol", "pmj02bn"] {
            let mapped = SamplerKind::from_pbrt(name).unwrap();
            assert!(mapped.kind == SamplerKind::ZSobol && mapped.note.unwrap().contains(name));
        }
        assert_eq!(SamplerKind::from_pbrt("random"), None);
    }
}
