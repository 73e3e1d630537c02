//! Images on area lights, and their sampling.

use super::RadianceImage;
use super::emitter::Emitter;
use std::sync::Arc;
use tenfold_geometry::{Primitive, ReferencePoint, Shape, ShapeSample, SurfacePoint};
use tenfold_image::{Image, WrapMode};
use tenfold_math::{ONE_MINUS_EPSILON, Vec2, Vec3};
use tenfold_sampling::distribution::PiecewiseConstant2D;
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

/// An image over the texture coordinates of a primitive, and how bright the primitive is where.
///
/// On flat rectangles and parallelograms points are chosen by two strategies, at random: by the solid angle
/// they fill, and by the image's brightness. The density is the exact one of both together. On other shapes
/// points are chosen by solid angle alone.
#[derive(Clone, Debug)]
pub struct AreaImage {
    radiance: Arc<RadianceImage>,
    brightness: Option<Brightness>,
}

/// The texture coordinates at the corners 00, 10, 01, 11 of a parallelogram.
pub(crate) type Corners = [Vec2; 4];

/// The brightness of a parallelogram over its parameters, whose square maps to equal areas.
#[derive(Clone, Debug)]
struct Brightness {
    distribution: Arc<PiecewiseConstant2D>,
    area: f32,
    centre: Vec3,
    radius_squared: f32,
}

/// Most cells of a distribution along an axis.
const MAX_CELLS: f32 = 1024.0;
/// Small images get cells finer than their pixels, between which they are interpolated: up to this many along
/// an axis, ...
const FINE_CELLS: f32 = 256.0;
/// ... and so many a pixel.
const CELLS_PER_PIXEL: f32 = 4.0;

impl AreaImage {
    /// The spectra `radiance` over the primitive `primitive` of `shape`, chosen also by `distribution` where
    /// there is one: that of [`AreaImage::distribution`] for the primitive's [`AreaImage::corners`].
    pub fn new(
        radiance: Arc<RadianceImage>,
        distribution: Option<Arc<PiecewiseConstant2D>>,
        shape: &Shape,
        primitive: usize,
    ) -> Self {
        let primitive = shape.primitive(primitive);
        let (bounds, area) = (primitive.bounds(), primitive.area());
        let brightness = distribution.map(|distribution| Brightness {
            distribution,
            area,
            centre: bounds.centroid(),
            radius_squared: 0.25 * bounds.diagonal().length_squared(),
        });
        Self { radiance, brightness }
    }

    /// The corners of a primitive that can be sampled by brightness.
    pub fn corners(shape: &Shape, primitive: usize) -> Option<Corners> {
        let primitive = shape.primitive(primitive);
        if !matches!(primitive, Primitive::Patch(_)) || !is_parallelogram(&primitive) {
            return None;
        }
        let uv = |x, y| primitive.sample_area(Vec2::new(x, y)).map(|s| s.uv);
        Some([uv(0.0, 0.0)?, uv(1.0, 0.0)?, uv(0.0, 1.0)?, uv(1.0, 1.0)?])
    }

    /// The distribution over the parameters of a parallelogram in proportion to the brightness of `image`
    /// there; `None` where it would save nothing.
    pub fn distribution(image: &Image, corners: &Corners) -> Option<PiecewiseConstant2D> {
        let size = Vec2::new(image.width() as f32, image.height() as f32);
        let cells = |edge: Vec2| {
            let pixels = (edge * size).length();
            let fine = (CELLS_PER_PIXEL * pixels).min(FINE_CELLS);
            pixels.max(fine).clamp(1.0, MAX_CELLS).ceil() as usize
        };
        let [c00, c10, c01, c11] = *corners;
        let (nx, ny) = (cells(c10 - c00), cells(c01 - c00));
        // The mean over a cell, by points at a quarter and three quarters of it.
        let mut weights = Vec::with_capacity(nx * ny);
        for y in 0..ny {
            for x in 0..nx {
                let mut sum = 0.0;
                for (dx, dy) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
                    let (a, b) = ((x as f32 + dx) / nx as f32, (y as f32 + dy) / ny as f32);
                    let uv = c00.lerp(c10, a).lerp(c01.lerp(c11, a), b);
                    let rgb = image.bilerp_rgb(flip(uv), WrapMode::Clamp);
                    sum += (rgb.x + rgb.y + rgb.z).max(0.0);
                }
                weights.push(sum);
            }
        }
        let moment =
            |k: i32| weights.iter().map(|&w| f64::from(w).powi(k)).sum::<f64>() / weights.len() as f64;
        // What sampling by brightness can save is the second moment over the squared mean.
        (moment(2) > 1.05 * moment(1).powi(2)).then(|| PiecewiseConstant2D::new(&weights, nx))
    }

    pub(super) fn radiance(&self) -> &RadianceImage {
        &self.radiance
    }

    /// The image at texture coordinates, whose v runs up.
    #[inline]
    pub(super) fn at(&self, uv: Vec2, w: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.bilinear(flip(uv), w)
    }

    #[inline]
    pub(super) fn sample_from(
        &self,
        emitter: &Emitter<'_>,
        from: &ReferencePoint,
        u: Vec2,
    ) -> Option<ShapeSample> {
        let Some(b) = &self.brightness else { return emitter.sample_from(from, u) };
        let by_image = b.probability(from);
        let mut sample = if u.x < by_image {
            let u = Vec2::new((u.x / by_image).min(ONE_MINUS_EPSILON), u.y);
            emitter.primitive().sample_area(b.distribution.sample(u).point)?
        } else {
            let u = Vec2::new(((u.x - by_image) / (1.0 - by_image)).min(ONE_MINUS_EPSILON), u.y);
            emitter.sample_from(from, u)?
        };
        sample.pdf = b.pdf_from(by_image, emitter, from, &sample.surface_point());
        Some(sample)
    }

    /// The point that `u` stands for in the distribution of brightness alone, wherever it is seen from.
    pub(super) fn point_from(
        &self,
        primitive: &Primitive<'_>,
        from: &ReferencePoint,
        u: Vec2,
    ) -> Option<ShapeSample> {
        let Some(b) = &self.brightness else { return primitive.sample_area_from(from, u) };
        let mut sample = primitive.sample_area(b.distribution.sample(u).point)?;
        sample.pdf = b.pdf_by_image(from, &sample.surface_point());
        Some(sample)
    }

    #[inline]
    pub(super) fn pdf_from(&self, emitter: &Emitter<'_>, from: &ReferencePoint, point: &SurfacePoint) -> f32 {
        match &self.brightness {
            Some(b) => b.pdf_from(b.probability(from), emitter, from, point),
            None => emitter.pdf_from_point(from, point),
        }
    }
}

#[inline]
fn flip(uv: Vec2) -> Vec2 {
    Vec2::new(uv.x, 1.0 - uv.y)
}

impl Brightness {
    /// How often to choose by brightness: mostly from afar, where the solid angle is spread evenly over the
    /// light, and half the time near it.
    #[inline]
    fn probability(&self, from: &ReferencePoint) -> f32 {
        let distance_squared = from.p.distance_squared(self.centre);
        1.0 - (self.radius_squared / distance_squared.max(1e-30)).clamp(0.1, 0.5)
    }

    /// Density by solid angle of a point that is chosen by brightness alone.
    #[inline]
    fn pdf_by_image(&self, from: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let to_light = point.p - from.p;
        let d2 = to_light.length_squared();
        let pdf =
            self.distribution.pdf(point.param) / self.area * d2 * d2.sqrt() / point.n.dot(to_light).abs();
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    #[inline]
    fn pdf_from(
        &self,
        by_image: f32,
        emitter: &Emitter<'_>,
        from: &ReferencePoint,
        point: &SurfacePoint,
    ) -> f32 {
        by_image * self.pdf_by_image(from, point) + (1.0 - by_image) * emitter.pdf_from_point(from, point)
    }
}

/// Whether sampling a patch by area is the identity on its parameters.
fn is_parallelogram(primitive: &Primitive<'_>) -> bool {
    let area = primitive.area();
    let probes = [0.0, 0.3, 0.9].into_iter().flat_map(|x| [0.0, 0.4, 0.95].map(|y| Vec2::new(x, y)));
    let fits = |u: Vec2| {
        let sample = primitive.sample_area(u);
        sample.is_some_and(|s| s.param.distance(u) < 1e-4 && (s.pdf * area - 1.0).abs() < 1e-3)
    };
    area > 0.0 && probes.into_iter().all(fits)
}
