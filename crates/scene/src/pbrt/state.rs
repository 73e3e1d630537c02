//! The graphics state: what directives set for those that follow.

use crate::{AreaLightId, ColorSpace, MaterialEntity, MediumInterface, Param, Span};
use std::sync::Arc;
use tenfold_math::{Id, Transform};

/// The current transforms, at the first and at the second of the transform times.
pub(super) type TransformPair = [Transform; 2];

/// A family of entities that `Attribute` can give default parameters.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum AttributeTarget {
    Shape,
    Light,
    Material,
    Medium,
    Texture,
}

impl AttributeTarget {
    pub(super) const NAMES: [(&str, Self); 5] = [
        ("shape", Self::Shape),
        ("light", Self::Light),
        ("material", Self::Material),
        ("medium", Self::Medium),
        ("texture", Self::Texture),
    ];
}

/// What `AttributeBegin` saves and `AttributeEnd` brings back (pbrt book, 4th edition, §C.2.3).
#[derive(Clone, Debug)]
pub(super) struct GraphicsState {
    pub(super) transforms: TransformPair,
    /// Which of the two transforms the transform directives change.
    pub(super) active: [bool; 2],
    pub(super) color_space: ColorSpace,
    pub(super) reverse_orientation: bool,
    pub(super) material: Id<MaterialEntity>,
    pub(super) area_light: Option<AreaLightId>,
    pub(super) media: MediumInterface,
    /// The default parameters, by [`AttributeTarget`].
    pub(super) attributes: [Arc<Vec<Param>>; 5],
}

/// What opened a scope.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum ScopeKind {
    /// `AttributeBegin`
    Attribute,
    /// `ObjectBegin`
    Object,
    /// `ObjectBegin` inside an object's definition, which is a fault
    NestedObject,
}

/// An open scope.
#[derive(Debug)]
pub(super) struct Scope {
    pub(super) kind: ScopeKind,
    pub(super) span: Span,
    /// The state to come back to.
    pub(super) state: GraphicsState,
}
