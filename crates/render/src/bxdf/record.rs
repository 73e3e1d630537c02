use std::fmt;
use std::ops::{BitOr, BitOrAssign};

use tenfold_math::Vec3;
use tenfold_spectrum::SampledSpectrum;

/// A set of ways to scatter: where to (reflection, transmission) and how (diffuse, glossy, specular).
#[derive(Copy, Clone, PartialEq, Eq, Default)]
pub struct Lobe(u8);

impl Lobe {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// Stays on the side of `wo`.
    pub const REFLECTION: Self = Self(1);
    /// Crosses the surface.
    pub const TRANSMISSION: Self = Self(2);
    /// Spread over the hemisphere.
    pub const DIFFUSE: Self = Self(4);
    /// Concentrated, of finite density.
    pub const GLOSSY: Self = Self(8);
    /// A delta distribution of directions.
    pub const SPECULAR: Self = Self(16);

    /// Whether all of `other` is in this set.
    #[inline]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether a delta is among the lobes. Of a sample: it came from a delta.
    #[inline]
    pub const fn is_specular(self) -> bool {
        self.contains(Self::SPECULAR)
    }

    /// Whether `eval` can be other than zero, so that light sampling is worth its price.
    #[inline]
    pub const fn has_density(self) -> bool {
        self.0 & (Self::DIFFUSE.0 | Self::GLOSSY.0) != 0
    }

    /// The same sides, by deltas alone.
    #[inline]
    pub(super) const fn sharpened(self) -> Self {
        Self(self.0 & (Self::REFLECTION.0 | Self::TRANSMISSION.0) | Self::SPECULAR.0)
    }

    /// Whether a path can be reflected.
    #[inline]
    pub const fn is_reflective(self) -> bool {
        self.contains(Self::REFLECTION)
    }

    /// Whether a path can cross the surface.
    #[inline]
    pub const fn is_transmissive(self) -> bool {
        self.contains(Self::TRANSMISSION)
    }
}

impl BitOr for Lobe {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Lobe {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl fmt::Debug for Lobe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = [
            (Self::REFLECTION, "REFLECTION"),
            (Self::TRANSMISSION, "TRANSMISSION"),
            (Self::DIFFUSE, "DIFFUSE"),
            (Self::GLOSSY, "GLOSSY"),
            (Self::SPECULAR, "SPECULAR"),
        ];
        f.write_str("Lobe(")?;
        let mut separator = "";
        for (lobe, name) in names {
            if self.contains(lobe) {
                write!(f, "{separator}{name}")?;
                separator = " | ";
            }
        }
        f.write_str(")")
    }
}

/// A sampled direction of scattering.
#[derive(Copy, Clone, Debug)]
pub struct BsdfSample {
    /// The BSDF per lane in sr⁻¹, without the cosine; of a specular lobe the weight of the delta over
    /// `|cos θi|`.
    pub f: SampledSpectrum,
    /// The sampled direction, pointing away from the surface.
    pub wi: Vec3,
    /// Per lane the density in solid angle with which this lane *as the hero* samples `wi`; of a specular lobe
    /// the discrete probability. Zero in lanes that could not have produced `wi`.
    pub pdf: SampledSpectrum,
    /// Which lobe the direction came from.
    pub lobe: Lobe,
    /// Of a transmission, the index of refraction of the far side over that of the side of `wo` at the hero's
    /// wavelength; 1 for a reflection.
    pub eta: f32,
    /// Whether the direction depends on the wavelength: a transmission whose index differs between lanes.
    pub dispersive: bool,
}

/// Value and density of scattering at one pair of directions.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) struct Scattering<T> {
    /// The BSDF in sr⁻¹, without the cosine.
    pub(crate) f: T,
    /// Density in solid angle of sampling the second direction from the first.
    pub(crate) pdf: T,
}

impl Scattering<SampledSpectrum> {
    pub(crate) const ZERO: Self = Self { f: SampledSpectrum::ZERO, pdf: SampledSpectrum::ZERO };
}
