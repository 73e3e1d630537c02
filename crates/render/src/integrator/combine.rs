/// How the two ways to find light are combined at each vertex: a point sampled on a light, and a direction of scattering that
/// meets one by itself.
///
/// All of them find all light; what differs is the noise. What only one way can find always counts in full: lights
/// without extent, and light that arrives from a specular direction or straight at the camera.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum CombineStrategy {
    /// Both, weighed against each other by the power heuristic with exponent 2 (Veach 1997, §9.2).
    #[default]
    Mis,
    /// Points sampled on lights alone.
    LightOnly,
    /// Directions of scattering alone.
    BsdfOnly,
}

impl CombineStrategy {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Mis, Self::LightOnly, Self::BsdfOnly];

    /// The name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mis => "mis",
            Self::LightOnly => "light-only",
            Self::BsdfOnly => "bsdf-only",
        }
    }
}
