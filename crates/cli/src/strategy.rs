//! `--strategy`: how variables are sampled.

use crate::args::unknown;
use tenfold_render::{
    bxdf::ScatterStrategy,
    integrator::{CombineStrategy, Strategies},
    light::LightStrategy,
};

/// One variable and its strategy, as in `light=solid-angle`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Strategy {
    Light(LightStrategy),
    Scatter(ScatterStrategy),
    Combine(CombineStrategy),
}

impl Strategy {
    /// Enters it where it belongs.
    pub(crate) fn apply(&self, to: &mut Strategies) {
        match self {
            Self::Light(strategy) => to.light = *strategy,
            Self::Scatter(strategy) => to.scatter = *strategy,
            Self::Combine(strategy) => to.combine = *strategy,
        }
    }
}

/// Understands `VARIABLE=NAME`.
pub(crate) fn parse(text: &str) -> Result<Strategy, String> {
    let Some((variable, name)) = text.split_once('=') else {
        return Err("expected VARIABLE=NAME, such as light=solid-angle".to_owned());
    };
    match variable {
        "light" => member(name, LightStrategy::ALL, LightStrategy::name).map(Strategy::Light),
        "scatter" => member(name, ScatterStrategy::ALL, ScatterStrategy::name).map(Strategy::Scatter),
        "combine" => member(name, CombineStrategy::ALL, CombineStrategy::name).map(Strategy::Combine),
        _ => Err(unknown("variable with strategies", variable, &["light", "scatter", "combine"])),
    }
}

/// The one of `all` with this name.
fn member<T: Copy, const N: usize>(
    name: &str,
    all: [T; N],
    name_of: fn(T) -> &'static str,
) -> Result<T, String> {
    let found = all.into_iter().find(|&one| name_of(one) == name);
    found.ok_or_else(|| unknown("strategy", name, &all.map(name_of)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_strategy_has_a_name() {
        let mut strategies = Strategies::default();
        for text in ["light=uniform-area", "scatter=cosine", "combine=bsdf-only"] {
            parse(text).unwrap().apply(&mut strategies);
        }
        let want = Strategies {
            light: LightStrategy::UniformArea,
            scatter: ScatterStrategy::Cosine,
            combine: CombineStrategy::BsdfOnly,
        };
        assert_eq!(strategies, want);
        // What is told is what can be given.
        let mut read = Strategies::default();
        strategies.to_string().split(',').for_each(|text| parse(text).unwrap().apply(&mut read));
        assert_eq!(read, want);
    }

    #[test]
    fn misspelt_ones_are_told_the_nearest() {
        for (text, part) in [
            ("light", "VARIABLE=NAME"),
            ("ligth=by-texture", "mean light?"),
            ("light=by-textures", "mean by-texture?"),
            ("scatter=uniform-area", "uniform, cosine, bsdf"),
            ("combine=", "mis, light-only, bsdf-only"),
            ("wavelength=uniform", "light, scatter, combine"),
        ] {
            let said = parse(text).unwrap_err();
            assert!(said.contains(part), "{text}: {said}");
        }
    }
}
