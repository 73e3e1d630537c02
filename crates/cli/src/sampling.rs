//! How the variables of the integral are drawn, as the command line says it.

use crate::args::unknown;
use tenfold_sampling::{Draw, Mapped, SamplePlan, SamplerKind, Variable};

/// One part of `--sampler`: `zsobol`, or `lens=n-rooks`.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct SamplerChoice {
    /// The variables that are named, where some are; else all.
    variables: Option<&'static [Variable]>,
    mapped: Mapped,
}

impl SamplerChoice {
    /// What to tell of the sampler's name.
    pub(crate) fn note(&self) -> Option<&'static str> {
        self.mapped.note
    }
}

/// Understands a part of `--sampler`.
pub(crate) fn sampler(text: &str) -> Result<SamplerChoice, String> {
    let (variables, name) = match text.split_once('=') {
        Some((variable, name)) => (Some(named(variable)?), name),
        None => (None, text),
    };
    Ok(SamplerChoice { variables, mapped: kind(name)? })
}

/// The sampler of that name.
pub(crate) fn kind(name: &str) -> Result<Mapped, String> {
    SamplerKind::from_pbrt(name)
        .ok_or_else(|| unknown("sampler", name, &SamplerKind::all_names().collect::<Vec<_>>()))
}

/// Has `plan` draw the variables as `choices` say: those for all first, wherever they stand.
pub(crate) fn apply(choices: &[SamplerChoice], plan: &mut SamplePlan) {
    if let Some(all) = choices.iter().rfind(|choice| choice.variables.is_none()) {
        *plan = all.mapped.kind.into();
    }
    for choice in choices {
        for &variable in choice.variables.unwrap_or_default() {
            plan.set(variable, Draw::By(choice.mapped.kind));
        }
    }
}

/// The variables of that name.
fn named(name: &str) -> Result<&'static [Variable], String> {
    Variable::named(name).ok_or_else(|| {
        unknown("variable", name, &Variable::names().collect::<Vec<_>>())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(text: &str) -> String {
        let choices: Vec<_> = text.split(',').map(|part| sampler(part).unwrap()).collect();
        let mut plan = SamplePlan::from(SamplerKind::Halton);
        apply(&choices, &mut plan);
        plan.to_string()
    }

    #[test]
    fn samplers_are_set_for_all_variables_or_for_some() {
        assert_eq!(plan("stratified"), "jittered");
        assert_eq!(plan("lens=n-rooks,time=jittered"), "halton, lens=n-rooks, time=jittered");
        assert_eq!(plan("lens=n-rooks,zsobol"), "zsobol, lens=n-rooks");
        assert_eq!(plan("light=sobol"), "halton, light-choice=sobol, light-point=sobol");
        assert_eq!(plan("light=sobol,light-choice=halton"), "halton, light-point=sobol");
    }

    #[test]
    fn unknown_names_are_told_with_the_nearest() {
        assert!(sampler("zsobl").unwrap_err().contains("did you mean zsobol?"));
        assert!(sampler("lans=zsobol").unwrap_err().contains("did you mean lens?"));
        assert!(sampler("lens=").unwrap_err().contains("multi-jittered"));
        assert!(sampler("what=zsobol").unwrap_err().contains("light-point"));
    }
}
