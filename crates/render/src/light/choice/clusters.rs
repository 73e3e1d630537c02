//! The bounds of a node's clusters, side by side and in few bits: choosing among many lights is waiting for memory.

use super::bounds::LightBounds;
use tenfold_geometry::ReferencePoint;
use tenfold_math::{Vec3, vectorized};

/// How many clusters are weighed together.
pub(super) const LANES: usize = 8;

/// The bounds of up to [`LANES`] lights or groups of lights, as the choice reads them. Lanes that are not set have no light.
///
/// Lengths are counted in steps of a grid around the clusters. All is rounded so that what a cluster may reach by its bounds, it may
/// reach by these, too (as in pbrt-v4's `CompactLightBounds`; pbrt book, 4th edition, section 12.6.3).
#[derive(Copy, Clone, Debug)]
pub(super) struct Clusters {
    origin: [f32; 3],
    step: f32,
    centre: [[u16; LANES]; 3],
    radius: [u16; LANES],
    /// In units of 1/[`AXIS_UNIT`].
    axis: [[i16; LANES]; 3],
    /// The upper half of a float, and its sign where two sides emit.
    intensity: [u16; LANES],
    cos_normals: [u8; LANES],
    cos_emission: [u8; LANES],
}

const AXIS_UNIT: f32 = 32767.0;
/// Centres take half the range of their numbers: radii are larger by what rounding moves centres.
const MOST_STEPS: f32 = 32767.0;
const TWO_SIDED: u16 = 1 << 15;

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

/// From 0 for −1 to 255 for 1.
#[inline(always)]
fn cos_normals(q: u8) -> f32 {
    f32::from(q) * (2.0 / 255.0) - 1.0
}

/// Half a unit below what it stands for: that covers the rounding of directions.
#[inline(always)]
fn cos_emission(q: u8) -> f32 {
    (f32::from(q) - 0.5) * (1.0 / 255.0)
}

/// Cosines of emission count as this much at least, where there is emission.
const LEAST_COSINE: f32 = 1e-3;
/// Importances are cut here, so that their sums are finite.
const MAX_IMPORTANCE: f32 = 1e30;

impl Clusters {
    pub(super) const EMPTY: Self = Self {
        origin: [0.0; 3],
        step: 0.0,
        centre: [[0; LANES]; 3],
        radius: [0; LANES],
        axis: [[0; LANES]; 3],
        intensity: [0; LANES],
        cos_normals: [0; LANES],
        cos_emission: [0; LANES],
    };

    /// Those of `all`, at most [`LANES`], each in the lane of its index.
    pub(super) fn new(all: &[LightBounds]) -> Self {
        let centres = tenfold_math::Bounds3::around(all.iter().map(|b| b.bounds.centroid()));
        let radius = all.iter().fold(0f32, |r, b| r.max(b.radius));
        // What is much smaller than the distance from the origin of the world is lost in the rounding of coordinates.
        let rounding = 4.0 * f32::EPSILON * centres.min.abs().max(centres.max.abs()).max_element();
        let step = centres.diagonal().max_element().max(radius).max(rounding) / MOST_STEPS;
        let mut clusters = Self { origin: centres.min.to_array(), step, ..Self::EMPTY };
        all.iter().enumerate().for_each(|(lane, b)| clusters.set(lane, b));
        clusters
    }

    fn set(&mut self, lane: usize, b: &LightBounds) {
        let centre = b.bounds.centroid();
        let steps = |length: f32| if self.step > 0.0 { length / self.step } else { 0.0 };
        for k in 0..3 {
            self.centre[k][lane] = steps(centre[k] - self.origin[k]).round() as u16;
            self.axis[k][lane] = (b.normals.axis[k] * AXIS_UNIT).round() as i16;
        }
        let moved = centre.distance(self.centre(lane));
        self.radius[lane] = (steps(b.radius + moved) * 1.0001).ceil() as u16;
        let bits = b.intensity.min(MAX_IMPORTANCE).to_bits();
        let rounded_up = bits.div_ceil(1 << 16) as u16;
        self.intensity[lane] = rounded_up | if b.two_sided { TWO_SIDED } else { 0 };
        self.cos_normals[lane] = ((b.normals.cos_theta + 1.0) * (0.5 * 255.0)) as u8;
        self.cos_emission[lane] = (b.cos_emission * 255.0) as u8;
    }

    #[inline(always)]
    fn centre(&self, lane: usize) -> Vec3 {
        let at = |k: usize| self.origin[k] + f32::from(self.centre[k][lane]) * self.step;
        Vec3::new(at(0), at(1), at(2))
    }

    /// An estimate of the irradiance at `from` from each lane, on the sides of the surface that matter there; on a surface
    /// turned toward the light where there is none. It is 0 only where no light arrives (Conty Estevez and Kulla 2018, section 4.2; pbrt book, 4th edition, section 12.6.3), and stays
    /// finite inside of a cluster: the distance counts as the radius of the cluster at least.
    #[inline]
    pub(super) fn importance(&self, from: &ReferencePoint) -> [f32; LANES] {
        importance(self, from)
    }

    #[inline(always)]
    pub(super) fn importance_in_lanes(&self, from: &ReferencePoint) -> [f32; LANES] {
        let mut views = Views::ZERO;
        self.look(from.p, &mut views);
        self.importance_of(&views, from.ns, from.one_sided)
    }

    /// The views from `p`.
    // Here and below without branches or calls, so that the compiler makes vectors of the lanes.
    #[inline(always)]
    pub(super) fn look(&self, p: Vec3, views: &mut Views) {
        for i in 0..LANES {
            let c = self.centre(i);
            let d = [p.x - c.x, p.y - c.y, p.z - c.z];
            let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let r = f32::from(self.radius[i]) * self.step;
            let r2 = r * r;
            let inside = d2 <= r2;
            let distance2 = d2.max(r2);
            let inverse2 = 1.0 / distance2;
            let inverse = inverse2.sqrt();
            for k in 0..3 {
                views.w[k][i] = d[k] * inverse;
            }
            let sin_b = r * inverse;
            views.sin_b[i] = sin_b;
            views.cos_b[i] = if inside { -1.0 } else { sin_of(sin_b) };
            (views.distance2[i], views.inverse2[i]) = (distance2, inverse2);
        }
    }

    /// [`Clusters::importance`] for a point with the normal `n`.
    // Unlike `clamp`, `max` turns what is not a number into 0.
    #[allow(clippy::manual_clamp)]
    #[inline(always)]
    pub(super) fn importance_of(&self, views: &Views, n: Vec3, one_sided: bool) -> [f32; LANES] {
        let on_surface = n != Vec3::ZERO;
        let mut importance = [0.0; LANES];
        for i in 0..LANES {
            let w = [views.w[0][i], views.w[1][i], views.w[2][i]];
            let (sin_b, cos_b) = (views.sin_b[i], views.cos_b[i]);
            // Angle from the nearest normal to the nearest of the directions in which the cluster sees the point.
            let axis = |k: usize| f32::from(self.axis[k][i]);
            let cos_w = (axis(0) * w[0] + axis(1) * w[1] + axis(2) * w[2]) * (1.0 / AXIS_UNIT);
            let cos_w = if self.intensity[i] & TWO_SIDED != 0 { cos_w.abs() } else { cos_w };
            let (sin_w, cos_o) = (sin_of(cos_w), cos_normals(self.cos_normals[i]));
            let sin_o = sin_of(cos_o);
            let cos_x = cos_difference(cos_w, sin_w, cos_o, sin_o);
            let sin_x = sin_difference(cos_w, sin_w, cos_o, sin_o);
            let cos_emitted = cos_difference(cos_x, sin_x, cos_b, sin_b);
            let cos_i = -(n.x * w[0] + n.y * w[1] + n.z * w[2]);
            let cos_i = if one_sided { cos_i } else { cos_i.abs() };
            let facing = cos_difference(cos_i, sin_of(cos_i), cos_b, sin_b).max(0.0);
            let facing = if on_surface { facing } else { 1.0 };
            let intensity = f32::from_bits(u32::from(self.intensity[i] & !TWO_SIDED) << 16);
            let value = intensity * cos_emitted.max(LEAST_COSINE) * facing * views.inverse2[i];
            let reached = (cos_emitted > cos_emission(self.cos_emission[i])) & (views.distance2[i] > 0.0);
            importance[i] = if reached { value.max(0.0).min(MAX_IMPORTANCE) } else { 0.0 };
        }
        importance
    }
}

/// How a point sees [`Clusters`]: by themselves, since the processor has few of the long chains of roots that lead to importance at work at a time, and more of
/// their halves.
#[derive(Copy, Clone)]
#[repr(C, align(64))]
pub(super) struct Views {
    /// Unit directions from the clusters; of no matter inside.
    w: [[f32; LANES]; 3],
    /// Half angles under which the spheres around the clusters are seen.
    sin_b: [f32; LANES],
    cos_b: [f32; LANES],
    /// Squared distances, as they count, and their inverse.
    distance2: [f32; LANES],
    inverse2: [f32; LANES],
}

impl Views {
    pub(super) const ZERO: Self = Self {
        w: [[0.0; LANES]; 3],
        sin_b: [0.0; LANES],
        cos_b: [0.0; LANES],
        distance2: [0.0; LANES],
        inverse2: [0.0; LANES],
    };
}

vectorized! {
    /// [`Clusters::importance`].
    #[inline]
    fn importance(clusters: &Clusters, from: &ReferencePoint) -> [f32; LANES] {
        clusters.importance_in_lanes(from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_geometry::NormalCone;
    use tenfold_math::Bounds3;

    fn importance(b: LightBounds, p: Vec3, n: Vec3) -> f32 {
        let importance =
            Clusters::new(&[b]).importance(&ReferencePoint { ns: n, ..ReferencePoint::free(p, 0.0) });
        assert_eq!(importance.iter().sum::<f32>(), importance[0]);
        importance[0]
    }

    /// A square of edge 0.2 around `centre` that faces up.
    fn lamp(centre: Vec3, intensity: f32) -> LightBounds {
        let half = Vec3::new(0.1, 0.1, 0.0);
        LightBounds {
            bounds: Bounds3::new(centre - half, centre + half),
            radius: half.length(),
            normals: NormalCone::along(Vec3::Z),
            cos_emission: 0.0,
            intensity,
            two_sided: false,
        }
    }

    #[test]
    fn a_point_has_the_irradiance_it_makes() {
        let b = LightBounds::point(Vec3::new(0.0, 0.0, 2.0), NormalCone::EVERYWHERE, 3.0);
        let near = |a: f32, b: f32| assert!(a >= b && a < 1.01 * b, "{a} {b}");
        near(importance(b, Vec3::ZERO, Vec3::Z), 0.75);
        near(importance(b, Vec3::ZERO, Vec3::NEG_Z), 0.75);
        let p = Vec3::new(2.0, 0.0, 0.0);
        near(importance(b, p, Vec3::Z), 3.0 / 8.0 * 0.5f32.sqrt());
        near(importance(b, p, Vec3::ZERO), 3.0 / 8.0);
    }

    #[test]
    fn an_emitter_turned_away_has_none() {
        let b = lamp(Vec3::ZERO, 1.0);
        let below = Vec3::new(0.0, 0.0, -1.0);
        assert_eq!(importance(b, below, Vec3::ZERO), 0.0);
        assert!(importance(LightBounds { two_sided: true, ..b }, below, Vec3::ZERO) > 0.9);
        assert!(importance(b, -below, Vec3::ZERO) > 0.9);
        assert!(importance(b, Vec3::new(0.05, 0.0, 0.0), Vec3::X).is_finite());
    }

    /// A lane knows its cluster well enough beside others that are far away, and stronger.
    #[test]
    fn lanes_are_as_good_as_alone() {
        let all: Vec<_> = (0..LANES)
            .map(|i| lamp(Vec3::new(3.0 * i as f32, -50.0, 1e3 + i as f32), 0.1 * 7f32.powi(i as i32)))
            .collect();
        let clusters = Clusters::new(&all);
        for z in [0.3, 1.0, 20.0] {
            for (lane, &b) in all.iter().enumerate() {
                let p = b.bounds.centroid() + Vec3::new(0.2, 0.1, z);
                let from = ReferencePoint { ns: Vec3::NEG_Z, ..ReferencePoint::free(p, 0.0) };
                let (beside, alone) = (clusters.importance(&from)[lane], importance(b, p, Vec3::NEG_Z));
                assert!((beside / alone - 1.0).abs() < 0.01, "{lane} at {z}: {beside} {alone}");
            }
        }
    }

    /// Just inside of the directions in which a lamp is seen, however far from it and from the origin of the world.
    #[test]
    fn what_is_barely_lit_is_not_missed() {
        for distance in [0.01, 1.0, 100.0, 1e5] {
            for at in [0.0, 1.0, 1e4] {
                let far = LightBounds::point(Vec3::splat(-at - 7.0), NormalCone::EVERYWHERE, 1.0);
                let b = lamp(Vec3::splat(at), 1.0);
                let clusters = Clusters::new(&[far, b]);
                let p = b.bounds.centroid() + Vec3::new(distance, 0.0, 1e-3 * distance);
                let from = ReferencePoint { ns: Vec3::NEG_X, ..ReferencePoint::free(p, 0.0) };
                assert!(clusters.importance(&from)[1] > 0.0, "{distance} {at}");
            }
        }
    }

    #[test]
    fn all_instructions_give_the_same_bits() {
        let lamps: Vec<_> =
            (0..5).map(|i| lamp(Vec3::new(i as f32, 0.3, 0.1 * i as f32), 1.0 + i as f32)).collect();
        let clusters = Clusters::new(&lamps);
        for i in 0..1000 {
            let p = Vec3::new(0.01 * i as f32 - 3.0, 0.2, 0.001 * (i % 70) as f32);
            let ns = [Vec3::ZERO, Vec3::Z, Vec3::new(0.6, 0.0, -0.8)][i % 3];
            let from = ReferencePoint { ns, one_sided: i % 2 == 0, ..ReferencePoint::free(p, 0.0) };
            let (wide, portable) = (clusters.importance(&from), clusters.importance_in_lanes(&from));
            assert_eq!(wide.map(f32::to_bits), portable.map(f32::to_bits));
        }
    }
}
