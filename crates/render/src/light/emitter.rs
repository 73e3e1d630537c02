//! The surfaces of area lights.

use std::sync::Arc;
use tenfold_geometry::{Primitive, Rectangle, ReferencePoint, Shape, ShapeSample, SurfacePoint};
use tenfold_math::Vec2;

/// Rectangles of larger meshes are not prepared, for the memory that this takes.
const MOST_PREPARED: usize = 1 << 16;

/// One primitive of a shape, prepared for sampling.
#[derive(Clone, Debug)]
pub(super) struct Emitter {
    shape: Arc<Shape>,
    primitive: u32,
    rectangle: Option<Box<Rectangle>>,
}

impl Emitter {
    /// The primitive `primitive` of `shape`.
    pub(super) fn new(shape: Arc<Shape>, primitive: usize) -> Self {
        let may_prepare = shape.len() <= MOST_PREPARED;
        let rectangle = may_prepare.then(|| shape.primitive(primitive).rectangle()).flatten().map(Box::new);
        Self { shape, primitive: primitive as u32, rectangle }
    }

    #[inline]
    pub(super) fn primitive(&self) -> Primitive<'_> {
        self.shape.primitive(self.primitive as usize)
    }

    /// [`Primitive::sample_from`].
    #[inline]
    pub(super) fn sample_from(&self, from: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        match &self.rectangle {
            Some(rectangle) => rectangle.sample_from(from, u),
            None => self.primitive().sample_from(from, u),
        }
    }

    /// [`Primitive::pdf_from_point`].
    #[inline]
    pub(super) fn pdf_from_point(&self, from: &ReferencePoint, point: &SurfacePoint) -> f32 {
        match &self.rectangle {
            Some(rectangle) => rectangle.pdf_from_point(from, point),
            None => self.primitive().pdf_from_point(from, point),
        }
    }
}
