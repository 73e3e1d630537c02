//! `--strategy`: how variables are sampled.

use crate::{args::unknown, failure::Failure};
use tenfold_render::{
    bxdf::ScatterStrategy, camera::TimeStrategy, integrator::CombineStrategy, light::LightStrategy,
    scene::Scene, schedule::RenderSettings,
};

/// One variable and its strategy, as in `light=solid-angle`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Strategy {
    Light(LightStrategy),
    Scatter(ScatterStrategy),
    Combine(CombineStrategy),
    Time(Time),
}

/// How the time is sampled, before there is a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Time {
    Shutter,
    /// Along the path of what has this name.
    Path(String),
}

impl Strategy {
    /// Enters it where it belongs.
    pub(crate) fn apply(&self, settings: &mut RenderSettings, scene: &Scene) -> Result<(), Failure> {
        let strategies = &mut settings.strategies;
        match self {
            Self::Light(strategy) => strategies.light = *strategy,
            Self::Scatter(strategy) => strategies.scatter = *strategy,
            Self::Combine(strategy) => strategies.combine = *strategy,
            Self::Time(Time::Shutter) => settings.time = TimeStrategy::Shutter,
            Self::Time(Time::Path(name)) => {
                let path = scene.time_along_path(name);
                settings.time = path.map_err(|error| Failure::Wrong(format!("time=path:{name}: {error}")))?;
            }
        }
        Ok(())
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
        "time" => match name.split_once(':') {
            Some(("path", name)) if !name.is_empty() => Ok(Strategy::Time(Time::Path(name.to_owned()))),
            None if name == "shutter" => Ok(Strategy::Time(Time::Shutter)),
            _ => Err(unknown("strategy", name, &["shutter", "path:NAME"])),
        },
        _ => Err(unknown("variable with strategies", variable, &["light", "scatter", "combine", "time"])),
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
    use tenfold_render::integrator::Strategies;

    /// A ball that flies and a box that does not.
    fn scene() -> Scene {
        let text = r#"Camera "perspective" WorldBegin ObjectBegin "ball" Shape "sphere" ObjectEnd
            ObjectBegin "box" Shape "disk" ObjectEnd ObjectInstance "box" ObjectBegin "bees" Shape "sphere" ObjectEnd
            ActiveTransform EndTime Translate 1 0 0 ObjectInstance "ball" ObjectInstance "bees" ObjectInstance "bees""#;
        let resources = tenfold_scene::EmbeddedResources::default();
        let (description, diagnostics) =
            tenfold_scene::read_pbrt_str("s", text, &resources, &mut tenfold_scene::SourceMap::new());
        tenfold_render::compile::compile(&description, &resources, &diagnostics).unwrap()
    }

    #[test]
    fn every_strategy_has_a_name() {
        let scene = scene();
        let mut settings = RenderSettings::of(&scene);
        let given = ["light=uniform-area", "scatter=cosine", "combine=bsdf-only", "time=path:ball"];
        for text in given {
            parse(text).unwrap().apply(&mut settings, &scene).unwrap();
        }
        let Strategies { light, scatter, combine } = settings.strategies;
        assert_eq!(light, LightStrategy::UniformArea);
        assert_eq!(scatter, ScatterStrategy::Cosine);
        assert_eq!(combine, CombineStrategy::BsdfOnly);
        // What is told is what can be given.
        assert_eq!(settings.strategy(), given.join(","));
        parse("time=shutter").unwrap().apply(&mut settings, &scene).unwrap();
        assert_eq!(settings.time, TimeStrategy::Shutter);
    }

    #[test]
    fn only_what_moves_has_a_path() {
        let scene = scene();
        for (name, part) in [
            ("bal", "no object \"bal\"; did you mean \"ball\"?"),
            ("xyzzy", "there are ball, bees, box, camera"),
            ("box", "\"box\" does not move"),
            ("camera", "\"camera\" does not move"),
            ("bees", "moves in 2 places"),
        ] {
            let strategy = parse(&format!("time=path:{name}")).unwrap();
            let said = strategy.apply(&mut RenderSettings::of(&scene), &scene).unwrap_err();
            assert!(said.message().contains(part) && said.code() == 2, "{name}: {said:?}");
        }
    }

    #[test]
    fn misspelt_ones_are_told_the_nearest() {
        for (text, part) in [
            ("light", "VARIABLE=NAME"),
            ("ligth=by-texture", "mean light?"),
            ("light=by-textures", "mean by-texture?"),
            ("scatter=uniform-area", "uniform, cosine, bsdf"),
            ("combine=", "mis, light-only, bsdf-only"),
            ("time=paths:ball", "shutter, path:NAME"),
            ("time=path:", "path:NAME"),
            ("wavelength=uniform", "light, scatter, combine, time"),
        ] {
            let said = parse(text).unwrap_err();
            assert!(said.contains(part), "{text}: {said}");
        }
    }
}
