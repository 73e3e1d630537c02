//! Parameters as a scene file gives them, and typed access to them.

mod reader;

pub use reader::{FloatSource, Params, Spectrum, SpectrumSource, SpectrumValue, Texture};

use crate::{ColorSpace, Span};
use std::{fmt, sync::Arc};

/// The parameters of one entity.
#[derive(Clone, Debug)]
pub struct ParamSet {
    /// All of them in the file, or the place where they would stand.
    pub span: Span,
    /// Those given with the entity, in the order of the file; of two with the same name the later one counts.
    pub params: Vec<Param>,
    /// Those that an `Attribute` directive gives to every entity of the family: they count where the entity itself
    /// says nothing, and may go unused.
    pub defaults: Arc<Vec<Param>>,
}

impl ParamSet {
    /// The parameter that counts for a name.
    pub fn get(&self, name: &str) -> Option<&Param> {
        self.by_weight().find(|p| p.name == name)
    }

    /// All parameters, the ones that count more first.
    pub(crate) fn by_weight(&self) -> impl Iterator<Item = &Param> {
        self.params.iter().rev().chain(self.defaults.iter().rev())
    }
}

/// One parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Param {
    /// The name.
    pub name: String,
    /// The declared type.
    pub ty: ParamType,
    /// The values, of the representation that the type has; their number is not checked.
    pub values: ParamValues,
    /// The declaration, as `"float radius"`.
    pub span: Span,
    /// The values in the file, brackets included.
    pub value_span: Span,
    /// The colour space of its RGB values, where it is not the entity's.
    pub color_space: Option<ColorSpace>,
}

/// The type of a parameter.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum ParamType {
    /// `bool`
    Bool,
    /// `integer`
    Integer,
    /// `float`
    Float,
    /// `point2`
    Point2,
    /// `vector2`
    Vector2,
    /// `point3`
    Point3,
    /// `vector3`
    Vector3,
    /// `normal`
    Normal,
    /// `spectrum`: a name, a file, or pairs of wavelength (nm) and value.
    Spectrum,
    /// `rgb`
    Rgb,
    /// `blackbody`: a temperature in kelvin.
    Blackbody,
    /// `string`
    String,
    /// `texture`: the name of a texture.
    Texture,
}

impl ParamType {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Bool,
        Self::Integer,
        Self::Float,
        Self::Point2,
        Self::Vector2,
        Self::Point3,
        Self::Vector3,
        Self::Normal,
        Self::Spectrum,
        Self::Rgb,
        Self::Blackbody,
        Self::String,
        Self::Texture,
    ];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Integer => "integer",
            Self::Float => "float",
            Self::Point2 => "point2",
            Self::Vector2 => "vector2",
            Self::Point3 => "point3",
            Self::Vector3 => "vector3",
            Self::Normal => "normal",
            Self::Spectrum => "spectrum",
            Self::Rgb => "rgb",
            Self::Blackbody => "blackbody",
            Self::String => "string",
            Self::Texture => "texture",
        }
    }

    /// The type of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ty| ty.name() == name)
    }

    /// How many numbers make one value.
    pub fn components(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal | Self::Rgb => 3,
            _ => 1,
        }
    }
}

impl fmt::Display for ParamType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The values of a parameter. Numbers are finite.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValues {
    /// Of every type made of numbers but `integer`; points and vectors flat.
    Floats(Vec<f32>),
    /// Of `integer`.
    Integers(Vec<i32>),
    /// Of `bool`.
    Bools(Vec<bool>),
    /// Of `string` and `texture`, and of a `spectrum` that is named.
    Strings(Vec<String>),
}

impl ParamValues {
    /// How many there are; points and vectors are counted by their numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::Floats(v) => v.len(),
            Self::Integers(v) => v.len(),
            Self::Bools(v) => v.len(),
            Self::Strings(v) => v.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
