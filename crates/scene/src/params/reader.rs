use super::{Param, ParamSet, ParamType, ParamValues};
use crate::{ColorSpace, Diagnostic, Diagnostics, Span};
use std::cell::{Cell, RefCell};
use tenfold_math::{Vec2, Vec3};

/// Typed access to the parameters of one entity.
///
/// A lookup that finds its name with another type or a wrong number of values reports that, with the place, and
/// answers as if nothing had been given. Where a parameter may have several types, ask [`Params::ty`] first, or
/// use [`Params::float_or_texture`] and [`Params::spectrum_or_texture`]. At the end [`Params::finish`] reports what
/// nobody asked for.
#[derive(Debug)]
pub struct Params<'a> {
    set: &'a ParamSet,
    what: String,
    span: Span,
    color_space: ColorSpace,
    diagnostics: &'a Diagnostics,
    /// For every parameter, first the own and then the defaults: whether it was asked for.
    used: Vec<Cell<bool>>,
    asked: RefCell<Vec<String>>,
}

/// A spectrum parameter.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Spectrum<'a> {
    /// The value.
    pub value: SpectrumValue<'a>,
    /// The colour space, for [`SpectrumValue::Rgb`].
    pub color_space: ColorSpace,
    /// Where it stands.
    pub span: Span,
}

/// The value of a spectrum parameter.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SpectrumValue<'a> {
    /// Components in a colour space; not negative.
    Rgb([f32; 3]),
    /// A temperature in kelvin; positive.
    Blackbody(f32),
    /// The name of a known spectrum or, if none has it, of a file.
    Named(&'a str),
    /// Pairs of a wavelength in nm and a value; the wavelengths increase strictly.
    Samples(&'a [[f32; 2]]),
}

/// A reference to a texture.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Texture<'a> {
    /// The name of the texture.
    pub name: &'a str,
    /// Where it stands.
    pub span: Span,
}

/// A number, or the texture that gives it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum FloatSource<'a> {
    /// A number.
    Value(f32),
    /// A texture.
    Texture(Texture<'a>),
}

/// A spectrum, or the texture that gives it.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SpectrumSource<'a> {
    /// A spectrum.
    Value(Spectrum<'a>),
    /// A texture.
    Texture(Texture<'a>),
}

impl<'a> Params<'a> {
    /// A reader for the parameters of `what` (as `shape "sphere"`), which stands at `span`.
    pub fn new(
        set: &'a ParamSet,
        what: impl Into<String>,
        span: Span,
        color_space: ColorSpace,
        diagnostics: &'a Diagnostics,
    ) -> Self {
        let used = vec![Cell::new(false); set.params.len() + set.defaults.len()];
        Self { set, what: what.into(), span, color_space, diagnostics, used, asked: RefCell::default() }
    }

    /// The parameters.
    pub fn set(&self) -> &'a ParamSet {
        self.set
    }

    /// Where the findings go.
    pub fn diagnostics(&self) -> &'a Diagnostics {
        self.diagnostics
    }

    /// What has these parameters, as `shape "sphere"`.
    pub fn what(&self) -> &str {
        &self.what
    }

    /// Where the name of the entity's type stands.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Where the value of a parameter stands, or else the entity's type: the place for a complaint about it.
    pub fn span_of(&self, name: &str) -> Span {
        self.set.get(name).map_or(self.span, |p| p.value_span)
    }

    /// The parameter that counts for a name, of whatever type. It counts as asked for.
    pub fn find(&self, name: &str) -> Option<&'a Param> {
        if !self.asked.borrow().iter().any(|n| n == name) {
            self.asked.borrow_mut().push(name.to_owned());
        }
        // What is shadowed by another parameter of the name is no fault: an attribute's default may well be.
        let all = self.set.params.iter().chain(self.set.defaults.iter());
        for (param, used) in all.zip(&self.used) {
            used.set(used.get() || param.name == name);
        }
        self.set.get(name)
    }

    /// The type of a parameter, if it is given. It does not count as asked for.
    pub fn ty(&self, name: &str) -> Option<ParamType> {
        self.set.get(name).map(|p| p.ty)
    }

    /// Whether a parameter is given. It does not count as asked for.
    pub fn has(&self, name: &str) -> bool {
        self.set.get(name).is_some()
    }

    /// A float, if given.
    pub fn float(&self, name: &str) -> Option<f32> {
        self.one(name, &[ParamType::Float], floats).map(|v| v[0])
    }

    /// An integer, if given.
    pub fn int(&self, name: &str) -> Option<i32> {
        self.one(name, &[ParamType::Integer], integers).map(|v| v[0])
    }

    /// A string, if given.
    pub fn string(&self, name: &str) -> Option<&'a str> {
        self.one(name, &[ParamType::String], strings).map(|v| v[0].as_str())
    }

    /// A float.
    pub fn one_float(&self, name: &str, default: f32) -> f32 {
        self.float(name).unwrap_or(default)
    }

    /// An integer.
    pub fn one_int(&self, name: &str, default: i32) -> i32 {
        self.int(name).unwrap_or(default)
    }

    /// A truth value.
    pub fn one_bool(&self, name: &str, default: bool) -> bool {
        self.one(name, &[ParamType::Bool], bools).map_or(default, |v| v[0])
    }

    /// A string.
    pub fn one_string(&self, name: &str, default: &'a str) -> &'a str {
        self.string(name).unwrap_or(default)
    }

    /// A point of the plane.
    pub fn one_point2(&self, name: &str, default: Vec2) -> Vec2 {
        self.one(name, &[ParamType::Point2], floats).map_or(default, Vec2::from_slice)
    }

    /// A vector of the plane.
    pub fn one_vector2(&self, name: &str, default: Vec2) -> Vec2 {
        self.one(name, &[ParamType::Vector2], floats).map_or(default, Vec2::from_slice)
    }

    /// A point of space.
    pub fn one_point3(&self, name: &str, default: Vec3) -> Vec3 {
        self.one(name, &[ParamType::Point3], floats).map_or(default, Vec3::from_slice)
    }

    /// A vector of space.
    pub fn one_vector3(&self, name: &str, default: Vec3) -> Vec3 {
        self.one(name, &[ParamType::Vector3], floats).map_or(default, Vec3::from_slice)
    }

    /// A normal.
    pub fn one_normal(&self, name: &str, default: Vec3) -> Vec3 {
        self.one(name, &[ParamType::Normal], floats).map_or(default, Vec3::from_slice)
    }

    /// One colour; its components may be negative.
    pub fn one_rgb(&self, name: &str) -> Option<[f32; 3]> {
        self.one(name, &[ParamType::Rgb], floats).map(|v| [v[0], v[1], v[2]])
    }

    /// Floats; none where the parameter is absent.
    pub fn floats(&self, name: &str) -> &'a [f32] {
        self.many(name, ParamType::Float, floats)
    }

    /// Integers.
    pub fn ints(&self, name: &str) -> &'a [i32] {
        self.many(name, ParamType::Integer, integers)
    }

    /// Truth values.
    pub fn bools(&self, name: &str) -> &'a [bool] {
        self.many(name, ParamType::Bool, bools)
    }

    /// Strings.
    pub fn strings(&self, name: &str) -> &'a [String] {
        self.many(name, ParamType::String, strings)
    }

    /// Points of the plane.
    pub fn point2s(&self, name: &str) -> &'a [Vec2] {
        bytemuck::cast_slice(self.many(name, ParamType::Point2, floats))
    }

    /// Points of space.
    pub fn point3s(&self, name: &str) -> &'a [Vec3] {
        bytemuck::cast_slice(self.many(name, ParamType::Point3, floats))
    }

    /// Vectors of space.
    pub fn vector3s(&self, name: &str) -> &'a [Vec3] {
        bytemuck::cast_slice(self.many(name, ParamType::Vector3, floats))
    }

    /// Normals.
    pub fn normals(&self, name: &str) -> &'a [Vec3] {
        bytemuck::cast_slice(self.many(name, ParamType::Normal, floats))
    }

    /// Colours; their components may be negative.
    pub fn rgbs(&self, name: &str) -> &'a [[f32; 3]] {
        bytemuck::cast_slice(self.many(name, ParamType::Rgb, floats))
    }

    /// The texture of a parameter that is given as `texture`; none, and no complaint, where it is given as
    /// something else.
    pub fn texture(&self, name: &str) -> Option<Texture<'a>> {
        if self.ty(name) != Some(ParamType::Texture) {
            return None;
        }
        let v = self.one(name, &[ParamType::Texture], strings)?;
        Some(Texture { name: &v[0], span: self.span_of(name) })
    }

    /// A parameter given as `float` or as `texture`.
    pub fn float_or_texture(&self, name: &str) -> Option<FloatSource<'a>> {
        if self.ty(name) == Some(ParamType::Texture) {
            return self.texture(name).map(FloatSource::Texture);
        }
        let v = self.one(name, &[ParamType::Float, ParamType::Texture], floats)?;
        Some(FloatSource::Value(v[0]))
    }

    /// A parameter given as `spectrum`, `rgb`, `blackbody` or `texture`.
    pub fn spectrum_or_texture(&self, name: &str) -> Option<SpectrumSource<'a>> {
        if self.ty(name) == Some(ParamType::Texture) {
            return self.texture(name).map(SpectrumSource::Texture);
        }
        self.spectrum_of(name, &SPECTRUM_OR_TEXTURE).map(SpectrumSource::Value)
    }

    /// A parameter given as `spectrum`, `rgb` or `blackbody`.
    pub fn spectrum(&self, name: &str) -> Option<Spectrum<'a>> {
        self.spectrum_of(name, &SPECTRUM_OR_TEXTURE[..3])
    }

    fn spectrum_of(&self, name: &str, types: &[ParamType]) -> Option<Spectrum<'a>> {
        let param = self.typed(name, types)?;
        let value = match (param.ty, &param.values) {
            (ParamType::Rgb, ParamValues::Floats(_)) => {
                let v = self.one(name, types, floats)?;
                if v.iter().any(|x| *x < 0.0) {
                    self.fault(param, "has a negative component".to_owned());
                    return None;
                }
                SpectrumValue::Rgb([v[0], v[1], v[2]])
            }
            (ParamType::Blackbody, ParamValues::Floats(v)) => {
                if v.len() == 2 {
                    self.diagnostics.push(
                        Diagnostic::error(param.value_span, format!("\"blackbody {name}\" has two values"))
                            .with_help(
                                "pbrt-v4 takes the temperature alone; the factor belongs to \"scale\"",
                            ),
                    );
                    return None;
                }
                let temperature = self.one(name, types, floats)?[0];
                if temperature <= 0.0 {
                    self.fault(param, "is not a temperature above 0 K".to_owned());
                    return None;
                }
                SpectrumValue::Blackbody(temperature)
            }
            (ParamType::Spectrum, ParamValues::Floats(v)) => SpectrumValue::Samples(self.samples(param, v)?),
            (_, ParamValues::Strings(_)) => SpectrumValue::Named(&self.one(name, types, strings)?[0]),
            _ => return None,
        };
        let color_space = param.color_space.unwrap_or(self.color_space);
        Some(Spectrum { value, color_space, span: param.value_span })
    }

    /// Checks pairs of wavelength and value.
    fn samples(&self, param: &Param, v: &'a [f32]) -> Option<&'a [[f32; 2]]> {
        let (pairs, rest) = v.as_chunks::<2>();
        if pairs.is_empty() || !rest.is_empty() {
            self.fault(param, format!("needs pairs of wavelength and value, found {}", numbers(v.len())));
            return None;
        }
        if let Some(w) = pairs.windows(2).find(|w| w[1][0] <= w[0][0]) {
            let found = format!("has wavelengths that do not increase: {} after {} nm", w[1][0], w[0][0]);
            self.fault(param, found);
            return None;
        }
        Some(pairs)
    }

    /// Reports something about a parameter's value, or about the entity where the parameter is not given.
    pub fn error(&self, name: &str, message: impl Into<String>) {
        self.diagnostics.error(self.span_of(name), message);
    }

    /// Reports that a parameter without default is not given.
    pub fn missing(&self, name: &str, ty: ParamType) {
        let message = format!("{} has no parameter \"{ty} {name}\"", self.what);
        self.diagnostics.error(self.span, message);
    }

    /// Reports every parameter that nobody asked for, as errors with the nearest known name. The names of `known` are
    /// accepted even if they were not asked for.
    pub fn finish(&self, known: &[&str]) {
        let asked = self.asked.borrow();
        for (param, _) in self.set.params.iter().zip(&self.used).filter(|(_, used)| !used.get()) {
            if known.contains(&param.name.as_str()) {
                continue;
            }
            let message = format!("unknown parameter \"{}\" of {}", param.name, self.what);
            let names = known.iter().copied().chain(asked.iter().map(String::as_str));
            self.diagnostics.push(Diagnostic::error(param.span, message).with_nearest(&param.name, names));
        }
    }

    /// The parameter of a name, if it has one of the types.
    fn typed(&self, name: &str, types: &[ParamType]) -> Option<&'a Param> {
        let param = self.find(name)?;
        if types.contains(&param.ty) {
            return Some(param);
        }
        let names: Vec<_> = types.iter().map(|ty| format!("\"{ty}\"")).collect();
        let message = format!(
            "parameter \"{name}\" of {} must be {}, found \"{}\"",
            self.what,
            names.join(" or "),
            param.ty
        );
        self.diagnostics.error(param.span, message);
        None
    }

    /// The values that make exactly one item.
    fn one<T>(
        &self,
        name: &str,
        types: &[ParamType],
        of: fn(&ParamValues) -> Option<&[T]>,
    ) -> Option<&'a [T]> {
        let param = self.typed(name, types)?;
        let values = of(&param.values)?;
        let need = param.ty.components();
        if values.len() != need {
            self.fault(param, format!("needs {}, found {}", count(need, param.ty), values.len()));
            return None;
        }
        Some(values)
    }

    /// The values that make a whole number of items.
    fn many<T>(&self, name: &str, ty: ParamType, of: fn(&ParamValues) -> Option<&[T]>) -> &'a [T] {
        let Some((param, values)) = self.typed(name, &[ty]).and_then(|p| Some((p, of(&p.values)?))) else {
            return &[];
        };
        let need = ty.components();
        if values.is_empty() {
            self.fault(param, "has no values".to_owned());
        } else if !values.len().is_multiple_of(need) {
            self.fault(param, format!("needs {need} numbers for each {ty}, found {}", numbers(values.len())));
            return &[];
        }
        values
    }

    fn fault(&self, param: &Param, what_is_wrong: String) {
        self.diagnostics.error(
            param.value_span,
            format!("parameter \"{}\" of {} {what_is_wrong}", param.name, self.what),
        );
    }
}

const SPECTRUM_OR_TEXTURE: [ParamType; 4] =
    [ParamType::Spectrum, ParamType::Rgb, ParamType::Blackbody, ParamType::Texture];

fn numbers(n: usize) -> String {
    if n == 1 { "1 number".to_owned() } else { format!("{n} numbers") }
}

fn count(n: usize, ty: ParamType) -> String {
    match ty {
        ParamType::String | ParamType::Texture => "one string".to_owned(),
        ParamType::Bool => "one truth value".to_owned(),
        ParamType::Spectrum => "one name".to_owned(),
        _ if n == 1 => "one number".to_owned(),
        _ => format!("{n} numbers"),
    }
}

fn floats(values: &ParamValues) -> Option<&[f32]> {
    if let ParamValues::Floats(v) = values { Some(v) } else { None }
}

fn integers(values: &ParamValues) -> Option<&[i32]> {
    if let ParamValues::Integers(v) = values { Some(v) } else { None }
}

fn bools(values: &ParamValues) -> Option<&[bool]> {
    if let ParamValues::Bools(v) = values { Some(v) } else { None }
}

fn strings(values: &ParamValues) -> Option<&[String]> {
    if let ParamValues::Strings(v) = values { Some(v) } else { None }
}
