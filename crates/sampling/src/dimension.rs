//! The variables of the integral, by name.

/// What a random number decides.
///
/// The numbers never change, so some names wait for their use: media, light that starts at light sources. The chance of a partly
/// transparent surface and the walks within coats draw from hashes of the ray and of the point instead.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Variable {
    /// The point in the pixel (two numbers).
    Pixel = 0,
    /// The point on the lens (two numbers).
    Lens = 1,
    /// The time in the shutter interval.
    Time = 2,
    /// The hero wavelength.
    Wavelength = 3,
    /// Which wavelength goes on alone where wavelengths part.
    Hero = 4,
    /// Which light is sampled.
    LightChoice = 5,
    /// The point on the light (two numbers).
    LightPoint = 6,
    /// Which lobe scatters.
    ScatterLobe = 7,
    /// The direction of scattering within its lobe (two numbers).
    ScatterDirection = 8,
    /// Which of the mixed materials is met.
    MaterialMix = 9,
    /// Whether a partly transparent surface is met at all.
    Alpha = 10,
    /// The walk within a layered material: seeds it, by [`PixelSample::hash`](crate::PixelSample::hash).
    Layer = 11,
    /// Whether the path goes on.
    Roulette = 12,
    /// The distance to the next event in a medium, or the seed of the walk to it.
    MediumDistance = 13,
    /// What happens in the medium.
    MediumEvent = 14,
    /// The direction of scattering in a medium (two numbers).
    PhaseDirection = 15,
    /// The shadow ray's way through media: seeds it.
    Transmittance = 16,
    /// The directions of light that starts at light sources (two numbers).
    LightDirection = 17,
}

impl Variable {
    /// All variables, in the order of their numbers.
    pub const ALL: [Self; 18] = [
        Self::Pixel,
        Self::Lens,
        Self::Time,
        Self::Wavelength,
        Self::Hero,
        Self::LightChoice,
        Self::LightPoint,
        Self::ScatterLobe,
        Self::ScatterDirection,
        Self::MaterialMix,
        Self::Alpha,
        Self::Layer,
        Self::Roulette,
        Self::MediumDistance,
        Self::MediumEvent,
        Self::PhaseDirection,
        Self::Transmittance,
        Self::LightDirection,
    ];

    /// The name for people, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pixel => "pixel",
            Self::Lens => "lens",
            Self::Time => "time",
            Self::Wavelength => "wavelength",
            Self::Hero => "hero",
            Self::LightChoice => "light-choice",
            Self::LightPoint => "light-point",
            Self::ScatterLobe => "scatter-lobe",
            Self::ScatterDirection => "scatter-direction",
            Self::MaterialMix => "material-mix",
            Self::Alpha => "alpha",
            Self::Layer => "layer",
            Self::Roulette => "roulette",
            Self::MediumDistance => "medium-distance",
            Self::MediumEvent => "medium-event",
            Self::PhaseDirection => "phase-direction",
            Self::Transmittance => "transmittance",
            Self::LightDirection => "light-direction",
        }
    }
}

/// A variable at a vertex of the path: the name under which a [`PixelSample`](crate::PixelSample) is asked for numbers.
///
/// The same dimension gives the same numbers whenever it is asked, and `get_1d` and `get_2d` of one dimension
/// are not independent of each other: a use has one name.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Dimension {
    /// What the numbers decide.
    pub variable: Variable,
    /// At which vertex of the path: 0 at the camera and at the first surface met, and so on.
    pub bounce: u16,
}

macro_rules! per_bounce {
    ($($name:ident $variable:ident $text:literal),* $(,)?) => {
        $(#[doc = concat!($text, " at a vertex of the path.")]
        #[inline]
        pub const fn $name(bounce: u16) -> Self {
            Self::new(Variable::$variable, bounce)
        })*
    };
}

impl Dimension {
    /// The point in the pixel.
    pub const PIXEL: Self = Self::new(Variable::Pixel, 0);
    /// The point on the lens.
    pub const LENS: Self = Self::new(Variable::Lens, 0);
    /// The time in the shutter interval.
    pub const TIME: Self = Self::new(Variable::Time, 0);
    /// The hero wavelength.
    pub const WAVELENGTH: Self = Self::new(Variable::Wavelength, 0);

    /// The `variable` at the vertex `bounce`.
    #[inline]
    pub const fn new(variable: Variable, bounce: u16) -> Self {
        Self { variable, bounce }
    }

    per_bounce! {
        hero Hero "The wavelength that goes on alone",
        light_choice LightChoice "The choice of a light",
        light_point LightPoint "The point on the light",
        scatter_lobe ScatterLobe "The choice of a lobe",
        scatter_direction ScatterDirection "The direction within the lobe",
        material_mix MaterialMix "The choice of a mixed material",
        alpha Alpha "The chance of a partly transparent surface",
        layer Layer "The walk within a layered material",
        roulette Roulette "Russian roulette",
        medium_distance MediumDistance "The distance in a medium",
        medium_event MediumEvent "The event in a medium",
        phase_direction PhaseDirection "The direction of scattering in a medium",
        transmittance Transmittance "The shadow ray's way through media",
        light_direction LightDirection "The direction of emitted light",
    }

    /// A number that no other dimension has, and that never changes: pictures depend on it.
    #[inline]
    pub const fn key(self) -> u32 {
        (self.bounce as u32) << 8 | self.variable as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn keys_and_names_are_distinct_and_stable() {
        let mut keys = HashSet::new();
        let mut names = HashSet::new();
        for (i, v) in Variable::ALL.into_iter().enumerate() {
            assert_eq!(v as usize, i);
            assert!(names.insert(v.name()));
            for bounce in [0, 1, 2, 255, 256, u16::MAX] {
                assert!(keys.insert(Dimension::new(v, bounce).key()));
            }
        }
        assert_eq!(Dimension::light_point(2).key(), 0x206);
        assert_eq!(Dimension::LENS.key(), 1);
    }
}
