//! What the quadrics share: a transform, double-precision rays in object space, and area under affine maps.

use crate::{ShapeHit, SurfaceInteraction};
use glam::DVec3;
use std::f32::consts::TAU;
use tenfold_math::ops;
use tenfold_math::{Ray, Transform, Vec3, gamma};

/// Why a quadric was refused.
#[derive(Copy, Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// A parameter is NaN, infinite, or outside its range.
    #[error("{parameter} = {value} is not possible")]
    Parameter {
        /// The parameter's name.
        parameter: &'static str,
        /// Its value.
        value: f32,
    },
}

/// Refuses NaN and infinite parameters.
pub(super) fn check_finite(parameters: &[(&'static str, f32)]) -> Result<(), ShapeError> {
    match parameters.iter().find(|(_, value)| !value.is_finite()) {
        Some(&(parameter, value)) => Err(ShapeError::Parameter { parameter, value }),
        None => Ok(()),
    }
}

/// How a quadric lies in the world.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Placement {
    pub(super) to_world: Transform,
    /// Whether normals are turned around: reversed orientation or a mirroring transform, but not both.
    pub(super) flip: bool,
    /// The factor of lengths, where the transform keeps shapes (rotates, moves and scales alike on all axes).
    pub(super) similarity: Option<f32>,
}

impl Placement {
    pub(super) fn new(to_world: Transform, reverse_orientation: bool) -> Self {
        let m = to_world.affine().matrix3;
        let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
        let s2 = x.length_squared();
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * s2;
        let similar = near(y.length_squared(), s2)
            && near(z.length_squared(), s2)
            && near(x.dot(y), 0.0)
            && near(y.dot(z), 0.0)
            && near(z.dot(x), 0.0);
        let similarity = similar.then(|| ops::cbrt(m.determinant().abs()));
        Self { to_world, flip: reverse_orientation ^ to_world.swaps_handedness(), similarity }
    }

    /// `n` as a geometric normal in the world, where `n` is the outward one of object space, of any length.
    pub(super) fn normal(&self, n: Vec3) -> Vec3 {
        let n = self.to_world.normal(n).normalize_or(Vec3::Z);
        if self.flip { -n } else { n }
    }

    /// World area over object area, of a small piece of surface with unit normal `n` in object space:
    /// `|det M| · |M⁻ᵀ n|`.
    pub(super) fn area_scale(&self, n: Vec3) -> f32 {
        match self.similarity {
            Some(s) => s * s,
            None => self.to_world.affine().matrix3.determinant().abs() * self.to_world.normal(n).length(),
        }
    }

    /// A surface of object space (but for `wo`) in the world.
    pub(super) fn place(&self, surface: &SurfaceInteraction) -> SurfaceInteraction {
        SurfaceInteraction { wo: surface.wo, ..surface.transformed(&self.to_world) }
    }

    pub(super) fn ray(&self, ray: &Ray) -> ObjectRay {
        let m = self.to_world.inverse_affine();
        let matrix = m.matrix3.as_dmat3();
        let translation = Vec3::from(m.translation);
        let abs = |v: glam::Vec3A| Vec3::from(v).abs();
        // The inverse is stored rounded to floats: that is the error of the origin, since the arithmetic here is double.
        let sum = abs(m.matrix3.x_axis) * ray.origin.x.abs()
            + abs(m.matrix3.y_axis) * ray.origin.y.abs()
            + abs(m.matrix3.z_axis) * ray.origin.z.abs()
            + translation.abs();
        ObjectRay {
            o: matrix * ray.origin.as_dvec3() + translation.as_dvec3(),
            d: matrix * ray.direction.as_dvec3(),
            o_error: (gamma(3) * sum).as_dvec3(),
        }
    }
}

/// A ray in object space.
#[derive(Copy, Clone, Debug)]
pub(super) struct ObjectRay {
    pub(super) o: DVec3,
    pub(super) d: DVec3,
    /// Bound on the error of `o` from the rounding of the transform.
    pub(super) o_error: DVec3,
}

impl ObjectRay {
    #[inline(always)]
    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.o + t * self.d
    }
}

/// Azimuth around z in [0, 2π).
pub(super) fn azimuth(p: Vec3) -> f32 {
    let phi = ops::atan2(p.y, p.x);
    if phi < 0.0 { phi + TAU } else { phi }
}

/// Roots of a quadric along a ray.
#[derive(Copy, Clone, Debug)]
pub(super) struct Roots {
    t: [f64; 2],
    /// |d|².
    a: f64,
    /// Bound on the error of |o|² − r².
    shift: f64,
}

impl Roots {
    /// Whether a positive root may be the origin's own surface: the `shift` of |o|² − r² moves it by √(shift/a) near a double root, elsewhere by
    /// shift / (a · distance of the roots).
    #[inline(always)]
    fn may_be_origin(&self, t: f64) -> bool {
        let Self { t: [near, far], a, shift } = *self;
        (a * t * t <= shift) & (a * (far - near) * t <= shift)
    }

    /// The first hit with `0 < t < t_max` and whether there is one, for a quadric that is whole.
    #[inline(always)]
    pub(super) fn first(&self, t_max: f32) -> (ShapeHit, bool) {
        let is_hit = |t: f64| (t > 0.0) & ((t as f32) < t_max) & !self.may_be_origin(t);
        let [near, far] = self.t;
        let (is_near, is_far) = (is_hit(near), is_hit(far));
        let t = if is_near { near } else { far };
        (ShapeHit { t: t as f32, u: 0.0, v: 0.0 }, is_near | is_far)
    }

    /// The first hit with `0 < t < t_max` that is not cut away and that `accept` takes.
    #[inline]
    pub(super) fn first_hit(
        &self,
        t_max: f32,
        is_cut_away: impl Fn(f64) -> bool,
        mut accept: impl FnMut(ShapeHit) -> bool,
    ) -> Option<ShapeHit> {
        self.t.into_iter().find_map(|t| {
            let hit = ShapeHit { t: t as f32, u: 0.0, v: 0.0 };
            if !(t > 0.0 && hit.t < t_max) || self.may_be_origin(t) || is_cut_away(t) {
                return None;
            }
            accept(hit).then_some(hit)
        })
    }
}

/// Roots of `|o + t·d|² = r²`, where |o|² is known within twice `half_shift` (leave out z for a cylinder by setting it to 0).
#[inline]
pub(super) fn roots(o: DVec3, d: DVec3, half_shift: f64, r: f64) -> Option<Roots> {
    let approach = Approach::new(o, d, r);
    approach.comes_within().then(|| approach.roots(half_shift))
}

/// Where a line comes closest to the centre of a quadric.
#[derive(Copy, Clone, Debug)]
pub(super) struct Approach {
    /// The ray parameter.
    t: f64,
    /// |d|².
    a: f64,
    r: f64,
    /// r² less the square of the distance.
    discriminant: f64,
}

impl Approach {
    #[inline(always)]
    pub(super) fn new(o: DVec3, d: DVec3, r: f64) -> Self {
        let a = d.length_squared();
        // From the point of closest approach: no cancellation in the discriminant far away
        // (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
        let t = -o.dot(d) / a;
        let closest = o + t * d;
        Self { t, a, r, discriminant: r * r - closest.length_squared() }
    }

    /// Whether the line meets the quadric: otherwise its roots are NaN.
    #[inline(always)]
    fn comes_within(&self) -> bool {
        (self.a > 0.0) & (self.discriminant >= 0.0)
    }

    /// See [`roots`].
    #[inline(always)]
    pub(super) fn roots(&self, half_shift: f64) -> Roots {
        let Self { t, a, r, discriminant } = *self;
        let half = (discriminant / a).sqrt();
        let shift = 2.0 * (half_shift + r * r * f64::from(f32::EPSILON));
        Roots { t: [t - half, t + half], a, shift }
    }
}

/// Nodes and weights of Gauss's quadrature with four points on [0, 1].
pub(super) const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// `∫₀¹ f`, with the rule of [`GAUSS`] on each of `panels` equal parts.
pub(super) fn integrate(panels: usize, f: impl Fn(f64) -> f64) -> f64 {
    let h = 1.0 / panels as f64;
    (0..panels).flat_map(|i| GAUSS.map(|(x, w)| (i as f64 * h + x * h, w * h))).map(|(x, w)| w * f(x)).sum()
}
