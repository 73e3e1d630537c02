//! The directives: one by one, what follows each word and what it does.

use super::{Parser, Reported, Token, TokenKind, build::Given, number::parse_float, state::AttributeTarget};
use crate::{ColorSpace, Diagnostic, OptionSetting, OptionValue, Span, TextureValue, nearest};

/// All directives.
const DIRECTIVES: [&str; 41] = [
    "Accelerator",
    "ActiveTransform",
    "AreaLightSource",
    "Attribute",
    "AttributeBegin",
    "AttributeEnd",
    "Camera",
    "ColorSpace",
    "ConcatTransform",
    "CoordSysTransform",
    "CoordinateSystem",
    "Film",
    "Identity",
    "Import",
    "Include",
    "Integrator",
    "LightSource",
    "LookAt",
    "MakeNamedMaterial",
    "MakeNamedMedium",
    "Material",
    "MediumInterface",
    "NamedMaterial",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Option",
    "PixelFilter",
    "ReverseOrientation",
    "Rotate",
    "Sampler",
    "Scale",
    "Shape",
    "Texture",
    "Transform",
    "TransformBegin",
    "TransformEnd",
    "TransformTimes",
    "Translate",
    "WorldBegin",
    "WorldEnd",
];

/// Whether a word is a directive.
pub(super) fn is_directive(word: &str) -> bool {
    DIRECTIVES.binary_search(&word).is_ok()
}

/// What the value of an option is.
#[derive(Copy, Clone)]
enum OptionType {
    Bool,
    Number,
    String,
}

/// The options of pbrt-v4, spelt without `-` and `_`.
const OPTIONS: [(&str, OptionType); 11] = [
    ("disablepixeljitter", OptionType::Bool),
    ("disabletexturefiltering", OptionType::Bool),
    ("disablewavelengthjitter", OptionType::Bool),
    ("displacementedgescale", OptionType::Number),
    ("forcediffuse", OptionType::Bool),
    ("msereferenceimage", OptionType::String),
    ("msereferenceout", OptionType::String),
    ("pixelstats", OptionType::Bool),
    ("rendercoordsys", OptionType::String),
    ("seed", OptionType::Number),
    ("wavefront", OptionType::Bool),
];

impl Parser<'_> {
    /// Reads all directives of the current stream.
    pub(super) fn directives(&mut self) {
        while let Some(token) = self.next() {
            if token.kind != TokenKind::Word || !is_directive(&token.text) {
                self.not_a_directive(&token);
                self.skip_to_directive();
            } else if self.directive(&token).is_err() {
                self.skip_to_directive();
            }
        }
    }

    fn not_a_directive(&mut self, token: &Token) {
        if token.broken {
            return;
        }
        let error = if token.kind == TokenKind::Word && parse_float(&token.text).is_err() {
            let error = Diagnostic::error(token.span, format!("unknown directive {}", token.shown()));
            error.with_nearest(&token.text, DIRECTIVES)
        } else {
            Diagnostic::error(token.span, format!("expected a directive, found {}", token.shown()))
        };
        self.diagnostics.push(error);
    }

    fn directive(&mut self, token: &Token) -> Result<(), Reported> {
        let span = token.span;
        let name = token.text.as_str();
        match name {
            "Include" => self.include(token)?,
            "Import" => self.import(token)?,
            "Option" => self.option(token)?,
            "WorldBegin" => self.builder.world_begin(span),
            "WorldEnd" => {
                let error = Diagnostic::error(span, "pbrt-v4 has no WorldEnd");
                self.diagnostics.push(error.with_help("the world ends with the file: remove it"));
            }

            "Film" => self.options_entity(token, |d| &mut d.film)?,
            "Sampler" => self.options_entity(token, |d| &mut d.sampler)?,
            "Integrator" => self.options_entity(token, |d| &mut d.integrator)?,
            "PixelFilter" => self.options_entity(token, |d| &mut d.filter)?,
            "Accelerator" => self.options_entity(token, |d| &mut d.accelerator)?,
            "Camera" => {
                let given = self.given(token)?;
                self.builder.camera(given);
            }

            "Identity" | "Translate" | "Scale" | "Rotate" | "LookAt" | "Transform" | "ConcatTransform" => {
                self.transform(token)?;
            }
            "ActiveTransform" => self.active_transform(token)?,
            "TransformTimes" => self.transform_times(token)?,
            "CoordinateSystem" => {
                let system = self.string("a name", token)?;
                self.builder.name_coordinate_system(system.text);
            }
            "CoordSysTransform" => {
                let system = self.string("the name of a coordinate system", token)?;
                self.builder.use_coordinate_system(&system.text, system.span);
            }

            "ColorSpace" => self.color_space(token)?,
            "Attribute" => self.attribute(token)?,
            "MediumInterface" => self.medium_interface(token)?,
            "MakeNamedMedium" => {
                let given = self.given(token)?;
                self.builder.make_named_medium(given);
            }
            _ => {
                self.builder.check_world(name, span);
                self.world_directive(token)?;
            }
        }
        Ok(())
    }

    /// The directives that are allowed after `WorldBegin` only.
    fn world_directive(&mut self, token: &Token) -> Result<(), Reported> {
        let span = token.span;
        match token.text.as_str() {
            "AttributeBegin" => self.builder.attribute_begin(span),
            "AttributeEnd" => self.builder.attribute_end("AttributeEnd", span),
            "TransformBegin" => {
                if !std::mem::replace(&mut self.warned_of_transform_begin, true) {
                    let message =
                        "TransformBegin and TransformEnd do the same as AttributeBegin and AttributeEnd";
                    let warning = Diagnostic::warning(span, message);
                    self.diagnostics.push(warning.with_help("pbrt-v4 deprecates them: write the latter"));
                }
                self.builder.attribute_begin(span);
            }
            "TransformEnd" => self.builder.attribute_end("TransformEnd", span),
            "ReverseOrientation" => {
                self.builder.state.reverse_orientation = !self.builder.state.reverse_orientation;
            }
            "ObjectBegin" => {
                let object = self.string("a name", token)?;
                self.builder.object_begin(object.text, object.span, span.to(object.span));
            }
            "ObjectEnd" => self.builder.object_end(span),
            "ObjectInstance" => {
                let object = self.string("the name of an object", token)?;
                self.builder.object_instance(&object.text, object.span, span.to(object.span));
            }
            "Shape" => {
                let given = self.given(token)?;
                self.builder.shape(given);
            }
            "LightSource" => {
                let given = self.given(token)?;
                self.builder.light(given);
            }
            "AreaLightSource" => {
                let given = self.given(token)?;
                self.builder.area_light(given);
            }
            "Material" => {
                let given = self.given(token)?;
                self.builder.material(given);
            }
            "MakeNamedMaterial" => {
                let given = self.given(token)?;
                self.builder.make_named_material(given);
            }
            "NamedMaterial" => {
                let material = self.string("the name of a material", token)?;
                self.builder.named_material(&material.text, material.span);
            }
            "Texture" => self.texture(token)?,
            // `DIRECTIVES` and the two matches name the same words; a test holds them together.
            _ => self.not_a_directive(token),
        }
        Ok(())
    }

    /// The name of a type, or a name, and parameters.
    fn given(&mut self, directive: &Token) -> Result<Given, Reported> {
        let kind = self.string("a name", directive)?;
        let params = self.parameters(kind.span);
        let span = directive.span.to(kind.span).to(params.span);
        Ok(Given { span, kind: kind.text, kind_span: kind.span, params })
    }

    fn options_entity(
        &mut self,
        directive: &Token,
        place: fn(&mut crate::Description) -> &mut Option<crate::Entity>,
    ) -> Result<(), Reported> {
        let given = self.given(directive)?;
        self.builder.set(&directive.text, given, place);
        Ok(())
    }

    fn color_space(&mut self, directive: &Token) -> Result<(), Reported> {
        let name = self.string("the name of a colour space", directive)?;
        match ColorSpace::from_name(&name.text) {
            Some(space) => self.builder.state.color_space = space,
            None => {
                let error = Diagnostic::error(name.span, format!("unknown colour space \"{}\"", name.text));
                let names = ColorSpace::ALL.map(ColorSpace::name);
                self.diagnostics.push(match nearest(&name.text, names) {
                    Some(_) => error.with_nearest(&name.text, names),
                    None => error.with_help(format!("the known ones are {}", names.join(", "))),
                });
            }
        }
        Ok(())
    }

    fn attribute(&mut self, directive: &Token) -> Result<(), Reported> {
        let target = self.string("a family of entities", directive)?;
        let params = self.parameters(target.span);
        match AttributeTarget::NAMES.iter().find(|(name, _)| *name == target.text) {
            Some((_, family)) => self.builder.attribute(*family, params),
            None => {
                let names = AttributeTarget::NAMES.map(|(name, _)| name);
                let message = format!(
                    "unknown target \"{}\" of Attribute: it is one of {}",
                    target.text,
                    names.join(", ")
                );
                self.diagnostics
                    .push(Diagnostic::error(target.span, message).with_nearest(&target.text, names));
            }
        }
        Ok(())
    }

    fn medium_interface(&mut self, directive: &Token) -> Result<(), Reported> {
        let inside = self.string("the name of a medium", directive)?;
        let outside = match self.next() {
            Some(token) if token.kind == TokenKind::String => token,
            Some(token) => {
                self.stream.hold(token);
                inside.clone()
            }
            None => inside.clone(),
        };
        self.builder.medium_interface((&inside.text, inside.span), (&outside.text, outside.span));
        Ok(())
    }

    fn texture(&mut self, directive: &Token) -> Result<(), Reported> {
        let name = self.string("a name", directive)?;
        let value = self.string("the type of its value", directive)?;
        let given = self.given(directive)?;
        let value = match value.text.as_str() {
            "float" => TextureValue::Float,
            "spectrum" => TextureValue::Spectrum,
            other => {
                let message = format!("textures give \"float\" or \"spectrum\", not \"{other}\"");
                let error = Diagnostic::error(value.span, message);
                self.diagnostics.push(match other {
                    "color" | "rgb" => error.with_help("pbrt-v4 writes \"spectrum\""),
                    _ => error.with_nearest(other, ["float", "spectrum"]),
                });
                return Ok(());
            }
        };
        self.builder.texture(name.text, name.span, value, given);
        Ok(())
    }

    fn option(&mut self, directive: &Token) -> Result<(), Reported> {
        let name = self.string("the name of an option", directive)?;
        let given = self.required("a value", directive)?;
        let span: Span = directive.span.to(given.span);
        let normal: String =
            name.text.chars().filter(|c| !matches!(c, '-' | '_')).flat_map(char::to_lowercase).collect();
        let Some((_, ty)) = OPTIONS.iter().find(|(known, _)| *known == normal) else {
            let error = Diagnostic::error(name.span, format!("unknown option \"{}\"", name.text));
            self.diagnostics.push(error.with_nearest(&normal, OPTIONS.map(|(known, _)| known)));
            return Ok(());
        };
        let quoted = given.kind == TokenKind::String;
        let (value, expected) = match ty {
            OptionType::Bool => (
                given.text.parse().ok().filter(|_| !quoted).map(OptionValue::Bool),
                "true or false, without quotes",
            ),
            OptionType::Number => {
                let number = parse_float(&given.text).is_ok() && !quoted;
                (given.text.parse().ok().filter(|_| number).map(OptionValue::Number), "a number")
            }
            OptionType::String => {
                (quoted.then(|| OptionValue::String(given.text.clone())), "a quoted string")
            }
        };
        match value {
            Some(value) => self.builder.description.options.push(OptionSetting { name: normal, value, span }),
            None => {
                let message = format!("option \"{}\" needs {expected}, found {}", name.text, given.shown());
                return self.fail(given.span, message);
            }
        }
        Ok(())
    }
}
