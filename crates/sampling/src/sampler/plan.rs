use super::SamplerKind;
use crate::Variable;
use std::fmt;
use tenfold_math::Vec2;

/// How the numbers of one variable come about.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Draw {
    /// Drawn by a sampler.
    By(SamplerKind),
    /// Held at a value, a number alone at the first of the two: the effect of the variable is switched off.
    Held(Vec2),
}

/// How the numbers of every variable come about: by one sampler for all, or by one of its own for some.
///
/// ```
/// use tenfold_math::Vec2;
/// use tenfold_sampling::{Draw, SamplePlan, SamplerKind, Variable};
///
/// let mut plan = SamplePlan::from(SamplerKind::ZSobol);
/// assert_eq!(plan.uniform_kind(), Some(SamplerKind::ZSobol));
/// plan.set(Variable::Lens, Draw::By(SamplerKind::NRooks));
/// plan.set(Variable::Time, Draw::Held(Vec2::splat(0.5)));
/// assert_eq!(plan.uniform_kind(), None);
/// ```
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SamplePlan {
    draws: [Draw; Variable::ALL.len()],
    streams: [u32; Variable::ALL.len()],
}

impl From<SamplerKind> for SamplePlan {
    /// The same sampler for all variables.
    fn from(kind: SamplerKind) -> Self {
        Self { draws: [Draw::By(kind); Variable::ALL.len()], streams: [0; Variable::ALL.len()] }
    }
}

impl SamplePlan {
    /// Draws `variable` so, at every vertex of the path.
    pub fn set(&mut self, variable: Variable, draw: Draw) {
        self.draws[variable as usize] = draw;
    }

    /// Gives `variable` the numbers of another `stream`, independent of those of all others: renders whose plans agree in
    /// the streams of some variables share the numbers of these. All streams are 0 unless set.
    pub fn set_stream(&mut self, variable: Variable, stream: u32) {
        self.streams[variable as usize] = stream;
    }

    /// How `variable` is drawn.
    #[inline]
    pub fn draw(&self, variable: Variable) -> Draw {
        self.draws[variable as usize]
    }

    /// The stream of `variable`.
    #[inline]
    pub fn stream(&self, variable: Variable) -> u32 {
        self.streams[variable as usize]
    }

    /// The sampler of all variables, where all have the same, and stream 0.
    pub fn uniform_kind(&self) -> Option<SamplerKind> {
        let Draw::By(kind) = self.draws[0] else { return None };
        (*self == Self::from(kind)).then_some(kind)
    }
}

/// The sampler of most variables, then those that differ: `zsobol, lens=n-rooks, time held at 0.5`.
impl fmt::Display for SamplePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let by = |kind: SamplerKind| self.draws.iter().filter(|d| **d == Draw::By(kind)).count();
        // The first of those with the most variables.
        let main = SamplerKind::ALL.into_iter().rev().max_by_key(|&kind| by(kind)).unwrap_or_default();
        f.write_str(main.name())?;
        for variable in Variable::ALL {
            match self.draw(variable) {
                Draw::By(kind) if kind == main => {}
                Draw::By(kind) => write!(f, ", {}={}", variable.name(), kind.name())?,
                Draw::Held(v) if v.x == v.y => write!(f, ", {} held at {}", variable.name(), v.x)?,
                Draw::Held(v) => write!(f, ", {} held at {},{}", variable.name(), v.x, v.y)?,
            }
        }
        Ok(())
    }
}
