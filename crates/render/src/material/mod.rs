//! Materials: how surfaces scatter light, as textures tell.
//!
//! A [`Material`] is a member of a closed family with slots for textures; [`Materials::bsdf`] evaluates them at a point
//! and answers the scattering function there. Semantics are those of pbrt-v4 (pbrt book, 4th edition, §10.5).

mod coat;
mod conductor;
mod dielectric;
mod diffuse;
mod eta;
mod mix;
mod relief;
mod roughness;

pub use coat::{Coat, CoatedConductor, CoatedDiffuse};
pub use conductor::{Conductor, Metal};
pub use dielectric::{Dielectric, ThinDielectric};
pub use diffuse::{Diffuse, DiffuseTransmission};
pub use eta::Eta;
pub use mix::Mix;
pub use relief::Relief;
pub use roughness::Roughness;

use tenfold_geometry::SurfaceInteraction;
use tenfold_math::Id;
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

use crate::{
    bxdf::{Bsdf, Bxdf, TrowbridgeReitz, WideBxdf},
    texture::{FloatSlot, SpectrumSlot, TextureContext, Textures},
};

/// What a surface is made of.
#[derive(Clone, Debug)]
pub enum Material {
    /// Scatters evenly back.
    Diffuse(Diffuse),
    /// Scatters evenly to both sides.
    DiffuseTransmission(DiffuseTransmission),
    /// Metal.
    Conductor(Conductor),
    /// Boundary of a transparent body.
    Dielectric(Dielectric),
    /// Pane.
    ThinDielectric(ThinDielectric),
    /// Lambertian reflector under a coat.
    CoatedDiffuse(CoatedDiffuse),
    /// Metal under a coat.
    CoatedConductor(CoatedConductor),
    /// One of two, by chance.
    Mix(Mix),
    /// Nothing: a boundary between media, which light does not notice.
    Interface,
}

/// All materials of a scene.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    all: Vec<Material>,
    /// The relief of each.
    reliefs: Vec<Relief>,
    /// Whether each is textured, its relief not counted.
    textured: Vec<bool>,
}

/// The wavelengths at which a material is evaluated.
#[derive(Copy, Clone, Debug)]
pub struct Waves<'a> {
    /// Those of the light.
    pub light: &'a SampledWavelengths,
    /// Those whose indices of refraction dielectrics have, which are the same unless dispersion is frozen.
    pub indices: &'a SampledWavelengths,
}

impl<'a> From<&'a SampledWavelengths> for Waves<'a> {
    fn from(light: &'a SampledWavelengths) -> Self {
        Self { light, indices: light }
    }
}

/// Where, and at which wavelengths, a material is evaluated.
#[derive(Copy, Clone, Debug)]
struct Point<'a> {
    textures: &'a Textures,
    context: &'a TextureContext,
    waves: Waves<'a>,
}

impl Point<'_> {
    #[inline]
    fn float(&self, slot: &FloatSlot) -> f32 {
        self.textures.float(slot, self.context)
    }

    #[inline]
    fn spectrum(&self, slot: &SpectrumSlot) -> SampledSpectrum {
        self.textures.spectrum(slot, self.context, self.waves.light)
    }

    /// A fraction of light.
    #[inline]
    fn albedo(&self, slot: &SpectrumSlot) -> SampledSpectrum {
        self.spectrum(slot).clamp(0.0, 1.0)
    }

    #[inline]
    fn distribution(&self, roughness: &Roughness) -> TrowbridgeReitz {
        roughness.distribution(self.textures, self.context)
    }
}

impl Material {
    /// The scattering function at a point; `None` where a surface of this material has none of its own.
    #[inline]
    fn bxdf(&self, at: &Point<'_>) -> Option<Bxdf<'_>> {
        Some(match self {
            Self::Diffuse(m) => Bxdf::Diffuse(m.bxdf(at)),
            Self::DiffuseTransmission(m) => Bxdf::DiffuseTransmission(m.bxdf(at)),
            Self::Conductor(m) => Bxdf::Conductor(m.bxdf(at)),
            Self::Dielectric(m) => Bxdf::Dielectric(m.bxdf(at)),
            Self::ThinDielectric(m) => Bxdf::ThinDielectric(m.bxdf(at)),
            Self::CoatedDiffuse(m) => m.bxdf(at),
            Self::CoatedConductor(m) => m.bxdf(at),
            Self::Mix(_) | Self::Interface => return None,
        })
    }

    /// Whether anything of it varies over a surface.
    fn is_textured(&self) -> bool {
        match self {
            Self::Diffuse(m) => m.reflectance.constant().is_none(),
            Self::DiffuseTransmission(m) => {
                m.reflectance.constant().and(m.transmittance.constant()).is_none()
            }
            Self::Conductor(m) => m.metal.is_textured() || m.roughness.constant().is_none(),
            Self::Dielectric(m) => m.roughness.constant().is_none(),
            Self::CoatedDiffuse(m) => m.reflectance.constant().is_none() || m.coat.is_textured(),
            Self::CoatedConductor(m) => {
                m.metal.is_textured() || m.roughness.constant().is_none() || m.coat.is_textured()
            }
            Self::Mix(_) => true,
            Self::ThinDielectric(_) | Self::Interface => false,
        }
    }
}

impl Materials {
    /// Adds a material.
    pub fn add(&mut self, material: Material, relief: Relief) -> Id<Material> {
        self.textured.push(material.is_textured());
        self.all.push(material);
        self.reliefs.push(relief);
        Id::new(self.all.len() - 1)
    }

    /// Replaces a material: for those that others named before they were known.
    pub fn set(&mut self, id: Id<Material>, material: Material, relief: Relief) {
        self.textured[id.index()] = material.is_textured();
        self.all[id.index()] = material;
        self.reliefs[id.index()] = relief;
    }

    /// A material.
    pub fn get(&self, id: Id<Material>) -> &Material {
        &self.all[id.index()]
    }

    /// The relief of a surface made of it.
    pub fn relief(&self, id: Id<Material>) -> &Relief {
        &self.reliefs[id.index()]
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Whether light does not notice a surface of this material anywhere.
    #[inline]
    pub fn is_interface(&self, id: Id<Material>) -> bool {
        matches!(self.all[id.index()], Material::Interface)
    }

    /// Whether light may not notice a surface of this material at some points, as far as can be told without looking at one.
    #[inline]
    pub fn may_be_interface(&self, id: Id<Material>) -> bool {
        matches!(self.all[id.index()], Material::Interface | Material::Mix(_))
    }

    /// The scattering function where a ray meets `surface`; `None` where light passes as if there were no surface. Its
    /// frame ([`Bsdf::frame`]) has the shading normal along z, bent by the material's relief where it has one: that
    /// is the normal that cosines are about.
    ///
    /// `at` is the point as textures see it. `u_mix` gives a number in [0, 1) that chooses between mixed materials; it is
    /// asked for at most once, and only where the chance is real.
    #[inline]
    pub fn bsdf<'w>(
        &self,
        id: Id<Material>,
        textures: &Textures,
        surface: &SurfaceInteraction,
        at: &TextureContext,
        waves: impl Into<Waves<'w>>,
        u_mix: impl FnOnce() -> f32,
    ) -> Option<Bsdf<'_>> {
        let id = self.resolve(id, textures, at, u_mix);
        let bxdf = self.all[id.index()].bxdf(&Point { textures, context: at, waves: waves.into() })?;
        let frame = self.reliefs[id.index()].frame(textures, surface, at);
        Some(Bsdf::new(frame, bxdf))
    }

    /// Whether surfaces of this material scatter all in the same way, and in the shapes' own frames: no mix, no interface, no relief.
    #[inline]
    pub fn is_plain(&self, id: Id<Material>) -> bool {
        !self.may_be_interface(id) && matches!(self.reliefs[id.index()], Relief::Smooth)
    }

    /// Whether textures tell more of it than its relief.
    #[inline]
    pub fn is_textured(&self, id: Id<Material>) -> bool {
        self.textured[id.index()]
    }

    /// The scattering function of a plain surface in its frame, at a point as textures see it; `None` where it takes more to tell.
    #[inline]
    pub fn bxdf<'w>(
        &self,
        id: Id<Material>,
        textures: &Textures,
        at: &TextureContext,
        waves: impl Into<Waves<'w>>,
    ) -> Option<Bxdf<'_>> {
        self.all[id.index()].bxdf(&Point { textures, context: at, waves: waves.into() })
    }

    /// The albedo, beyond whose bounds of 0 and 1 it is clamped, of surfaces of this material, where they are plain even reflectors: what
    /// [`Materials::bsdf`] answers is a [`Bxdf::Diffuse`] of it. `None` of others.
    #[inline]
    pub fn even_albedo(&self, id: Id<Material>) -> Option<&SpectrumSlot> {
        match (&self.all[id.index()], &self.reliefs[id.index()]) {
            (Material::Diffuse(m), Relief::Smooth) => Some(&m.reflectance),
            _ => None,
        }
    }

    /// What [`Materials::bsdf`] answers of a plain surface, where that is a scattering function that is computed side by side; `None` of others.
    #[inline(always)]
    pub(crate) fn wide_bxdf<'w>(
        &self,
        id: Id<Material>,
        textures: &Textures,
        at: &TextureContext,
        waves: impl Into<Waves<'w>>,
    ) -> Option<WideBxdf> {
        let Relief::Smooth = self.reliefs[id.index()] else { return None };
        let at = Point { textures, context: at, waves: waves.into() };
        match &self.all[id.index()] {
            Material::Diffuse(m) => Some(WideBxdf::Diffuse(m.bxdf(&at).reflectance())),
            Material::Dielectric(m) => m.rough(&at).map(WideBxdf::Dielectric),
            Material::Conductor(m) => m.rough(&at).map(WideBxdf::Conductor),
            _ => None,
        }
    }

    /// The material itself, or the one that chance takes out of a mix.
    #[inline]
    fn resolve(
        &self,
        mut id: Id<Material>,
        textures: &Textures,
        at: &TextureContext,
        u_mix: impl FnOnce() -> f32,
    ) -> Id<Material> {
        let mut ask = Some(u_mix);
        let mut u = 0.0;
        // Mixes of mixes end: a mix that contains itself is refused when a scene is compiled.
        while let Material::Mix(mix) = &self.all[id.index()] {
            let amount = textures.float(&mix.amount, at);
            if amount > 0.0
                && amount < 1.0
                && let Some(u_mix) = ask.take()
            {
                u = u_mix();
            }
            (id, u) = mix.choose(amount, u);
        }
        id
    }
}

#[cfg(test)]
mod tests;
