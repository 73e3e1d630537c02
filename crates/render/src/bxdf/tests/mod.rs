//! Tests of all scattering functions together.

mod chi2;
mod coated;
mod consistency;
mod energy;
mod strategies;

use tenfold_math::Vec3;
use tenfold_math::ops;
use tenfold_spectrum::SampledSpectrum;

use super::*;

/// Unit direction at an angle in degrees from +z and an azimuth in degrees.
fn direction(theta: f32, phi: f32) -> Vec3 {
    tenfold_math::spherical_direction(
        ops::sin(theta.to_radians()),
        ops::cos(theta.to_radians()),
        phi.to_radians(),
    )
}

fn splat(v: f32) -> SampledSpectrum {
    SampledSpectrum::splat(v)
}

/// Strongly dispersive glass.
fn dispersive_eta() -> SampledSpectrum {
    SampledSpectrum::new([1.55, 1.5, 1.6, 1.7])
}

fn ggx(alpha_x: f32, alpha_y: f32) -> TrowbridgeReitz {
    TrowbridgeReitz::new(alpha_x, alpha_y)
}

/// Something like copper.
fn copper(distribution: TrowbridgeReitz) -> Conductor {
    let eta = SampledSpectrum::new([1.2, 1.0, 0.3, 0.25]);
    let k = SampledSpectrum::new([2.4, 2.6, 2.9, 3.6]);
    Conductor::new(eta, k, distribution)
}

fn slab(thickness: f32, albedo: f32) -> Slab {
    Slab { thickness, albedo: splat(albedo), g: 0.4, max_depth: 10, samples: 1 }
}

/// A scattering function and what to call it.
struct Case<'a> {
    name: String,
    bxdf: Bxdf<'a>,
}

/// The tables borrowed by [`cases`].
struct Tables {
    smooth: CoatTable,
    rough: CoatTable,
    anisotropic: CoatTable,
    dispersive: CoatTable,
    textured: CoatTable,
}

impl Tables {
    fn new() -> Self {
        let constant = |x, y| CoatRoughness::Constant(ggx(x, y));
        Self {
            smooth: CoatTable::new(1.5, 1.5, constant(0.0, 0.0), 0.01),
            rough: CoatTable::new(1.5, 1.5, constant(0.3, 0.3), 0.01),
            anisotropic: CoatTable::new(1.4, 1.4, constant(0.1, 0.5), 0.2),
            dispersive: CoatTable::new(1.5, 1.7, constant(0.2, 0.2), 0.01),
            textured: CoatTable::new(1.5, 1.5, CoatRoughness::IsotropicUpTo(0.6), 0.01),
        }
    }
}

/// One of every kind, and the corners of their parameters.
fn cases(tables: &Tables) -> Vec<Case<'_>> {
    let mut cases = Vec::new();
    let mut add = |name: &str, bxdf| cases.push(Case { name: name.to_owned(), bxdf });
    let albedo = SampledSpectrum::new([0.8, 0.5, 0.2, 0.0]);
    add("diffuse", Bxdf::Diffuse(Diffuse::new(albedo)));
    add(
        "diffuse transmission",
        Bxdf::DiffuseTransmission(DiffuseTransmission::new(
            albedo,
            SampledSpectrum::new([0.1, 0.4, 0.2, 0.7]),
        )),
    );
    add(
        "diffuse transmission alone",
        Bxdf::DiffuseTransmission(DiffuseTransmission::new(SampledSpectrum::ZERO, albedo)),
    );
    for (x, y) in [(0.0, 0.0), (0.05, 0.05), (0.3, 0.3), (0.1, 0.6), (1.0, 1.0)] {
        add(&format!("conductor {x} {y}"), Bxdf::Conductor(copper(ggx(x, y))));
    }
    for (x, y) in [(0.0, 0.0), (0.1, 0.1), (0.3, 0.3), (0.15, 0.6), (1.0, 1.0)] {
        for (what, eta) in [("1.5", splat(1.5)), ("0.7", splat(0.7)), ("dispersive", dispersive_eta())] {
            add(&format!("dielectric {x} {y} {what}"), Bxdf::Dielectric(Dielectric::new(eta, ggx(x, y))));
        }
    }
    add("dielectric of nothing", Bxdf::Dielectric(Dielectric::new(splat(1.0), ggx(0.3, 0.3))));
    add("thin dielectric", Bxdf::ThinDielectric(ThinDielectric::new(dispersive_eta())));
    for (name, table, eta, distribution) in [
        ("smooth", &tables.smooth, splat(1.5), ggx(0.0, 0.0)),
        ("rough", &tables.rough, splat(1.5), ggx(0.3, 0.3)),
        ("anisotropic", &tables.anisotropic, splat(1.4), ggx(0.1, 0.5)),
        ("dispersive", &tables.dispersive, dispersive_eta(), ggx(0.2, 0.2)),
        ("textured", &tables.textured, splat(1.5), ggx(0.34, 0.34)),
        ("textured smooth", &tables.textured, splat(1.5), ggx(0.0, 0.0)),
    ] {
        let coated = CoatedDiffuse::new(table, eta, distribution, albedo, 10);
        add(&format!("coated diffuse {name}"), Bxdf::CoatedDiffuse(coated));
    }
    let diffuse = LayeredBase::Diffuse(Diffuse::new(albedo));
    let metal = |x, y| LayeredBase::Conductor(copper(ggx(x, y)));
    for (name, eta, coat, slab, base) in [
        ("diffuse with a medium", splat(1.5), ggx(0.2, 0.2), slab(0.5, 0.8), diffuse),
        ("smooth diffuse with a medium", splat(1.5), ggx(0.0, 0.0), slab(0.5, 0.8), diffuse),
        ("smooth on smooth", splat(1.5), ggx(0.0, 0.0), slab(0.01, 0.0), metal(0.0, 0.0)),
        ("smooth on smooth with a medium", splat(1.5), ggx(0.0, 0.0), slab(0.3, 0.6), metal(0.0, 0.0)),
        ("smooth on rough", splat(1.5), ggx(0.0, 0.0), slab(0.01, 0.0), metal(0.2, 0.3)),
        ("rough on smooth", splat(1.5), ggx(0.3, 0.3), slab(0.01, 0.0), metal(0.0, 0.0)),
        ("rough on rough", splat(1.5), ggx(0.3, 0.1), slab(0.01, 0.0), metal(0.2, 0.2)),
        ("dispersive rough on rough", dispersive_eta(), ggx(0.2, 0.2), slab(0.01, 0.0), metal(0.2, 0.2)),
        ("nothing on rough", splat(1.0), ggx(0.3, 0.3), slab(0.01, 0.0), metal(0.3, 0.3)),
    ] {
        add(&format!("layered {name}"), Bxdf::Layered(Layered::new(eta, coat, slab, base, 7)));
    }
    cases
}

/// Directions from straight down to grazing, on both sides.
fn outgoing() -> Vec<Vec3> {
    [(0.0, 0.0), (30.0, 50.0), (65.0, 200.0), (85.0, 110.0), (140.0, 300.0), (100.0, 30.0)]
        .map(|(theta, phi)| direction(theta, phi))
        .to_vec()
}
