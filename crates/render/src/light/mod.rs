//! Lights: emission, sampling, and the choice among many.
//!
//! [`Lights`] is what an integrator talks to; each kind of light is one file. All densities of directions are per
//! steradian at the point that is lit. A light's strength is compared with another's by
//! its mean over the visible wavelengths.

mod area;
mod area_image;
mod choice;
mod distant;
mod emission;
mod emitter;
mod far;
mod goniometric;
mod image_infinite;
mod lights;
mod point;
mod projection;
mod radiance_image;
mod samples;
mod spot;
mod strategy;
mod uniform;

#[cfg(test)]
mod tests;

pub use area::{AreaEmission, AreaRadiance, DiffuseAreaLight, EmittingShape};
pub use area_image::AreaImage;
pub use choice::LightBounds;
pub use distant::DistantLight;
pub use emission::Emission;
pub use goniometric::GoniometricLight;
pub use image_infinite::ImageInfinite;
pub use lights::Lights;
pub use point::PointLight;
pub use projection::{ProjectionLight, Screen};
pub use radiance_image::RadianceImage;
pub(crate) use radiance_image::{mean_rgb, weighted_rgb};
pub use samples::LightSamples;
pub use spot::SpotLight;
pub(crate) use spot::is_similarity;
pub use strategy::LightStrategy;
pub use uniform::UniformInfinite;

use far::FarIrradiance;
use tenfold_geometry::{ReferencePoint, SHADOW_T_MAX, ShapeSample, ray_between};
use tenfold_math::{Ray, Vec2, Vec3};
use tenfold_spectrum::{SampledSpectrum, SampledWavelengths};

/// A source of light. Many are primitives of shapes, in 16 bytes: paths find them by chance, each in memory of its own.
#[derive(Clone, Debug)]
pub enum Light {
    /// Evenly from a point.
    Point(Box<PointLight>),
    /// From a point into a cone.
    Spot(Box<SpotLight>),
    /// From one direction.
    Distant(Box<DistantLight>),
    /// From a point, an image.
    Projection(Box<ProjectionLight>),
    /// From a point, by measured intensities.
    Goniometric(Box<GoniometricLight>),
    /// From one primitive of a shape.
    Area(DiffuseAreaLight),
    /// Evenly from all directions.
    Uniform(Box<UniformInfinite>),
    /// From all directions, by an image.
    Image(Box<ImageInfinite>),
}

const _: () = assert!(size_of::<Light>() <= 16);

macro_rules! into_light {
    ($($kind:ident: $light:ty),*) => {
        $(impl From<$light> for Light {
            fn from(light: $light) -> Self {
                Self::$kind(Box::new(light))
            }
        })*
    };
}

into_light!(
    Point: PointLight, Spot: SpotLight, Distant: DistantLight, Projection: ProjectionLight,
    Goniometric: GoniometricLight, Uniform: UniformInfinite, Image: ImageInfinite
);

/// Light that may reach a point, if nothing is in the way.
#[derive(Copy, Clone, Debug)]
pub struct LightSample {
    /// Of area and infinite lights, the radiance in W·m⁻²·sr⁻¹·nm⁻¹; of lights at a point, the intensity over
    /// the squared distance, and of distant ones the irradiance, both in W·m⁻²·nm⁻¹.
    pub radiance: SampledSpectrum,
    /// Unit direction to the light.
    pub wi: Vec3,
    /// What the shadow ray must reach.
    pub target: ShadowTarget,
    /// Density of `wi` per steradian times the probability of the light; where `delta`, that probability alone.
    pub pdf: f32,
    /// Whether no other way of sampling finds this light.
    pub delta: bool,
}

/// The far end of a shadow ray.
#[derive(Copy, Clone, Debug)]
pub enum ShadowTarget {
    /// A point on a surface.
    Surface {
        /// The point.
        p: Vec3,
        /// Bound on its absolute error.
        p_error: Vec3,
        /// Its unit geometric normal.
        n: Vec3,
    },
    /// A point in space.
    Point(Vec3),
    /// Infinitely far away in the direction of the sample.
    Infinity,
}

impl From<&ShapeSample> for ShadowTarget {
    fn from(s: &ShapeSample) -> Self {
        Self::Surface { p: s.p, p_error: s.p_error, n: s.n }
    }
}

/// A ray that must be free for light to arrive.
#[derive(Copy, Clone, Debug)]
pub struct ShadowRay {
    /// From the lit point to the light.
    pub ray: Ray,
    /// Only what the ray meets before this parameter is in the way.
    pub t_max: f32,
}

impl LightSample {
    /// The ray that must be free, from the point that the sample was made for.
    #[inline]
    pub fn shadow_ray(&self, from: &ReferencePoint) -> ShadowRay {
        match self.target {
            ShadowTarget::Surface { p, p_error, n } => ShadowRay {
                ray: ray_between(from.p, from.p_error, from.n, p, p_error, n, from.time),
                t_max: SHADOW_T_MAX,
            },
            ShadowTarget::Point(p) => ShadowRay { ray: from.spawn_ray_to_point(p), t_max: SHADOW_T_MAX },
            ShadowTarget::Infinity => ShadowRay { ray: from.spawn_ray(self.wi), t_max: f32::INFINITY },
        }
    }
}

/// How a light enters the choice among all.
#[derive(Copy, Clone, Debug)]
enum Role {
    /// With others, by where it is.
    Local(LightBounds),
    /// By itself, infinitely far away: by all of its light, and by what of it does not come from all directions alike.
    Far { whole: FarIrradiance, uneven: Option<FarIrradiance> },
}

impl Light {
    fn role(&self) -> Role {
        match self {
            Self::Point(l) => Role::Local(l.bounds()),
            Self::Spot(l) => Role::Local(l.bounds()),
            Self::Projection(l) => Role::Local(l.bounds()),
            Self::Goniometric(l) => Role::Local(l.bounds()),
            Self::Area(l) => Role::Local(l.bounds()),
            Self::Distant(l) => {
                let irradiance = l.irradiance.visible_mean();
                let whole = FarIrradiance::Parallel { irradiance, direction: l.direction };
                Role::Far { whole, uneven: Some(whole) }
            }
            Self::Uniform(l) => Role::Far {
                whole: FarIrradiance::around(l.radiance.visible_mean(), Vec3::ZERO),
                uneven: None,
            },
            Self::Image(l) => Role::Far { whole: l.irradiance(), uneven: l.uneven_irradiance() },
        }
    }

    /// Whether rays that leave the scene meet it.
    pub fn is_sky(&self) -> bool {
        matches!(self, Self::Uniform(_) | Self::Image(_))
    }

    /// Light from this light at `from`, by `u` in `[0, 1)²`; the density is that of the direction alone.
    #[inline]
    fn sample(
        &self,
        strategy: LightStrategy,
        from: &ReferencePoint,
        u: Vec2,
        w: &SampledWavelengths,
    ) -> Option<LightSample> {
        match self {
            Self::Point(l) => l.sample(from, w),
            Self::Spot(l) => l.sample(from, w),
            Self::Distant(l) => Some(l.sample(w)),
            Self::Projection(l) => l.sample(from, w),
            Self::Goniometric(l) => l.sample(from, w),
            Self::Area(l) => l.sample(strategy, from, u, w),
            Self::Uniform(l) => (strategy != LightStrategy::AsPoint).then(|| l.sample(strategy, from, u, w)),
            Self::Image(l) => l.sample(strategy, u, w),
        }
    }

    /// Radiance from the unit `direction`, infinitely far away.
    #[inline]
    fn escaped(&self, direction: Vec3, w: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::Uniform(l) => l.radiance.sample(w),
            Self::Image(l) => l.radiance(direction, w),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Projection(_)
            | Self::Goniometric(_)
            | Self::Area(_) => SampledSpectrum::ZERO,
        }
    }

    /// Density with which [`Light::sample`] finds, from `from`, the infinitely far unit `direction`.
    #[inline]
    fn pdf_escaped(&self, strategy: LightStrategy, from: &ReferencePoint, direction: Vec3) -> f32 {
        match self {
            Self::Uniform(_) if strategy == LightStrategy::AsPoint => 0.0,
            Self::Uniform(l) => l.pdf(strategy, from, direction),
            Self::Image(l) => l.pdf(strategy, direction),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Projection(_)
            | Self::Goniometric(_)
            | Self::Area(_) => 0.0,
        }
    }
}
