use super::RenderSettings;
use std::fmt;
use tenfold_math::Vec2;
use tenfold_sampling::{Draw, Variable};

/// Something that a render holds at one value, so that its effect is absent from the picture.
///
/// A held variable ([`Draw::Held`]) gives its value at every vertex of every path. What that means where it is not plain:
///
/// - `Pixel`: the value is the place in the pixel's square, whatever the filter, and its weight is one.
/// - `Lens`: ½, ½ is the middle of the lens: everything is sharp. `Time`: ½ is half way between opening and closing,
///   whatever the shutter's curve.
/// - `LightPoint`: every light shines from one point. `ScatterDirection`: every lobe scatters in one direction, for ½, ½ in its
///   middle. Where light is sampled, it is found in no other way: see [`Strategies::held`](crate::integrator::Strategies::held).
/// - `Alpha`: surfaces are there where their alpha is above the value, and else not.
/// - `Roulette`: paths go on however little they carry, whatever the value.
/// - Other choices (`LightChoice`, `ScatterLobe`, `MaterialMix`, ...): one alternative stands for all, and the others are missing.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Frozen {
    /// A variable of the integral, at numbers in `[0, 1)`. Not the wavelength.
    Variable(Variable, Vec2),
    /// The wavelength, in nm: the picture in the light of this one, divided by the density with which it would
    /// have been drawn. The mean of such pictures over wavelengths so drawn is the picture in all light.
    Wavelength(f32),
    /// Dispersion: all light is refracted as light of this wavelength, in nm, is. Colours stay.
    Dispersion(f32),
}

impl Frozen {
    /// The wavelength of helium's d line, in nm, at which catalogues quote the index of refraction of glass.
    pub const D_LINE: f32 = 587.56;
}

/// As the command line has it: `time=0.5`, `lens=0.5:0.25`, `wavelength=550`.
impl fmt::Display for Frozen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variable(variable, v) if v.x == v.y => write!(f, "{}={}", variable.name(), v.x),
            Self::Variable(variable, v) => write!(f, "{}={}:{}", variable.name(), v.x, v.y),
            Self::Wavelength(nm) => write!(f, "wavelength={nm}"),
            Self::Dispersion(nm) => write!(f, "dispersion={nm}"),
        }
    }
}

impl RenderSettings {
    /// Holds something at a value.
    pub fn freeze(&mut self, frozen: Frozen) {
        match frozen {
            Frozen::Variable(variable, value) => self.sampling.set(variable, Draw::Held(value)),
            Frozen::Wavelength(nm) => self.wavelength = Some(nm),
            Frozen::Dispersion(nm) => self.index_wavelength = Some(nm),
        }
    }

    /// All that is held.
    pub fn frozen(&self) -> Vec<Frozen> {
        let variables = Variable::ALL.into_iter().filter_map(|variable| match self.sampling.draw(variable) {
            Draw::Held(value) => Some(Frozen::Variable(variable, value)),
            Draw::By(_) => None,
        });
        let wavelength = self.wavelength.map(Frozen::Wavelength);
        variables.chain(wavelength).chain(self.index_wavelength.map(Frozen::Dispersion)).collect()
    }
}
