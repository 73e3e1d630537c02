use tenfold_sampling::Variable;

/// Variables that decide one thing together, at all vertices of the path.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// The point in the pixel.
    Pixel,
    /// The point on the lens.
    Lens,
    /// The time in the shutter interval.
    Time,
    /// The wavelengths, and which of them goes on alone.
    Wavelength,
    /// The light and the point on it.
    Light,
    /// The lobe and the direction of scattering, and walks within layers.
    Scatter,
    /// Which of mixed materials is met.
    Mix,
    /// Whether a partly transparent surface is met.
    Alpha,
    /// Whether a path goes on.
    Roulette,
    /// Distances, events and directions in media.
    Medium,
}

impl Group {
    /// All groups.
    pub const ALL: [Self; 10] = [
        Self::Pixel,
        Self::Lens,
        Self::Time,
        Self::Wavelength,
        Self::Light,
        Self::Scatter,
        Self::Mix,
        Self::Alpha,
        Self::Roulette,
        Self::Medium,
    ];

    /// The group of a variable: every variable has one.
    pub const fn of(variable: Variable) -> Self {
        match variable {
            Variable::Pixel => Self::Pixel,
            Variable::Lens => Self::Lens,
            Variable::Time => Self::Time,
            Variable::Wavelength | Variable::Hero => Self::Wavelength,
            Variable::LightChoice | Variable::LightPoint | Variable::LightDirection => Self::Light,
            Variable::ScatterLobe | Variable::ScatterDirection | Variable::Layer => Self::Scatter,
            Variable::MaterialMix => Self::Mix,
            Variable::Alpha => Self::Alpha,
            Variable::Roulette => Self::Roulette,
            Variable::MediumDistance
            | Variable::MediumEvent
            | Variable::PhaseDirection
            | Variable::Transmittance => Self::Medium,
        }
    }

    /// Its variables.
    pub fn variables(self) -> impl Iterator<Item = Variable> {
        Variable::ALL.into_iter().filter(move |&v| Self::of(v) == self)
    }

    /// The name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pixel => "pixel",
            Self::Lens => "lens",
            Self::Time => "time",
            Self::Wavelength => "wavelength",
            Self::Light => "light",
            Self::Scatter => "scatter",
            Self::Mix => "material mix",
            Self::Alpha => "alpha",
            Self::Roulette => "roulette",
            Self::Medium => "medium",
        }
    }

    /// What it decides, for people.
    pub const fn decides(self) -> &'static str {
        match self {
            Self::Pixel => "the point in the pixel: edges, detail",
            Self::Lens => "the point on the lens: depth of field",
            Self::Time => "the moment: motion blur",
            Self::Wavelength => "the wavelengths: colour, dispersion",
            Self::Light => "the light and the point on it: soft shadows",
            Self::Scatter => "lobe and direction: gloss, indirect light",
            Self::Mix => "which of mixed materials is met",
            Self::Alpha => "whether partly transparent surfaces are met",
            Self::Roulette => "whether paths go on",
            Self::Medium => "distances and directions in media",
        }
    }
}
