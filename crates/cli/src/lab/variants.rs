//! Ways to draw the samples, as the command line names them to be compared.

use crate::args::sampler;
use tenfold_sampling::SamplePlan;

/// A plan and what it is called.
#[derive(Clone, Debug)]
pub(super) struct NamedPlan {
    pub(super) name: String,
    pub(super) plan: SamplePlan,
}

/// Understands one of `--samplers`.
pub(super) fn plan(text: &str) -> Result<NamedPlan, String> {
    Ok(NamedPlan { name: text.to_owned(), plan: sampler(text)?.kind.into() })
}
