use crate::{Diagnostics, ParamSet, Params, Span};
use std::{collections::HashMap, fmt};
use tenfold_math::{Id, Motion};

/// What a scene file says, checked for grammar only: names of types and parameters are as they were written, and mean
/// something to the compile step alone.
///
/// Every reference between entities (materials, media, objects) is resolved.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// The film, where the file says one.
    pub film: Option<Entity>,
    /// The sampler.
    pub sampler: Option<Entity>,
    /// The integrator.
    pub integrator: Option<Entity>,
    /// The pixel filter.
    pub filter: Option<Entity>,
    /// The ray accelerator.
    pub accelerator: Option<Entity>,
    /// The camera.
    pub camera: Option<CameraEntity>,
    /// Options of the renderer, in the order of the file.
    pub options: Vec<OptionSetting>,
    /// The shapes outside objects.
    pub shapes: Vec<ShapeEntity>,
    /// The definitions of objects.
    pub objects: Vec<ObjectDefinition>,
    /// The uses of objects.
    pub instances: Vec<InstanceEntity>,
    /// The lights that are not shapes.
    pub lights: Vec<LightEntity>,
    /// The emission of shapes, one for every `AreaLightSource`; shapes refer to it.
    pub area_lights: Vec<Entity>,
    /// The materials. The first one is the default, a `diffuse` without parameters.
    pub materials: Vec<MaterialEntity>,
    /// The textures, in the order of the file: a texture may refer to those before it.
    pub textures: Vec<TextureEntity>,
    /// The participating media.
    pub media: Vec<MediumEntity>,
    /// The materials that have a name.
    pub material_names: HashMap<String, Id<MaterialEntity>>,
}

/// The emission of shapes: an [`Entity`] in [`Description::area_lights`].
pub type AreaLightId = Id<Entity>;

/// A thing of a scene: a type name with parameters.
#[derive(Clone, Debug)]
pub struct Entity {
    /// The name of the type, as `sphere`.
    pub kind: String,
    /// Where the name of the type stands.
    pub kind_span: Span,
    /// The parameters.
    pub params: ParamSet,
    /// The whole directive.
    pub span: Span,
    /// The colour space of its RGB values.
    pub color_space: ColorSpace,
}

impl Entity {
    /// A reader of the parameters, for an entity of a `family` such as `shape`.
    pub fn params<'a>(&'a self, family: &str, diagnostics: &'a Diagnostics) -> Params<'a> {
        let what = format!("{family} \"{}\"", self.kind);
        Params::new(&self.params, what, self.kind_span, self.color_space, diagnostics)
    }
}

/// An RGB colour space that pbrt knows by name.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// `srgb`: the primaries of Rec. 709, white D65.
    #[default]
    Srgb,
    /// `dci-p3`: the primaries of DCI-P3, white D65.
    DciP3,
    /// `rec2020`: the primaries of Rec. 2020, white D65.
    Rec2020,
    /// `aces2065-1`: the primaries AP0, white about D60.
    Aces2065_1,
}

impl ColorSpace {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Srgb, Self::DciP3, Self::Rec2020, Self::Aces2065_1];

    /// The name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Srgb => "srgb",
            Self::DciP3 => "dci-p3",
            Self::Rec2020 => "rec2020",
            Self::Aces2065_1 => "aces2065-1",
        }
    }

    /// The space of a name, letters' case aside.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|space| space.name().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for ColorSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A camera.
#[derive(Clone, Debug)]
pub struct CameraEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// From camera space to world space: the inverses of the transforms that were current.
    pub world_from_camera: Motion,
    /// The medium around the camera.
    pub medium: Option<Id<MediumEntity>>,
}

/// The media on the two sides of a surface; none is vacuum.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct MediumInterface {
    /// Against the normal.
    pub inside: Option<Id<MediumEntity>>,
    /// On the side of the normal.
    pub outside: Option<Id<MediumEntity>>,
}

/// A shape.
#[derive(Clone, Debug)]
pub struct ShapeEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// From object space to world space; in an object's definition, to the space of the object.
    pub motion: Motion,
    /// Whether the file asks for the normals to be turned round. A transform that swaps handedness turns them as
    /// well; both together cancel.
    pub reverse_orientation: bool,
    /// The material.
    pub material: Id<MaterialEntity>,
    /// The emission, if it emits. Always none in an object's definition, as in pbrt.
    pub area_light: Option<AreaLightId>,
    /// The media inside and outside.
    pub media: MediumInterface,
}

/// A group of shapes to be used several times.
#[derive(Clone, Debug)]
pub struct ObjectDefinition {
    /// The name.
    pub name: String,
    /// The shapes, in the space of the object.
    pub shapes: Vec<ShapeEntity>,
    /// The directive that begins it.
    pub span: Span,
}

/// A use of an object.
#[derive(Clone, Debug)]
pub struct InstanceEntity {
    /// What is used.
    pub object: Id<ObjectDefinition>,
    /// From the space of the object to world space. The definition's own transform is part of its shapes' motion.
    pub motion: Motion,
    /// The directive.
    pub span: Span,
}

/// A light that is no shape.
#[derive(Clone, Debug)]
pub struct LightEntity {
    /// Type and parameters.
    pub entity: Entity,
    /// From light space to world space.
    pub motion: Motion,
    /// The medium around it.
    pub medium: Option<Id<MediumEntity>>,
}

/// A material.
#[derive(Clone, Debug)]
pub struct MaterialEntity {
    /// The name, where it has one.
    pub name: Option<String>,
    /// Type and parameters. Of a named material the parameter `type` has become the type.
    pub entity: Entity,
}

/// What a texture gives.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Hash)]
pub enum TextureValue {
    /// A number.
    Float,
    /// A spectrum.
    Spectrum,
}

/// A texture.
#[derive(Clone, Debug)]
pub struct TextureEntity {
    /// The name; unique among the textures that give the same.
    pub name: String,
    /// What it gives.
    pub value: TextureValue,
    /// Type and parameters.
    pub entity: Entity,
    /// From texture space to world space.
    pub motion: Motion,
}

/// A participating medium.
#[derive(Clone, Debug)]
pub struct MediumEntity {
    /// The name.
    pub name: String,
    /// Type and parameters. The parameter `type` has become the type.
    pub entity: Entity,
    /// From medium space to world space.
    pub motion: Motion,
}

/// The value of an option.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// `true` or `false`.
    Bool(bool),
    /// A number.
    Number(f64),
    /// A quoted string.
    String(String),
}

/// An option of the renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct OptionSetting {
    /// The name, in small letters without `-` and `_`. It is one of pbrt's.
    pub name: String,
    /// The value, of the type that the option has.
    pub value: OptionValue,
    /// The directive.
    pub span: Span,
}
