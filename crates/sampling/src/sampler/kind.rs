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
    pub const ALL: [Self; 4] = [Self::Independent, Self::Stratified, Self::ZSobol, Self::PaddedSobol];

    /// The name in scene files, which is pbrt's.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Stratified => "stratified",
            Self::ZSobol => "zsobol",
            Self::PaddedSobol => "paddedsobol",
        }
    }

    /// The kind nearest to the sampler of that name in pbrt-v4, if it has one of that name.
    pub fn from_pbrt(name: &str) -> Option<Mapped> {
        if let Some(kind) = Self::ALL.into_iter().find(|k| k.name() == name) {
            return Some(Mapped { kind, note: None });
        }
        let note = match name {
            "halton" => "the sampler \"halton\" is replaced by \"zsobol\"",
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
        for name in ["halton", "sobol", "pmj02bn"] {
            let mapped = SamplerKind::from_pbrt(name).unwrap();
            assert!(mapped.kind == SamplerKind::ZSobol && mapped.note.unwrap().contains(name));
        }
        assert_eq!(SamplerKind::from_pbrt("random"), None);
    }
}
