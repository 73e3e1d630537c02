//! Compiles the lights of a description.

mod area;
#[cfg(test)]
mod tests;

pub(crate) use area::{AreaEmitter, compile_area_light};

use super::context::{Context, color_space};
use crate::light::{
    DistantLight, Emission, GoniometricLight, ImageInfinite, Light, PointLight, ProjectionLight,
    RadianceImage, Screen, SpotLight, UniformInfinite, mean_rgb, weighted_rgb,
};
use crate::texture::SpectrumRole;
use std::f32::consts::PI;
use std::sync::Arc;
use tenfold_image::Image;
use tenfold_math::{Frame, Mat3, Mat4, Transform, Vec2, Vec3, equal_area_square_to_sphere};
use tenfold_scene::{Diagnostic, Entity, LightEntity, ParamType, Params};
use tenfold_spectrum::{RgbColorSpace, Spectrum, photometric};

/// The kinds of light and their parameters.
const KINDS: [(&str, &[&str]); 6] = [
    ("point", &["I", "scale", "power", "from"]),
    ("spot", &["I", "scale", "power", "from", "to", "coneangle", "conedeltaangle"]),
    ("distant", &["L", "scale", "illuminance", "from", "to"]),
    ("infinite", &["L", "scale", "illuminance", "filename", "portal"]),
    ("projection", &["scale", "power", "fov", "filename"]),
    ("goniometric", &["I", "scale", "power", "filename"]),
];

/// Compiles a light that is no shape. Faults are reported.
pub(crate) fn compile_light(cx: &mut Context<'_>, light: &LightEntity) -> Option<Light> {
    let entity = &light.entity;
    let Some((_, known)) = KINDS.iter().find(|(kind, _)| *kind == entity.kind) else {
        cx.unknown_kind(entity.kind_span, "light", &entity.kind, KINDS.map(|(kind, _)| kind));
        return None;
    };
    let p = &entity.params("light", cx.diagnostics);
    if light.motion.is_moving() {
        let message =
            "a moving light is not supported yet: it stays where it is at the first time, as in pbrt-v4";
        cx.diagnostics.warning(p.span(), message);
    }
    let t = light.motion.start();
    let compiled = match entity.kind.as_str() {
        "point" => point(cx, p, entity, t),
        "spot" => spot(cx, p, entity, t),
        "distant" => distant(cx, p, entity, t),
        "infinite" => infinite(cx, p, entity, t),
        "projection" => projection(cx, p, t),
        _ => goniometric(cx, p, entity, t),
    };
    p.finish(known);
    compiled
}

/// A spectrum and the factor to make it one of photometric value 1 (pbrt-v4: of RGB colours, what makes their
/// white so) times the parameter `scale`.
fn emission(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, name: &str) -> Option<Emission> {
    let scale = scale(p);
    let spectrum = match p.spectrum(name) {
        Some(given) => cx.spectrum(&given, SpectrumRole::Illuminant),
        // A value that cannot be read has been reported; what is not given is white.
        None if p.has(name) => None,
        None => Some(white(color_space(entity.color_space))),
    };
    let (scale, spectrum) = (scale?, spectrum?);
    Some(Emission::new(&spectrum, per_photometric(&spectrum, scale)))
}

fn white(space: &RgbColorSpace) -> Spectrum {
    Spectrum::Dense(space.illuminant().clone())
}

/// `scale` over the photometric value; 0 for what cannot be seen.
fn per_photometric(spectrum: &Spectrum, scale: f32) -> f32 {
    let value = photometric(spectrum);
    if value > 0.0 { scale / value } else { 0.0 }
}

/// The parameter `scale`.
fn scale(p: &Params<'_>) -> Option<f32> {
    let scale = p.one_float("scale", 1.0);
    if scale < 0.0 {
        p.error("scale", format!("the scale of a light is not negative, as {scale} is"));
        return None;
    }
    Some(scale)
}

/// The parameter `name`, `power` or `illuminance`, where it counts.
fn target(p: &Params<'_>, name: &str) -> Option<f32> {
    let value = p.float(name)?;
    if value <= 0.0 {
        let message = format!("\"{name}\" counts above 0 alone: {value} is ignored, as in pbrt-v4");
        p.diagnostics().warning(p.span_of(name), message);
        return None;
    }
    Some(value)
}

/// The factor that makes light of the amount `found` be `target`.
fn normalisation(target: Option<f32>, found: f32) -> f32 {
    match target {
        Some(target) if found > 0.0 => target / found,
        _ => 1.0,
    }
}

fn point(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, t: &Transform) -> Option<Light> {
    let intensity = emission(cx, p, entity, "I");
    let factor = normalisation(target(p, "power"), 4.0 * PI);
    let position = t.point(p.one_point3("from", Vec3::ZERO));
    Some(Light::from(PointLight { position, intensity: intensity?.scaled(factor) }))
}

fn spot(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, t: &Transform) -> Option<Light> {
    let intensity = emission(cx, p, entity, "I");
    let power = target(p, "power");
    let from = p.one_point3("from", Vec3::ZERO);
    let axis = direction(p, from, p.one_point3("to", Vec3::Z))?;
    let (cone, delta) = (p.one_float("coneangle", 30.0), p.one_float("conedeltaangle", 5.0));
    if !(cone > 0.0 && cone <= 180.0) {
        p.error("coneangle", format!("a cone's angle lies above 0 and up to 180 degrees, {cone} does not"));
        return None;
    }
    if !(0.0..=cone).contains(&delta) {
        let message = format!(
            "the cone's edge lies between 0 and the cone's angle of {cone} degrees, {delta} does not"
        );
        p.error("conedeltaangle", message);
        return None;
    }
    let (start, end) = ((cone - delta).to_radians(), cone.to_radians());
    let factor = normalisation(power, SpotLight::measure(start, end));
    let frame = Frame::from_z(axis);
    let rotation =
        Mat4::from_cols(frame.x.extend(0.0), frame.y.extend(0.0), frame.z.extend(0.0), from.extend(1.0));
    let world_from_light = *t * Transform::from_mat4(rotation)?;
    Some(Light::from(SpotLight::new(&world_from_light, intensity?.scaled(factor), start, end)))
}

/// The unit vector between two points; that they are one is reported.
fn direction(p: &Params<'_>, from: Vec3, to: Vec3) -> Option<Vec3> {
    let direction = (to - from).try_normalize();
    if direction.is_none() {
        let name = if p.has("to") { "to" } else { "from" };
        p.error(name, "\"from\" and \"to\" are the same point, which leaves the light without direction");
    }
    direction
}

fn distant(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, t: &Transform) -> Option<Light> {
    let irradiance = emission(cx, p, entity, "L");
    let factor = normalisation(target(p, "illuminance"), 1.0);
    let from = p.one_point3("from", Vec3::ZERO);
    let direction = t.vector(-direction(p, from, p.one_point3("to", Vec3::Z))?).try_normalize()?;
    Some(Light::from(DistantLight { direction, irradiance: irradiance?.scaled(factor) }))
}

fn infinite(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, t: &Transform) -> Option<Light> {
    let illuminance = target(p, "illuminance");
    if !p.point3s("portal").is_empty() {
        cx.unsupported(p.span_of("portal"), "the portal of an infinite light");
        return None;
    }
    let Some(filename) = p.string("filename") else {
        // Illuminance on a surface below a sky of radiance 1.
        let factor = normalisation(illuminance, PI);
        let radiance = emission(cx, p, entity, "L")?.scaled(factor);
        return Some(Light::from(UniformInfinite { radiance }));
    };
    if p.find("L").is_some() {
        p.error("L", "an infinite light has either \"L\" or \"filename\", not both");
        return None;
    }
    let scale = scale(p);
    let image = square_image(cx, p, filename)?;
    let space = image_space(&image);
    let world_from_light = orthonormal(p, t)?;
    // pbrt-v4 counts the pixels of the upper hemisphere with half their solid angle of 4π; so it is here, for
    // pictures as bright as its own.
    let upper = 2.0 * PI * weighted_rgb(&image, |st| equal_area_square_to_sphere(st).z.max(0.0));
    let factor = normalisation(illuminance, space.luminance(upper));
    let scale = per_photometric(&white(space), scale? * factor);
    Some(Light::from(ImageInfinite::new(world_from_light, &image, space, scale)))
}

/// The rotation (or rotation and reflection) in a transform, whatever its uniform scale.
fn orthonormal(p: &Params<'_>, t: &Transform) -> Option<Mat3> {
    if !crate::light::is_similarity(t) {
        let message =
            "the image of an infinite light cannot be stretched: its transform has unequal scales or a shear";
        p.diagnostics().error(p.span(), message);
        return None;
    }
    let axis = |v: Vec3| t.vector(v).normalize();
    Some(Mat3::from_cols(axis(Vec3::X), axis(Vec3::Y), axis(Vec3::Z)))
}

fn projection(cx: &mut Context<'_>, p: &Params<'_>, t: &Transform) -> Option<Light> {
    let (scale, power) = (scale(p), target(p, "power"));
    let fov = p.one_float("fov", 90.0);
    if !(fov > 0.0 && fov < 180.0) {
        p.error("fov", format!("a field of view lies between 0 and 180 degrees, {fov} does not"));
        return None;
    }
    let image = image(cx, p, p.string("filename"))?;
    let space = image_space(&image);
    let screen = Screen::new(image.width(), image.height(), fov.to_radians());
    let factor = normalisation(power, space.luminance(screen.measure(&image)));
    let scale = per_photometric(&white(space), scale? * factor);
    Some(Light::from(ProjectionLight::new(t, screen, RadianceImage::new(&image, space), scale)))
}

fn goniometric(cx: &mut Context<'_>, p: &Params<'_>, entity: &Entity, t: &Transform) -> Option<Light> {
    let intensity = emission(cx, p, entity, "I");
    let power = target(p, "power");
    let image = square_image(cx, p, p.string("filename"))?;
    let side = image.width();
    let factor = |i: u32| {
        let rgb = image.rgb(i % side, i / side).max(Vec3::ZERO);
        (rgb.x + rgb.y + rgb.z) / 3.0
    };
    let factors: Vec<f32> = (0..side * side).map(factor).collect();
    let mean = mean_rgb(&image).element_sum() / 3.0;
    let normalisation = normalisation(power, 4.0 * PI * mean);
    // The map's pole is the y axis of the light's space.
    let swap = Transform::from_mat4(Mat4::from_mat3(Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::Y)))?;
    let intensity = intensity?.scaled(normalisation);
    Some(Light::from(GoniometricLight::new(&(*t * swap), intensity, factors, side as usize)))
}

/// The image that a light names, fit to be one.
fn image<'a>(
    cx: &mut Context<'_>,
    p: &Params<'_>,
    filename: impl Into<Option<&'a str>>,
) -> Option<Arc<Image>> {
    let Some(filename) = filename.into() else {
        p.missing("filename", ParamType::String);
        return None;
    };
    let image = cx.image(filename, p.span_of("filename"), None)?;
    let finite = |y| (0..image.width()).all(|x| image.rgb(x, y).is_finite());
    if let Some(y) = (0..image.height()).find(|&y| !finite(y)) {
        let message = format!(
            "the image \"{filename}\" has values that are not finite in row {y}: it cannot be a light"
        );
        p.error("filename", message);
        return None;
    }
    Some(image)
}

/// An image over all directions.
fn square_image<'a>(
    cx: &mut Context<'_>,
    p: &Params<'_>,
    filename: impl Into<Option<&'a str>>,
) -> Option<Arc<Image>> {
    let image = image(cx, p, filename)?;
    let (width, height) = image.resolution();
    if width != height {
        let message =
            format!("the image of a light on all sides is square, this one has {width} × {height} pixels");
        let help = "pbrt-v4 has such images in the equal-area octahedral projection; its `imgtool makeequiarea` converts \
                    from latitude and longitude";
        p.diagnostics().push(Diagnostic::error(p.span_of("filename"), message).with_help(help));
        return None;
    }
    Some(image)
}

/// The colour space of an image: the one whose primaries it names, or sRGB.
fn image_space(image: &Image) -> &'static RgbColorSpace {
    let Some(c) = image.metadata.chromaticities else { return RgbColorSpace::srgb() };
    let near = |a: Vec2, b: Vec2| a.distance(b) < 1e-3;
    let same = |space: &&RgbColorSpace| space.primaries().into_iter().zip(c).all(|(a, b)| near(a, b));
    RgbColorSpace::all().iter().find(same).unwrap_or(RgbColorSpace::srgb())
}
