//! Textures from their descriptions.

use std::{collections::HashMap, path::PathBuf, sync::Arc};

use tenfold_image::{ColorEncoding, Pyramid, TextureFilter, WrapMode};
use tenfold_math::{Transform, Vec2, Vec3};
use tenfold_scene::{
    Description, Diagnostic, FloatSource, ParamType, Params, SpectrumSource, SpectrumValue, Texture,
    TextureEntity, TextureValue, nearest,
};
use tenfold_spectrum::{LAMBDA_MAX, LAMBDA_MIN, PiecewiseLinear, Spectrum};

use super::context::{Context, string_of};
use crate::texture::{
    Bilerp, Board, Checkerboard, DirectionMix, Dots, Fbm, FloatSlot, FloatTexture, ImageMap, Mapping2,
    Mapping3, Marble, Mix, Scale, SpectrumImageMap, SpectrumRole, SpectrumSlot, SpectrumTexture, Textures,
    Windy, Wrinkled, color_space_of,
};

/// All types of textures that pbrt-v4 knows.
const KINDS: [&str; 13] = [
    "bilerp",
    "checkerboard",
    "constant",
    "directionmix",
    "dots",
    "fbm",
    "imagemap",
    "marble",
    "mix",
    "ptex",
    "scale",
    "windy",
    "wrinkled",
];

/// Textures may refer to textures that refer to textures, but not deeper than this: evaluating one recurses.
const DEEPEST: usize = 64;

/// The textures of a description, compiled when first asked for: a texture of spectra once for every role that it
/// plays.
pub(crate) struct TextureLibrary<'s> {
    entities: &'s [TextureEntity],
    by_name: HashMap<(TextureValue, &'s str), usize>,
    floats: HashMap<usize, State<FloatSlot>>,
    spectra: HashMap<(usize, SpectrumRole), State<SpectrumSlot>>,
    /// By file, and by encoding and wrapping.
    pyramids: HashMap<(PathBuf, String), Option<Arc<Pyramid>>>,
    textures: Textures,
    /// How many textures are being compiled, one for the sake of the other.
    depth: usize,
}

#[derive(Clone)]
enum State<S> {
    /// Begun: whoever asks for it now asks for itself.
    Begun,
    Done(S),
    /// Faulty, and reported.
    Failed,
}

impl<'s> TextureLibrary<'s> {
    /// A library of all textures in `description`.
    pub(crate) fn new(description: &'s Description) -> Self {
        let entities = &description.textures[..];
        let by_name = entities.iter().enumerate().map(|(i, e)| ((e.value, e.name.as_str()), i)).collect();
        Self {
            entities,
            by_name,
            floats: HashMap::new(),
            spectra: HashMap::new(),
            pyramids: HashMap::new(),
            textures: Textures::default(),
            depth: 0,
        }
    }

    /// Reads the images of all textures: several at once, before the textures are compiled one after the other.
    pub(crate) fn read_images(&self, cx: &mut Context<'_>) {
        let maps = self.entities.iter().map(|texture| &texture.entity).filter(|e| e.kind == "imagemap");
        cx.read_images(maps.filter_map(|entity| {
            let encoding = match string_of(&entity.params, "encoding") {
                None => None,
                Some(name) => Some(encoding(name)?),
            };
            Some((string_of(&entity.params, "filename")?, encoding))
        }));
    }

    /// All textures that were asked for. Those that were not are checked all the same.
    pub(crate) fn finish(mut self, cx: &mut Context<'_>) -> Textures {
        for (i, entity) in self.entities.iter().enumerate() {
            match entity.value {
                TextureValue::Float if !self.floats.contains_key(&i) => drop(self.compile_float(cx, i)),
                TextureValue::Spectrum if !self.spectra.keys().any(|(known, _)| *known == i) => {
                    self.compile_spectrum(cx, i, SpectrumRole::Albedo);
                }
                _ => {}
            }
        }
        self.textures
    }

    /// A number or a texture of numbers, if the parameter is given without fault.
    pub(crate) fn float(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        name: &str,
    ) -> Option<FloatSlot> {
        match params.float_or_texture(name)? {
            FloatSource::Value(v) => Some(FloatSlot::Constant(v)),
            FloatSource::Texture(texture) => self.float_texture(cx, params, name, texture),
        }
    }

    /// A number or a texture of numbers.
    pub(crate) fn float_or(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        name: &str,
        default: f32,
    ) -> FloatSlot {
        self.float(cx, params, name).unwrap_or(FloatSlot::Constant(default))
    }

    /// A spectrum or a texture of spectra, if the parameter is given without fault.
    pub(crate) fn spectrum(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        name: &str,
        role: SpectrumRole,
    ) -> Option<SpectrumSlot> {
        match params.spectrum_or_texture(name)? {
            SpectrumSource::Value(value) => constant(cx, &value, role).map(SpectrumSlot::Constant),
            SpectrumSource::Texture(texture) => self.spectrum_texture(cx, params, name, texture, role),
        }
    }

    /// A spectrum or a texture of spectra; `default` is the same at all wavelengths.
    pub(crate) fn spectrum_or(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        name: &str,
        role: SpectrumRole,
        default: f32,
    ) -> SpectrumSlot {
        self.spectrum(cx, params, name, role).unwrap_or(SpectrumSlot::Constant(Spectrum::Constant(default)))
    }

    fn float_texture(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        parameter: &str,
        texture: Texture<'_>,
    ) -> Option<FloatSlot> {
        let index = self.find(cx, params, parameter, texture, TextureValue::Float)?;
        let state = match self.floats.get(&index) {
            Some(state) => state.clone(),
            None => self.compile_float(cx, index),
        };
        self.finished(cx, texture, state)
    }

    fn spectrum_texture(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        parameter: &str,
        texture: Texture<'_>,
        role: SpectrumRole,
    ) -> Option<SpectrumSlot> {
        let index = self.find(cx, params, parameter, texture, TextureValue::Spectrum)?;
        let state = match self.spectra.get(&(index, role)) {
            Some(state) => state.clone(),
            None => self.compile_spectrum(cx, index, role),
        };
        self.finished(cx, texture, state)
    }

    /// The index of the texture that a parameter names.
    fn find(
        &self,
        cx: &Context<'_>,
        params: &Params<'_>,
        parameter: &str,
        texture: Texture<'_>,
        value: TextureValue,
    ) -> Option<usize> {
        if let Some(index) = self.by_name.get(&(value, texture.name)) {
            return Some(*index);
        }
        let (other, given, wanted) = match value {
            TextureValue::Float => (TextureValue::Spectrum, "spectra", "numbers"),
            TextureValue::Spectrum => (TextureValue::Float, "numbers", "spectra"),
        };
        let diagnostic = if let Some(&index) = self.by_name.get(&(other, texture.name)) {
            let message = format!(
                "parameter \"{parameter}\" of {} wants a texture of {wanted}, but \"{}\" gives {given}",
                params.what(),
                texture.name
            );
            Diagnostic::error(texture.span, message)
                .with_note(self.entities[index].entity.span, "defined here")
        } else {
            let known = self.by_name.keys().filter(|(v, _)| *v == value).map(|(_, name)| *name);
            // The order of a hash map is not to be seen.
            let mut known: Vec<_> = known.collect();
            known.sort_unstable();
            Diagnostic::error(texture.span, format!("unknown texture \"{}\"", texture.name))
                .with_nearest(texture.name, known)
        };
        cx.diagnostics.push(diagnostic);
        None
    }

    fn finished<S>(&self, cx: &Context<'_>, texture: Texture<'_>, state: State<S>) -> Option<S> {
        match state {
            State::Done(slot) => Some(slot),
            State::Begun => {
                cx.diagnostics.error(texture.span, format!("texture \"{}\" refers to itself", texture.name));
                None
            }
            State::Failed => None,
        }
    }

    fn compile_float(&mut self, cx: &mut Context<'_>, index: usize) -> State<FloatSlot> {
        self.floats.insert(index, State::Begun);
        let slot =
            self.nested(cx, index, |library, cx, params, placed| library.new_float(cx, params, placed));
        let state = slot.map_or(State::Failed, State::Done);
        self.floats.insert(index, state.clone());
        state
    }

    fn compile_spectrum(
        &mut self,
        cx: &mut Context<'_>,
        index: usize,
        role: SpectrumRole,
    ) -> State<SpectrumSlot> {
        // What failed in one role would fail, and be reported, in all.
        let failed = self.spectra.iter().any(|((i, _), s)| *i == index && matches!(s, State::Failed));
        self.spectra.insert((index, role), State::Begun);
        let slot = if failed {
            None
        } else {
            self.nested(cx, index, |library, cx, params, placed| {
                library.new_spectrum(cx, params, placed, role)
            })
        };
        let state = slot.map_or(State::Failed, State::Done);
        self.spectra.insert((index, role), state.clone());
        state
    }

    /// Compiles one texture, one level deeper; a fault anywhere in it leaves none.
    fn nested<S>(
        &mut self,
        cx: &mut Context<'_>,
        index: usize,
        compile: impl FnOnce(&mut Self, &mut Context<'_>, &Params<'_>, &Placed<'s>) -> Option<S>,
    ) -> Option<S> {
        let texture = &self.entities[index];
        let params = texture.entity.params("texture", cx.diagnostics);
        if self.depth == DEEPEST {
            let message = format!("textures refer to one another more than {DEEPEST} deep");
            cx.diagnostics.error(params.span(), message);
            return None;
        }
        let errors = cx.diagnostics.count(tenfold_scene::Severity::Error);
        self.depth += 1;
        let slot = compile(self, cx, &params, &Placed { texture });
        self.depth -= 1;
        if slot.is_some() {
            params.finish(&[]);
        }
        slot.filter(|_| cx.diagnostics.count(tenfold_scene::Severity::Error) == errors)
    }

    fn new_float(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        placed: &Placed<'s>,
    ) -> Option<FloatSlot> {
        let mut part = |name: &str, default: f32| self.float_or(cx, params, name, default);
        let texture = match placed.kind() {
            "constant" => return Some(FloatSlot::Constant(params.one_float("value", 1.0))),
            "scale" => {
                let (texture, scale) = (part("tex", 1.0), part("scale", 1.0));
                return Some(self.scaled_float(texture, scale));
            }
            "mix" => {
                let mix =
                    Mix { textures: [part("tex1", 0.0), part("tex2", 1.0)], amount: part("amount", 0.5) };
                match mix.amount {
                    FloatSlot::Constant(0.0) => return Some(mix.textures[0]),
                    FloatSlot::Constant(1.0) => return Some(mix.textures[1]),
                    _ => FloatTexture::Mix(mix),
                }
            }
            "directionmix" => FloatTexture::DirectionMix(DirectionMix {
                textures: [part("tex1", 0.0), part("tex2", 1.0)],
                direction: placed.direction(cx, params)?,
            }),
            "checkerboard" => FloatTexture::Checkerboard(Checkerboard {
                textures: [part("tex1", 1.0), part("tex2", 0.0)],
                board: placed.board(cx, params)?,
            }),
            "dots" => {
                // pbrt-v4 exchanges the two, and scenes are made to look right in it.
                let (inside, outside) = (part("outside", 0.0), part("inside", 1.0));
                FloatTexture::Dots(Dots { mapping: placed.mapping2(cx, params)?, inside, outside })
            }
            "bilerp" => FloatTexture::Bilerp(Bilerp {
                corners: [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)]
                    .map(|(name, default)| params.one_float(name, default)),
                mapping: placed.mapping2(cx, params)?,
            }),
            "imagemap" => FloatTexture::Image(self.image_map(cx, params, placed)?.0),
            "fbm" => FloatTexture::Fbm(Fbm {
                mapping: placed.mapping3(cx),
                octaves: octaves(params),
                omega: params.one_float("roughness", 0.5),
            }),
            "wrinkled" => FloatTexture::Wrinkled(Wrinkled {
                mapping: placed.mapping3(cx),
                octaves: octaves(params),
                omega: params.one_float("roughness", 0.5),
            }),
            "windy" => FloatTexture::Windy(Windy { mapping: placed.mapping3(cx) }),
            _ => return placed.refuse(cx, params),
        };
        Some(FloatSlot::Texture(self.textures.add_float(texture)))
    }

    fn new_spectrum(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        placed: &Placed<'s>,
        role: SpectrumRole,
    ) -> Option<SpectrumSlot> {
        let mut part =
            |cx: &mut Context<'_>, name: &str, default| self.spectrum_or(cx, params, name, role, default);
        let texture = match placed.kind() {
            "constant" => return Some(SpectrumSlot::Constant(one_spectrum(cx, params, "value", role, 1.0)?)),
            "scale" => {
                let texture = part(cx, "tex", 1.0);
                let scale = self.float_or(cx, params, "scale", 1.0);
                return Some(self.scaled_spectrum(texture, scale));
            }
            "mix" => {
                let textures = [part(cx, "tex1", 0.0), part(cx, "tex2", 1.0)];
                match (self.float_or(cx, params, "amount", 0.5), textures) {
                    (FloatSlot::Constant(0.0), [first, _]) => return Some(first),
                    (FloatSlot::Constant(1.0), [_, second]) => return Some(second),
                    (amount, textures) => SpectrumTexture::Mix(Mix { textures, amount }),
                }
            }
            "directionmix" => SpectrumTexture::DirectionMix(DirectionMix {
                textures: [part(cx, "tex1", 0.0), part(cx, "tex2", 1.0)],
                direction: placed.direction(cx, params)?,
            }),
            "checkerboard" => SpectrumTexture::Checkerboard(Checkerboard {
                textures: [part(cx, "tex1", 1.0), part(cx, "tex2", 0.0)],
                board: placed.board(cx, params)?,
            }),
            "dots" => {
                // Exchanged as for numbers.
                let (inside, outside) = (part(cx, "outside", 0.0), part(cx, "inside", 1.0));
                SpectrumTexture::Dots(Dots { mapping: placed.mapping2(cx, params)?, inside, outside })
            }
            "bilerp" => {
                let mut corner = |name: &str, default| one_spectrum(cx, params, name, role, default);
                let corners =
                    [corner("v00", 0.0)?, corner("v01", 1.0)?, corner("v10", 0.0)?, corner("v11", 1.0)?];
                SpectrumTexture::Bilerp(Bilerp { corners, mapping: placed.mapping2(cx, params)? })
            }
            "imagemap" => {
                let (image, color_space) = self.image_map(cx, params, placed)?;
                SpectrumTexture::Image(SpectrumImageMap { image, color_space, role })
            }
            "marble" => {
                let marble = Marble {
                    mapping: placed.mapping3(cx),
                    octaves: octaves(params),
                    omega: params.one_float("roughness", 0.5),
                    scale: params.one_float("scale", 1.0),
                    variation: params.one_float("variation", 0.2),
                };
                // A reflectance whatever it is used for, as in pbrt-v4.
                SpectrumTexture::Marble(marble, SpectrumRole::Albedo)
            }
            _ => return placed.refuse(cx, params),
        };
        Some(SpectrumSlot::Texture(self.textures.add_spectrum(texture)))
    }

    /// A product, made as simple as may be.
    fn scaled_float(&mut self, texture: FloatSlot, scale: FloatSlot) -> FloatSlot {
        match (texture, scale) {
            (FloatSlot::Constant(a), FloatSlot::Constant(b)) => FloatSlot::Constant(a * b),
            (slot, FloatSlot::Constant(1.0)) | (FloatSlot::Constant(1.0), slot) => slot,
            (texture, scale) => {
                let product = FloatTexture::Scale(Scale { texture, scale });
                FloatSlot::Texture(self.textures.add_float(product))
            }
        }
    }

    /// A product, made as simple as may be.
    fn scaled_spectrum(&mut self, texture: SpectrumSlot, scale: FloatSlot) -> SpectrumSlot {
        let product = match (texture, scale) {
            (slot, FloatSlot::Constant(1.0)) => return slot,
            (SpectrumSlot::Constant(Spectrum::Constant(v)), FloatSlot::Constant(s)) => {
                return SpectrumSlot::Constant(Spectrum::Constant(v * s));
            }
            (texture, scale) => match (self.image_of(&texture), scale) {
                // Colours are scaled before they become spectra, as in pbrt-v4; of an inverted image (where
                // pbrt-v4 scales the image before the inversion) the spectra are.
                (Some(image), FloatSlot::Constant(s)) if !image.image.invert => {
                    let mut image = image.clone();
                    image.image.scale *= s;
                    SpectrumTexture::Image(image)
                }
                _ => SpectrumTexture::Scale(Scale { texture, scale }),
            },
        };
        SpectrumSlot::Texture(self.textures.add_spectrum(product))
    }

    fn image_of(&self, slot: &SpectrumSlot) -> Option<&SpectrumImageMap> {
        match slot {
            SpectrumSlot::Texture(id) => match self.textures.spectrum_texture(*id) {
                SpectrumTexture::Image(image) => Some(image),
                _ => None,
            },
            SpectrumSlot::Constant(_) => None,
        }
    }

    fn image_map(
        &mut self,
        cx: &mut Context<'_>,
        params: &Params<'_>,
        placed: &Placed<'s>,
    ) -> Option<(ImageMap, &'static tenfold_spectrum::RgbColorSpace)> {
        let mapping = placed.mapping2(cx, params);
        let max_anisotropy = params.one_float("maxanisotropy", 8.0);
        let filter = one_of(cx, params, "filter", "bilinear", &FILTERS).map(|filter| match filter {
            // The ratio of a longer to a shorter axis.
            TextureFilter::Ewa { .. } => TextureFilter::Ewa { max_anisotropy: max_anisotropy.max(1.0) },
            other => other,
        });
        let wrap = one_of(cx, params, "wrap", "repeat", &WRAPS);
        let encoding = match params.string("encoding") {
            None => Some(None),
            Some(name) => encoding(name).map(Some).or_else(|| {
                let message = format!("unknown encoding \"{name}\"");
                let help = "it can be \"sRGB\", \"linear\" or \"gamma\" with a number, as \"gamma 2.2\"";
                cx.diagnostics.push(Diagnostic::error(params.span_of("encoding"), message).with_help(help));
                None
            }),
        };
        let (scale, invert) = (params.one_float("scale", 1.0), params.one_bool("invert", false));
        let Some(filename) = params.string("filename") else {
            if !params.has("filename") {
                params.missing("filename", ParamType::String);
            }
            return None;
        };
        let (mapping, filter, wrap, encoding) = (mapping?, filter?, wrap?, encoding?);
        let span = params.span_of("filename");
        let image = cx.image(filename, span, encoding)?;
        let color_space = color_space_of(&image.metadata);
        let key = (cx.resources.identity(filename), format!("{encoding:?} {wrap:?}"));
        let pyramid = match self.pyramids.get(&key) {
            Some(known) => known.clone(),
            None => {
                let built = image.as_ref().clone().into_texture().and_then(|i| Pyramid::build(i, wrap));
                let built = built.map_err(|e| cx.diagnostics.error(span, format!("\"{filename}\": {e}")));
                let built = built.ok().map(Arc::new);
                self.pyramids.insert(key, built.clone());
                built
            }
        };
        Some((ImageMap { mapping, pyramid: pyramid?, filter, scale, invert }, color_space))
    }
}

/// A texture's description, and where its space lies.
struct Placed<'s> {
    texture: &'s TextureEntity,
}

impl Placed<'_> {
    fn kind(&self) -> &str {
        &self.texture.entity.kind
    }

    /// From texture space to the world.
    fn transform(&self, cx: &Context<'_>) -> &Transform {
        if self.texture.motion.is_moving() {
            let message = "textures do not move of their own: the transform of the first time counts";
            cx.diagnostics.warning(self.texture.entity.kind_span, message);
        }
        self.texture.motion.start()
    }

    fn mapping3(&self, cx: &Context<'_>) -> Mapping3 {
        Mapping3::new(self.transform(cx))
    }

    fn mapping2(&self, cx: &Context<'_>, params: &Params<'_>) -> Option<Mapping2> {
        let pair =
            |a: &str, b: &str, default| Vec2::new(params.one_float(a, default), params.one_float(b, default));
        let to_texture = || *self.transform(cx).inverse_affine();
        match params.one_string("mapping", "uv") {
            "uv" => Some(Mapping2::Uv {
                scale: pair("uscale", "vscale", 1.0),
                delta: pair("udelta", "vdelta", 0.0),
            }),
            "spherical" => Some(Mapping2::Spherical { to_texture: to_texture() }),
            "cylindrical" => Some(Mapping2::Cylindrical { to_texture: to_texture() }),
            "planar" => Some(Mapping2::Planar {
                to_texture: to_texture(),
                vs: params.one_vector3("v1", Vec3::X),
                vt: params.one_vector3("v2", Vec3::Y),
                delta: pair("udelta", "vdelta", 0.0),
            }),
            name => {
                let diagnostic =
                    Diagnostic::error(params.span_of("mapping"), format!("unknown mapping \"{name}\""));
                let known = ["uv", "spherical", "cylindrical", "planar"];
                cx.diagnostics.push(diagnostic.with_nearest(name, known));
                None
            }
        }
    }

    fn board(&self, cx: &Context<'_>, params: &Params<'_>) -> Option<Board> {
        match params.one_int("dimension", 2) {
            2 => self.mapping2(cx, params).map(Board::Squares),
            3 => Some(Board::Cubes(self.mapping3(cx))),
            n => {
                params.error("dimension", format!("a checkerboard has 2 or 3 dimensions, not {n}"));
                None
            }
        }
    }

    /// The direction of a mix by direction, in the world.
    fn direction(&self, cx: &Context<'_>, params: &Params<'_>) -> Option<Vec3> {
        let direction = self.transform(cx).vector(params.one_vector3("dir", Vec3::Y)).try_normalize();
        if direction.is_none() {
            params.error("dir", "the direction of a mix has no length");
        }
        direction
    }

    /// Reports that there is no texture of this type.
    fn refuse<S>(&self, cx: &Context<'_>, params: &Params<'_>) -> Option<S> {
        let kind = self.kind();
        if kind == "ptex" {
            cx.unsupported(params.span(), "texture \"ptex\"");
        } else if KINDS.contains(&kind) {
            let (gives, want) = match self.texture.value {
                TextureValue::Float => ("spectra", "numbers"),
                TextureValue::Spectrum => ("numbers", "spectra"),
            };
            let message = format!("textures of type \"{kind}\" give {gives}, not {want}");
            cx.diagnostics.error(params.span(), message);
        } else {
            cx.unknown_kind(params.span(), "texture", kind, KINDS);
        }
        None
    }
}

const FILTERS: [(&str, TextureFilter); 4] = [
    ("point", TextureFilter::Point),
    ("bilinear", TextureFilter::Bilinear),
    ("trilinear", TextureFilter::Trilinear),
    ("ewa", TextureFilter::Ewa { max_anisotropy: 8.0 }),
];

const WRAPS: [(&str, WrapMode); 4] = [
    ("repeat", WrapMode::Repeat),
    ("black", WrapMode::Black),
    ("clamp", WrapMode::Clamp),
    ("octahedralsphere", WrapMode::OctahedralSphere),
];

/// The value that a string parameter names; letters' case aside.
fn one_of<T: Copy>(
    cx: &Context<'_>,
    params: &Params<'_>,
    name: &str,
    default: &str,
    values: &[(&str, T)],
) -> Option<T> {
    let given = params.string(name).unwrap_or(default);
    let found = values.iter().find(|(known, _)| known.eq_ignore_ascii_case(given));
    if found.is_none() {
        let known: Vec<_> = values.iter().map(|(known, _)| *known).collect();
        let diagnostic = Diagnostic::error(params.span_of(name), format!("unknown {name} \"{given}\""));
        cx.diagnostics.push(match nearest(given, known.iter().copied()) {
            Some(near) => diagnostic.with_help(format!("did you mean \"{near}\"?")),
            None => diagnostic.with_help(format!("it can be {}", known.join(", "))),
        });
    }
    found.map(|(_, value)| *value)
}

/// The encoding of a scene file's name for it.
fn encoding(name: &str) -> Option<ColorEncoding> {
    let mut words = name.split_whitespace();
    let encoding = match words.next()?.to_ascii_lowercase().as_str() {
        "srgb" => ColorEncoding::Srgb,
        "linear" => ColorEncoding::Linear,
        "gamma" => {
            let gamma: f32 = words.next()?.parse().ok()?;
            (gamma.is_finite() && gamma > 0.0).then_some(ColorEncoding::Gamma(gamma))?
        }
        _ => return None,
    };
    words.next().is_none().then_some(encoding)
}

fn octaves(params: &Params<'_>) -> u32 {
    // More than these are finer than the floats they are made of.
    const MOST: i32 = 64;
    let octaves = params.one_int("octaves", 8);
    if !(0..=MOST).contains(&octaves) {
        params.error("octaves", format!("the number of octaves must be between 0 and {MOST}"));
    }
    octaves.clamp(0, MOST) as u32
}

/// A spectrum that cannot be a texture.
fn one_spectrum(
    cx: &mut Context<'_>,
    params: &Params<'_>,
    name: &str,
    role: SpectrumRole,
    default: f32,
) -> Option<Spectrum> {
    match params.spectrum(name) {
        Some(value) => constant(cx, &value, role),
        None => Some(Spectrum::Constant(default)),
    }
}

/// The spectrum of a parameter's value.
fn constant(
    cx: &mut Context<'_>,
    value: &tenfold_scene::Spectrum<'_>,
    role: SpectrumRole,
) -> Option<Spectrum> {
    let spectrum = cx.spectrum(value, role)?;
    let is_rgb = matches!(value.value, SpectrumValue::Rgb(_));
    if role == SpectrumRole::Albedo && !is_rgb && spectrum.max_value() > 1.0 {
        let message = "a reflectance lies between 0 and 1: larger values are taken as 1";
        cx.diagnostics.warning(value.span, message);
    }
    Some(quick(spectrum))
}

/// The same spectrum in the form that is sampled fastest: long tables of irregular wavelengths on whole nanometres.
pub(crate) fn quick(spectrum: Spectrum) -> Spectrum {
    let Spectrum::PiecewiseLinear(s) = &spectrum else { return spectrum };
    let points = s.points();
    let covers = points[0][0] <= LAMBDA_MIN && points[points.len() - 1][0] >= LAMBDA_MAX;
    // Features finer than that would be lost, and short tables are searched in no time.
    let is_smooth = points.windows(2).all(|p| p[1][0] - p[0][0] >= 2.0);
    if !covers || !is_smooth || points.len() < 8 {
        return spectrum;
    }
    let whole = (LAMBDA_MIN as u16..=LAMBDA_MAX as u16).map(f32::from).map(|l| [l, s.eval(l)]).collect();
    PiecewiseLinear::from_points(whole).map_or(spectrum, Spectrum::PiecewiseLinear)
}

#[cfg(test)]
mod tests;
