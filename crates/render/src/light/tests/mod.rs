//! Tests of the lights together: densities, closed forms, and the choice.

mod choice;
mod irradiance;
mod sampling;

use super::LightStrategy::{ByTexture, Complementary};
use super::*;
use std::sync::Arc;
use tenfold_geometry::{
    BilinearMesh, Cylinder, CylinderParams, Disk, DiskParams, MeshParts, Shape, Sphere, SphereParams,
    TriangleMesh,
};
use tenfold_image::Image;
use tenfold_math::Transform;
use tenfold_spectrum::{RgbColorSpace, Spectrum};
use tenfold_testkit::Rng;

/// All wavelengths at one, where constant spectra give their value.
fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::fixed(550.0)
}

fn constant(value: f32) -> Emission {
    Emission::new(&Spectrum::Constant(1.0), value)
}

/// A point of a surface with both normals `n`.
fn surface(p: Vec3, n: Vec3) -> ReferencePoint {
    ReferencePoint { n, ns: n, ..ReferencePoint::free(p, 0.0) }
}

fn area(shape: Shape, radiance: f32, two_sided: bool) -> Vec<Light> {
    let (count, radiance) = (shape.len(), AreaRadiance::Uniform(constant(radiance)));
    let emitting =
        Arc::new(EmittingShape::new(shape, vec![AreaEmission { radiance, scale: 1.0 }], two_sided));
    (0..count).map(|i| Light::Area(DiffuseAreaLight::new(emitting.clone(), i))).collect()
}

fn sphere(centre: Vec3, radius: f32) -> Shape {
    Shape::Sphere(Sphere::new(Transform::translate(centre), false, SphereParams::whole(radius)).unwrap())
}

/// A disk at height `z` that faces down, around the z axis.
fn disk(z: f32, radius: f32) -> Shape {
    let params = DiskParams { height: z, radius, ..DiskParams::default() };
    Shape::Disk(Disk::new(Transform::IDENTITY, true, params).unwrap())
}

/// A tube around the z axis, in place by `t`.
fn cylinder(t: Transform, radius: f32) -> Shape {
    let params = CylinderParams { radius, ..CylinderParams::default() };
    Shape::Cylinder(Cylinder::new(t, false, params).unwrap())
}

fn parts(positions: &[Vec3], indices: &[u32], uvs: &[Vec2]) -> MeshParts {
    MeshParts {
        indices: indices.to_vec(),
        positions: positions.to_vec(),
        uvs: (!uvs.is_empty()).then(|| uvs.to_vec()),
        ..MeshParts::default()
    }
}

fn triangles(positions: &[Vec3], indices: &[u32]) -> Shape {
    let mesh = TriangleMesh::new(parts(positions, indices, &[]), &Transform::IDENTITY, false).unwrap();
    Shape::Triangles(Arc::new(mesh))
}

/// A patch with corners 00, 10, 01, 11.
fn patch(corners: [Vec3; 4], uvs: &[Vec2]) -> Shape {
    let mesh = BilinearMesh::new(parts(&corners, &[0, 1, 2, 3], uvs), &Transform::IDENTITY, false).unwrap();
    Shape::Patches(Arc::new(mesh))
}

/// The rectangle `[-1, 1] × [-0.5, 0.5]` at height 1, facing down.
fn ceiling() -> [Vec3; 4] {
    let p = |x, y| Vec3::new(x, y, 1.0);
    [p(-1.0, -0.5), p(-1.0, 0.5), p(1.0, -0.5), p(1.0, 0.5)]
}

/// A light on `shape` with an image of random brightness of which a part is bright and a part dark.
fn textured(shape: Shape) -> Light {
    let mut rng = Rng::new(7);
    let image = Image::from_fn(8, 6, ["R", "G", "B"], |x, y| match (x + y) % 3 {
        0 => [0.03; 3],
        1 => [0.1 * rng.f32(), 0.2, 0.3 * rng.f32()],
        _ => [10.0 * rng.f32(), 4.0, 2.0],
    })
    .unwrap();
    let radiance = Arc::new(RadianceImage::new(&image, RgbColorSpace::srgb()));
    let distribution = AreaImage::corners(&shape, 0).and_then(|c| AreaImage::distribution(&image, &c));
    let image = AreaImage::new(radiance, distribution.map(Arc::new), &shape, 0);
    let radiance = AreaRadiance::Image(Arc::new(image));
    let emitting = EmittingShape::new(shape, vec![AreaEmission { radiance, scale: 1.0 }], false);
    Light::Area(DiffuseAreaLight::new(Arc::new(emitting), 0))
}

/// A sky of random pixels with a sun.
fn sky() -> Image {
    let mut rng = Rng::new(3);
    Image::from_fn(16, 16, ["R", "G", "B"], |x, y| {
        if (x, y) == (9, 5) { [300.0, 200.0, 100.0] } else { [rng.f32(), rng.f32(), rng.f32()] }
    })
    .unwrap()
}

fn image_sky() -> Light {
    let turn = Transform::rotate(0.8, Vec3::new(1.0, 2.0, -0.5)).unwrap();
    let axis = |v| turn.vector(v);
    let rotation = tenfold_math::Mat3::from_cols(axis(Vec3::X), axis(Vec3::Y), -axis(Vec3::Z));
    Light::from(ImageInfinite::new(rotation, &sky(), RgbColorSpace::srgb(), 0.5))
}

/// Where a ray from `from` toward `wi` first meets the area light `light`.
fn seen(light: &Light, from: &ReferencePoint, wi: Vec3) -> Option<tenfold_geometry::SurfaceInteraction> {
    let Light::Area(l) = light else { return None };
    let ray = from.spawn_ray(wi);
    let primitive = l.primitive();
    let hit = primitive.intersect(&ray, f32::INFINITY, |_| true)?;
    Some(primitive.interaction(&ray, &hit))
}

/// The density of `wi` by everything that a path knows: what it meets, and [`Lights`].
fn density(strategy: LightStrategy, lights: &Lights, from: &ReferencePoint, wi: Vec3) -> f32 {
    let of = |i: usize| {
        let id = tenfold_math::Id::new(i);
        let light = lights.get(id);
        if light.is_sky() {
            return lights.pdf_escaped(strategy, from, id, wi);
        }
        seen(light, from, wi).map_or(0.0, |hit| lights.pdf_hit(strategy, from, id, &hit, wi))
    };
    (0..lights.len()).map(of).sum()
}
