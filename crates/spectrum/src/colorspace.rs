//! RGB colour spaces.

use std::sync::{LazyLock, OnceLock};

use glam::{DMat3, DVec3};
use tenfold_math::{Mat3, Vec2, Vec3};

use crate::spectrum::rgb_factor;
use crate::upsample::Solver;
use crate::{
    Chromaticity, DenselySampled, Rgb, SampledSpectrum, SampledWavelengths, SigmoidPolynomial, SigmoidTable,
    Spectrum, Xyz, named, spectrum_to_xyz,
};

/// Nodes of a table that has to be made.
const NODES: usize = 36;

/// A linear RGB colour space: primaries, the illuminant that is its white, and the ways to and from XYZ and spectra.
#[derive(Debug)]
pub struct RgbColorSpace {
    name: &'static str,
    primaries: [Chromaticity; 3],
    white: Chromaticity,
    rgb_to_xyz: Mat3,
    xyz_to_rgb: Mat3,
    illuminant: DenselySampled,
    solver: Solver,
    /// The shipped file of `table`, which is read when first asked for.
    shipped: &'static [u8],
    table: OnceLock<SigmoidTable>,
}

static SPACES: LazyLock<[RgbColorSpace; 4]> = LazyLock::new(|| {
    let v = Vec2::new;
    let (d65, d60) = ("stdillum-D65", "illum-acesD60");
    let srgb: &[u8] = include_bytes!("../data/srgb.sigmoid");
    let p3: &[u8] = include_bytes!("../data/dci-p3.sigmoid");
    let rec2020: &[u8] = include_bytes!("../data/rec2020.sigmoid");
    let aces: &[u8] = include_bytes!("../data/aces2065-1.sigmoid");
    [
        // ITU-R BT.709.
        RgbColorSpace::new("srgb", [v(0.64, 0.33), v(0.3, 0.6), v(0.15, 0.06)], d65, srgb),
        // SMPTE RP 431-2 with the white of displays, D65.
        RgbColorSpace::new("dci-p3", [v(0.68, 0.32), v(0.265, 0.69), v(0.15, 0.06)], d65, p3),
        // ITU-R BT.2020.
        RgbColorSpace::new("rec2020", [v(0.708, 0.292), v(0.17, 0.797), v(0.131, 0.046)], d65, rec2020),
        // SMPTE ST 2065-1.
        RgbColorSpace::new("aces2065-1", [v(0.7347, 0.2653), v(0.0, 1.0), v(0.0001, -0.077)], d60, aces),
    ]
});

impl RgbColorSpace {
    /// Derives the matrices: the columns of RGB → XYZ are the XYZ of the primaries, scaled to add up to
    /// the white (pbrt 4th ed., section 4.6.3).
    fn new(
        name: &'static str,
        primaries: [Chromaticity; 3],
        illuminant: &str,
        shipped: &'static [u8],
    ) -> Self {
        let illuminant = named(illuminant).unwrap_or(Spectrum::Constant(1.0));
        let white = spectrum_to_xyz(&illuminant);
        let xyz = primaries.map(|p| {
            let p = p.as_dvec2();
            DVec3::new(p.x, p.y, 1.0 - p.x - p.y)
        });
        let unscaled = DMat3::from_cols(xyz[0], xyz[1], xyz[2]);
        let rgb_to_xyz = unscaled * DMat3::from_diagonal(unscaled.inverse() * white.0.as_dvec3());
        let illuminant = DenselySampled::from_spectrum(&illuminant);
        Self {
            name,
            primaries,
            white: white.chromaticity(),
            rgb_to_xyz: rgb_to_xyz.as_mat3(),
            xyz_to_rgb: rgb_to_xyz.inverse().as_mat3(),
            solver: Solver::new(rgb_to_xyz, &illuminant),
            illuminant,
            shipped,
            table: OnceLock::new(),
        }
    }

    /// sRGB's primaries (ITU-R BT.709) and D65.
    pub fn srgb() -> &'static Self {
        &SPACES[0]
    }

    /// The P3 primaries and D65 (Display P3).
    pub fn dci_p3() -> &'static Self {
        &SPACES[1]
    }

    /// ITU-R BT.2020.
    pub fn rec2020() -> &'static Self {
        &SPACES[2]
    }

    /// ACES 2065-1, with the Academy's D60.
    pub fn aces2065_1() -> &'static Self {
        &SPACES[3]
    }

    /// All of them.
    pub fn all() -> &'static [Self] {
        &*SPACES
    }

    /// By pbrt-v4's names `srgb`, `dci-p3`, `rec2020`, `aces2065-1`, in upper or lower case.
    pub fn named(name: &str) -> Option<&'static Self> {
        SPACES.iter().find(|s| s.name.eq_ignore_ascii_case(name))
    }

    /// pbrt-v4's name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Chromaticities of red, green and blue.
    pub fn primaries(&self) -> [Chromaticity; 3] {
        self.primaries
    }

    /// Chromaticity of the white.
    pub fn white(&self) -> Chromaticity {
        self.white
    }

    /// The spectrum that is white, of [`crate::photometric`] value [`crate::CIE_Y_INTEGRAL`].
    #[inline]
    pub fn illuminant(&self) -> &DenselySampled {
        &self.illuminant
    }

    /// Matrix from RGB to XYZ. White (1, 1, 1) has Y = 1.
    pub fn rgb_to_xyz(&self) -> Mat3 {
        self.rgb_to_xyz
    }

    /// Matrix from XYZ to RGB.
    pub fn xyz_to_rgb(&self) -> Mat3 {
        self.xyz_to_rgb
    }

    /// RGB to XYZ.
    #[inline]
    pub fn to_xyz(&self, c: Rgb) -> Xyz {
        Xyz(self.rgb_to_xyz * c.0)
    }

    /// XYZ to RGB.
    #[inline]
    pub fn to_rgb(&self, c: Xyz) -> Rgb {
        Rgb(self.xyz_to_rgb * c.0)
    }

    /// Matrix from this space's RGB to another's, without adaptation of the white.
    pub fn to(&self, other: &Self) -> Mat3 {
        other.xyz_to_rgb * self.rgb_to_xyz
    }

    /// Weights of red, green and blue in the luminance Y.
    pub fn luminance_vector(&self) -> Rgb {
        Rgb(self.rgb_to_xyz.row(1))
    }

    /// The luminance Y of a colour.
    #[inline]
    pub fn luminance(&self, rgb: Vec3) -> f32 {
        rgb.dot(self.luminance_vector().0)
    }

    /// The reflectance spectrum of a colour, by interpolation in a table: for textures, in some tens of nanoseconds. Components are
    /// clamped to [0, 1]; greys are exact. Of sRGB, colours are met to within 1 % of the
    /// largest component, and 0.1 % on average; those between 0.05 and 0.001 to within 12 % (purples without
    /// green) and 1 %.
    #[inline]
    pub fn to_sigmoid(&self, rgb: Rgb) -> SigmoidPolynomial {
        self.table().lookup(rgb)
    }

    /// The reflectance spectrum of a colour, solved for: for constants, in some tens of microseconds. Components are clamped to
    /// [0, 1]; greys have a closed form.
    pub fn solve_sigmoid(&self, rgb: Rgb) -> SigmoidPolynomial {
        let rgb = Rgb(rgb.0.clamp(Vec3::ZERO, Vec3::ONE));
        if rgb.is_grey() {
            return SigmoidPolynomial::constant(rgb.0.x);
        }
        let (c, _) = self.solver.solve_from_grey(rgb.0.as_dvec3());
        SigmoidPolynomial { c: c.as_vec3().to_array() }
    }

    /// Values of the reflectance of a texel at the wavelengths of a path, from the table.
    #[inline]
    pub fn sample_albedo(&self, rgb: Rgb, w: &SampledWavelengths) -> SampledSpectrum {
        self.to_sigmoid(rgb).sample(w)
    }

    /// Values of an unbounded coefficient of a texel at the wavelengths of a path, from the table.
    #[inline]
    pub fn sample_unbounded(&self, rgb: Rgb, w: &SampledWavelengths) -> SampledSpectrum {
        let (scale, rgb) = rgb_factor(rgb);
        scale * self.to_sigmoid(rgb).sample(w)
    }

    /// Values of the emission of a texel at the wavelengths of a path, from the table.
    #[inline]
    pub fn sample_illuminant(&self, rgb: Rgb, w: &SampledWavelengths) -> SampledSpectrum {
        self.sample_unbounded(rgb, w) * self.illuminant.sample(w)
    }

    /// Solves for a table of `n` nodes a side: for shipping it with the program.
    pub fn make_table(&self, n: usize) -> SigmoidTable {
        SigmoidTable::build(&self.solver, n)
    }

    #[inline]
    fn table(&self) -> &SigmoidTable {
        self.table.get_or_init(|| {
            // A test sees to it that the shipped files are sound.
            SigmoidTable::read(self.shipped).unwrap_or_else(|_| self.make_table(NODES))
        })
    }

    #[cfg(test)]
    pub(crate) fn solver(&self) -> &Solver {
        &self.solver
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published: IEC 61966-2-1 and ITU-R BT.709 (to four digits), BT.2020's luminance weights, SMPTE ST 2065-1.
    #[test]
    fn matrices_against_published_figures() {
        let srgb = RgbColorSpace::srgb();
        let want = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        for (i, row) in want.into_iter().enumerate() {
            let got = srgb.rgb_to_xyz().row(i);
            assert!((got - Vec3::from_array(row)).abs().max_element() < 3e-4, "{got}");
        }
        let y = RgbColorSpace::rec2020().luminance_vector().0;
        assert!((y - Vec3::new(0.2627, 0.6780, 0.0593)).abs().max_element() < 2e-4, "{y}");
        let p3 = RgbColorSpace::dci_p3().luminance_vector().0;
        assert!((p3 - Vec3::new(0.2290, 0.6917, 0.0793)).abs().max_element() < 2e-4, "{p3}");
        let aces = RgbColorSpace::aces2065_1().rgb_to_xyz();
        let want = [[0.9525524, 0.0, 0.0000937], [0.3439664, 0.7281661, -0.0721325], [0.0, 0.0, 1.0088252]];
        for (i, row) in want.into_iter().enumerate() {
            assert!((aces.row(i) - Vec3::from_array(row)).abs().max_element() < 6e-4, "{aces}");
        }
    }

    #[test]
    fn the_illuminant_is_white() {
        for cs in RgbColorSpace::all() {
            let white = cs.to_rgb(spectrum_to_xyz(&Spectrum::Dense(cs.illuminant().clone())));
            assert!((white.0 - 1.0).abs().max_element() < 1e-5, "{} {white:?}", cs.name());
            let y = cs.luminance_vector().0.element_sum();
            assert!((y - 1.0).abs() < 1e-5, "{} {y}", cs.name());
            for (i, p) in cs.primaries().into_iter().enumerate() {
                let mut rgb = Vec3::ZERO;
                rgb[i] = 1.0;
                assert!((cs.to_xyz(Rgb(rgb)).chromaticity() - p).abs().max_element() < 1e-5);
            }
            let back = cs.to_rgb(cs.to_xyz(Rgb::new(0.1, 0.5, 0.9)));
            assert!((back.0 - Vec3::new(0.1, 0.5, 0.9)).abs().max_element() < 1e-6);
            assert!(SigmoidTable::read(cs.shipped).is_ok(), "{}", cs.name());
        }
        let d65 = RgbColorSpace::srgb().to_rgb(spectrum_to_xyz(&named("stdillum-D65").unwrap()));
        assert!((d65.0 - 1.0).abs().max_element() < 1e-3, "{d65:?}");
        assert!((RgbColorSpace::srgb().white() - Vec2::new(0.3127, 0.3290)).abs().max_element() < 1e-4);
    }

    /// Illuminant A in linear sRGB, from its published XYZ (1.09850, 1, 0.35585) by the matrix of IEC 61966-2-1.
    #[test]
    fn illuminant_a_in_srgb() {
        let a = RgbColorSpace::srgb().to_rgb(spectrum_to_xyz(&named("stdillum-A").unwrap()));
        let want = Vec3::new(1.8450, 0.8261, 0.2354);
        assert!((a.0 - want).abs().max_element() < 4e-3, "{a:?}");
    }

    #[test]
    fn names_and_conversions() {
        for cs in RgbColorSpace::all() {
            assert_eq!(
                RgbColorSpace::named(&cs.name().to_uppercase()).map(RgbColorSpace::name),
                Some(cs.name())
            );
        }
        assert!(RgbColorSpace::named("adobe").is_none());
        let m = RgbColorSpace::rec2020().to(RgbColorSpace::srgb());
        // ITU-R BT.2087.
        let want = Vec3::new(1.6605, -0.1246, -0.0182);
        assert!((m.x_axis - want).abs().max_element() < 5e-4, "{m}");
    }
}
