//! How the variables of the integral are drawn, as the command line says it.

use crate::args::unknown;
use tenfold_math::{ONE_MINUS_EPSILON, Vec2};
use tenfold_render::schedule::Frozen;
use tenfold_sampling::{Draw, Mapped, SamplePlan, SamplerKind, Variable};
use tenfold_spectrum::{LAMBDA_MAX, LAMBDA_MIN, SampledWavelengths};

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
fn kind(name: &str) -> Result<Mapped, String> {
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

/// What one part of `--freeze` holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Freeze(Vec<Frozen>);

impl Freeze {
    pub(crate) fn frozen(&self) -> impl Iterator<Item = Frozen> {
        self.0.iter().copied()
    }
}

/// Understands a part of `--freeze`: `lens`, `time=0.5`, `lens=0.5:0.25`, `wavelength=550`.
pub(crate) fn freeze(text: &str) -> Result<Freeze, String> {
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (name, Some(value)),
        None => (text, None),
    };
    let nanometres = |default| value.map_or(Ok(default), wavelength);
    Ok(Freeze(match name {
        "dispersion" => vec![Frozen::Dispersion(nanometres(Frozen::D_LINE)?)],
        "wavelength" => vec![Frozen::Wavelength(nanometres(SampledWavelengths::visible_median())?)],
        _ => {
            let known = || Variable::names().chain(["dispersion"]).collect::<Vec<_>>();
            let variables = Variable::named(name).ok_or_else(|| unknown("variable", name, &known()))?;
            let value = value.map_or(Ok(Vec2::splat(0.5)), numbers)?;
            // Of a group the choices go on, lest all lights or lobes but one are missing: those have names of their own.
            let held = variables.iter().filter(|v| variables.len() == 1 || !v.is_choice());
            held.map(|&variable| Frozen::Variable(variable, value)).collect()
        }
    }))
}

fn wavelength(text: &str) -> Result<f32, String> {
    let range = LAMBDA_MIN..=LAMBDA_MAX;
    let parsed = text.parse().ok().filter(|nm| range.contains(nm));
    parsed.ok_or_else(|| {
        format!("expected a wavelength from {LAMBDA_MIN} to {LAMBDA_MAX} nm, found \"{text}\"")
    })
}

/// One number for both, or two with a colon between.
fn numbers(text: &str) -> Result<Vec2, String> {
    let number = |text: &str| text.parse().ok().filter(|x| (0.0..=ONE_MINUS_EPSILON).contains(x));
    let (x, y) = text.split_once(':').unwrap_or((text, text));
    let both = number(x).zip(number(y)).map(Vec2::from);
    both.ok_or_else(|| {
        format!("expected a number from 0 to below 1, or two with a colon between, found \"{text}\"")
    })
}

/// The variables of that name.
fn named(name: &str) -> Result<&'static [Variable], String> {
    Variable::named(name).ok_or_else(|| unknown("variable", name, &Variable::names().collect::<Vec<_>>()))
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
        assert!(freeze("lense").unwrap_err().contains("did you mean lens?"));
        assert!(sampler("what=zsobol").unwrap_err().contains("light-point"));
    }

    #[test]
    fn variables_are_held_at_values() {
        let frozen =
            |text| freeze(text).unwrap().0.iter().map(Frozen::to_string).collect::<Vec<_>>().join(" ");
        for (text, expected) in [
            ("time=0.25", "time=0.25"),
            ("lens", "lens=0.5"),
            ("lens=0.5:0.25", "lens=0.5:0.25"),
            ("light", "light-point=0.5"),
            ("light-choice=0", "light-choice=0"),
            ("scatter", "scatter-direction=0.5"),
            ("wavelength=550", "wavelength=550"),
            ("dispersion", "dispersion=587.56"),
        ] {
            assert_eq!(frozen(text), expected);
        }
        for wrong in
            ["time=1", "time=-0.1", "time=NaN", "lens=0.5:", "lens=0:0:0", "wavelength=200", "dispersion=x"]
        {
            assert!(freeze(wrong).unwrap_err().contains("expected"), "{wrong}");
        }
    }
}
