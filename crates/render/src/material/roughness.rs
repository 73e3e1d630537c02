use crate::{
    bxdf::TrowbridgeReitz,
    texture::{FloatSlot, TextureContext, Textures},
};

/// The roughness of a microfacet surface.
#[derive(Clone, Debug)]
pub enum Roughness {
    /// The same everywhere.
    Constant(TrowbridgeReitz),
    /// Varying.
    Varying {
        /// Along ∂p/∂u.
        u: FloatSlot,
        /// Along ∂p/∂v.
        v: FloatSlot,
        /// Whether the numbers are a perceptual roughness, and not α of the distribution itself.
        remap: bool,
    },
}

impl Roughness {
    /// The roughness that two slots give.
    pub fn new(u: FloatSlot, v: FloatSlot, remap: bool) -> Self {
        match (u.constant(), v.constant()) {
            (Some(u), Some(v)) => Self::Constant(distribution(u, v, remap)),
            _ => Self::Varying { u, v, remap },
        }
    }

    /// The distribution of microfacets, where it is the same everywhere.
    pub fn constant(&self) -> Option<TrowbridgeReitz> {
        match self {
            Self::Constant(d) => Some(*d),
            Self::Varying { .. } => None,
        }
    }

    /// The distribution of microfacets at a point.
    #[inline]
    pub fn distribution(&self, textures: &Textures, at: &TextureContext) -> TrowbridgeReitz {
        match self {
            Self::Constant(d) => *d,
            Self::Varying { u, v, remap } => {
                distribution(textures.float(u, at), textures.float(v, at), *remap)
            }
        }
    }
}

#[inline]
fn distribution(u: f32, v: f32, remap: bool) -> TrowbridgeReitz {
    let alpha = |roughness: f32| {
        // Textures may give anything; NaN counts as smooth.
        let roughness = roughness.max(0.0);
        if remap { TrowbridgeReitz::roughness_to_alpha(roughness) } else { roughness }
    };
    TrowbridgeReitz::new(alpha(u), alpha(v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Bilerp, FloatTexture, Mapping2};
    use tenfold_math::vec2;

    #[test]
    fn constants_are_remapped_once() {
        let constant = |u, v, remap| {
            Roughness::new(FloatSlot::Constant(u), FloatSlot::Constant(v), remap).constant().unwrap()
        };
        assert_eq!(constant(0.25, 0.04, true), TrowbridgeReitz::new(0.5, 0.2));
        assert_eq!(constant(0.25, 0.04, false), TrowbridgeReitz::new(0.25, 0.04));
        assert!(constant(0.0, 0.0, true).effectively_smooth());
    }

    #[test]
    fn textures_vary_it() {
        let mut textures = Textures::default();
        let ramp = Bilerp { mapping: Mapping2::default(), corners: [0.0, 0.0, 1.0, 1.0] };
        let u = FloatSlot::Texture(textures.add_float(FloatTexture::Bilerp(ramp)));
        let roughness = Roughness::new(u, FloatSlot::Constant(0.09), true);
        assert!(roughness.constant().is_none());
        let at = TextureContext::at_uv(vec2(0.64, 0.0));
        assert_eq!(roughness.distribution(&textures, &at), TrowbridgeReitz::new(0.8, 0.3));
    }
}
