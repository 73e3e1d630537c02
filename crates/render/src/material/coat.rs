//! Surfaces under a coat of dielectric.

use std::sync::Arc;

use tenfold_sampling::mix_bits;
use tenfold_spectrum::SampledSpectrum;

use super::{Eta, Metal, Point, Roughness, conductor::ComplexIndex};
use crate::{
    bxdf::{self, Bxdf, CoatTable, Layered, LayeredBase, Slab, TrowbridgeReitz},
    texture::{FloatSlot, SpectrumSlot},
};

/// A layer of dielectric with a medium between its upper side and the base.
#[derive(Clone, Debug)]
pub struct Coat {
    /// Its index of refraction.
    pub eta: Eta,
    /// How rough its upper side is.
    pub roughness: Roughness,
    /// Its optical thickness: the mean free path of its medium is one.
    pub thickness: FloatSlot,
    /// The scattering albedo of its medium; black where that only absorbs.
    pub albedo: SpectrumSlot,
    /// The asymmetry of the medium's phase function.
    pub g: FloatSlot,
    /// How many times light crosses the layer at most.
    pub max_depth: u32,
    /// How many random walks estimate what has no closed form.
    pub samples: u32,
    /// What the layer does to flux, where that could be tabulated: then no random walks are needed.
    pub table: Option<Arc<CoatTable>>,
}

impl Coat {
    /// The largest α that the table of a textured coat goes up to; what is rougher is taken for that.
    pub const ROUGHEST: f32 = 1.0;

    /// Whether the medium scatters nothing anywhere.
    pub fn is_clear(&self) -> bool {
        self.albedo.constant().is_some_and(|s| s.max_value() <= 0.0)
    }

    /// Whether anything of it varies over a surface.
    pub(super) fn is_textured(&self) -> bool {
        let Self { eta: _, roughness, thickness, albedo, g, max_depth: _, samples: _, table: _ } = self;
        roughness.constant().is_none()
            || thickness.constant().and(g.constant()).is_none()
            || albedo.constant().is_none()
    }

    /// The coat over `base` at a point, by random walks.
    fn over(&self, at: &Point<'_>, eta: SampledSpectrum, base: LayeredBase) -> Bxdf<'static> {
        let slab = Slab {
            thickness: at.float(&self.thickness).max(0.0),
            albedo: at.albedo(&self.albedo),
            g: at.float(&self.g).clamp(-1.0, 1.0),
            max_depth: self.max_depth,
            samples: self.samples,
        };
        Bxdf::Layered(Layered::new(eta, at.distribution(&self.roughness), slab, base, seed(at)))
    }
}

/// A number of its own for about every sample of a picture.
fn seed(at: &Point<'_>) -> u64 {
    let (p, lambda) = (at.context.p, at.waves.light.lambda()[0]);
    [p.x, p.y, p.z, lambda].iter().fold(0, |hash: u64, v| {
        // The increment of splitmix64 keeps zeros from mapping to zeros.
        mix_bits((hash ^ u64::from(v.to_bits())).wrapping_add(0x9e37_79b9_7f4a_7c15))
    })
}

/// A Lambertian reflector under a coat.
#[derive(Clone, Debug)]
pub struct CoatedDiffuse {
    /// The fraction of light that the base scatters.
    pub reflectance: SpectrumSlot,
    /// What is above it.
    pub coat: Coat,
}

/// A metal under a coat.
#[derive(Clone, Debug)]
pub struct CoatedConductor {
    /// Of which.
    pub metal: Metal,
    /// How rough it is.
    pub roughness: Roughness,
    /// What is above it.
    pub coat: Coat,
}

impl CoatedDiffuse {
    #[inline]
    pub(super) fn bxdf(&self, at: &Point<'_>) -> Bxdf<'_> {
        let eta = self.coat.eta.sample(at.waves.indices);
        let reflectance = at.albedo(&self.reflectance);
        let Some(table) = &self.coat.table else {
            return self.coat.over(at, eta, LayeredBase::Diffuse(bxdf::Diffuse::new(reflectance)));
        };
        let distribution = match &self.coat.roughness {
            Roughness::Constant(d) => *d,
            varying => {
                let d = varying.distribution(at.textures, at.context);
                TrowbridgeReitz::new(d.alpha_x().min(Coat::ROUGHEST), d.alpha_y().min(Coat::ROUGHEST))
            }
        };
        Bxdf::CoatedDiffuse(bxdf::CoatedDiffuse::new(
            table,
            eta,
            distribution,
            reflectance,
            self.coat.max_depth,
        ))
    }
}

impl CoatedConductor {
    pub(super) fn bxdf(&self, at: &Point<'_>) -> Bxdf<'_> {
        let interface = self.coat.eta.sample(at.waves.indices);
        let ComplexIndex { eta, k } = self.metal.index(at);
        // The metal is seen from inside the coat.
        let (eta, k) = (eta / interface, k / interface);
        let base = bxdf::Conductor::new(eta, k, at.distribution(&self.roughness));
        self.coat.over(at, interface, LayeredBase::Conductor(base))
    }
}
