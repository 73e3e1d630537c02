use super::CombineStrategy;
use crate::{bxdf::ScatterStrategy, light::LightStrategy};
use std::fmt;

/// How the variables of the integral that depend on the scene are sampled: uniformly with weights, or by a density
/// that follows what is integrated. The picture is the same for all but for its noise, of which the default has the least.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Strategies {
    /// The point on a light.
    pub light: LightStrategy,
    /// The direction of scattering.
    pub scatter: ScatterStrategy,
    /// How the two are combined.
    pub combine: CombineStrategy,
}

/// As the command line takes it: `light=by-texture,scatter=bsdf,combine=mis`.
impl fmt::Display for Strategies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { light, scatter, combine } = self;
        write!(f, "light={},scatter={},combine={}", light.name(), scatter.name(), combine.name())
    }
}
