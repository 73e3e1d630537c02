//! Images of radiance, converted to spectra beforehand.

use rayon::prelude::*;
use tenfold_image::{Image, WrapMode};
use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::{
    DenselySampled, Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths, SigmoidPolynomial,
};

/// The spectrum of a pixel: a factor times a sigmoid times the white of the image.
#[derive(Copy, Clone, Debug)]
struct Texel {
    scale: f32,
    sigmoid: SigmoidPolynomial,
}

impl Texel {
    /// The illuminant spectrum of a colour (pbrt book, 4th edition, section 4.6.6); negative parts count as 0.
    fn new(rgb: Vec3, space: &RgbColorSpace) -> Self {
        let rgb = rgb.max(Vec3::ZERO);
        let scale = 2.0 * rgb.max_element();
        if scale <= 0.0 {
            return Self { scale: 0.0, sigmoid: SigmoidPolynomial { c: [0.0; 3] } };
        }
        Self { scale, sigmoid: space.to_sigmoid(Rgb(rgb / scale)) }
    }

    #[inline]
    fn sample(&self, w: &SampledWavelengths) -> SampledSpectrum {
        if self.scale == 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.scale * self.sigmoid.sample(w)
    }
}

/// An image whose pixels are emitted spectra: a lookup takes neither a search nor a table of colours.
///
/// Coordinates are those of [`Image`]: (0, 0) is the corner of the first pixel of the top row.
#[derive(Clone, Debug)]
pub struct RadianceImage {
    width: u32,
    height: u32,
    texels: Vec<Texel>,
    illuminant: DenselySampled,
    mean: Vec3,
}

impl RadianceImage {
    /// The spectra of `image`, whose colours are of `space`.
    pub fn new(image: &Image, space: &RgbColorSpace) -> Self {
        let (width, height) = (image.width(), image.height());
        let texels = (0..width as usize * height as usize)
            .into_par_iter()
            .map(|i| Texel::new(image.rgb(i as u32 % width, i as u32 / width), space))
            .collect();
        Self { width, height, texels, illuminant: space.illuminant().clone(), mean: mean_rgb(image) }
    }

    /// Width and height in pixels.
    pub fn resolution(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The mean over the visible wavelengths, see [`visible_mean`](super::emission::visible_mean), and over
    /// the image.
    pub(super) fn visible_mean(&self) -> f32 {
        let white = super::emission::visible_mean(|lambda| self.illuminant.eval(lambda));
        white * (self.mean.x + self.mean.y + self.mean.z) / 3.0
    }

    #[inline]
    fn texel(&self, x: u32, y: u32) -> &Texel {
        &self.texels[y as usize * self.width as usize + x as usize]
    }

    /// Of the pixel in the given column and row.
    #[inline]
    pub fn pixel(&self, [x, y]: [usize; 2], w: &SampledWavelengths) -> SampledSpectrum {
        self.texel(x as u32, y as u32).sample(w) * self.illuminant.sample(w)
    }

    /// Of the pixel that covers `st`, or of the nearest one.
    #[inline]
    pub fn nearest(&self, st: Vec2, w: &SampledWavelengths) -> SampledSpectrum {
        // Conversions saturate, and send NaN to 0.
        let x = ((st.x * self.width as f32) as u32).min(self.width - 1);
        let y = ((st.y * self.height as f32) as u32).min(self.height - 1);
        self.texel(x, y).sample(w) * self.illuminant.sample(w)
    }

    /// Interpolated between the spectra at the centres of the four pixels around `st`; the border goes on
    /// outside. Its colour is the interpolated colour.
    #[inline]
    pub fn bilinear(&self, st: Vec2, w: &SampledWavelengths) -> SampledSpectrum {
        let p = st * Vec2::new(self.width as f32, self.height as f32) - Vec2::splat(0.5);
        let corner = p.floor();
        let d = p - corner;
        let clamp = |v: f32, size: u32| (v as i64).clamp(0, i64::from(size) - 1) as u32;
        let (x0, x1) = (clamp(corner.x, self.width), clamp(corner.x + 1.0, self.width));
        let (y0, y1) = (clamp(corner.y, self.height), clamp(corner.y + 1.0, self.height));
        let corners = [(x0, y0), (x1, y0), (x0, y1), (x1, y1)];
        let weights = [(1.0 - d.x) * (1.0 - d.y), d.x * (1.0 - d.y), (1.0 - d.x) * d.y, d.x * d.y];
        let mut sum = SampledSpectrum::ZERO;
        for ((x, y), weight) in corners.into_iter().zip(weights) {
            if weight > 0.0 {
                sum += weight * self.texel(x, y).sample(w);
            }
        }
        sum * self.illuminant.sample(w)
    }
}

/// Mean colour, negative parts as zero.
pub(crate) fn mean_rgb(image: &Image) -> Vec3 {
    weighted_rgb(image, |_| 1.0)
}

/// Mean over all pixels of the colour times `weight` at the pixel's centre in `[0, 1]²`, negative parts as zero.
pub(crate) fn weighted_rgb(image: &Image, weight: impl Fn(Vec2) -> f32) -> Vec3 {
    let (width, height) = (image.width(), image.height());
    let mut sum = [0.0f64; 3];
    for y in 0..height {
        for x in 0..width {
            let centre = Vec2::new((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
            let value =
                image.rgb_wrapped(x as i32, y as i32, WrapMode::Clamp).max(Vec3::ZERO) * weight(centre);
            for (s, v) in sum.iter_mut().zip(value.to_array()) {
                *s += f64::from(v);
            }
        }
    }
    let pixels = f64::from(width) * f64::from(height);
    Vec3::from(sum.map(|s| (s / pixels) as f32))
}
