//! The options by which the noise decides over the samples.

use crate::failure::Failure;
use clap::ValueEnum;
use tenfold_render::schedule::{self, NoiseSettings};

/// The options of renders to a target of noise or a limit of time.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Noise")]
pub(crate) struct NoiseArgs {
    /// Take as many samples as bring the noise down to this: the relative standard error of a pixel's luminance, in the
    /// quadratic mean over the picture; 0.01 is 1 %
    #[arg(long, value_name = "X", value_parser = positive, conflicts_with_all = ["spp", "quick"])]
    pub(crate) noise: Option<f64>,

    /// Render the best picture that there is time for: seconds, or with a unit as in 90s, 10m, 2h
    #[arg(long, value_name = "TIME", value_parser = seconds, conflicts_with_all = ["spp", "quick"])]
    pub(crate) time_limit: Option<f64>,

    /// Samples that every pixel gets, with --noise or --time-limit [default: 16]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) min_spp: Option<u32>,

    /// Samples that no pixel gets more of, with --noise or --time-limit [default: no bound]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) max_spp: Option<u32>,

    /// Which pixels get the samples, with --noise or --time-limit: those with large errors, or all alike [default:
    /// adaptive]
    #[arg(long, value_name = "RULE", value_enum)]
    pub(crate) allocation: Option<Allocation>,
}

/// Which pixels get the samples.
#[derive(Copy, Clone, Debug, ValueEnum)]
pub(crate) enum Allocation {
    Adaptive,
    Uniform,
}

impl NoiseArgs {
    /// What is asked for; `None` for renders with a number of samples that is known beforehand.
    pub(crate) fn settings(&self) -> Result<Option<NoiseSettings>, Failure> {
        let default = NoiseSettings::default();
        if self.noise.is_none() && self.time_limit.is_none() {
            let depends = [
                ("--min-spp", self.min_spp.is_some()),
                ("--max-spp", self.max_spp.is_some()),
                ("--allocation", self.allocation.is_some()),
            ];
            return match depends.iter().find(|(_, given)| *given) {
                None => Ok(None),
                Some((name, _)) => Err(Failure::Wrong(format!(
                    "{name} goes with --noise or --time-limit; --spp N takes N samples of every pixel"
                ))),
            };
        }
        let max_spp = self.max_spp.unwrap_or(default.max_spp);
        let min_spp = self.min_spp.unwrap_or(default.min_spp.min(max_spp));
        if min_spp > max_spp {
            return Err(Failure::Wrong(format!("--min-spp {min_spp} is more than --max-spp {max_spp}")));
        }
        let allocation = match self.allocation {
            Some(Allocation::Uniform) => schedule::Allocation::Uniform,
            Some(Allocation::Adaptive) | None => schedule::Allocation::Adaptive,
        };
        Ok(Some(NoiseSettings {
            target: self.noise,
            min_spp,
            max_spp,
            time_limit: self.time_limit,
            allocation,
        }))
    }
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|n| *n > 0.0 && n.is_finite());
    number.ok_or_else(|| "expected a number above 0, such as 0.01".to_owned())
}

/// Seconds from a time span such as `90`, `90s`, `1.5m`, `2h`.
fn seconds(text: &str) -> Result<f64, String> {
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let unit = units.into_iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, unit)));
    let (number, unit) = unit.unwrap_or((text, 1.0));
    match positive(number.trim_end()) {
        Ok(number) => Ok(number * unit),
        Err(_) => Err("expected a time span above 0, such as 90, 90s, 10m or 2h".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_spans_have_units() {
        assert_eq!(
            ["90", "90s", "1.5m", "2h", "3 m"].map(|t| seconds(t).unwrap()),
            [90.0, 90.0, 90.0, 7200.0, 180.0]
        );
        for wrong in ["", "s", "0", "-1", "1d", "inf", "nan", "1 h 5 m"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
