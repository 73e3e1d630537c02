//! Ways to render, as the command line names them to be compared: the parts of one with `+` between.

use crate::{
    failure::Failure,
    sampling,
    strategy::{self, Strategy},
};
use tenfold_lab::convergence::Variant;
use tenfold_render::{scene::Scene, schedule::RenderSettings};
use tenfold_sampling::{SamplePlan, SamplerKind};

/// A way to draw the samples and what it is called.
#[derive(Clone, Debug)]
pub(super) struct NamedPlan {
    pub(super) name: String,
    pub(super) plan: SamplePlan,
}

/// Strategies and what they are called.
#[derive(Clone, Debug)]
pub(super) struct NamedStrategies {
    name: String,
    strategies: Vec<Strategy>,
}

/// Understands one of `--samplers`.
pub(super) fn plan(text: &str) -> Result<NamedPlan, String> {
    let choices = text.split('+').map(sampling::sampler).collect::<Result<Vec<_>, _>>()?;
    let mut plan = SamplePlan::from(SamplerKind::default());
    sampling::apply(&choices, &mut plan);
    Ok(NamedPlan { name: text.to_owned(), plan })
}

/// Understands one of `--strategies`.
pub(super) fn strategies(text: &str) -> Result<NamedStrategies, String> {
    let strategies = text.split('+').map(strategy::parse).collect::<Result<_, _>>()?;
    Ok(NamedStrategies { name: text.to_owned(), strategies })
}

/// Every plan with every choice of strategies, where there are any, for `scene`.
pub(super) fn all(
    plans: &[NamedPlan],
    strategies: &[NamedStrategies],
    usual: &RenderSettings,
    scene: &Scene,
) -> Result<Vec<Variant>, Failure> {
    let drawn = |p: &NamedPlan| {
        let settings = RenderSettings { sampling: p.plan, ..usual.clone() };
        Variant { name: p.name.clone(), settings }
    };
    if strategies.is_empty() {
        return Ok(plans.iter().map(drawn).collect());
    }
    let with = |p: &NamedPlan, s: &NamedStrategies| {
        let name = if plans.len() > 1 { format!("{}, {}", p.name, s.name) } else { s.name.clone() };
        let mut settings = drawn(p).settings;
        s.strategies.iter().try_for_each(|strategy| strategy.apply(&mut settings, scene))?;
        Ok(Variant { name, settings })
    };
    plans.iter().flat_map(|p| strategies.iter().map(move |s| with(p, s))).collect()
}
