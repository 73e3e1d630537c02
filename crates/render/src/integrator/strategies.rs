use super::CombineStrategy;
use crate::{bxdf::ScatterStrategy, light::LightStrategy};
use std::fmt;
use tenfold_sampling::{Draw, SamplePlan, Variable};

/// How the variables of the integral that depend on the scene are sampled: uniformly with weights, or by a density
/// that follows what is integrated. The picture is the same for all but for its noise. The defaults do well in every scene.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Strategies {
    /// The point on a light.
    pub light: LightStrategy,
    /// The direction of scattering.
    pub scatter: ScatterStrategy,
    /// How the two are combined.
    pub combine: CombineStrategy,
}

impl Strategies {
    /// What they come to with each other, and where `plan` holds points on lights or directions of scattering. A held point is not one that a scattered
    /// direction meets, nor does a held direction meet lights as often as it should: so where both would count, light is
    /// found by sampling it alone. With held points lights are points; light from infinitely far has no point to
    /// be held, and scattered directions alone find it. With held directions glossy surfaces are mirrors. Where lights are sampled
    /// alone, no light is left to scattered directions.
    #[must_use]
    pub fn held(self, plan: &SamplePlan) -> Self {
        let held = |variable| matches!(plan.draw(variable), Draw::Held(_));
        let (point, direction) = (held(Variable::LightPoint), held(Variable::ScatterDirection));
        let single = (point || direction) && self.combine == CombineStrategy::Mis;
        let combine = if single { CombineStrategy::LightOnly } else { self.combine };
        let light = match self.light {
            _ if point => LightStrategy::AsPoint,
            LightStrategy::Complementary if combine == CombineStrategy::LightOnly => LightStrategy::ByTexture,
            light => light,
        };
        Self { light, combine, ..self }
    }
}

/// As the command line takes it: `light=complementary,scatter=bsdf,combine=mis`.
impl fmt::Display for Strategies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { light, scatter, combine } = self;
        write!(f, "light={},scatter={},combine={}", light.name(), scatter.name(), combine.name())
    }
}
