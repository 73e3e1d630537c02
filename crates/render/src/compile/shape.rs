//! Compiles shapes, objects and their instances.

use super::{
    context::Context,
    light::{AreaEmitter, compile_area_light},
    mesh,
    mesh_files::MeshFiles,
    mover::find_movers,
    texture::TextureLibrary,
};
use crate::{
    camera::Shutter,
    light::Light,
    material::{Material, Materials},
    movers::Movers,
    scene::{Surface, SurfaceLights},
    texture::FloatSlot,
};
use std::{collections::HashMap, f32::consts::TAU};
use tenfold_geometry::{
    Cylinder, CylinderParams, Disk, DiskParams, Geometry, Group, Instance, Shape, ShapeError, Sphere,
    SphereParams, World, WorldDesc,
};
use tenfold_math::{Id, Transform};
use tenfold_scene::{AreaLightId, Description, Params, ShapeEntity};

/// pbrt-v4's shapes.
const KNOWN: [&str; 8] =
    ["bilinearmesh", "curve", "cylinder", "disk", "loopsubdiv", "plymesh", "sphere", "trianglemesh"];

/// The shapes of a scene, compiled.
pub(super) struct Shapes {
    geometries: Vec<Geometry>,
    instances: Vec<Instance>,
    pub(super) surfaces: Vec<Surface>,
}

impl Shapes {
    /// Compiles all shapes; those that emit add to `lights`.
    pub(super) fn compile<'s>(
        cx: &mut Context<'_>,
        description: &'s Description,
        materials: &Materials,
        textures: &mut TextureLibrary<'s>,
        lights: &mut Vec<Light>,
    ) -> Self {
        cx.meshes = MeshFiles::read(description, cx.resources);
        let mut compiler = Compiler {
            cx,
            description,
            materials,
            textures,
            lights,
            emitters: HashMap::new(),
            shapes: Self { geometries: Vec::new(), instances: Vec::new(), surfaces: Vec::new() },
        };
        for entity in &description.shapes {
            compiler.add(entity, None);
        }
        for (i, object) in description.objects.iter().enumerate() {
            for entity in &object.shapes {
                compiler.add(entity, Some(Id::new(i)));
            }
        }
        compiler.shapes.instances = description
            .instances
            .iter()
            .map(|i| Instance { group: Id::new(i.object.index()), motion: i.motion.clone() })
            .collect();
        compiler.shapes
    }

    /// How the objects move; asked before the hierarchies are built.
    pub(super) fn movers(&self, description: &Description) -> Movers {
        find_movers(description, &self.geometries)
    }

    /// Builds the hierarchies; the surfaces are what is left.
    pub(super) fn world(&mut self, cx: &Context<'_>, shutter: &Shutter) -> Option<World> {
        let built = World::build(WorldDesc {
            geometries: std::mem::take(&mut self.geometries),
            instances: std::mem::take(&mut self.instances),
            shutter: [shutter.open, shutter.close],
        });
        built.map_err(|error| cx.diagnostics.error(None, error.to_string())).ok()
    }
}

struct Compiler<'c, 'a, 's> {
    cx: &'c mut Context<'a>,
    description: &'s Description,
    materials: &'c Materials,
    textures: &'c mut TextureLibrary<'s>,
    lights: &'c mut Vec<Light>,
    /// Emissions compiled so far: several shapes may share one.
    emitters: HashMap<AreaLightId, Option<AreaEmitter>>,
    shapes: Shapes,
}

impl Compiler<'_, '_, '_> {
    fn add(&mut self, entity: &ShapeEntity, group: Option<Id<Group>>) {
        let params = &entity.entity.params("shape", self.cx.diagnostics);
        let alpha = self.textures.float(self.cx, params, "alpha");
        // What moves stays in its own space; what stands still is placed once and for all.
        let moving = entity.motion.is_moving();
        let place = if moving { Transform::IDENTITY } else { *entity.motion.start() };
        // What a shape of an unknown kind may be told is unknown, too.
        let Some(compiled) = self.shape(entity, params, &place) else { return };
        params.finish(&["emissionfilename"]);
        if !compiled.is_empty() && compiled.iter().all(has_no_area) {
            self.cx.diagnostics.error(entity.entity.kind_span, "the mesh has no area: no ray can meet it");
        }
        for shape in compiled {
            if shape.is_empty() {
                continue;
            }
            let surface = self.surface(entity, &shape, alpha, moving);
            self.shapes.geometries.push(Geometry {
                shape,
                motion: moving.then(|| entity.motion.clone()),
                group,
                user: self.shapes.surfaces.len() as u32,
                masked: surface.may_be_passed(self.materials),
            });
            self.shapes.surfaces.push(surface);
        }
    }

    /// The look of a shape. Its lights, if any, come to stand one after another.
    fn surface(
        &mut self,
        entity: &ShapeEntity,
        shape: &Shape,
        alpha: Option<FloatSlot>,
        moving: bool,
    ) -> Surface {
        let alpha = alpha.filter(|a| a.constant().is_none_or(|a| a < 1.0));
        let material: Id<Material> = Id::new(entity.material.index());
        let lights = entity.area_light.and_then(|light| self.emit(light, entity, shape, alpha, moving));
        Surface { material, lights, alpha }
    }

    fn emit(
        &mut self,
        light: AreaLightId,
        entity: &ShapeEntity,
        shape: &Shape,
        alpha: Option<FloatSlot>,
        moving: bool,
    ) -> Option<SurfaceLights> {
        let emission = &self.description.area_lights[light.index()];
        if moving {
            self.cx.unsupported(entity.entity.span, "an area light on a moving shape");
            return None;
        }
        let invisible = match alpha.as_ref().map(FloatSlot::constant) {
            None => false,
            Some(Some(0.0)) => true,
            Some(_) => {
                self.cx.unsupported(entity.entity.span, "an area light on a shape with an alpha mask");
                return None;
            }
        };
        let cx = &mut *self.cx;
        let emitter = self.emitters.entry(light).or_insert_with(|| compile_area_light(cx, emission));
        let first = Id::new(self.lights.len());
        let (lights, primitives_each) = emitter.as_ref()?.lights(shape, invisible);
        self.lights.extend(lights);
        Some(SurfaceLights { first, primitives_each })
    }

    /// The shape, in up to two parts: the triangles and the quadrilaterals of a mesh. `None` for a kind that is not there.
    fn shape(&mut self, entity: &ShapeEntity, params: &Params<'_>, place: &Transform) -> Option<Vec<Shape>> {
        let reverse = entity.reverse_orientation;
        let quadric = |shape: Result<Shape, ShapeError>| match shape {
            Ok(shape) => vec![shape],
            Err(error) => {
                let ShapeError::Parameter { parameter, .. } = &error;
                params.error(parameter, error.to_string());
                Vec::new()
            }
        };
        let phi_max = |params: &Params<'_>| params.one_float("phimax", 360.0).clamp(0.0, 360.0) / 360.0 * TAU;
        Some(match entity.entity.kind.as_str() {
            "sphere" => {
                let radius = params.one_float("radius", 1.0);
                let sphere = SphereParams {
                    radius,
                    z_min: params.one_float("zmin", -radius),
                    z_max: params.one_float("zmax", radius),
                    phi_max: phi_max(params),
                };
                quadric(Sphere::new(*place, reverse, sphere).map(Shape::Sphere))
            }
            "disk" => {
                let disk = DiskParams {
                    height: params.one_float("height", 0.0),
                    radius: params.one_float("radius", 1.0),
                    inner_radius: params.one_float("innerradius", 0.0),
                    phi_max: phi_max(params),
                };
                quadric(Disk::new(*place, reverse, disk).map(Shape::Disk))
            }
            "cylinder" => {
                let cylinder = CylinderParams {
                    radius: params.one_float("radius", 1.0),
                    z_min: params.one_float("zmin", -1.0),
                    z_max: params.one_float("zmax", 1.0),
                    phi_max: phi_max(params),
                };
                quadric(Cylinder::new(*place, reverse, cylinder).map(Shape::Cylinder))
            }
            "trianglemesh" => mesh::triangle_mesh(params, place, reverse).into_iter().collect(),
            "bilinearmesh" => {
                if params.has("emissionfilename") {
                    let span = params.span_of("emissionfilename");
                    self.cx.unsupported(span, "the parameter \"emissionfilename\"");
                }
                mesh::bilinear_mesh(params, place, reverse).into_iter().collect()
            }
            "plymesh" => mesh::ply_mesh(self.cx, params, place, reverse),
            "loopsubdiv" => mesh::loop_subdivision(params, place, reverse).into_iter().collect(),
            kind if KNOWN.contains(&kind) => {
                self.cx.unsupported(entity.entity.kind_span, &format!("shape \"{kind}\""));
                return None;
            }
            kind => {
                self.cx.unknown_kind(entity.entity.kind_span, "shape", kind, KNOWN);
                return None;
            }
        })
    }
}

/// Whether a mesh, though it has primitives, has nothing that a ray can meet: its numbers are not what they were meant to be.
fn has_no_area(shape: &Shape) -> bool {
    match shape {
        Shape::Sphere(_) | Shape::Disk(_) | Shape::Cylinder(_) => false,
        Shape::Triangles(mesh) => !mesh.is_empty() && mesh.has_no_area(),
        Shape::Patches(mesh) => !mesh.is_empty() && (0..mesh.len()).all(|i| shape.primitive(i).area() == 0.0),
    }
}
