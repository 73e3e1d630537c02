//! Measured and standard spectra by pbrt-v4's names.

use std::sync::LazyLock;

use crate::{CIE_Y_INTEGRAL, PiecewiseLinear, Spectrum, data, photometric};

/// Glasses are tabulated on these whole wavelengths, nm.
const GLASS_RANGE: std::ops::RangeInclusive<u16> = 300..=900;

/// Metals: stem of the names, table of wavelength, η and k.
const METALS: [(&str, &str); 7] = [
    ("metal-Ag", include_str!("../data/metal-Ag.csv")),
    ("metal-Al", include_str!("../data/metal-Al.csv")),
    ("metal-Au", include_str!("../data/metal-Au.csv")),
    ("metal-Cu", include_str!("../data/metal-Cu.csv")),
    ("metal-CuZn", include_str!("../data/metal-CuZn.csv")),
    ("metal-MgO", include_str!("../data/metal-MgO.csv")),
    ("metal-TiO2", include_str!("../data/metal-TiO2.csv")),
];

static SPECTRA: LazyLock<Vec<(String, Spectrum)>> = LazyLock::new(|| {
    let mut all = Vec::new();
    for (name, row) in data::named_rows(include_str!("../data/glasses.csv")) {
        let points = GLASS_RANGE.map(|l| [f32::from(l), sellmeier(&row, f64::from(l) * 1e-3)]).collect();
        push(&mut all, name.to_owned(), PiecewiseLinear::from_points(points).ok());
    }
    for (stem, csv) in METALS {
        for (column, suffix) in [(1, "eta"), (2, "k")] {
            let metal = column_of(csv, column).map(|s| s.extended());
            push(&mut all, format!("{stem}-{suffix}"), metal);
        }
    }
    let standard = include_str!("../data/illuminants.csv");
    for (i, name) in ["stdillum-A", "stdillum-D50", "stdillum-D65", "illum-acesD60"].iter().enumerate() {
        push(&mut all, (*name).to_owned(), illuminant(standard, i + 1));
    }
    for i in 1..=12 {
        let fluorescent = illuminant(include_str!("../data/illuminants-f.csv"), i);
        push(&mut all, format!("stdillum-F{i}"), fluorescent);
    }
    all
});

static NAMES: LazyLock<Vec<&'static str>> =
    LazyLock::new(|| SPECTRA.iter().map(|(name, _)| name.as_str()).collect());

/// The spectrum of a name of pbrt-v4: `glass-…` (index of refraction), `metal-…-eta` and `metal-…-k` (complex index of refraction),
/// `stdillum-…` and `illum-acesD60` (scaled to a [`photometric`] value of [`CIE_Y_INTEGRAL`], as pbrt-v4
/// does). `glass-SF5`, `-SF10` and `-SF11` are also understood for pbrt-v4's `glass-F5`, `-F10` and `-F11`: which they are.
///
/// Glasses follow their Sellmeier formulas over the whole range, where pbrt-v4 interpolates on a grid of some
/// 21 nm (up to 2·10⁻⁴ apart). The ends of measured metals and illuminants are held constant. `stdillum-D50` carries
/// pbrt-v4's figures, so that pictures agree: they are bluer than the CIE's D50, at xy (0.3368, 0.3580) instead of (0.3457, 0.3585).
pub fn named(name: &str) -> Option<Spectrum> {
    let name = match name {
        "glass-SF5" => "glass-F5",
        "glass-SF10" => "glass-F10",
        "glass-SF11" => "glass-F11",
        other => other,
    };
    SPECTRA.iter().find(|(n, _)| n == name).map(|(_, s)| s.clone())
}

/// All names that [`named`] knows, for suggesting the nearest one; less the second names.
pub fn named_names() -> &'static [&'static str] {
    &NAMES
}

fn push(all: &mut Vec<(String, Spectrum)>, name: String, s: Option<PiecewiseLinear>) {
    all.extend(s.map(|s| (name, Spectrum::PiecewiseLinear(s))));
}

/// Column `i` of a table against its first column.
fn column_of(csv: &str, i: usize) -> Option<PiecewiseLinear> {
    let points = data::rows(csv).filter_map(|row| Some([row[0], *row.get(i)?])).collect();
    PiecewiseLinear::from_points(points).ok()
}

fn illuminant(csv: &str, column: usize) -> Option<PiecewiseLinear> {
    let s = column_of(csv, column)?.extended();
    let factor = CIE_Y_INTEGRAL / photometric(&Spectrum::PiecewiseLinear(s.clone()));
    Some(s.scaled(factor))
}

/// Sellmeier's formula: n² = 1 + Σ Bᵢ λ² / (λ² − Cᵢ), λ in µm, for a row of B₁, B₂, B₃, C₁, C₂, C₃.
fn sellmeier(row: &[f32], micrometres: f64) -> f32 {
    let l2 = micrometres * micrometres;
    let (b, c) = row.split_at(row.len() / 2);
    let terms = b.iter().zip(c).map(|(&b, &c)| f64::from(b) * l2 / (l2 - f64::from(c)));
    (1.0 + terms.sum::<f64>()).sqrt() as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum_to_xyz;

    fn at(name: &str, lambda: f32) -> f32 {
        named(name).unwrap_or_else(|| panic!("{name}")).eval(lambda)
    }

    #[test]
    fn all_names_are_there() {
        let names = named_names();
        assert_eq!(names.len(), 7 + 14 + 4 + 12);
        for n in names {
            let s = named(n).unwrap();
            for lambda in [360.0, 361.5, 500.0, 830.0] {
                assert!(s.eval(lambda).is_finite() && s.eval(lambda) >= 0.0, "{n} at {lambda}");
            }
        }
        assert!(named("glass-bk7").is_none() && named("").is_none());
        assert_eq!(named("glass-SF11"), named("glass-F11"));
    }

    /// Published: Schott data sheets of N-BK7 (517642), N-BAF10 (670471), N-FK51A (487845), N-LASF9 (850322), N-SF5 (673323),
    /// N-SF10 (728285) and N-SF11 (785257): indices at the lines C 656.2725, d 587.5618 and F 486.1327 nm, and the
    /// Abbe number (n_d − 1) / (n_F − n_C).
    #[test]
    fn glasses_at_the_fraunhofer_lines() {
        for (name, c, d, f) in
            [("glass-BK7", 1.51432, 1.51680, 1.52238), ("glass-F11", 1.77596, 1.78472, 1.80651)]
        {
            for (lambda, n) in [(656.2725, c), (587.5618, d), (486.1327, f)] {
                assert!((at(name, lambda) - n).abs() < 1e-5, "{name} at {lambda}: {} {n}", at(name, lambda));
            }
        }
        for (name, d, abbe) in [
            ("glass-BK7", 1.51680, 64.17),
            ("glass-BAF10", 1.67003, 47.11),
            ("glass-FK51A", 1.48656, 84.47),
            ("glass-LASF9", 1.85025, 32.17),
            ("glass-F5", 1.67271, 32.25),
            ("glass-F10", 1.72828, 28.53),
            ("glass-F11", 1.78472, 25.68),
        ] {
            let n = at(name, 587.5618);
            assert!((n - d).abs() < 1e-5, "{name}: {n}");
            let v = (n - 1.0) / (at(name, 486.1327) - at(name, 656.2725));
            assert!((v - abbe).abs() < 0.012, "{name}: {v}");
        }
    }

    /// Nodes of pbrt-v4's tables.
    #[test]
    fn metals_and_illuminants_carry_the_figures_of_pbrt() {
        for (name, lambda, v) in [
            ("metal-Ag-eta", 551.040771, 0.124375),
            ("metal-Ag-k", 551.040771, 3.348125),
            ("metal-Al-eta", 486.212463, 0.72375),
            ("metal-Al-k", 652.548279, 7.82),
            ("metal-Au-eta", 539.061646, 0.402),
            ("metal-Au-k", 450.851562, 1.875875),
            ("metal-Cu-eta", 604.800842, 0.35125),
            ("metal-Cu-k", 688.800964, 4.05),
            ("metal-CuZn-eta", 450.0, 1.094),
            ("metal-CuZn-k", 630.0, 3.522),
            ("metal-MgO-eta", 546.166992, 1.74077),
            ("metal-MgO-eta", 830.0, 1.72872),
            ("metal-TiO2-eta", 620.0, 2.88),
            ("metal-TiO2-k", 412.031006, 0.022),
        ] {
            assert!((at(name, lambda) - v).abs() < 2e-4 * v, "{name} at {lambda}: {}", at(name, lambda));
        }
        for name in named_names().iter().filter(|n| n.contains("illum")) {
            let y = photometric(&named(name).unwrap());
            assert!((y - CIE_Y_INTEGRAL).abs() < 1e-3, "{name}: {y}");
        }
        let ratio = at("stdillum-D65", 460.0) / at("stdillum-D65", 560.0);
        assert!((ratio - 1.178_12).abs() < 1e-5);
        let ratio = at("stdillum-D50", 660.0) / at("stdillum-D50", 560.0);
        assert!((ratio - 0.857_562_03).abs() < 1e-5);
    }

    /// Published: CIE 015:2018, table 3, and TB-2014-004 of the Academy for its D60.
    #[test]
    fn chromaticities_of_the_illuminants() {
        for (name, x, y, tolerance) in [
            ("stdillum-A", 0.447_57, 0.407_45, 1e-4),
            ("stdillum-D65", 0.312_72, 0.329_03, 1e-4),
            ("illum-acesD60", 0.321_68, 0.337_67, 2e-4),
            ("stdillum-F2", 0.372_08, 0.375_29, 2e-4),
            ("stdillum-F7", 0.312_92, 0.329_33, 2e-4),
            ("stdillum-F11", 0.380_52, 0.377_13, 2e-4),
        ] {
            let c = spectrum_to_xyz(&named(name).unwrap()).chromaticity();
            assert!((c.x - x).abs() < tolerance && (c.y - y).abs() < tolerance, "{name}: {c}");
        }
    }
}
