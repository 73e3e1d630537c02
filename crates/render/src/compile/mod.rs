//! From a scene's description to a scene that renders.
//!
//! Everything is checked here and nothing later: the compile step reports every fault it finds with its place, and gives a
//! [`Scene`] only where there is none.

mod camera;
mod coarsen;
mod context;
mod film;
mod light;
mod material;
mod mesh;
mod mesh_files;
mod mover;
mod settings;
mod shape;
mod texture;

use crate::{light::Lights, scene::Scene};
pub use coarsen::coarsen;
use context::Context;
pub use film::crop_window;
use shape::Shapes;
use tenfold_scene::{Description, Diagnostics, Resources};
use texture::TextureLibrary;

/// Compiles a description; files that it names come from `resources`. Faults go to `diagnostics`; any error among them, also
/// one reported before, leaves no scene.
pub fn compile(
    description: &Description,
    resources: &dyn Resources,
    diagnostics: &Diagnostics,
) -> Option<Scene> {
    let cx = &mut Context::new(diagnostics, resources);
    settings::check_options(cx, description);
    let film = film::compile_film(cx, description.film.as_ref());
    let filter = film::compile_filter(cx, description.filter.as_ref());
    let sampler = film::compile_sampler(cx, description.sampler.as_ref());
    let integrator = settings::compile_integrator(cx, description);
    let camera = match (&description.camera, &film) {
        (Some(entity), Some(film)) => camera::compile_camera(cx, entity, film.resolution),
        (None, _) => {
            diagnostics.error(None, "the scene has no camera");
            None
        }
        _ => None,
    };

    let mut textures = TextureLibrary::new(description);
    textures.read_images(cx);
    let materials = material::compile_materials(cx, description, &mut textures);
    let mut lights: Vec<_> =
        description.lights.iter().filter_map(|entity| light::compile_light(cx, entity)).collect();
    let mut shapes = Shapes::compile(cx, description, &materials, &mut textures, &mut lights);
    let textures = textures.finish(cx);

    let (mut film, camera) = (film?, camera?);
    film::expose(&mut film, description.film.as_ref(), &camera.shutter);
    if diagnostics.has_errors() {
        return None;
    }
    let movers = shapes.movers(description);
    let world = shapes.world(cx, &camera.shutter)?;
    let lights = Lights::build(lights);
    Some(Scene {
        needs_footprint: textures.need_footprint(),
        camera,
        filter: filter?,
        film,
        world,
        surfaces: shapes.surfaces,
        movers,
        materials,
        textures,
        lights,
        max_depth: integrator.max_depth,
        sampler,
    })
}
