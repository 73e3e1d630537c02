/// How the point on a light is chosen, once the light is.
///
/// The picture is the same by all of [`LightStrategy::ALL`]; what differs is the noise. They concern lights that have more than one
/// point: areas and infinite lights.
///
/// | | on a surface | infinitely far away |
/// |---|---|---|
/// | `UniformArea` | by area | by direction |
/// | `SolidAngle` | by solid angle, where the shape can | by direction; even light by the cosine at surfaces |
/// | `ByTexture` | the same, and where there is a picture also by its brightness | the same, and a picture by its brightness |
/// | `Complementary` | the same | a picture by its brightness above the mean; even light not at all |
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum LightStrategy {
    /// Uniformly over the light's area (quadrics that are stretched unevenly: over that before), or over all directions.
    UniformArea,
    /// Uniformly over what is seen of it, as far as the shape can: spheres, triangles and rectangles. Pictures are ignored.
    SolidAngle,
    /// In proportion to its picture, and to solid angle near it.
    ByTexture,
    /// The same, but what of a sky is the same from all sides is left to scattered directions, which find it as well: the samples go to
    /// the brighter parts and to other lights. Where lights are sampled alone, this is `ByTexture`.
    #[default]
    Complementary,
    /// Every area as a single point that the numbers give, at which all its light is gathered; light from infinitely
    /// far is not sampled. For numbers that are frozen: not one of those by which the picture is the same.
    AsPoint,
}

impl LightStrategy {
    /// All by which the picture is the same, plain before refined.
    pub const ALL: [Self; 4] = [Self::UniformArea, Self::SolidAngle, Self::ByTexture, Self::Complementary];

    /// The name, in kebab case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::UniformArea => "uniform-area",
            Self::SolidAngle => "solid-angle",
            Self::ByTexture => "by-texture",
            Self::Complementary => "complementary",
            Self::AsPoint => "as-point",
        }
    }
}
