//! Surfaces whose scattering is computed side by side.

use crate::bxdf::{Interface, TrowbridgeReitz, WideBxdf};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Frame, Rays, Vec3, Vec3s, WIDTH, offset_ray_origin, select};
use tenfold_spectrum::Spectra;

/// Surfaces whose scattering is computed side by side ([`WideBxdf`]): in each slot what its kind asks for.
#[derive(Debug)]
pub(super) struct Surfaces {
    /// Unit shading normals.
    pub(super) n: Vec3s,
    /// Directions to which the first axes of the shading frames are nearest.
    pub(super) tangent: Vec3s,
    /// Albedos of even reflectors.
    pub(super) reflectance: Spectra,
    /// Rough boundaries.
    pub(super) interface: [Interface; WIDTH],
    /// Microfacets of metals.
    pub(super) distribution: [TrowbridgeReitz; WIDTH],
    /// Indices of refraction of metals, real parts.
    pub(super) eta: Spectra,
    /// Imaginary parts.
    pub(super) k: Spectra,
}

impl Surfaces {
    /// The shading frame in a slot.
    #[inline(always)]
    pub(super) fn frame(&self, slot: usize) -> Frame {
        Frame::from_z_and_tangent(self.n.get(slot), self.tangent.get(slot))
    }

    /// Puts a surface with the scattering function `bxdf` and a frame with these `axes`, z and what x is nearest to, into a slot.
    #[inline(always)]
    pub(super) fn set(&mut self, slot: usize, [n, tangent]: [Vec3; 2], bxdf: &WideBxdf) {
        self.n.set(slot, n);
        self.tangent.set(slot, tangent);
        match bxdf {
            WideBxdf::Diffuse(reflectance) => self.reflectance.set(slot, *reflectance),
            WideBxdf::Dielectric(interface) => self.interface[slot] = *interface,
            WideBxdf::Conductor(metal) => {
                self.distribution[slot] = metal.distribution();
                let [eta, k] = metal.index();
                self.eta.set(slot, eta);
                self.k.set(slot, k);
            }
        }
    }
}

impl Default for Surfaces {
    fn default() -> Self {
        Self {
            n: Vec3s::ZERO,
            tangent: Vec3s::ZERO,
            reflectance: Spectra::ZERO,
            interface: [Interface::new(1.0, TrowbridgeReitz::SMOOTH); WIDTH],
            distribution: [TrowbridgeReitz::SMOOTH; WIDTH],
            eta: Spectra::ZERO,
            k: Spectra::ZERO,
        }
    }
}

/// Sets the ray of a slot to one that leaves the surface there for `wi`, if the slot is one of those looked at; for loops over slots.
#[inline(always)]
pub(super) fn leave_if(is_here: bool, slot: usize, from: &ReferencePoints, wi: Vec3, rays: &mut Rays) {
    let origin = offset_ray_origin(from.p.get(slot), from.p_error.get(slot), from.n.get(slot), wi);
    let mask = u32::from(is_here).wrapping_neg();
    rays.origin.set_where(mask, slot, origin);
    rays.direction.set_where(mask, slot, wi);
    rays.time[slot] = select(mask, from.time[slot], rays.time[slot]);
}
