//! The graphics state: what directives set for those that follow.

use crate::{AreaLightId, ColorSpace, MaterialEntity, MediumInterface, Param, Span};
use std::sync::Arc;
use tenfold_math::{Id, Key, Motion, Transform};

/// The current transforms, at each of the transform times.
#[derive(Clone, Debug)]
pub(super) enum Transforms {
    /// At all times.
    Same(Transform),
    /// At each of them.
    Each(Arc<[Transform]>),
}

impl Transforms {
    /// The transforms at `count` times, with those that are active as `change` makes them.
    pub(super) fn map(
        &self,
        count: usize,
        active: Active,
        mut change: impl FnMut(Transform) -> Transform,
    ) -> Self {
        match (self, active) {
            (Self::Same(t), Active::All) => Self::Same(change(*t)),
            _ => Self::Each(
                (0..count)
                    .map(|i| if active.includes(i) { change(self.at(i)) } else { self.at(i) })
                    .collect(),
            ),
        }
    }

    fn at(&self, key: usize) -> Transform {
        match self {
            Self::Same(t) => *t,
            Self::Each(each) => each[key],
        }
    }

    /// The motion through them.
    pub(super) fn motion(&self, times: &[f32]) -> Motion {
        match self {
            Self::Same(t) => Motion::still(*t),
            Self::Each(each) => {
                let keys = times.iter().zip(&**each);
                Motion::through(&keys.map(|(&time, &transform)| Key { time, transform }).collect::<Vec<_>>())
            }
        }
    }
}

/// Which of the transforms the transform directives change.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) enum Active {
    All,
    /// That of the key with this index.
    Key(usize),
}

impl Active {
    fn includes(self, key: usize) -> bool {
        self == Self::All || self == Self::Key(key)
    }
}

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
    pub(super) transforms: Transforms,
    pub(super) active: Active,
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
