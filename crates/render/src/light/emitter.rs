//! The surfaces of area lights.

use tenfold_geometry::{
    Primitive, Rectangle, ReferencePoint, ReferencePoints, Shape, ShapeSample, ShapeSamples, SurfacePoint,
};
use tenfold_math::{Slots, Vec2, Vec2s};

/// Rectangles of larger meshes are not prepared, for the memory that this takes.
const MOST_PREPARED: usize = 1 << 16;

/// A shape, its primitives prepared for sampling.
#[derive(Clone, Debug)]
pub(super) struct EmittingSurface {
    shape: Shape,
    /// Of every primitive, where any is one.
    rectangles: Vec<Option<Rectangle>>,
}

impl EmittingSurface {
    pub(super) fn new(shape: Shape) -> Self {
        let prepared = if shape.len() <= MOST_PREPARED { shape.len() } else { 0 };
        let mut rectangles: Vec<_> = (0..prepared).map(|i| shape.primitive(i).rectangle()).collect();
        if rectangles.iter().all(Option::is_none) {
            rectangles = Vec::new();
        }
        Self { shape, rectangles }
    }

    /// Begins to load the primitive `primitive`.
    #[inline]
    pub(super) fn prefetch(&self, primitive: usize) {
        self.shape.prefetch(primitive);
    }

    /// The primitive `primitive`.
    #[inline]
    pub(super) fn emitter(&self, primitive: usize) -> Emitter<'_> {
        Emitter {
            shape: &self.shape,
            primitive,
            rectangle: self.rectangles.get(primitive).and_then(Option::as_ref),
        }
    }
}

/// One primitive of a shape, prepared for sampling.
#[derive(Copy, Clone, Debug)]
pub(super) struct Emitter<'a> {
    shape: &'a Shape,
    primitive: usize,
    rectangle: Option<&'a Rectangle>,
}

impl<'a> Emitter<'a> {
    #[inline]
    pub(super) fn primitive(&self) -> Primitive<'a> {
        self.shape.primitive(self.primitive)
    }

    /// [`Primitive::sample_from`].
    #[inline]
    pub(super) fn sample_from(&self, from: &ReferencePoint, u: Vec2) -> Option<ShapeSample> {
        match self.rectangle {
            Some(rectangle) => rectangle.sample_from(from, u),
            None => self.primitive().sample_from(from, u),
        }
    }

    /// [`Emitter::sample_from`] for the points in `slots`, with a density of 0 in place of `None`; false where the kind of primitive has to be asked
    /// for each by itself.
    #[inline]
    pub(super) fn samples_from(
        &self,
        slots: Slots,
        from: &ReferencePoints,
        u: &Vec2s,
        out: &mut ShapeSamples,
    ) -> bool {
        let Some(rectangle) = self.rectangle else { return false };
        rectangle.samples_from(slots, from, u, out);
        true
    }

    /// [`Primitive::pdf_from_point`].
    #[inline]
    pub(super) fn pdf_from_point(&self, from: &ReferencePoint, point: &SurfacePoint) -> f32 {
        match self.rectangle {
            Some(rectangle) => rectangle.pdf_from_point(from, point),
            None => self.primitive().pdf_from_point(from, point),
        }
    }
}
