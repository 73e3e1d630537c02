//! What a light, or a group of lights, can send toward a point at most: the measure by which lights are chosen.

use super::cone;
use tenfold_geometry::NormalCone;
use tenfold_math::ops;
use tenfold_math::{Bounds3, Vec3};

/// Where light is emitted, in which directions and how strongly.
#[derive(Copy, Clone, Debug)]
pub struct LightBounds {
    /// A box around the emitting points.
    pub bounds: Bounds3,
    /// Radius of a sphere around the centre of `bounds` that holds the emitting points.
    pub radius: f32,
    /// The normals of the emitting points (of one side).
    pub normals: NormalCone,
    /// Cosine of the angle from its normal up to which a point emits; not negative.
    pub cos_emission: f32,
    /// Sum of the radiant intensities along the normals, in W·sr⁻¹·nm⁻¹ averaged over the visible wavelengths.
    pub intensity: f32,
    /// Whether the opposite normals emit as well.
    pub two_sided: bool,
}

impl LightBounds {
    /// Of light that leaves the point `p` in the directions of `cone`.
    pub fn point(p: Vec3, cone: NormalCone, intensity: f32) -> Self {
        // The slack covers the rounding of the angles, which must not cut off the rim of a cone.
        let cos_emission = 0.999;
        Self {
            bounds: Bounds3::new(p, p),
            radius: 0.0,
            normals: cone,
            cos_emission,
            intensity,
            two_sided: false,
        }
    }

    /// Of both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let bounds = self.bounds.union(other.bounds);
        let centre = bounds.centroid();
        let reach = |b: &Self| b.bounds.centroid().distance(centre) + b.radius;
        Self {
            bounds,
            radius: (0.5 * bounds.diagonal().length()).min(reach(&self).max(reach(&other))),
            normals: cone::union(self.normals, other.normals),
            cos_emission: self.cos_emission.min(other.cos_emission),
            intensity: self.intensity + other.intensity,
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// The measure of the directions that get light, in steradians, weighted by the cosine beyond the cone of the
    /// normals (Conty Estevez and Kulla 2018, eq. 1).
    pub fn orientation_measure(&self) -> f32 {
        use std::f32::consts::{PI, TAU};
        let (cos_o, sin_o) =
            (self.normals.cos_theta, (1.0 - self.normals.cos_theta * self.normals.cos_theta).max(0.0).sqrt());
        let theta_o = ops::acos(cos_o.clamp(-1.0, 1.0));
        let theta_w = (theta_o + ops::acos(self.cos_emission.clamp(-1.0, 1.0))).min(PI);
        TAU * (1.0 - cos_o)
            + 0.5
                * PI
                * (2.0 * theta_w * sin_o - ops::cos(theta_o - 2.0 * theta_w) - 2.0 * theta_o * sin_o + cos_o)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_of_whole_spheres_and_of_flat_emitters() {
        use std::f32::consts::PI;
        let b = LightBounds::point(Vec3::ZERO, NormalCone::EVERYWHERE, 1.0);
        assert!((b.orientation_measure() - 4.0 * PI).abs() < 1e-4);
        let flat = LightBounds { normals: NormalCone::along(Vec3::Z), cos_emission: 0.0, ..b };
        assert!((flat.orientation_measure() - PI).abs() < 1e-4);
    }
}
