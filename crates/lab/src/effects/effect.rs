use tenfold_math::Vec2;
use tenfold_render::schedule::{Frozen, RenderSettings};
use tenfold_sampling::Variable;

/// What a variable of the integral does for a picture.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Smooth edges.
    AntiAliasing,
    /// Blur of what is out of focus.
    DepthOfField,
    /// Blur of what moves.
    MotionBlur,
    /// Shadows with penumbrae.
    SoftShadows,
    /// Blurred reflection and refraction.
    Gloss,
    /// Spectra behind glass.
    Dispersion,
}

impl Effect {
    /// All effects.
    pub const ALL: [Self; 6] = [
        Self::AntiAliasing,
        Self::DepthOfField,
        Self::MotionBlur,
        Self::SoftShadows,
        Self::Gloss,
        Self::Dispersion,
    ];

    /// The name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AntiAliasing => "anti-aliasing",
            Self::DepthOfField => "depth of field",
            Self::MotionBlur => "motion blur",
            Self::SoftShadows => "soft shadows",
            Self::Gloss => "gloss",
            Self::Dispersion => "dispersion",
        }
    }

    /// What makes it, for people.
    pub const fn variable(self) -> &'static str {
        match self {
            Self::AntiAliasing => "the point in the pixel",
            Self::DepthOfField => "the point on the lens",
            Self::MotionBlur => "the time",
            Self::SoftShadows => "the point on the light",
            Self::Gloss => "the direction of scattering",
            Self::Dispersion => "the wavelength, where glass refracts",
        }
    }

    /// Holds its variable in the middle.
    pub fn switch_off(self, settings: &mut RenderSettings) {
        let held = |variable| Frozen::Variable(variable, Vec2::splat(0.5));
        settings.freeze(match self {
            Self::AntiAliasing => held(Variable::Pixel),
            Self::DepthOfField => held(Variable::Lens),
            Self::MotionBlur => held(Variable::Time),
            Self::SoftShadows => held(Variable::LightPoint),
            Self::Gloss => held(Variable::ScatterDirection),
            Self::Dispersion => Frozen::Dispersion(Frozen::D_LINE),
        });
    }
}
