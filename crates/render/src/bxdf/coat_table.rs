use std::f32::consts::FRAC_PI_2;
use tenfold_math::ops;

use rayon::prelude::*;
use tenfold_math::{Vec2, Vec3, sqr};
use tenfold_spectrum::{N, SampledSpectrum};

use super::fresnel::{fresnel_dielectric, fresnel_dielectric_lanes};
use super::gauss::gauss_legendre;
use super::interface::Interface;
use super::microfacet::TrowbridgeReitz;

/// Nodes in cos θ.
const COSINES: usize = 96;
/// Nodes in sin² φ of an anisotropic coat.
const AZIMUTHS: usize = 9;
/// Nodes in √α of a textured coat.
const ALPHAS: usize = 25;
/// Nodes in the index of a dispersive coat.
const ETAS: usize = 6;
/// Points of quadrature over visible normals: by radius, by azimuth.
const RADII: usize = 24;
const TURNS: usize = 24;
/// Points of quadrature over the cosine on each side of the critical angle.
const ELEVATIONS: usize = 24;
/// The least cosine tabulated: the limit at the horizon itself is not of the form 0/0.
const COSINE_MIN: f32 = 1e-4;

/// The roughness of a coat over a whole material.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum CoatRoughness {
    /// One distribution everywhere.
    Constant(TrowbridgeReitz),
    /// Isotropic distributions of any α up to this one.
    IsotropicUpTo(f32),
}

/// What a clear coat of dielectric over a slab does to flux: the fluxes that [`super::CoatedDiffuse`] is made of.
///
/// With `t` the transmission of particles and `r` the reflection of the coat's rough boundary, and
/// `A(ω) = exp(-thickness / |cos θ|)` the attenuation along a crossing of the slab,
///
/// - `τ(ω) = ∫ t(ω, ω') A(ω') |cos θ'| dω'`, the share of the flux from `ω` above that reaches the base;
/// - `ρ(ω) = ∫ r(ω, ω') |cos θ'| dω'`, the share reflected at once;
/// - `K = 1/π ∫ A(ω) |cos θ| ∫ r(ω, ω') A(ω') |cos θ'| dω' dω`, from below, the share of Lambertian flux that
///   leaves the base and is returned to it by the coat.
///
/// Each is integrated over visible normals with the very functions the renderer evaluates; a smooth coat has closed forms.
/// Tables are linear in the cosine, in sin² φ where the coat is anisotropic, and in √α and the index where they vary.
#[derive(Clone, Debug)]
pub struct CoatTable {
    thickness: f32,
    eta: Axis,
    /// In √α.
    alpha: Axis,
    azimuth: Axis,
    cosine: Axis,
    /// τ and ρ by index, α, azimuth and cosine; empty of smooth coats.
    directions: Vec<Direction>,
    /// K and the mean of τ under Lambertian illumination by index and α.
    totals: Vec<Total>,
}

/// τ and ρ of one direction.
#[derive(Copy, Clone, Debug, Default)]
struct Direction {
    transmitted: f32,
    reflected: f32,
}

#[derive(Copy, Clone, Debug, Default)]
struct Total {
    inner: f32,
    mean_transmitted: f32,
}

/// Equally spaced nodes of a table along one variable.
#[derive(Copy, Clone, Debug)]
struct Axis {
    start: f32,
    /// Nodes per unit; 0 where there is one node alone.
    density: f32,
    count: usize,
}

/// A place between two nodes.
#[derive(Copy, Clone)]
struct Place {
    node: usize,
    /// 1, or 0 where there is one node alone.
    step: usize,
    t: f32,
}

impl Axis {
    fn new(start: f32, end: f32, count: usize) -> Self {
        if end > start && count > 1 {
            Self { start, density: (count - 1) as f32 / (end - start), count }
        } else {
            Self { start, density: 0.0, count: 1 }
        }
    }

    fn node(&self, i: usize) -> f32 {
        if self.count > 1 { self.start + i as f32 / self.density } else { self.start }
    }

    #[inline]
    fn place(&self, x: f32) -> Place {
        if self.count == 1 {
            return Place { node: 0, step: 0, t: 0.0 };
        }
        let x = ((x - self.start) * self.density).clamp(0.0, (self.count - 1) as f32);
        let node = (x as usize).min(self.count - 2);
        Place { node, step: 1, t: x - node as f32 }
    }
}

impl CoatTable {
    /// The table of a coat with indices from `eta_min` to `eta_max` (over that of the surroundings), the given
    /// roughness, and the optical `thickness` of its slab, as pbrt's of unit extinction.
    ///
    /// A constant index and roughness take about ten milliseconds of one core, anisotropy nine times that, a range of
    /// roughness twenty-five times, a range of indices six times.
    pub fn new(eta_min: f32, eta_max: f32, roughness: CoatRoughness, thickness: f32) -> Self {
        let eta = Axis::new(eta_min, eta_max, ETAS);
        let (alpha, constant) = match roughness {
            CoatRoughness::Constant(d) => (Axis::new(0.0, 0.0, 1), Some(d)),
            CoatRoughness::IsotropicUpTo(max) => (Axis::new(0.0, max.max(0.0).sqrt(), ALPHAS), None),
        };
        let isotropic = constant.is_none_or(|d| d.alpha_x() == d.alpha_y());
        let smooth = constant.is_some_and(|d| d.effectively_smooth()) || (eta_min == 1.0 && eta_max == 1.0);
        let azimuth = Axis::new(0.0, 1.0, if isotropic { 1 } else { AZIMUTHS });
        let cosine = Axis::new(COSINE_MIN, 1.0, COSINES);
        let mut table =
            Self { thickness, eta, alpha, azimuth, cosine, directions: Vec::new(), totals: Vec::new() };

        let interface = |k: usize| {
            let alpha = sqr(alpha.node(k % alpha.count));
            let distribution = constant.unwrap_or_else(|| TrowbridgeReitz::new(alpha, alpha));
            Interface::new(eta.node(k / table.alpha.count), distribution)
        };
        let families = eta.count * alpha.count;
        if !smooth {
            table.directions = (0..families * azimuth.count)
                .into_par_iter()
                .flat_map_iter(|k| {
                    let interface = interface(k / azimuth.count);
                    let sin2_phi = azimuth.node(k % azimuth.count);
                    (0..cosine.count).map(move |i| direction(&interface, thickness, cosine.node(i), sin2_phi))
                })
                .collect();
        }
        table.totals =
            (0..families).into_par_iter().map(|k| total(&interface(k), thickness, isotropic)).collect();
        table
    }

    /// The optical thickness of the slab.
    pub fn thickness(&self) -> f32 {
        self.thickness
    }

    /// τ and ρ for the direction `w` above, per lane. `smooth` must say whether `distribution` is smooth.
    #[inline]
    pub(crate) fn fluxes(&self, eta: SampledSpectrum, distribution: &TrowbridgeReitz, w: Vec3) -> CoatFluxes {
        if self.directions.is_empty() || distribution.effectively_smooth() {
            return self.smooth_fluxes(eta, w);
        }
        let cosine = self.cosine.place(w.z);
        let azimuth = if self.azimuth.count > 1 {
            let sin2 = w.x * w.x + w.y * w.y;
            self.azimuth.place(if sin2 > 0.0 { w.y * w.y / sin2 } else { 0.0 })
        } else {
            self.azimuth.place(0.0)
        };
        let alpha = self.alpha.place(distribution.alpha_x().sqrt());
        if self.eta.count == 1 {
            let d = self.interpolate(Place { node: 0, step: 0, t: 0.0 }, alpha, azimuth, cosine);
            return CoatFluxes {
                transmitted: SampledSpectrum::splat(d.transmitted),
                reflected: SampledSpectrum::splat(d.reflected),
            };
        }
        let mut fluxes = CoatFluxes { transmitted: SampledSpectrum::ZERO, reflected: SampledSpectrum::ZERO };
        for lane in 0..N {
            let d = self.interpolate(self.eta.place(eta.lane(lane)), alpha, azimuth, cosine);
            fluxes.transmitted.set_lane(lane, d.transmitted);
            fluxes.reflected.set_lane(lane, d.reflected);
        }
        fluxes
    }

    /// τ = (1 - F) exp(-thickness / cos θt) and ρ = F.
    #[inline]
    fn smooth_fluxes(&self, eta: SampledSpectrum, w: Vec3) -> CoatFluxes {
        let cos = w.z.abs();
        let reflected = fresnel_dielectric_lanes(cos, eta);
        let cos2_t = 1.0 - (1.0 - cos * cos) / (eta * eta);
        let attenuation = (SampledSpectrum::splat(-self.thickness) / cos2_t.clamp(1e-9, 1.0).sqrt()).exp();
        CoatFluxes { transmitted: (1.0 - reflected) * attenuation, reflected }
    }

    #[inline]
    fn interpolate(&self, eta: Place, alpha: Place, azimuth: Place, cosine: Place) -> Direction {
        let mut sum = Direction::default();
        for e in 0..=eta.step {
            for a in 0..=alpha.step {
                for p in 0..=azimuth.step {
                    let weight = corner(eta, e) * corner(alpha, a) * corner(azimuth, p);
                    let family = (eta.node + e) * self.alpha.count + alpha.node + a;
                    let row = (family * self.azimuth.count + azimuth.node + p) * self.cosine.count;
                    let (d0, d1) =
                        (self.directions[row + cosine.node], self.directions[row + cosine.node + 1]);
                    let t = cosine.t;
                    sum.transmitted += weight * (d0.transmitted + t * (d1.transmitted - d0.transmitted));
                    sum.reflected += weight * (d0.reflected + t * (d1.reflected - d0.reflected));
                }
            }
        }
        sum
    }

    /// K, and the mean of τ under Lambertian illumination, per lane.
    #[inline]
    pub(crate) fn totals(&self, eta: SampledSpectrum, distribution: &TrowbridgeReitz) -> CoatTotals {
        let alpha = self.alpha.place(distribution.alpha_x().sqrt());
        let at = |eta: Place| {
            let mut sum = Total::default();
            for e in 0..=eta.step {
                for a in 0..=alpha.step {
                    let weight = corner(eta, e) * corner(alpha, a);
                    let total = self.totals[(eta.node + e) * self.alpha.count + alpha.node + a];
                    sum.inner += weight * total.inner;
                    sum.mean_transmitted += weight * total.mean_transmitted;
                }
            }
            sum
        };
        let mut totals = CoatTotals { inner: SampledSpectrum::ZERO, mean_transmitted: SampledSpectrum::ZERO };
        if self.eta.count == 1 {
            let total = at(Place { node: 0, step: 0, t: 0.0 });
            totals.inner = SampledSpectrum::splat(total.inner);
            totals.mean_transmitted = SampledSpectrum::splat(total.mean_transmitted);
        } else {
            for lane in 0..N {
                let total = at(self.eta.place(eta.lane(lane)));
                totals.inner.set_lane(lane, total.inner);
                totals.mean_transmitted.set_lane(lane, total.mean_transmitted);
            }
        }
        totals
    }
}

/// τ and ρ per lane.
#[derive(Copy, Clone, Debug)]
pub(crate) struct CoatFluxes {
    pub(crate) transmitted: SampledSpectrum,
    pub(crate) reflected: SampledSpectrum,
}

/// K, and the mean of τ under Lambertian illumination, per lane.
#[derive(Copy, Clone, Debug)]
pub(crate) struct CoatTotals {
    pub(crate) inner: SampledSpectrum,
    pub(crate) mean_transmitted: SampledSpectrum,
}

#[inline]
fn corner(place: Place, upper: usize) -> f32 {
    if place.step == 0 {
        1.0
    } else if upper == 1 {
        place.t
    } else {
        1.0 - place.t
    }
}

/// The direction at a cosine and sin² φ in the first quadrant.
fn tabulated_direction(cos: f32, sin2_phi: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(sin * (1.0 - sin2_phi).max(0.0).sqrt(), sin * sin2_phi.sqrt(), cos)
}

/// Attenuation of a crossing along `w`.
#[inline]
pub(crate) fn attenuation(thickness: f32, w: Vec3) -> f32 {
    if thickness <= f32::MIN_POSITIVE { 1.0 } else { ops::exp(-thickness / w.z.abs()) }
}

/// Mean of `f` over the unit square: Gauss's rule in y, equally spaced points in x, in which it is periodic.
fn over_square(f: impl Fn(Vec2) -> f32) -> f64 {
    let mut sum = 0.0;
    for (i, node) in gauss_legendre(RADII).into_iter().enumerate() {
        // Rings are turned by the golden ratio: Fresnel's reflectance bends along curves across them.
        let turn = (i as f64 * 0.618_033_988_75).fract();
        for j in 0..TURNS {
            let u = Vec2::new(((j as f64 + turn) / TURNS as f64) as f32, node.x as f32);
            sum += node.weight / TURNS as f64 * f64::from(f(u));
        }
    }
    sum
}

/// τ and ρ of one direction.
fn direction(interface: &Interface, thickness: f32, cos: f32, sin2_phi: f32) -> Direction {
    let w = tabulated_direction(cos, sin2_phi);
    let transmitted = over_square(|u| {
        interface.sample_transmission(w, u).map_or(0.0, |s| s.weight * attenuation(thickness, s.wi))
    });
    let reflected = over_square(|u| interface.sample_reflection(w, u).map_or(0.0, |s| s.weight));
    Direction { transmitted: transmitted as f32, reflected: reflected as f32 }
}

fn total(interface: &Interface, thickness: f32, isotropic: bool) -> Total {
    if interface.is_smooth() {
        return smooth_total(interface.eta_from(Vec3::Z), thickness);
    }
    let azimuths = if isotropic { 1 } else { AZIMUTHS };
    let eta = interface.eta_from(Vec3::Z);
    // Of a nearly smooth coat the integrands bend where total reflection sets in, below or above.
    let critical = f64::from((1.0 - sqr(eta.min(1.0 / eta))).max(0.0).sqrt());
    let (mut inner, mut mean_transmitted) = (0.0, 0.0);
    for (start, end) in [(0.0, critical), (critical, 1.0)] {
        for node in gauss_legendre(ELEVATIONS) {
            let x = start + (end - start) * node.x;
            let cos = x as f32;
            let weight = node.weight * (end - start) * 2.0 * x / azimuths as f64;
            for j in 0..azimuths {
                let sin2_phi = sqr(ops::sin(FRAC_PI_2 * (j as f32 + 0.5) / azimuths as f32));
                let above = direction(interface, thickness, cos, sin2_phi);
                mean_transmitted += weight * f64::from(above.transmitted);
                let below = -tabulated_direction(cos, sin2_phi);
                let returned = over_square(|u| {
                    let s = interface.sample_reflection(below, u);
                    s.map_or(0.0, |s| s.weight * attenuation(thickness, s.wi))
                });
                inner += weight * f64::from(attenuation(thickness, below)) * returned;
            }
        }
    }
    Total { inner: inner as f32, mean_transmitted: mean_transmitted as f32 }
}

/// Of a smooth coat ρ from below is Fresnel's reflectance, and its integral splits where total reflection sets in.
fn smooth_total(eta: f32, thickness: f32) -> Total {
    let inside = |cos: f32| (1.0 - (1.0 - sqr(cos)) / sqr(eta)).max(0.0).sqrt();
    let pass = |cos: f32| f64::from(attenuation(thickness, Vec3::Z * cos.max(1e-9)));
    let (mut inner, mut mean_transmitted) = (0.0, 0.0);
    for node in gauss_legendre(ELEVATIONS) {
        let cos = node.x as f32;
        let weight = node.weight * 2.0 * node.x;
        if eta > 1.0 {
            let reflected = f64::from(fresnel_dielectric(cos, eta));
            mean_transmitted += weight * (1.0 - reflected) * pass(inside(cos));
            // Below the critical angle by the cosine outside: 2 µ dµ inside is 1/η² of that.
            inner += weight / f64::from(sqr(eta)) * reflected * sqr64(pass(inside(cos)));
            // Beyond it everything is reflected: µ from 0 to the critical cosine.
            let critical = inside(0.0);
            inner += weight * f64::from(sqr(critical)) * sqr64(pass(cos * critical));
        } else {
            // Total reflection sets in outside, so both integrals go over the cosine inside.
            let reflected = f64::from(fresnel_dielectric(cos, 1.0 / eta));
            mean_transmitted += weight * f64::from(sqr(eta)) * (1.0 - reflected) * pass(cos);
            inner += weight * reflected * sqr64(pass(cos));
        }
    }
    Total { inner: inner as f32, mean_transmitted: mean_transmitted as f32 }
}

fn sqr64(x: f64) -> f64 {
    x * x
}
