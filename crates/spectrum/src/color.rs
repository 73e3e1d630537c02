//! Colours as three numbers: RGB of some colour space, CIE XYZ, and CIE xy chromaticity.

use tenfold_math::{Vec2, Vec3};

/// A colour in the linear RGB of some [`crate::RgbColorSpace`].
#[derive(Copy, Clone, PartialEq, Debug, Default)]
pub struct Rgb(pub Vec3);

/// A colour in CIE 1931 XYZ.
#[derive(Copy, Clone, PartialEq, Debug, Default)]
pub struct Xyz(pub Vec3);

/// A CIE 1931 xy chromaticity.
pub type Chromaticity = Vec2;

impl Rgb {
    /// From its components.
    #[inline]
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self(Vec3::new(r, g, b))
    }

    /// Whether the three components are equal.
    #[inline]
    pub fn is_grey(self) -> bool {
        self.0.x == self.0.y && self.0.y == self.0.z
    }
}

impl Xyz {
    /// From its components.
    #[inline]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self(Vec3::new(x, y, z))
    }

    /// CIE xyY to XYZ; black where `c.y` is 0.
    pub fn from_xyy(c: Chromaticity, y: f32) -> Self {
        if c.y == 0.0 {
            return Self::default();
        }
        Self(Vec3::new(c.x, c.y, 1.0 - c.x - c.y) * (y / c.y))
    }

    /// (X, Y) / (X + Y + Z); 0 for black.
    pub fn chromaticity(self) -> Chromaticity {
        let sum = self.0.element_sum();
        if sum == 0.0 { Vec2::ZERO } else { self.0.truncate() / sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chromaticity_and_xyy_are_inverse() {
        let v = Xyz::new(0.3, 0.5, 0.9);
        let back = Xyz::from_xyy(v.chromaticity(), 0.5);
        assert!((back.0 - v.0).abs().max_element() < 1e-6);
        assert_eq!(Xyz::default().chromaticity(), Vec2::ZERO);
        assert_eq!(Xyz::from_xyy(Vec2::new(0.3, 0.0), 1.0), Xyz::default());
        assert!(Rgb::new(0.2, 0.2, 0.2).is_grey() && !Rgb::new(0.2, 0.2, 0.3).is_grey());
    }
}
