//! Textures read from image files.

use std::sync::Arc;

use tenfold_image::{Metadata, Pyramid, TextureFilter};
use tenfold_math::{Vec2, Vec3, vec2};
use tenfold_spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};

use super::{Mapping2, SpectrumRole, TextureContext};

/// An image on surfaces: its lower left corner at (s, t) = (0, 0), its upper right one at (1, 1).
#[derive(Clone, Debug)]
pub struct ImageMap {
    /// How it lies.
    pub mapping: Mapping2,
    /// The image, as [`tenfold_image::Image::into_texture`] leaves it: one, three (RGB) or four (RGBA) channels.
    pub pyramid: Arc<Pyramid>,
    /// How it is averaged.
    pub filter: TextureFilter,
    /// Factor on its values.
    pub scale: f32,
    /// Whether 1 minus the scaled value is meant.
    pub invert: bool,
}

/// An image of spectra.
#[derive(Clone, Debug)]
pub struct SpectrumImageMap {
    /// The image.
    pub image: ImageMap,
    /// The colour space of its values.
    pub color_space: &'static RgbColorSpace,
    /// What its colours stand for.
    pub role: SpectrumRole,
}

impl ImageMap {
    /// Coordinates with t running down, as the rows of an image do.
    #[inline]
    fn coordinates(&self, at: &TextureContext) -> (Vec2, Vec2, Vec2) {
        let c = self.mapping.map(at);
        let down = |v: Vec2| vec2(v.x, -v.y);
        (vec2(c.st.x, 1.0 - c.st.y), down(c.dstdx), down(c.dstdy))
    }

    /// The number at a point: the image's opacity where it has one, else the mean of its channels.
    #[inline]
    pub fn float(&self, at: &TextureContext) -> f32 {
        let (st, dx, dy) = self.coordinates(at);
        let v = match self.pyramid.levels()[0].channels().len() {
            1 => self.pyramid.lookup(0, st, dx, dy, self.filter),
            4 => self.pyramid.lookup(3, st, dx, dy, self.filter),
            _ => self.pyramid.lookup_rgb(st, dx, dy, self.filter).element_sum() * (1.0 / 3.0),
        };
        let v = self.scale * v;
        if self.invert { (1.0 - v).max(0.0) } else { v }
    }

    /// The colour at a point, without negative components.
    #[inline]
    pub fn rgb(&self, at: &TextureContext) -> Rgb {
        let (st, dx, dy) = self.coordinates(at);
        let v = self.scale * self.pyramid.lookup_rgb(st, dx, dy, self.filter);
        Rgb((if self.invert { Vec3::ONE - v } else { v }).max(Vec3::ZERO))
    }
}

impl SpectrumImageMap {
    /// The spectrum at a point.
    #[inline]
    pub fn spectrum(&self, at: &TextureContext, w: &SampledWavelengths) -> SampledSpectrum {
        self.role.sample(self.color_space, self.image.rgb(at), w)
    }
}

/// The colour space that a file says its values are in; sRGB where it says none, or none that is known.
pub(crate) fn color_space_of(metadata: &Metadata) -> &'static RgbColorSpace {
    // Files store them rounded.
    const TOLERANCE: f32 = 1e-3;
    let Some(given) = metadata.chromaticities else { return RgbColorSpace::srgb() };
    let near = |space: &&RgbColorSpace| {
        let [r, g, b] = space.primaries();
        [r, g, b, space.white()].iter().zip(given).all(|(a, b)| (*a - b).abs().max_element() < TOLERANCE)
    };
    RgbColorSpace::all().iter().find(near).unwrap_or(RgbColorSpace::srgb())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Footprint;
    use tenfold_image::{ColorEncoding, Image, WrapMode};
    use tenfold_math::ops;

    /// Two columns, two rows: values 0.1, 0.2 above 0.3, 0.4.
    fn grey(wrap: WrapMode, filter: TextureFilter) -> ImageMap {
        let image = Image::from_f32(2, 2, ["Y"], vec![0.1, 0.2, 0.3, 0.4]).unwrap();
        ImageMap {
            mapping: Mapping2::default(),
            pyramid: Arc::new(Pyramid::build(image, wrap).unwrap()),
            filter,
            scale: 1.0,
            invert: false,
        }
    }

    fn rgb(channels: &[&str], values: Vec<f32>) -> ImageMap {
        let image = Image::from_f32(1, 1, channels.iter().copied(), values).unwrap();
        let pyramid = Arc::new(Pyramid::build(image, WrapMode::Repeat).unwrap());
        ImageMap { pyramid, ..grey(WrapMode::Repeat, TextureFilter::Bilinear) }
    }

    fn at(u: f32, v: f32) -> TextureContext {
        TextureContext::at_uv(vec2(u, v))
    }

    #[test]
    fn the_lower_left_corner_of_the_image_is_the_origin() {
        let t = grey(WrapMode::Clamp, TextureFilter::Point);
        assert_eq!(t.float(&at(0.25, 0.25)), 0.3);
        assert_eq!(t.float(&at(0.75, 0.25)), 0.4);
        assert_eq!(t.float(&at(0.25, 0.75)), 0.1);
        assert_eq!(t.float(&at(0.75, 0.75)), 0.2);
    }

    #[test]
    fn filters_interpolate_and_wrap() {
        let t = grey(WrapMode::Clamp, TextureFilter::Bilinear);
        assert!((t.float(&at(0.5, 0.5)) - 0.25).abs() < 1e-6);
        assert!((t.float(&at(0.5, 0.25)) - 0.35).abs() < 1e-6);
        assert!((t.float(&at(0.0, 0.0)) - 0.3).abs() < 1e-6);
        let t = grey(WrapMode::Repeat, TextureFilter::Bilinear);
        assert!((t.float(&at(0.0, 0.0)) - 0.25).abs() < 1e-6);
        assert!((t.float(&at(3.25, -1.75)) - 0.3).abs() < 1e-6);
        let t = grey(WrapMode::Black, TextureFilter::Bilinear);
        assert!((t.float(&at(0.0, 0.0)) - 0.075).abs() < 1e-6);
        assert_eq!(t.float(&at(1.6, 0.5)), 0.0);
        let t = grey(WrapMode::OctahedralSphere, TextureFilter::Point);
        // Beyond the left edge lies the left edge, upside down.
        assert_eq!(t.float(&at(-0.25, 0.25)), 0.1);
    }

    #[test]
    fn a_wide_footprint_gives_the_mean() {
        let footprint = Footprint { dudx: 4.0, dvdy: 4.0, ..Footprint::default() };
        for filter in
            [TextureFilter::Bilinear, TextureFilter::Trilinear, TextureFilter::Ewa { max_anisotropy: 8.0 }]
        {
            let t = grey(WrapMode::Repeat, filter);
            assert!((t.float(&TextureContext { footprint, ..at(0.25, 0.25) }) - 0.25).abs() < 1e-6);
        }
    }

    #[test]
    fn scale_comes_before_inversion() {
        let t = ImageMap { scale: 2.0, ..grey(WrapMode::Repeat, TextureFilter::Point) };
        assert_eq!(t.float(&at(0.25, 0.25)), 0.6);
        let t = ImageMap { invert: true, ..t };
        assert!((t.float(&at(0.25, 0.25)) - 0.4).abs() < 1e-6);
        let t = ImageMap { scale: 5.0, ..t };
        assert_eq!(t.float(&at(0.25, 0.25)), 0.0);
        assert_eq!(t.rgb(&at(0.25, 0.25)).0, Vec3::ZERO);
    }

    #[test]
    fn a_number_is_the_opacity_or_the_mean() {
        assert!((rgb(&["R", "G", "B"], vec![0.1, 0.2, 0.6]).float(&at(0.5, 0.5)) - 0.3).abs() < 1e-6);
        assert_eq!(rgb(&["R", "G", "B", "A"], vec![0.1, 0.2, 0.6, 0.75]).float(&at(0.5, 0.5)), 0.75);
    }

    #[test]
    fn colours_become_spectra_by_their_role() {
        let w = SampledWavelengths::sample_visible(0.4);
        let space = RgbColorSpace::srgb();
        let of = |values: Vec<f32>, role| {
            SpectrumImageMap { image: rgb(&["R", "G", "B"], values), color_space: space, role }
                .spectrum(&at(0.5, 0.5), &w)
        };
        let c = [0.8, 0.3, 0.1];
        assert_eq!(of(c.to_vec(), SpectrumRole::Albedo), space.sample_albedo(Rgb::new(0.8, 0.3, 0.1), &w));
        let grey = |v: f32| vec![v; 3];
        let near = |a: SampledSpectrum, b: SampledSpectrum| {
            (a.0 - b.0).abs().max_element() < 1e-5 * b.0.max_element()
        };
        assert!(near(of(grey(0.5), SpectrumRole::Albedo), SampledSpectrum::splat(0.5)));
        assert!(near(of(grey(5.0), SpectrumRole::Albedo), SampledSpectrum::ONE));
        assert!(near(of(grey(5.0), SpectrumRole::Unbounded), SampledSpectrum::splat(5.0)));
        assert!(near(of(grey(5.0), SpectrumRole::Illuminant), 5.0 * space.illuminant().sample(&w)));
    }

    #[test]
    fn codes_are_decoded() {
        for (encoding, want) in [
            (ColorEncoding::Linear, 0.2),
            (ColorEncoding::Srgb, ops::powf((0.2f32 + 0.055) / 1.055, 2.4)),
            (ColorEncoding::Gamma(2.0), 0.04),
        ] {
            let image = Image::from_u8(1, 1, ["Y"], vec![51], encoding).unwrap();
            let pyramid = Arc::new(Pyramid::build(image, WrapMode::Repeat).unwrap());
            let t = ImageMap { pyramid, ..grey(WrapMode::Repeat, TextureFilter::Bilinear) };
            assert!((t.float(&at(0.3, 0.3)) - want).abs() < 1e-6, "{encoding:?}");
        }
    }

    #[test]
    fn spaces_are_known_by_their_chromaticities() {
        assert_eq!(color_space_of(&Metadata::default()).name(), "srgb");
        for space in RgbColorSpace::all() {
            let [r, g, b] = space.primaries();
            let chromaticities = Some([r, g, b, space.white()].map(|c| c + vec2(2e-4, -2e-4)));
            assert_eq!(
                color_space_of(&Metadata { chromaticities, ..Metadata::default() }).name(),
                space.name()
            );
        }
        let chromaticities = Some([Vec2::ONE; 4]);
        assert_eq!(color_space_of(&Metadata { chromaticities, ..Metadata::default() }).name(), "srgb");
    }
}
