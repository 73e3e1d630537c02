//! Textures made of two others: products, weighted means, and choice by the surface's direction.

use std::ops::{Add, Mul};

use tenfold_math::Vec3;

use super::{FloatSlot, TextureContext};

/// A texture (slot `S`) times a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale<S> {
    /// The texture.
    pub texture: S,
    /// The number.
    pub scale: FloatSlot,
}

/// `(1 − amount) · textures[0] + amount · textures[1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mix<S> {
    /// What is mixed.
    pub textures: [S; 2],
    /// The weight of the second.
    pub amount: FloatSlot,
}

/// A mix by direction: the first texture where the surface faces along `direction` or against it, the second
/// where it runs beside.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionMix<S> {
    /// What is mixed.
    pub textures: [S; 2],
    /// The unit vector, in world space.
    pub direction: Vec3,
}

impl<S> DirectionMix<S> {
    /// The weight of the second texture.
    #[inline]
    pub fn weight(&self, at: &TextureContext) -> f32 {
        1.0 - at.n.dot(self.direction).abs().min(1.0)
    }
}

/// The weighted mean of two textures; one without weight is not looked at.
#[inline]
pub(crate) fn blend<S, V>(textures: &[S; 2], weight: f32, eval: impl Fn(&S) -> V) -> V
where
    V: Add<Output = V> + Mul<f32, Output = V>,
{
    if weight == 0.0 {
        eval(&textures[0])
    } else if weight == 1.0 {
        eval(&textures[1])
    } else {
        eval(&textures[0]) * (1.0 - weight) + eval(&textures[1]) * weight
    }
}
