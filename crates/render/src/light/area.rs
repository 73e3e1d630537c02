//! Light from the surface of a shape.

use super::LightStrategy::{AsPoint, ByTexture, Complementary, SolidAngle, UniformArea};
use super::area_image::AreaImage;
use super::emitter::{Emitter, EmittingSurface};
use super::{Emission, LightBounds, LightSample, LightStrategy, ShadowTarget};
use std::f32::consts::PI;
use std::sync::Arc;
use tenfold_geometry::{
    NormalCone, Primitive, ReferencePoint, ReferencePoints, Shape, ShapeSamples, SurfacePoint,
};
use tenfold_math::{Slots, Vec2, Vec2s, Vec3};
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

/// The radiance that leaves a surface, the same in all directions of the side that emits.
#[derive(Clone, Debug)]
pub enum AreaRadiance {
    /// The same everywhere.
    Uniform(Emission),
    /// An image over the texture coordinates, its top at v = 1, times the light's scale.
    Image(Arc<AreaImage>),
}

/// What a primitive emits: `scale` times `radiance`.
#[derive(Clone, Debug)]
pub struct AreaEmission {
    /// The radiance.
    pub radiance: AreaRadiance,
    /// Its factor.
    pub scale: f32,
}

/// A shape that emits: what the lights that are its primitives share.
#[derive(Clone, Debug)]
pub struct EmittingShape {
    surface: EmittingSurface,
    /// That of all primitives, or those of each.
    emissions: Vec<AreaEmission>,
    two_sided: bool,
    /// Whether rays pass through it, so that light sampling alone can find it.
    invisible: bool,
}

impl EmittingShape {
    /// With one of the `emissions` for all primitives or as many as there are primitives, on the side of the geometric normal or on
    /// both.
    pub fn new(shape: Shape, emissions: Vec<AreaEmission>, two_sided: bool) -> Self {
        debug_assert!(emissions.len() == 1 || emissions.len() == shape.len());
        Self { surface: EmittingSurface::new(shape), emissions, two_sided, invisible: false }
    }

    /// The same as a surface that no ray meets, for shapes whose alpha is 0 everywhere.
    #[must_use]
    pub fn invisible(self) -> Self {
        Self { invisible: true, ..self }
    }
}

/// One primitive of a shape, emitting.
#[derive(Clone, Debug)]
pub struct DiffuseAreaLight {
    emitting: Arc<EmittingShape>,
    primitive: u32,
    /// As its shape says.
    two_sided: bool,
}

impl DiffuseAreaLight {
    /// The primitive `primitive` of `emitting`.
    pub fn new(emitting: Arc<EmittingShape>, primitive: usize) -> Self {
        Self { two_sided: emitting.two_sided, emitting, primitive: primitive as u32 }
    }

    #[inline]
    fn emission(&self) -> &AreaEmission {
        match &self.emitting.emissions[..] {
            [shared] => shared,
            each => &each[self.primitive as usize],
        }
    }

    #[inline]
    fn emitter(&self) -> Emitter<'_> {
        self.emitting.surface.emitter(self.primitive as usize)
    }

    /// Radiance averaged over the visible wavelengths and, for images, over the image.
    fn visible_mean(&self) -> f32 {
        let AreaEmission { radiance, scale } = self.emission();
        scale
            * match radiance {
                AreaRadiance::Uniform(emission) => emission.visible_mean(),
                AreaRadiance::Image(image) => image.radiance().visible_mean(),
            }
    }

    /// Its primitive.
    #[inline]
    pub(super) fn primitive(&self) -> Primitive<'_> {
        self.emitter().primitive()
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let primitive = self.emitter().primitive();
        let (bounds, normals, area) = (primitive.bounds(), primitive.normal_cone(), primitive.area());
        // A convex surface that faces all ways shows a quarter of itself to each (Cauchy).
        let shown = if normals.cos_theta <= -1.0 { 0.25 * area } else { area };
        let half = 0.5 * bounds.diagonal();
        // A ball reaches less far than the corners of its box.
        let ball = matches!(primitive, Primitive::Sphere(_))
            && (area / (4.0 * PI * half.x * half.x) - 1.0).abs() < 1e-3
            && half.max_element() - half.min_element() < 1e-3 * half.x;
        let intensity = shown * self.visible_mean();
        LightBounds {
            bounds,
            radius: if ball { half.max_element() } else { half.length() },
            normals: if normals.cos_theta.is_finite() { normals } else { NormalCone::EVERYWHERE },
            cos_emission: 0.0,
            intensity: if intensity.is_finite() && !bounds.is_empty() { intensity } else { 0.0 },
            two_sided: self.two_sided,
        }
    }

    /// Whether a surface point with geometric normal `n` emits toward `w`.
    #[inline]
    pub(super) fn emits_toward(&self, n: Vec3, w: Vec3) -> bool {
        self.two_sided || n.dot(w) > 0.0
    }

    /// Radiance toward the unit direction `w` of the surface point with geometric normal `n` and texture
    /// coordinates `uv`.
    #[inline]
    pub(super) fn emitted(
        &self,
        n: Vec3,
        uv: Vec2,
        w: Vec3,
        wavelengths: &SampledWavelengths,
    ) -> SampledSpectrum {
        if !self.emits_toward(n, w) {
            return SampledSpectrum::ZERO;
        }
        self.radiance(uv, wavelengths)
    }

    #[inline]
    pub(super) fn sample(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> Option<LightSample> {
        let emitter = &self.emitter();
        let s = match (strategy, &self.emission().radiance) {
            (ByTexture | Complementary, AreaRadiance::Image(image)) => image.sample_from(emitter, from, u)?,
            (ByTexture | Complementary | SolidAngle, _) => emitter.sample_from(from, u)?,
            (UniformArea, _) => emitter.primitive().sample_area_from(from, u)?,
            (AsPoint, AreaRadiance::Image(image)) => image.point_from(&emitter.primitive(), from, u)?,
            // A ball shines to all sides by what is seen of it; where the other shapes are seen from must not matter.
            (AsPoint, _) => match emitter.primitive() {
                sphere @ Primitive::Sphere(_) => sphere.sample_from(from, u)?,
                primitive => primitive.sample_area_from(from, u)?,
            },
        };
        let to_light = s.p - from.p;
        let distance_squared = to_light.length_squared();
        if distance_squared == 0.0 || s.pdf.is_nan() || s.pdf <= 0.0 {
            return None;
        }
        let wi = to_light / distance_squared.sqrt();
        let radiance = self.emitted(s.n, s.uv, -wi, w);
        (!radiance.is_black()).then(|| LightSample {
            radiance,
            wi,
            target: ShadowTarget::from(&s),
            pdf: s.pdf,
            delta: self.emitting.invisible,
        })
    }

    /// Points that [`DiffuseAreaLight::sample`] chooses for the points `from` in `slots`; false where this kind of surface, emission or strategy has
    /// to be asked for each by itself.
    #[inline]
    pub(super) fn points_from(
        &self,
        strategy: LightStrategy,
        slots: Slots,
        from: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
    ) -> bool {
        self.is_sampled_evenly(strategy) && self.emitter().samples_from(slots, from, u, out)
    }

    /// Begins to load its surface.
    #[inline]
    pub(super) fn prefetch(&self) {
        self.emitting.surface.prefetch(self.primitive as usize);
    }

    /// Whether it emits the same everywhere and is sampled by what is seen of it.
    #[inline]
    pub(super) fn is_sampled_evenly(&self, strategy: LightStrategy) -> bool {
        matches!(self.emission().radiance, AreaRadiance::Uniform(_))
            && matches!(strategy, ByTexture | Complementary | SolidAngle)
    }

    /// Radiance of the point with texture coordinates `uv`, which matter to images only, on the side that emits.
    #[inline]
    pub(super) fn radiance(&self, uv: Vec2, wavelengths: &SampledWavelengths) -> SampledSpectrum {
        let AreaEmission { radiance, scale } = self.emission();
        let value = match radiance {
            AreaRadiance::Uniform(emission) => emission.sample(wavelengths),
            AreaRadiance::Image(image) => image.at(uv, wavelengths),
        };
        *scale * value
    }

    /// Whether both sides emit.
    #[inline]
    pub(super) fn is_two_sided(&self) -> bool {
        self.two_sided
    }

    /// Whether rays pass through it.
    #[inline]
    pub(super) fn is_invisible(&self) -> bool {
        self.emitting.invisible
    }

    /// Density per steradian with which [`DiffuseAreaLight::sample`] finds `point`; where it finds but one, any positive number.
    #[inline]
    pub(super) fn pdf(&self, strategy: LightStrategy, from: &ReferencePoint, point: &SurfacePoint) -> f32 {
        let emitter = &self.emitter();
        match (strategy, &self.emission().radiance) {
            (ByTexture | Complementary, AreaRadiance::Image(image)) => image.pdf_from(emitter, from, point),
            (ByTexture | Complementary | SolidAngle, _) => emitter.pdf_from_point(from, point),
            (UniformArea | AsPoint, _) => emitter.primitive().pdf_area_from_point(from, point),
        }
    }
}
