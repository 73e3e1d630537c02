//! Materials from their descriptions.

use std::{collections::HashSet, sync::Arc};

use tenfold_math::Id;
use tenfold_scene::{Description, Diagnostic, MaterialEntity, ParamType, Params, nearest};
use tenfold_spectrum::{LAMBDA_MAX, LAMBDA_MIN, Spectrum, named};

use super::{
    context::Context,
    texture::{TextureLibrary, quick},
};
use crate::{
    bxdf::{CoatRoughness, CoatTable},
    material::{
        Coat, CoatedConductor, CoatedDiffuse, Conductor, Dielectric, Diffuse, DiffuseTransmission, Eta,
        Material, Materials, Metal, Mix, Relief, Roughness, ThinDielectric,
    },
    texture::{FloatSlot, SpectrumRole, SpectrumSlot},
};

/// All types of materials that pbrt-v4 knows.
const KINDS: [&str; 12] = [
    "coatedconductor",
    "coateddiffuse",
    "conductor",
    "dielectric",
    "diffuse",
    "diffusetransmission",
    "hair",
    "interface",
    "measured",
    "mix",
    "subsurface",
    "thindielectric",
];

/// The materials of a description, with the same indices.
pub(crate) fn compile_materials<'s>(
    cx: &mut Context<'_>,
    description: &'s Description,
    textures: &mut TextureLibrary<'s>,
) -> Materials {
    let mut materials = Materials::default();
    let mut compiler = Compiler { cx, description, textures, coat_tables: Vec::new() };
    for entity in &description.materials {
        let (material, relief) = compiler.material(entity).unwrap_or((Material::Interface, Relief::Smooth));
        materials.add(material, relief);
    }
    break_cycles(compiler.cx, description, &mut materials);
    materials
}

struct Compiler<'c, 'a, 's> {
    cx: &'c mut Context<'a>,
    description: &'s Description,
    textures: &'c mut TextureLibrary<'s>,
    coat_tables: Vec<(CoatKey, Arc<CoatTable>)>,
}

/// What a table of a coat is made for.
#[derive(Copy, Clone, Debug, PartialEq)]
struct CoatKey {
    eta: [f32; 2],
    roughness: CoatRoughness,
    thickness: f32,
}

impl Compiler<'_, '_, '_> {
    fn material(&mut self, entity: &MaterialEntity) -> Option<(Material, Relief)> {
        let kind = entity.entity.kind.as_str();
        let params = &entity.entity.params("material", self.cx.diagnostics);
        let material = match kind {
            "diffuse" => Material::Diffuse(Diffuse { reflectance: self.albedo(params, "reflectance", 0.5) }),
            "diffusetransmission" => Material::DiffuseTransmission(DiffuseTransmission {
                reflectance: self.albedo(params, "reflectance", 0.25),
                transmittance: self.albedo(params, "transmittance", 0.25),
                scale: at_least_zero(params, "scale", params.one_float("scale", 1.0)),
            }),
            "conductor" => Material::Conductor(Conductor {
                metal: self.metal(params, "")?,
                roughness: self.roughness(params, "").0,
            }),
            "dielectric" => Material::Dielectric(Dielectric {
                eta: self.eta(params, "eta"),
                roughness: self.roughness(params, "").0,
            }),
            "thindielectric" => Material::ThinDielectric(ThinDielectric { eta: self.eta(params, "eta") }),
            "coateddiffuse" => Material::CoatedDiffuse(CoatedDiffuse {
                reflectance: self.albedo(params, "reflectance", 0.5),
                coat: self.coat(params, "", true),
            }),
            "coatedconductor" => Material::CoatedConductor(CoatedConductor {
                metal: self.metal(params, "conductor.")?,
                roughness: self.roughness(params, "conductor.").0,
                coat: self.coat(params, "interface.", false),
            }),
            "mix" => Material::Mix(self.mix(params)?),
            "interface" => Material::Interface,
            "" | "none" => {
                let message = format!("material \"{kind}\" is called \"interface\" in pbrt-v4");
                self.cx.diagnostics.warning(params.span(), message);
                return Some((Material::Interface, Relief::Smooth));
            }
            "hair" | "measured" | "subsurface" => {
                self.cx.unsupported(params.span(), &format!("material \"{kind}\""));
                return None;
            }
            _ => {
                self.cx.unknown_kind(params.span(), "material", kind, KINDS);
                return None;
            }
        };
        let relief = match material {
            Material::Mix(_) | Material::Interface => Relief::Smooth,
            _ => self.relief(params),
        };
        params.finish(&[]);
        Some((material, relief))
    }

    fn relief(&mut self, params: &Params<'_>) -> Relief {
        let displacement = self.textures.float(self.cx, params, "displacement");
        let normal_map = params.string("normalmap").and_then(|path| {
            let span = params.span_of("normalmap");
            let linear = Some(tenfold_image::ColorEncoding::Linear);
            let image = self.cx.image(path, span, linear)?;
            if !image.is_color() {
                self.cx.diagnostics.error(span, format!("the normal map \"{path}\" has no three channels"));
                return None;
            }
            Some(image)
        });
        match (normal_map, displacement) {
            (Some(image), displacement) => {
                if displacement.is_some() {
                    let message = "a material with a normal map takes no displacement: it is ignored";
                    self.cx.diagnostics.warning(params.span_of("displacement"), message);
                }
                Relief::NormalMap(image)
            }
            // The same height everywhere only moves the surface, which bump maps never do.
            (None, None | Some(FloatSlot::Constant(_))) => Relief::Smooth,
            (None, Some(height)) => Relief::Displacement(height),
        }
    }

    fn albedo(&mut self, params: &Params<'_>, name: &str, default: f32) -> SpectrumSlot {
        self.textures.spectrum_or(self.cx, params, name, SpectrumRole::Albedo, default)
    }

    /// A metal by the parameters `eta` and `k` after `prefix`, or by `reflectance`; copper where nothing is given.
    fn metal(&mut self, params: &Params<'_>, prefix: &str) -> Option<Metal> {
        let (eta_name, k_name) = (format!("{prefix}eta"), format!("{prefix}k"));
        let has_index = params.has(&eta_name) || params.has(&k_name);
        if params.has("reflectance") {
            if has_index {
                let message = format!(
                    "{} takes either \"reflectance\" or \"{eta_name}\" and \"{k_name}\", not both",
                    params.what()
                );
                self.cx.diagnostics.error(params.span_of("reflectance"), message);
                return None;
            }
            return Some(Metal::Reflectance(self.albedo(params, "reflectance", 1.0)));
        }
        let mut constant = |name: &str, copper: &str| {
            let given = self.textures.spectrum(self.cx, params, name, SpectrumRole::Unbounded);
            // The names of copper are known.
            given.or_else(|| named(copper).map(quick).map(SpectrumSlot::Constant))
        };
        Some(Metal::Index { eta: constant(&eta_name, "metal-Cu-eta")?, k: constant(&k_name, "metal-Cu-k")? })
    }

    /// An index of refraction: a number or a spectrum, but no texture.
    fn eta(&mut self, params: &Params<'_>, name: &str) -> Eta {
        const DEFAULT: Spectrum = Spectrum::Constant(1.5);
        let eta = match params.ty(name) {
            None => DEFAULT,
            Some(ParamType::Float) => params.float(name).map_or(DEFAULT, Spectrum::Constant),
            Some(ParamType::Spectrum | ParamType::Rgb | ParamType::Blackbody) => params
                .spectrum(name)
                .and_then(|value| self.cx.spectrum(&value, SpectrumRole::Unbounded))
                .map_or(DEFAULT, simplified),
            Some(other) => {
                params.find(name);
                let message =
                    format!("parameter \"{name}\" must be \"float\" or \"spectrum\", found \"{other}\"");
                params.error(name, message);
                DEFAULT
            }
        };
        let least = (0..=47).map(|i| eta.eval(360.0 + 10.0 * i as f32)).fold(f32::INFINITY, f32::min);
        if least < 0.0 {
            params.error(name, "an index of refraction cannot be negative");
            return Eta::new(DEFAULT);
        }
        Eta::new(eta)
    }

    /// The parameters `roughness`, `uroughness`, `vroughness` after `prefix`, and `remaproughness`; and whether the
    /// roughness is the same in all directions.
    fn roughness(&mut self, params: &Params<'_>, prefix: &str) -> (Roughness, bool) {
        let mut slot = |name: &str| {
            let name = format!("{prefix}{name}");
            let slot = self.textures.float(self.cx, params, &name)?;
            let checked = slot.constant().map(|v| FloatSlot::Constant(at_least_zero(params, &name, v)));
            Some(checked.unwrap_or(slot))
        };
        let both = slot("roughness").unwrap_or(FloatSlot::Constant(0.0));
        let (u, v) = (slot("uroughness").unwrap_or(both), slot("vroughness").unwrap_or(both));
        (Roughness::new(u, v, params.one_bool("remaproughness", true)), u == v)
    }

    /// A coat whose interface's parameters have `prefix`; over a base that its table can be used with, or not.
    fn coat(&mut self, params: &Params<'_>, prefix: &str, with_table: bool) -> Coat {
        let (roughness, isotropic) = self.roughness(params, prefix);
        let thickness = self.textures.float_or(self.cx, params, "thickness", 0.01);
        let thickness = match thickness {
            FloatSlot::Constant(v) => FloatSlot::Constant(at_least_zero(params, "thickness", v)),
            slot => slot,
        };
        let mut coat = Coat {
            eta: self.eta(params, &format!("{prefix}eta")),
            roughness,
            thickness,
            albedo: self.albedo(params, "albedo", 0.0),
            g: self.textures.float_or(self.cx, params, "g", 0.0),
            max_depth: count(params, "maxdepth", 10),
            samples: count(params, "nsamples", 1),
            table: None,
        };
        if with_table && coat.is_clear() {
            coat.table = self.coat_table(&coat, isotropic);
        }
        coat
    }

    /// The table of a clear coat, if its parameters vary no more than tables can.
    fn coat_table(&mut self, coat: &Coat, isotropic: bool) -> Option<Arc<CoatTable>> {
        let thickness = coat.thickness.constant()?;
        let roughness = match coat.roughness.constant() {
            Some(distribution) => CoatRoughness::Constant(distribution),
            None if isotropic => CoatRoughness::IsotropicUpTo(Coat::ROUGHEST),
            None => return None,
        };
        let key = CoatKey { eta: coat.eta.range(), roughness, thickness };
        if let Some((_, known)) = self.coat_tables.iter().find(|(k, _)| *k == key) {
            return Some(known.clone());
        }
        let table = Arc::new(CoatTable::new(key.eta[0], key.eta[1], roughness, thickness));
        self.coat_tables.push((key, table.clone()));
        Some(table)
    }

    fn mix(&mut self, params: &Params<'_>) -> Option<Mix> {
        let amount = self.textures.float_or(self.cx, params, "amount", 0.5);
        if !params.has("materials") {
            params.missing("materials", ParamType::String);
            return None;
        }
        let [first, second] = params.strings("materials") else {
            params.error("materials", "a mix needs the names of two materials");
            return None;
        };
        let find = |name: &str| {
            let found = self.description.material_names.get(name);
            if found.is_none() {
                let mut known: Vec<_> = self.description.material_names.keys().map(String::as_str).collect();
                // The order of a hash map is not to be seen.
                known.sort_unstable();
                let diagnostic =
                    Diagnostic::error(params.span_of("materials"), format!("unknown material \"{name}\""));
                let near = nearest(name, known);
                let help = near.map(|near| format!("did you mean \"{near}\"?"));
                self.cx.diagnostics.push(match help {
                    Some(help) => diagnostic.with_help(help),
                    None => diagnostic,
                });
            }
            found.map(|id| Id::new(id.index()))
        };
        let (first, second) = (find(first), find(second));
        Some(Mix { materials: [first?, second?], amount })
    }
}

/// Reports mixes that contain themselves, and takes one of every cycle out.
fn break_cycles(cx: &Context<'_>, description: &Description, materials: &mut Materials) {
    let contains_itself = |materials: &Materials, id: Id<Material>| {
        let (mut seen, mut stack) = (HashSet::new(), vec![id]);
        while let Some(next) = stack.pop() {
            let Material::Mix(mix) = materials.get(next) else { continue };
            if mix.materials.contains(&id) {
                return true;
            }
            stack.extend(mix.materials.into_iter().filter(|part| seen.insert(*part)));
        }
        false
    };
    for (i, entity) in description.materials.iter().enumerate() {
        let id = Id::new(i);
        if contains_itself(materials, id) {
            cx.diagnostics.error(entity.entity.kind_span, "a mix of materials contains itself");
            materials.set(id, Material::Interface, Relief::Smooth);
        }
    }
}

/// A number that may not be negative.
fn at_least_zero(params: &Params<'_>, name: &str, value: f32) -> f32 {
    if value < 0.0 {
        params.error(name, format!("parameter \"{name}\" of {} cannot be negative", params.what()));
    }
    value.max(0.0)
}

/// A number of something, at least 1.
fn count(params: &Params<'_>, name: &str, default: i32) -> u32 {
    let value = params.one_int(name, default);
    if value < 1 {
        params.error(name, format!("parameter \"{name}\" of {} must be at least 1", params.what()));
    }
    value.max(1) as u32
}

/// The same spectrum, as one number where it does not depend on the wavelength: what follows must not be taken for
/// dispersive.
fn simplified(spectrum: Spectrum) -> Spectrum {
    let flat = match &spectrum {
        Spectrum::PiecewiseLinear(s) => {
            let points = s.points();
            let covers = points[0][0] <= LAMBDA_MIN && points[points.len() - 1][0] >= LAMBDA_MAX;
            // The very number: an interpolated one may be off by its rounding.
            (covers && points.iter().all(|p| p[1] == points[0][1])).then_some(points[0][1])
        }
        Spectrum::RgbUnbounded(s) => {
            (s.sigmoid.c[1] == 0.0 && s.sigmoid.c[2] == 0.0).then(|| spectrum.eval(LAMBDA_MIN))
        }
        _ => None,
    };
    flat.map_or(spectrum, Spectrum::Constant)
}

#[cfg(test)]
mod tests;
