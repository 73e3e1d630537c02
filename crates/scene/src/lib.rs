//! Scene descriptions, diagnostics and the readers of scene formats.
//!
//! A reader turns files into a plain [`Description`]: entities with generic parameters and source spans, grammar checked,
//! references resolved, nothing interpreted. What a parameter means is decided by whoever compiles the description:
//! it asks through [`Params`], which reports wrong types, wrong counts and parameters that nobody asked for,
//! each with its place. All faults are values, collected in [`Diagnostics`].

mod description;
mod diagnostic;
mod params;
mod pbrt;
mod ply;
mod resources;
mod source;

pub use description::{
    AreaLightId, CameraEntity, ColorSpace, Description, Entity, InstanceEntity, LightEntity, MaterialEntity,
    MediumEntity, MediumInterface, ObjectDefinition, OptionSetting, OptionValue, ShapeEntity, TextureEntity,
    TextureValue,
};
pub use diagnostic::{Diagnostic, Diagnostics, Note, Severity, nearest};
pub use params::{
    FloatSource, Param, ParamSet, ParamType, ParamValues, Params, Spectrum, SpectrumSource, SpectrumValue,
    Texture,
};
pub use pbrt::{read_pbrt, read_pbrt_str};
pub use ply::{PlyError, PlyMesh, read_ply, read_ply_in_pieces};
pub use resources::{EmbeddedResources, FileResources, LargeFile, Resources, unpack};
pub use source::{FileId, Location, SourceFile, SourceMap, Span};
