use tenfold_math::{Frame, Vec2, Vec3};
use tenfold_spectrum::SampledSpectrum;

use super::record::{BsdfSample, Lobe};
use super::{Bxdf, Hemispheres, ScatterStrategy};

/// A [`Bxdf`] at a point of a surface: the same methods on directions in the world.
#[derive(Copy, Clone, Debug)]
pub struct Bsdf<'a> {
    frame: Frame,
    bxdf: Bxdf<'a>,
    strategy: ScatterStrategy,
    /// Whether its one direction is that of a mirror.
    mirrors: bool,
}

impl<'a> Bsdf<'a> {
    /// Puts `bxdf` in the shading frame `frame`, whose z is the shading normal.
    #[inline]
    pub fn new(frame: Frame, bxdf: Bxdf<'a>) -> Self {
        Self { frame, bxdf, strategy: ScatterStrategy::Bsdf, mirrors: false }
    }

    /// Has directions sampled by `strategy`; by the scattering function unless set.
    #[inline]
    pub fn set_strategy(&mut self, strategy: ScatterStrategy) {
        self.strategy = strategy;
    }

    /// Has every sample scatter in one direction, which the caller sees to. Surfaces without a diffuse lobe then are mirrors:
    /// they show lights, and none is to be sampled for them.
    #[inline]
    pub fn hold_direction(&mut self) {
        self.mirrors = !self.bxdf.lobes().contains(Lobe::DIFFUSE);
    }

    /// The shading frame.
    #[inline]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The scattering function in the local frame.
    #[inline]
    pub fn bxdf(&self) -> &Bxdf<'a> {
        &self.bxdf
    }

    /// What it can do.
    #[inline]
    pub fn lobes(&self) -> Lobe {
        if self.mirrors { self.bxdf.lobes().sharpened() } else { self.bxdf.lobes() }
    }

    /// Whether the lobe's number makes a difference to [`Bsdf::sample`].
    #[inline]
    pub fn chooses_lobe(&self) -> bool {
        !matches!(self.bxdf, Bxdf::Diffuse(_) | Bxdf::Conductor(_)) || self.strategy != ScatterStrategy::Bsdf
    }

    /// As [`Bxdf::is_dispersive`].
    #[inline]
    pub fn is_dispersive(&self) -> bool {
        self.bxdf.is_dispersive()
    }

    /// As [`Bxdf::parts_wavelengths`]; directions that are not chosen by the scattering function serve all lanes alike.
    #[inline]
    pub fn parts_wavelengths(&self) -> bool {
        self.bxdf.parts_wavelengths()
            && (self.strategy == ScatterStrategy::Bsdf || !self.bxdf.lobes().has_density())
    }

    /// The BSDF per lane in sr⁻¹, without the cosine; 0 of specular lobes. As [`Bxdf::eval`].
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        self.bxdf.eval(self.frame.to_local(wo), self.frame.to_local(wi))
    }

    /// Density per lane of [`Bsdf::sample`] in solid angle. As [`Bxdf::pdf`].
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        let (wo, wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
        match Hemispheres::new(self.strategy, &self.bxdf, wo) {
            None => self.bxdf.pdf(wo, wi),
            Some(hemispheres) => hemispheres.eval_and_pdf(&self.bxdf, wo, wi).pdf,
        }
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] in one: the price of one of them.
    #[inline]
    pub fn eval_and_pdf(&self, wo: Vec3, wi: Vec3) -> BsdfValue {
        let (wo, wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
        match Hemispheres::new(self.strategy, &self.bxdf, wo) {
            None => self.bxdf.eval_and_pdf(wo, wi),
            Some(hemispheres) => hemispheres.eval_and_pdf(&self.bxdf, wo, wi),
        }
    }

    /// Samples a direction; `hero` is the lane that decides. As [`Bxdf::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, hero: usize) -> Option<BsdfSample> {
        let wo = self.frame.to_local(wo);
        if let Some(hemispheres) = Hemispheres::new(self.strategy, &self.bxdf, wo) {
            // Apart, as the way of the default must not pay for it.
            return hemispheres.sample(&self.bxdf, wo, u_lobe, u, hero).map(|sample| self.in_world(sample));
        }
        self.bxdf.sample(wo, u_lobe, u, hero).map(|sample| self.in_world(sample))
    }

    #[inline]
    fn in_world(&self, sample: BsdfSample) -> BsdfSample {
        let lobe = if self.mirrors { sample.lobe.sharpened() } else { sample.lobe };
        BsdfSample { wi: self.frame.to_world(sample.wi), lobe, ..sample }
    }
}

/// Value and density of a BSDF at one pair of directions.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct BsdfValue {
    /// The BSDF per lane in sr⁻¹, without the cosine.
    pub f: SampledSpectrum,
    /// Density per lane of sampling `wi`, in solid angle.
    pub pdf: SampledSpectrum,
}
