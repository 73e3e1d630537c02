use super::{Conductor, Interface};
use tenfold_spectrum::SampledSpectrum;

/// Scattering functions that are computed for many paths side by side.
#[derive(Copy, Clone, Debug)]
pub(crate) enum WideBxdf {
    /// Lambertian reflection of this albedo.
    Diffuse(SampledSpectrum),
    /// A rough boundary of a body with the same index at all wavelengths.
    Dielectric(Interface),
    /// Rough metal.
    Conductor(Conductor),
}
