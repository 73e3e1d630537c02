//! Compiles the emission of shapes.

use super::{emission, image, image_space, normalisation, per_photometric, scale, target, white};
use crate::compile::context::{Context, color_space};
use crate::light::{
    AreaEmission, AreaImage, AreaRadiance, DiffuseAreaLight, Emission, EmittingShape, Light, RadianceImage,
    mean_rgb,
};
use std::cell::RefCell;
use std::collections::HashMap;
use std::f32::consts::PI;
use std::sync::Arc;
use tenfold_geometry::Shape;
use tenfold_image::Image;
use tenfold_sampling::distribution::PiecewiseConstant2D;
use tenfold_scene::{Entity, Params};

/// The emission of shapes, read once for all shapes that share it.
#[derive(Debug)]
pub(crate) struct AreaEmitter {
    content: Content,
    scale: f32,
    power: Option<f32>,
    two_sided: bool,
}

#[derive(Debug)]
enum Content {
    Uniform(Emission),
    Image(ImageContent),
}

/// Distributions of an image over parallelograms, by the bits of their corners.
type Distributions = HashMap<[[u32; 2]; 4], Option<Arc<PiecewiseConstant2D>>>;

#[derive(Debug)]
struct ImageContent {
    image: Arc<Image>,
    spectra: Arc<RadianceImage>,
    /// Mean luminance of the image.
    luminance: f32,
    /// Most parallelograms share theirs.
    distributions: RefCell<Distributions>,
}

impl ImageContent {
    /// The image over a primitive.
    fn on(&self, shape: &Shape, primitive: usize) -> AreaImage {
        let distribution = AreaImage::corners(shape, primitive).and_then(|corners| {
            let key = corners.map(|c| [c.x.to_bits(), c.y.to_bits()]);
            let make = || AreaImage::distribution(&self.image, &corners).map(Arc::new);
            self.distributions.borrow_mut().entry(key).or_insert_with(make).clone()
        });
        AreaImage::new(self.spectra.clone(), distribution, shape, primitive)
    }
}

/// Compiles the emission of shapes. Faults are reported.
pub(crate) fn compile_area_light(cx: &mut Context<'_>, entity: &Entity) -> Option<AreaEmitter> {
    let p = &entity.params("area light", cx.diagnostics);
    if entity.kind != "diffuse" {
        cx.unknown_kind(entity.kind_span, "area light", &entity.kind, ["diffuse"]);
        return None;
    }
    let emitter = area_emitter(cx, p, entity);
    p.finish(&["L", "scale", "power", "twosided", "filename"]);
    emitter
}

fn area_emitter(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity) -> Option<AreaEmitter> {
    let (two_sided, power) = (p.one_bool("twosided", false), target(p, "power"));
    let Some(filename) = p.string("filename") else {
        let emission = emission(cx, p, entity, "L")?;
        return Some(AreaEmitter { content: Content::Uniform(emission), scale: 1.0, power, two_sided });
    };
    if p.find("L").is_some() {
        p.error("L", "an area light has either \"L\" or \"filename\", not both");
        return None;
    }
    let scale = scale(p);
    let image = image(cx, p, filename)?;
    let space = image_space(&image);
    // pbrt-v4 normalises by the scene's white even where the image has its own.
    let scale = per_photometric(&white(color_space(entity.color_space)), scale?);
    let luminance = space.luminance(mean_rgb(&image));
    let spectra = Arc::new(RadianceImage::new(&image, space));
    let content = ImageContent { image, spectra, luminance, distributions: RefCell::default() };
    Some(AreaEmitter { content: Content::Image(content), scale, power, two_sided })
}

impl AreaEmitter {
    /// The lights of a shape in the order of its primitives, and how many primitives each of them is: one, or two where pairs of
    /// triangles are rectangles that emit evenly. Rays do not meet an `invisible` shape. As in pbrt-v4, `power` is that of each
    /// primitive.
    pub(crate) fn lights(&self, shape: &Shape, invisible: bool) -> (Vec<Light>, u32) {
        if let (Content::Uniform(_), None, Shape::Triangles(mesh)) = (&self.content, self.power, shape)
            && let Some(rectangles) = mesh.rectangles()
        {
            return (self.of_each(Shape::Patches(Arc::new(rectangles)), invisible), 2);
        }
        // Every light is found by chance: one look at its vertices is less than one at its indices and one at each vertex.
        let separate = match shape {
            Shape::Triangles(mesh) => mesh.separated().map(|mesh| Shape::Triangles(Arc::new(mesh))),
            Shape::Patches(mesh) => mesh.separated().map(|mesh| Shape::Patches(Arc::new(mesh))),
            Shape::Sphere(_) | Shape::Disk(_) | Shape::Cylinder(_) => None,
        };
        (self.of_each(separate.unwrap_or_else(|| shape.clone()), invisible), 1)
    }

    fn of_each(&self, shape: Shape, invisible: bool) -> Vec<Light> {
        let count = shape.len();
        let emissions = match (&self.content, self.power) {
            (Content::Uniform(emission), None) => {
                vec![AreaEmission { radiance: AreaRadiance::Uniform(emission.clone()), scale: self.scale }]
            }
            (content, power) => (0..count)
                .map(|i| {
                    let (radiance, luminance) = content.on(&shape, i);
                    let sides = if self.two_sided { 2.0 } else { 1.0 };
                    let found = luminance * sides * PI * shape.primitive(i).area();
                    AreaEmission { radiance, scale: self.scale * normalisation(power, found) }
                })
                .collect(),
        };
        let emitting = EmittingShape::new(shape, emissions, self.two_sided);
        let emitting = Arc::new(if invisible { emitting.invisible() } else { emitting });
        (0..count).map(|i| Light::Area(DiffuseAreaLight::new(emitting.clone(), i))).collect()
    }
}

impl Content {
    /// What the primitive `i` of `shape` emits, and its mean luminance.
    fn on(&self, shape: &Shape, i: usize) -> (AreaRadiance, f32) {
        match self {
            Self::Uniform(emission) => (AreaRadiance::Uniform(emission.clone()), 1.0),
            Self::Image(content) => (AreaRadiance::Image(Arc::new(content.on(shape, i))), content.luminance),
        }
    }
}
