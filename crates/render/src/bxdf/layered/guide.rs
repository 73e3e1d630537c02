use std::f32::consts::FRAC_1_PI;

use tenfold_math::{Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::{Layered, LayeredBase};
use crate::bxdf::coat_table::attenuation;
use crate::bxdf::local::{reflect, refract_local};
use crate::bxdf::microfacet::TrowbridgeReitz;

/// The mixture from which directions above a layered surface are sampled, for one `wo` above.
///
/// - the coat: its delta if it is smooth, else reflection about its visible normals;
/// - the base, where it is a metal: reflection about visible normals of the base, between directions refracted at the
///   macroscopic normal, with α widened by what two passages through a rough coat add. A microfacet slope `s` of the
///   coat turns a direction inside by about `(1 - 1/η) s`, one of the base by `2 s`, and variances add;
/// - the cosine.
///
/// The index is the mean of the lanes, so that no density depends on the lane.
pub(super) struct Guide {
    /// Probabilities; they sum to one.
    pub(super) coat: f32,
    base: f32,
    cosine: f32,
    /// Weight of the coat's delta, over the cosine.
    pub(super) delta: SampledSpectrum,
    is_delta: bool,
    eta: f32,
    /// `wo` as the base sees it.
    inside: Vec3,
    lobe: TrowbridgeReitz,
}

pub(super) enum Choice {
    Delta,
    Coat,
    Base,
    Cosine,
}

/// Least share of the cosine beside the lobe of a metal: directions after several bounces are spread more widely.
const COSINE_SHARE: f32 = 0.1;

impl Guide {
    pub(super) fn new(layered: &Layered, wo: Vec3) -> Self {
        let eta = layered.eta.average();
        let slab = &layered.slab;
        let is_delta = layered.coat.lobes().is_specular();
        let delta = layered.delta(wo);
        let fresnel = layered.coat.fresnel(wo, wo.z).average();
        let mut coat = if is_delta { delta.average() } else { fresnel };
        let (mut base, mut cosine) = (0.0, 0.0);
        let mut lobe = TrowbridgeReitz::SMOOTH;
        let mut inside = Vec3::Z;
        if let Some(refracted) = refract_local(wo, eta) {
            inside = -refracted;
            let passed = (1.0 - fresnel) * attenuation(slab.thickness, inside);
            let albedo = layered.base.albedo(inside).average() * passed;
            match &layered.base {
                LayeredBase::Diffuse(_) => cosine = albedo,
                LayeredBase::Conductor(_) if is_delta && layered.base.is_smooth() => {}
                LayeredBase::Conductor(metal) => {
                    base = albedo;
                    cosine = COSINE_SHARE * albedo;
                    let coat = layered.distribution;
                    let metal = metal.distribution();
                    let turn = 0.5 * (1.0 - 1.0 / eta).powi(2);
                    // A width below any that matters keeps the lobe from being a delta.
                    let width = |metal: f32, coat: f32| (metal * metal + turn * coat * coat).sqrt().max(2e-3);
                    lobe = TrowbridgeReitz::new(
                        width(metal.alpha_x(), coat.alpha_x()),
                        width(metal.alpha_y(), coat.alpha_y()),
                    );
                }
            }
            if layered.has_medium() {
                let scattered = 1.0 - attenuation(2.0 * slab.thickness, inside);
                cosine += ((1.0 - fresnel) * scattered * slab.albedo.average()).max(1e-3 * (1.0 - fresnel));
            }
        }
        let sum = coat + base + cosine;
        if sum > 0.0 {
            (coat, base, cosine) = (coat / sum, base / sum, cosine / sum);
        }
        Self { coat, base, cosine, delta, is_delta, eta, inside, lobe }
    }

    /// Probability of the coat's delta.
    pub(super) fn delta_probability(&self) -> f32 {
        if self.is_delta { self.coat } else { 0.0 }
    }

    pub(super) fn choose(&self, u: f32) -> Choice {
        if u < self.coat || self.base + self.cosine == 0.0 {
            if self.is_delta { Choice::Delta } else { Choice::Coat }
        } else if u < self.coat + self.base || self.cosine == 0.0 {
            Choice::Base
        } else {
            Choice::Cosine
        }
    }

    /// Samples the lobe of the base. `None` under total internal reflection.
    pub(super) fn sample_base(&self, u: Vec2) -> Option<Vec3> {
        let up = reflect(self.inside, self.lobe.sample_visible(self.inside, u));
        if up.z <= 0.0 { None } else { refract_local(-up, 1.0 / self.eta) }
    }

    fn base_pdf(&self, wi: Vec3) -> f32 {
        let Some(refracted) = refract_local(wi, self.eta) else { return 0.0 };
        let up = -refracted;
        let half = self.inside + up;
        let length = half.length();
        if length == 0.0 {
            return 0.0;
        }
        let m = half / length;
        let cos = self.inside.dot(m);
        if cos <= 0.0 {
            return 0.0;
        }
        // Snell's law: dω' / dω = cos θ / (η² cos θ').
        self.lobe.visible_pdf(self.inside, m) / (4.0 * cos) * wi.z / (self.eta * self.eta * up.z)
    }

    /// Density in solid angle of the sampled directions that are not the delta; `wi` above.
    pub(super) fn pdf(&self, layered: &Layered, wo: Vec3, wi: Vec3) -> f32 {
        let mut pdf = self.cosine * FRAC_1_PI * wi.z;
        if !self.is_delta {
            pdf += self.coat * layered.coat.reflection(wo, wi).visible_pdf;
        }
        if self.base > 0.0 {
            pdf += self.base * self.base_pdf(wi);
        }
        pdf
    }
}
