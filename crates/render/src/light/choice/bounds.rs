//! What a light, or a group of lights, can send toward a point at most: the measure by which lights are chosen.

use super::cone;
use tenfold_geometry::{NormalCone, ReferencePoint};
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

/// How many clusters are weighed together.
pub(super) const LANES: usize = 8;

/// The bounds of up to [`LANES`] lights or groups of lights, side by side as the choice reads them. Lanes
/// that are not set have no light.
#[derive(Copy, Clone, Debug)]
pub(super) struct Clusters {
    centre: [[f32; LANES]; 3],
    radius: [f32; LANES],
    axis: [[f32; LANES]; 3],
    cos_normals: [f32; LANES],
    cos_emission: [f32; LANES],
    intensity: [f32; LANES],
    two_sided: [bool; LANES],
}

/// `cos(max(0, a − b))` of two angles in `[0, π]`.
#[inline(always)]
fn cos_difference(cos_a: f32, sin_a: f32, cos_b: f32, sin_b: f32) -> f32 {
    let difference = cos_a * cos_b + sin_a * sin_b;
    if cos_a > cos_b { 1.0 } else { difference }
}

/// `sin(max(0, a − b))` of two angles in `[0, π]`.
#[inline(always)]
fn sin_difference(cos_a: f32, sin_a: f32, cos_b: f32, sin_b: f32) -> f32 {
    let difference = sin_a * cos_b - cos_a * sin_b;
    if cos_a > cos_b { 0.0 } else { difference }
}

#[inline(always)]
fn sin_of(cos: f32) -> f32 {
    (1.0 - cos * cos).max(0.0).sqrt()
}

/// Importances are cut here, so that their sums are finite.
const MAX_IMPORTANCE: f32 = 1e30;

impl Clusters {
    pub(super) const EMPTY: Self = Self {
        centre: [[0.0; LANES]; 3],
        radius: [0.0; LANES],
        axis: [[0.0; LANES]; 3],
        cos_normals: [0.0; LANES],
        cos_emission: [0.0; LANES],
        intensity: [0.0; LANES],
        two_sided: [false; LANES],
    };

    pub(super) fn set(&mut self, lane: usize, b: &LightBounds) {
        let centre = b.bounds.centroid();
        for k in 0..3 {
            self.centre[k][lane] = centre[k];
            self.axis[k][lane] = b.normals.axis[k];
        }
        self.radius[lane] = b.radius;
        self.cos_normals[lane] = b.normals.cos_theta;
        self.cos_emission[lane] = b.cos_emission;
        self.intensity[lane] = b.intensity;
        self.two_sided[lane] = b.two_sided;
    }

    /// An estimate of the irradiance at `from` from each lane, on the sides of the surface that matter there; on a surface
    /// turned toward the light where there is none. It is 0 only where no light arrives (Conty Estevez and Kulla 2018, section 4.2; pbrt book, 4th edition, section 12.6.3), and stays
    /// finite inside of a cluster: the distance counts as the radius of the cluster at least.
    // One index for all arrays; and unlike `clamp`, `max` turns what is not a number into 0.
    #[allow(clippy::needless_range_loop, clippy::manual_clamp)]
    #[inline]
    pub(super) fn importance(&self, from: &ReferencePoint) -> [f32; LANES] {
        let (p, n) = (from.p, from.ns);
        let on_surface = n != Vec3::ZERO;
        let mut importance = [0.0; LANES];
        // Without branches or calls, so that the compiler makes vectors of the lanes.
        for i in 0..LANES {
            let d = [p.x - self.centre[0][i], p.y - self.centre[1][i], p.z - self.centre[2][i]];
            let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let r2 = self.radius[i] * self.radius[i];
            let distance2 = d2.max(r2);
            let scale = if d2 > 0.0 { 1.0 / d2.sqrt() } else { 0.0 };
            let w = [d[0] * scale, d[1] * scale, d[2] * scale];
            // Half angle under which `p` sees the sphere around the cluster.
            let inside = d2 <= r2;
            let sin2_b = if inside { 0.0 } else { r2 / d2 };
            let sin_b = sin2_b.sqrt();
            let cos_b = if inside { -1.0 } else { (1.0 - sin2_b).sqrt() };
            // Angle from the nearest normal to the nearest of the directions in which the cluster sees `p`.
            let cos_w = self.axis[0][i] * w[0] + self.axis[1][i] * w[1] + self.axis[2][i] * w[2];
            let cos_w = if self.two_sided[i] { cos_w.abs() } else { cos_w };
            let (sin_w, cos_o) = (sin_of(cos_w), self.cos_normals[i]);
            let sin_o = sin_of(cos_o);
            let cos_x = cos_difference(cos_w, sin_w, cos_o, sin_o);
            let sin_x = sin_difference(cos_w, sin_w, cos_o, sin_o);
            let cos_emitted = cos_difference(cos_x, sin_x, cos_b, sin_b);
            let cos_i = -(n.x * w[0] + n.y * w[1] + n.z * w[2]);
            let cos_i = if from.one_sided { cos_i } else { cos_i.abs() };
            let facing = cos_difference(cos_i, sin_of(cos_i), cos_b, sin_b).max(0.0);
            let facing = if on_surface { facing } else { 1.0 };
            let value = (self.intensity[i] * cos_emitted * facing / distance2).max(0.0).min(MAX_IMPORTANCE);
            let reached = (cos_emitted > self.cos_emission[i]) & (distance2 > 0.0);
            importance[i] = if reached { value } else { 0.0 };
        }
        importance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Cluster(LightBounds);

    impl Cluster {
        fn importance(&self, p: Vec3, n: Vec3) -> f32 {
            let mut clusters = Clusters::EMPTY;
            clusters.set(3, &self.0);
            let importance = clusters.importance(&ReferencePoint { ns: n, ..ReferencePoint::free(p, 0.0) });
            assert_eq!(importance.iter().sum::<f32>(), importance[3]);
            importance[3]
        }
    }

    #[test]
    fn a_point_has_the_irradiance_it_makes() {
        let b = LightBounds::point(Vec3::new(0.0, 0.0, 2.0), NormalCone::EVERYWHERE, 3.0);
        let c = Cluster(b);
        assert!((c.importance(Vec3::ZERO, Vec3::Z) - 0.75).abs() < 1e-6);
        assert!((c.importance(Vec3::ZERO, Vec3::NEG_Z) - 0.75).abs() < 1e-6);
        let p = Vec3::new(2.0, 0.0, 0.0);
        assert!((c.importance(p, Vec3::Z) - 3.0 / 8.0 * 0.5f32.sqrt()).abs() < 1e-6);
        assert!((c.importance(p, Vec3::ZERO) - 3.0 / 8.0).abs() < 1e-6);
    }

    #[test]
    fn an_emitter_turned_away_has_none() {
        let b = LightBounds {
            bounds: Bounds3::new(Vec3::new(-0.1, -0.1, 0.0), Vec3::new(0.1, 0.1, 0.0)),
            radius: 0.1 * 2f32.sqrt(),
            normals: NormalCone::along(Vec3::Z),
            cos_emission: 0.0,
            intensity: 1.0,
            two_sided: false,
        };
        let below = Vec3::new(0.0, 0.0, -1.0);
        assert_eq!(Cluster(b).importance(below, Vec3::ZERO), 0.0);
        assert!(Cluster(LightBounds { two_sided: true, ..b }).importance(below, Vec3::ZERO) > 0.9);
        assert!(Cluster(b).importance(-below, Vec3::ZERO) > 0.9);
        assert!(Cluster(b).importance(Vec3::new(0.05, 0.0, 0.0), Vec3::X).is_finite());
    }

    #[test]
    fn measures_of_whole_spheres_and_of_flat_emitters() {
        use std::f32::consts::PI;
        let b = LightBounds::point(Vec3::ZERO, NormalCone::EVERYWHERE, 1.0);
        assert!((b.orientation_measure() - 4.0 * PI).abs() < 1e-4);
        let flat = LightBounds { normals: NormalCone::along(Vec3::Z), cos_emission: 0.0, ..b };
        assert!((flat.orientation_measure() - PI).abs() < 1e-4);
    }
}
