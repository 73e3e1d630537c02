//! Lists of parameters.

use super::{
    Parser, Reported,
    directives::is_directive,
    number::{NumberFault, parse_float, parse_integer},
    stream::{Token, TokenKind},
};
use crate::{Diagnostic, Param, ParamSet, ParamType, ParamValues, Span};
use std::sync::Arc;

/// Spellings of other versions and programs, and what pbrt-v4 says instead.
const OLD_TYPES: [(&str, &str); 12] = [
    ("color", "rgb"),
    ("colour", "rgb"),
    ("point", "point3"),
    ("vector", "vector3"),
    ("normal3", "normal"),
    ("int", "integer"),
    ("boolean", "bool"),
    ("double", "float"),
    ("number", "float"),
    ("xyz", "rgb"),
    ("color3", "rgb"),
    ("str", "string"),
];

impl Parser<'_> {
    /// Reads parameters up to the first token that does not begin one.
    ///
    /// A fault in one of them is reported, and the others are read nevertheless where their beginnings can be made out.
    pub(super) fn parameters(&mut self, after: Span) -> ParamSet {
        let mut params: Vec<Param> = Vec::new();
        while let Some(token) = self.next() {
            if token.kind != TokenKind::String {
                self.stream.hold(token);
                break;
            }
            match self.parameter(&token) {
                Ok(Some(param)) => params.push(param),
                Ok(None) => {}
                Err(Reported) => {
                    self.skip_to_directive();
                    break;
                }
            }
        }
        let span = match (params.first(), params.last()) {
            (Some(first), Some(last)) => first.span.to(last.value_span),
            _ => Span { start: after.end, ..after },
        };
        ParamSet { span, params, defaults: Arc::default() }
    }

    /// Reads one parameter after its declaration; none where the declaration is faulty but the values can be skipped.
    fn parameter(&mut self, declaration: &Token) -> Result<Option<Param>, Reported> {
        let span = declaration.span;
        if declaration.broken {
            return Err(Reported);
        }
        let mut words = declaration.text.split([' ', '\t']).filter(|word| !word.is_empty());
        let (ty_name, name) = match (words.next(), words.next()) {
            (Some(ty), Some(name)) => (ty, name),
            (only, _) => {
                let error = Diagnostic::error(span, "a parameter's declaration needs a type and a name");
                self.diagnostics
                    .push(error.with_help(format!("as in \"float {}\"", only.unwrap_or("radius"))));
                return Err(Reported);
            }
        };
        if let Some(extra) = words.next() {
            let message = format!("`{extra}` after the name of a parameter means nothing");
            self.diagnostics.warning(span, message);
        }
        let ty = ParamType::from_name(ty_name);
        if ty.is_none() {
            let error = Diagnostic::error(span, format!("unknown parameter type \"{ty_name}\""));
            self.diagnostics.push(match OLD_TYPES.iter().find(|(old, _)| *old == ty_name) {
                Some((_, new)) => error.with_help(format!("pbrt-v4 writes \"{new} {name}\"")),
                None => error.with_nearest(ty_name, ParamType::ALL.map(ParamType::name)),
            });
        }
        let (values, value_span) = self.values(ty, declaration, name)?;
        let (Some(ty), Some(values)) = (ty, values) else { return Ok(None) };
        Ok(Some(Param { name: name.to_owned(), ty, values, span, value_span, color_space: None }))
    }

    /// Reads the values of a parameter, in brackets or a single one without; none where a fault was reported.
    fn values(
        &mut self,
        ty: Option<ParamType>,
        declaration: &Token,
        name: &str,
    ) -> Result<(Option<ParamValues>, Span), Reported> {
        let mut values = Values::new(ty);
        let Some(first) = self.next() else {
            return self.fail(declaration.span, format!("the file ends before the value of \"{name}\""));
        };
        if first.kind != TokenKind::Open {
            let missing = first.kind == TokenKind::Close
                || (first.kind == TokenKind::Word && is_directive(&first.text))
                || (!values.takes_strings() && is_declaration(&first));
            if missing {
                self.diagnostics.error(declaration.span, format!("parameter \"{name}\" has no value"));
                self.stream.hold(first);
                return Ok((None, declaration.span));
            }
            self.value(&mut values, &first, name);
            return Ok((values.finish(), first.span));
        }
        loop {
            match &mut values {
                Values::Floats(v) => self.stream.take_floats(v),
                Values::Integers(v) => self.stream.take_integers(v),
                _ => {}
            }
            let Some(token) = self.next() else {
                let message = format!("the file ends inside the list of values of \"{name}\"");
                return self.fail(first.span, message);
            };
            let ends_early = match token.kind {
                TokenKind::Close => return Ok((values.finish(), first.span.to(token.span))),
                TokenKind::Open => {
                    return self.fail(token.span, format!("`[` inside the values of \"{name}\""));
                }
                TokenKind::Word => is_directive(&token.text),
                TokenKind::String => !values.takes_strings() && is_declaration(&token),
            };
            if ends_early {
                let error =
                    Diagnostic::error(first.span, format!("the values of \"{name}\" have no closing `]`"))
                        .with_note(token.span, "they end before this at the latest");
                self.diagnostics.push(error);
                self.stream.hold(token);
                return Ok((None, first.span));
            }
            self.value(&mut values, &token, name);
        }
    }

    /// Adds a value; a faulty one is reported, the first of a parameter only, and all further ones are skipped.
    fn value(&mut self, values: &mut Values, token: &Token, name: &str) {
        if token.broken {
            *values = Values::Skipped;
        }
        if let Err(expected) = values.add(token) {
            let error = Diagnostic::error(
                token.span,
                format!("expected {expected} for parameter \"{name}\", found {}", token.shown()),
            );
            let whole = parse_float(&token.text).ok().filter(|v| v.fract() == 0.0 && v.abs() < 1e9);
            self.diagnostics.push(match (&*values, whole) {
                (Values::Integers(_), Some(v)) => error.with_help(format!("write {v}")),
                _ => error,
            });
            *values = Values::Skipped;
        } else if matches!(values, Values::Bools(_)) && token.kind == TokenKind::String {
            let message = format!("the value of \"{name}\" is quoted; pbrt-v4 writes {} alone", token.text);
            self.diagnostics.warning(token.span, message);
        }
    }
}

/// Whether a string looks like the declaration of a parameter.
fn is_declaration(token: &Token) -> bool {
    token.kind == TokenKind::String
        && token.text.split_once([' ', '\t']).is_some_and(|(ty, _)| {
            ParamType::from_name(ty).is_some() || OLD_TYPES.iter().any(|(old, _)| *old == ty)
        })
}

/// Values as they come in.
enum Values {
    Floats(Vec<f32>),
    Integers(Vec<i32>),
    Bools(Vec<bool>),
    Strings(Vec<String>),
    /// Of a `spectrum`: the first one decides.
    FloatsOrStrings,
    /// A fault was reported.
    Skipped,
}

impl Values {
    fn new(ty: Option<ParamType>) -> Self {
        match ty {
            None => Self::Skipped,
            Some(ParamType::Bool) => Self::Bools(Vec::new()),
            Some(ParamType::Integer) => Self::Integers(Vec::new()),
            Some(ParamType::String | ParamType::Texture) => Self::Strings(Vec::new()),
            Some(ParamType::Spectrum) => Self::FloatsOrStrings,
            Some(_) => Self::Floats(Vec::new()),
        }
    }

    fn takes_strings(&self) -> bool {
        matches!(self, Self::Strings(_) | Self::FloatsOrStrings)
    }

    /// Adds a value, or says what had to be one.
    fn add(&mut self, token: &Token) -> Result<(), &'static str> {
        if let Self::FloatsOrStrings = self {
            *self = match token.kind {
                TokenKind::String => Self::Strings(Vec::new()),
                _ if parse_float(&token.text) == Err(NumberFault::NotANumber) => {
                    return Err("a quoted name or a number");
                }
                _ => Self::Floats(Vec::new()),
            };
        }
        let is_string = token.kind == TokenKind::String;
        match self {
            Self::Floats(v) => {
                let value = if is_string { Err(NumberFault::NotANumber) } else { parse_float(&token.text) };
                v.push(value.map_err(|fault| match fault {
                    NumberFault::OutOfRange => "a number below 3.4e38",
                    _ => "a number",
                })?);
            }
            Self::Integers(v) => {
                let value = if is_string { Err(NumberFault::NotANumber) } else { parse_integer(&token.text) };
                v.push(value.map_err(|fault| match fault {
                    NumberFault::OutOfRange => "an integer of 32 bits",
                    _ => "an integer",
                })?);
            }
            Self::Bools(v) => v.push(match token.text.as_str() {
                "true" => true,
                "false" => false,
                _ => return Err("true or false"),
            }),
            Self::Strings(v) if is_string => v.push(token.text.clone()),
            Self::Strings(_) => return Err("a quoted string"),
            Self::FloatsOrStrings | Self::Skipped => {}
        }
        Ok(())
    }

    fn finish(self) -> Option<ParamValues> {
        Some(match self {
            Self::Floats(mut v) => {
                v.shrink_to_fit();
                ParamValues::Floats(v)
            }
            Self::Integers(mut v) => {
                v.shrink_to_fit();
                ParamValues::Integers(v)
            }
            Self::Bools(v) => ParamValues::Bools(v),
            Self::Strings(v) => ParamValues::Strings(v),
            Self::FloatsOrStrings => ParamValues::Floats(Vec::new()),
            Self::Skipped => return None,
        })
    }
}
