//! Textures: numbers and spectra that vary over surfaces.
//!
//! A texture is a member of one of two closed families, [`FloatTexture`] and [`SpectrumTexture`], kept in the arenas of
//! [`Textures`]. Whoever needs a value that may vary holds a slot ([`FloatSlot`], [`SpectrumSlot`]): a constant, or the id
//! of a texture. Textures made of others hold slots too; a slot only ever refers to textures that came into the arena before.
//!
//! Semantics are those of pbrt-v4 (pbrt book, 4th edition, chapter 10).

mod bilerp;
mod blend;
mod checkerboard;
mod context;
mod dots;
mod imagemap;
mod mapping;
mod noise;
mod procedural;
mod role;

pub use bilerp::Bilerp;
pub use blend::{DirectionMix, Mix, Scale};
pub use checkerboard::{Board, Checkerboard};
pub use context::{Footprint, TextureContext};
pub use dots::Dots;
pub(crate) use imagemap::color_space_of;
pub use imagemap::{ImageMap, SpectrumImageMap};
pub use mapping::{Mapping2, Mapping3, TexCoord2, TexCoord3};
pub use procedural::{Fbm, Marble, Windy, Wrinkled};
pub use role::SpectrumRole;

use blend::blend;
use tenfold_image::TextureFilter;
use tenfold_math::Id;
use tenfold_spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum};

/// A number that varies over surfaces.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// Corner values, interpolated.
    Bilerp(Bilerp<f32>),
    /// A checkerboard.
    Checkerboard(Checkerboard<FloatSlot>),
    /// Polka dots.
    Dots(Dots<FloatSlot>),
    /// An image.
    Image(ImageMap),
    /// A product.
    Scale(Scale<FloatSlot>),
    /// A weighted mean.
    Mix(Mix<FloatSlot>),
    /// A mix by direction.
    DirectionMix(DirectionMix<FloatSlot>),
    /// Fractional Brownian motion.
    Fbm(Fbm),
    /// Creases.
    Wrinkled(Wrinkled),
    /// Waves.
    Windy(Windy),
}

/// A spectrum that varies over surfaces.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// Corner values, interpolated.
    Bilerp(Bilerp<Spectrum>),
    /// A checkerboard.
    Checkerboard(Checkerboard<SpectrumSlot>),
    /// Polka dots.
    Dots(Dots<SpectrumSlot>),
    /// An image.
    Image(SpectrumImageMap),
    /// A product.
    Scale(Scale<SpectrumSlot>),
    /// A weighted mean.
    Mix(Mix<SpectrumSlot>),
    /// A mix by direction.
    DirectionMix(DirectionMix<SpectrumSlot>),
    /// Marble, and what its colours stand for.
    Marble(Marble, SpectrumRole),
}

/// A number that may vary over surfaces.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum FloatSlot {
    /// The same everywhere.
    Constant(f32),
    /// Varying.
    Texture(Id<FloatTexture>),
}

/// A spectrum that may vary over surfaces.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumSlot {
    /// The same everywhere.
    Constant(Spectrum),
    /// Varying.
    Texture(Id<SpectrumTexture>),
}

impl FloatSlot {
    /// The number, where it is the same everywhere.
    pub fn constant(&self) -> Option<f32> {
        match self {
            Self::Constant(v) => Some(*v),
            Self::Texture(_) => None,
        }
    }
}

impl SpectrumSlot {
    /// The spectrum, where it is the same everywhere.
    pub fn constant(&self) -> Option<&Spectrum> {
        match self {
            Self::Constant(v) => Some(v),
            Self::Texture(_) => None,
        }
    }
}

/// All textures of a scene.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    floats: Vec<FloatTexture>,
    spectra: Vec<SpectrumTexture>,
}

impl Textures {
    /// Adds a texture of numbers.
    pub fn add_float(&mut self, texture: FloatTexture) -> Id<FloatTexture> {
        self.floats.push(texture);
        Id::new(self.floats.len() - 1)
    }

    /// Adds a texture of spectra.
    pub fn add_spectrum(&mut self, texture: SpectrumTexture) -> Id<SpectrumTexture> {
        self.spectra.push(texture);
        Id::new(self.spectra.len() - 1)
    }

    /// A texture of numbers.
    pub fn float_texture(&self, id: Id<FloatTexture>) -> &FloatTexture {
        &self.floats[id.index()]
    }

    /// A texture of spectra.
    pub fn spectrum_texture(&self, id: Id<SpectrumTexture>) -> &SpectrumTexture {
        &self.spectra[id.index()]
    }

    /// Whether any texture's values depend on the footprint beyond what the samples of a pixel average out by themselves:
    /// only those that are asked to filter.
    pub fn need_footprint(&self) -> bool {
        let filters = |t: &ImageMap| matches!(t.filter, TextureFilter::Trilinear | TextureFilter::Ewa { .. });
        self.floats.iter().any(|t| matches!(t, FloatTexture::Image(t) if filters(t)))
            || self.spectra.iter().any(|t| matches!(t, SpectrumTexture::Image(t) if filters(&t.image)))
    }

    /// The number in a slot, at a point of a surface.
    #[inline]
    pub fn float(&self, slot: &FloatSlot, at: &TextureContext) -> f32 {
        match slot {
            FloatSlot::Constant(v) => *v,
            FloatSlot::Texture(id) => self.eval_float(&self.floats[id.index()], at),
        }
    }

    /// The spectrum in a slot, at a point of a surface and the wavelengths of a path.
    #[inline]
    pub fn spectrum(
        &self,
        slot: &SpectrumSlot,
        at: &TextureContext,
        w: &SampledWavelengths,
    ) -> SampledSpectrum {
        match slot {
            SpectrumSlot::Constant(v) => v.sample(w),
            SpectrumSlot::Texture(id) => self.eval_spectrum(&self.spectra[id.index()], at, w),
        }
    }

    /// The spectrum in a slot at a point of a surface, where it is one that the scene has and no mixture.
    #[inline]
    pub fn settle<'s>(&'s self, slot: &'s SpectrumSlot, at: &TextureContext) -> Option<&'s Spectrum> {
        let id = match slot {
            SpectrumSlot::Constant(v) => return Some(v),
            SpectrumSlot::Texture(id) => *id,
        };
        match self.spectrum_texture(id) {
            SpectrumTexture::Checkerboard(t) => {
                let weight = t.board.weight(at);
                if weight != 0.0 && weight != 1.0 {
                    return None;
                }
                // Which one is not foreseen: no branch for that.
                t.textures[usize::from(weight == 1.0)].constant()
            }
            SpectrumTexture::Dots(t) => t.choose(at).constant(),
            _ => None,
        }
    }

    fn eval_float(&self, texture: &FloatTexture, at: &TextureContext) -> f32 {
        let part = |slot: &FloatSlot| self.float(slot, at);
        match texture {
            FloatTexture::Bilerp(t) => t.eval(at, |v| *v),
            FloatTexture::Checkerboard(t) => blend(&t.textures, t.board.weight(at), part),
            FloatTexture::Dots(t) => part(t.choose(at)),
            FloatTexture::Image(t) => t.float(at),
            FloatTexture::Scale(t) => match part(&t.scale) {
                0.0 => 0.0,
                scale => scale * part(&t.texture),
            },
            FloatTexture::Mix(t) => blend(&t.textures, part(&t.amount), part),
            FloatTexture::DirectionMix(t) => blend(&t.textures, t.weight(at), part),
            FloatTexture::Fbm(t) => t.eval(at),
            FloatTexture::Wrinkled(t) => t.eval(at),
            FloatTexture::Windy(t) => t.eval(at),
        }
    }

    fn eval_spectrum(
        &self,
        texture: &SpectrumTexture,
        at: &TextureContext,
        w: &SampledWavelengths,
    ) -> SampledSpectrum {
        let part = |slot: &SpectrumSlot| self.spectrum(slot, at, w);
        match texture {
            SpectrumTexture::Bilerp(t) => t.eval(at, |v| v.sample(w)),
            SpectrumTexture::Checkerboard(t) => blend(&t.textures, t.board.weight(at), part),
            SpectrumTexture::Dots(t) => part(t.choose(at)),
            SpectrumTexture::Image(t) => t.spectrum(at, w),
            SpectrumTexture::Scale(t) => match self.float(&t.scale, at) {
                0.0 => SampledSpectrum::ZERO,
                scale => part(&t.texture) * scale,
            },
            SpectrumTexture::Mix(t) => blend(&t.textures, self.float(&t.amount, at), part),
            SpectrumTexture::DirectionMix(t) => blend(&t.textures, t.weight(at), part),
            SpectrumTexture::Marble(t, role) => role.sample(RgbColorSpace::srgb(), Rgb(t.eval(at)), w),
        }
    }
}

#[cfg(test)]
mod tests;
