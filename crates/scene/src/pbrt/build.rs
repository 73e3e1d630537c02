//! The description as it grows, under the rules of pbrt's `BasicSceneBuilder` (pbrt book, 4th edition, §C.2).

use super::{
    names::Names,
    state::{Active, AttributeTarget, GraphicsState, Scope, ScopeKind, Transforms},
};
use crate::{
    CameraEntity, ColorSpace, Description, Diagnostic, Diagnostics, Entity, InstanceEntity, LightEntity,
    MaterialEntity, MediumEntity, MediumInterface, ObjectDefinition, ParamSet, ParamType, ParamValues,
    ShapeEntity, Span, TextureEntity, TextureValue,
};
use std::{collections::HashMap, sync::Arc};
use tenfold_math::{Id, Motion, Transform};

/// How deep scopes may lie in each other.
const MAX_SCOPES: usize = 65_536;

/// A directive's place, the name of its type and its parameters.
pub(super) struct Given {
    /// The whole directive.
    pub(super) span: Span,
    /// The name of the type.
    pub(super) kind: String,
    pub(super) kind_span: Span,
    pub(super) params: ParamSet,
}

pub(super) struct Builder<'a> {
    pub(super) description: Description,
    pub(super) state: GraphicsState,
    diagnostics: &'a Diagnostics,
    scopes: Vec<Scope>,
    /// The scopes that were open where the current import began; they cannot be closed in it.
    floor: usize,
    in_world: bool,
    complained_of_world: bool,
    transform_times: Vec<f32>,
    /// Where `ActiveTransform` first told keys apart.
    keys_told_apart: Option<Span>,
    coordinate_systems: HashMap<String, Transforms>,
    materials: Names<MaterialEntity>,
    media: Names<MediumEntity>,
    objects: Names<ObjectDefinition>,
    textures: HashMap<(String, TextureValue), Span>,
    /// The object that is being defined, and whether it is to be thrown away.
    open_object: Option<(ObjectDefinition, bool)>,
}

/// What an import must leave as it was.
pub(super) struct ImportScope {
    state: GraphicsState,
    floor: usize,
    coordinate_systems: HashMap<String, Transforms>,
}

fn no_params(span: Span) -> ParamSet {
    ParamSet { span, params: Vec::new(), defaults: Arc::default() }
}

fn entity(kind: &str, span: Span) -> Entity {
    let (kind, color_space) = (kind.to_owned(), ColorSpace::default());
    Entity { kind, kind_span: span, params: no_params(span), span, color_space }
}

impl<'a> Builder<'a> {
    /// A scene without anything, of a file that begins at `start`.
    pub(super) fn new(diagnostics: &'a Diagnostics, start: Span) -> Self {
        let mut materials = Names::new();
        let default = MaterialEntity { name: None, entity: entity("diffuse", start) };
        let material = materials.add(default, start);
        Self {
            description: Description::default(),
            state: GraphicsState {
                transforms: Transforms::Same(Transform::IDENTITY),
                active: Active::All,
                color_space: ColorSpace::default(),
                reverse_orientation: false,
                material,
                area_light: None,
                media: MediumInterface::default(),
                attributes: Default::default(),
            },
            diagnostics,
            scopes: Vec::new(),
            floor: 0,
            in_world: false,
            complained_of_world: false,
            transform_times: vec![0.0, 1.0],
            keys_told_apart: None,
            coordinate_systems: HashMap::new(),
            materials,
            media: Names::new(),
            objects: Names::new(),
            textures: HashMap::new(),
            open_object: None,
        }
    }

    pub(super) fn in_world(&self) -> bool {
        self.in_world
    }

    /// Whether a directive of the options stands where it may; reports it otherwise.
    pub(super) fn check_options(&self, directive: &str, span: Span) -> bool {
        if self.in_world {
            self.diagnostics.error(span, format!("{directive} is allowed before WorldBegin only"));
        }
        !self.in_world
    }

    /// Reports a directive of the world that stands before `WorldBegin`, the first one only.
    pub(super) fn check_world(&mut self, directive: &str, span: Span) {
        if !self.in_world && !self.complained_of_world {
            self.complained_of_world = true;
            self.diagnostics.error(span, format!("{directive} is allowed after WorldBegin only"));
        }
    }

    pub(super) fn world_begin(&mut self, span: Span) {
        if !self.check_options("WorldBegin", span) {
            return;
        }
        self.in_world = true;
        self.state.transforms = Transforms::Same(Transform::IDENTITY);
        self.state.active = Active::All;
        self.coordinate_systems.insert("world".to_owned(), self.state.transforms.clone());
    }

    // Transforms.

    fn motion(&self) -> Motion {
        self.state.transforms.motion(&self.transform_times)
    }

    /// Lets the active transforms become what `change` makes of them. What has no finite inverse is reported.
    pub(super) fn transform(&mut self, span: Span, change: impl Fn(Transform) -> Transform) {
        let mut faulty = false;
        let transforms =
            self.state.transforms.map(self.transform_times.len(), self.state.active, |current| {
                let changed = change(current);
                let good = changed.affine().is_finite() && changed.inverse_affine().is_finite();
                faulty |= !good;
                if good { changed } else { current }
            });
        self.state.transforms = transforms;
        if faulty {
            self.diagnostics.error(span, "with this, the current transform leaves the range of numbers");
        }
    }

    /// Sets the times of the keys, of which there are two or more.
    pub(super) fn set_transform_times(&mut self, times: Vec<f32>, span: Span) {
        if !self.check_options("TransformTimes", span) {
            return;
        }
        match self.keys_told_apart {
            Some(apart) if times.len() != self.transform_times.len() => {
                let (new, old) = (times.len(), self.transform_times.len());
                let message =
                    format!("TransformTimes with {new} keys after ActiveTransform told {old} apart");
                self.diagnostics.push(
                    Diagnostic::error(span, message)
                        .with_note(apart, "this is the first one: TransformTimes belongs before it"),
                );
            }
            _ => self.transform_times = times,
        }
    }

    /// How many keys there are.
    pub(super) fn key_count(&self) -> usize {
        self.transform_times.len()
    }

    /// Sets which transforms change.
    pub(super) fn activate(&mut self, active: Active, span: Span) {
        self.state.active = active;
        if active != Active::All {
            self.keys_told_apart.get_or_insert(span);
        }
    }

    pub(super) fn name_coordinate_system(&mut self, name: String) {
        self.coordinate_systems.insert(name, self.state.transforms.clone());
    }

    pub(super) fn use_coordinate_system(&mut self, name: &str, span: Span) {
        match self.coordinate_systems.get(name) {
            Some(transforms) => self.state.transforms = transforms.clone(),
            None => {
                let mut known: Vec<_> = self.coordinate_systems.keys().map(String::as_str).collect();
                known.sort_unstable();
                let message =
                    format!("coordinate system \"{name}\" is not defined: the directive does nothing");
                self.diagnostics.push(Diagnostic::warning(span, message).with_nearest(name, known));
            }
        }
    }

    // Scopes.

    fn open_scope(&mut self, kind: ScopeKind, span: Span) {
        if self.scopes.len() == MAX_SCOPES {
            self.diagnostics.error(span, format!("scopes lie in each other more than {MAX_SCOPES} deep"));
        }
        if self.scopes.len() < MAX_SCOPES {
            self.scopes.push(Scope { kind, span, state: self.state.clone() });
        }
    }

    pub(super) fn attribute_begin(&mut self, span: Span) {
        self.open_scope(ScopeKind::Attribute, span);
    }

    pub(super) fn attribute_end(&mut self, directive: &str, span: Span) {
        let open = self.scopes.len() > self.floor;
        match self.scopes.last() {
            Some(scope) if open && scope.kind == ScopeKind::Attribute => {
                if let Some(scope) = self.scopes.pop() {
                    self.state = scope.state;
                }
            }
            Some(scope) if open => self.diagnostics.push(
                Diagnostic::error(span, format!("{directive} inside an object's definition closes nothing"))
                    .with_note(scope.span, "the object begins here"),
            ),
            _ => self.diagnostics.error(span, format!("{directive} closes nothing")),
        }
    }

    pub(super) fn object_begin(&mut self, name: String, name_span: Span, span: Span) {
        let scopes = self.scopes.len();
        if let Some((outer, _)) = &self.open_object {
            self.diagnostics.push(
                Diagnostic::error(span, "ObjectBegin inside an object's definition")
                    .with_note(outer.span, "the outer object begins here"),
            );
            self.open_scope(ScopeKind::NestedObject, span);
            return;
        }
        let earlier = self.objects.definition(&name);
        if let Some(earlier) = earlier {
            self.redefined("object", &name, name_span, earlier);
        }
        self.open_scope(ScopeKind::Object, span);
        if self.scopes.len() > scopes {
            let definition = ObjectDefinition { name, shapes: Vec::new(), span };
            self.open_object = Some((definition, earlier.is_some()));
        }
    }

    pub(super) fn object_end(&mut self, span: Span) {
        let open = &self.scopes[self.floor..];
        let Some(object) = open.iter().rposition(|scope| scope.kind != ScopeKind::Attribute) else {
            self.diagnostics.error(span, "ObjectEnd closes nothing");
            return;
        };
        if let Some(scope) = open.get(object + 1) {
            self.diagnostics.push(
                Diagnostic::error(span, "ObjectEnd before the end of an attribute scope")
                    .with_note(scope.span, "AttributeEnd is missing for this"),
            );
        }
        self.scopes.truncate(self.floor + object + 1);
        if let Some(scope) = self.scopes.pop() {
            self.state = scope.state;
            if scope.kind == ScopeKind::Object {
                self.close_object();
            }
        }
    }

    fn close_object(&mut self) {
        if let Some((object, throw_away)) = self.open_object.take()
            && !throw_away
        {
            let (name, span) = (object.name.clone(), object.span);
            self.objects.define(&name, object, span);
        }
    }

    /// Reports and closes all scopes above the floor.
    fn close_scopes(&mut self) {
        while self.scopes.len() > self.floor {
            let Some(scope) = self.scopes.pop() else { break };
            let (begin, end) = match scope.kind {
                ScopeKind::Attribute => ("AttributeBegin", "AttributeEnd"),
                ScopeKind::Object | ScopeKind::NestedObject => ("ObjectBegin", "ObjectEnd"),
            };
            self.diagnostics.error(scope.span, format!("{begin} has no {end} in this file"));
            if scope.kind == ScopeKind::Object {
                self.close_object();
            }
        }
    }

    /// An import starts with a copy of the state. Named coordinate systems are part of it, and those it names end with it; in
    /// pbrt it cannot see the ones of the file around it.
    pub(super) fn begin_import(&mut self) -> ImportScope {
        let floor = std::mem::replace(&mut self.floor, self.scopes.len());
        ImportScope { state: self.state.clone(), floor, coordinate_systems: self.coordinate_systems.clone() }
    }

    pub(super) fn end_import(&mut self, scope: ImportScope) {
        self.close_scopes();
        self.floor = scope.floor;
        self.state = scope.state;
        self.coordinate_systems = scope.coordinate_systems;
    }

    // Entities.

    fn redefined(&self, what: &str, name: &str, span: Span, earlier: Span) {
        self.diagnostics.push(
            Diagnostic::error(span, format!("{what} \"{name}\" is defined twice"))
                .with_note(earlier, "the first definition is here"),
        );
    }

    /// Adds default parameters for a family of entities.
    pub(super) fn attribute(&mut self, target: AttributeTarget, params: ParamSet) {
        let color_space = self.state.color_space;
        let attributes = Arc::make_mut(&mut self.state.attributes[target as usize]);
        attributes.extend(params.params.into_iter().map(|mut param| {
            param.color_space = Some(color_space);
            param
        }));
    }

    fn entity(&self, given: Given, family: Option<AttributeTarget>) -> Entity {
        let Given { span, kind, kind_span, mut params } = given;
        if let Some(family) = family {
            params.defaults = self.state.attributes[family as usize].clone();
        }
        Entity { kind, kind_span, params, span, color_space: self.state.color_space }
    }

    /// Sets something of the options, such as the film.
    pub(super) fn set(
        &mut self,
        directive: &str,
        given: Given,
        place: fn(&mut Description) -> &mut Option<Entity>,
    ) {
        if !self.check_options(directive, given.span) {
            return;
        }
        let entity = self.entity(given, None);
        let span = entity.span;
        if let Some(earlier) = place(&mut self.description).replace(entity) {
            self.replaced(directive, span, earlier.span);
        }
    }

    fn replaced(&self, directive: &str, span: Span, earlier: Span) {
        self.diagnostics.push(
            Diagnostic::warning(span, format!("this {directive} replaces an earlier one"))
                .with_note(earlier, "the earlier one is here"),
        );
    }

    pub(super) fn camera(&mut self, given: Given) {
        if !self.check_options("Camera", given.span) {
            return;
        }
        // The current transform takes the world to the camera.
        let world_from_camera =
            self.state.transforms.map(self.key_count(), Active::All, |transform| transform.inverse());
        let motion = world_from_camera.motion(&self.transform_times);
        self.coordinate_systems.insert("camera".to_owned(), world_from_camera);
        let medium = self.state.media.outside;
        medium.into_iter().for_each(|id| self.media.need(id));
        let entity = self.entity(given, None);
        let span = entity.span;
        let camera = CameraEntity { entity, world_from_camera: motion, medium };
        if let Some(earlier) = self.description.camera.replace(camera) {
            self.replaced("Camera", span, earlier.entity.span);
        }
    }

    pub(super) fn shape(&mut self, given: Given) {
        let span = given.span;
        let entity = self.entity(given, Some(AttributeTarget::Shape));
        let GraphicsState { reverse_orientation, material, mut area_light, media, .. } = self.state;
        self.materials.need(material);
        media.inside.into_iter().chain(media.outside).for_each(|id| self.media.need(id));
        if self.open_object.is_some() && area_light.take().is_some() {
            self.diagnostics
                .warning(span, "shapes of objects do not emit, in pbrt as here: the light is ignored");
        }
        let motion = self.motion();
        let shape = ShapeEntity { entity, motion, reverse_orientation, material, area_light, media };
        match &mut self.open_object {
            Some((object, _)) => object.shapes.push(shape),
            None => self.description.shapes.push(shape),
        }
    }

    pub(super) fn object_instance(&mut self, name: &str, name_span: Span, span: Span) {
        if let Some((object, _)) = &self.open_object {
            self.diagnostics.push(
                Diagnostic::error(span, "ObjectInstance inside an object's definition")
                    .with_note(object.span, "the object begins here"),
            );
            return;
        }
        let object = self.objects.refer(name, name_span);
        self.objects.need(object);
        let motion = self.motion();
        self.description.instances.push(InstanceEntity { object, motion, span });
    }

    pub(super) fn light(&mut self, given: Given) {
        let entity = self.entity(given, Some(AttributeTarget::Light));
        let medium = self.state.media.outside;
        medium.into_iter().for_each(|id| self.media.need(id));
        let motion = self.motion();
        self.description.lights.push(LightEntity { entity, motion, medium });
    }

    pub(super) fn area_light(&mut self, given: Given) {
        // As in pbrt, an empty name ends the emission.
        self.state.area_light = if given.kind.is_empty() {
            None
        } else {
            let entity = self.entity(given, Some(AttributeTarget::Light));
            self.description.area_lights.push(entity);
            Some(Id::new(self.description.area_lights.len() - 1))
        };
    }

    pub(super) fn texture(&mut self, name: String, name_span: Span, value: TextureValue, given: Given) {
        let key = (name.clone(), value);
        if let Some(&earlier) = self.textures.get(&key) {
            self.redefined("texture", &name, name_span, earlier);
            return;
        }
        self.textures.insert(key, name_span);
        let entity = self.entity(given, Some(AttributeTarget::Texture));
        let motion = self.motion();
        self.description.textures.push(TextureEntity { name, value, entity, motion });
    }

    pub(super) fn material(&mut self, given: Given) {
        let entity = self.entity(given, Some(AttributeTarget::Material));
        let span = entity.span;
        self.state.material = self.materials.add(MaterialEntity { name: None, entity }, span);
    }

    /// `given.kind` is the name; the type is a parameter.
    pub(super) fn make_named_material(&mut self, given: Given) {
        let (name, span) = (given.kind.clone(), given.kind_span);
        if let Some(earlier) = self.materials.definition(&name) {
            return self.redefined("material", &name, span, earlier);
        }
        let entity = self.entity(given, Some(AttributeTarget::Material));
        let entity = self.with_type_parameter("material", entity);
        self.materials.define(&name, MaterialEntity { name: Some(name.clone()), entity }, span);
    }

    pub(super) fn named_material(&mut self, name: &str, span: Span) {
        self.state.material = self.materials.refer(name, span);
    }

    /// `given.kind` is the name; the type is a parameter.
    pub(super) fn make_named_medium(&mut self, given: Given) {
        let (name, span) = (given.kind.clone(), given.kind_span);
        if let Some(earlier) = self.media.definition(&name) {
            return self.redefined("medium", &name, span, earlier);
        }
        let entity = self.entity(given, Some(AttributeTarget::Medium));
        let entity = self.with_type_parameter("medium", entity);
        let motion = self.motion();
        self.media.define(&name, MediumEntity { name: name.clone(), entity, motion }, span);
    }

    pub(super) fn medium_interface(&mut self, inside: (&str, Span), outside: (&str, Span)) {
        // An empty name is vacuum.
        let mut medium =
            |(name, span): (&str, Span)| (!name.is_empty()).then(|| self.media.refer(name, span));
        self.state.media = MediumInterface { inside: medium(inside), outside: medium(outside) };
    }

    /// Makes the parameter `type` the type of an entity.
    fn with_type_parameter(&self, what: &str, mut entity: Entity) -> Entity {
        let found = entity.params.get("type").map(|p| (p.ty, p.values.clone(), p.value_span));
        let name = std::mem::take(&mut entity.kind);
        match found {
            Some((ParamType::String, ParamValues::Strings(mut v), span)) if v.len() == 1 => {
                entity.kind = v.swap_remove(0);
                entity.kind_span = span;
            }
            Some((_, _, span)) => {
                let message = format!("the parameter \"type\" of {what} \"{name}\" must be one string");
                self.diagnostics.error(span, message);
            }
            None => {
                let message = format!("{what} \"{name}\" has no parameter \"string type\"");
                self.diagnostics.error(entity.kind_span, message);
            }
        }
        entity.params.params.retain(|p| p.name != "type");
        entity
    }

    /// The scene, at the end of the files.
    pub(super) fn finish(mut self, last: Span) -> Description {
        self.close_scopes();
        if !self.in_world {
            let end = Span { start: last.end, ..last };
            self.diagnostics.error(end, "the file ends without WorldBegin");
        }
        let mut description = self.description;
        let diagnostics = self.diagnostics;
        (description.materials, description.material_names) =
            self.materials.finish("material", diagnostics, |name, span| MaterialEntity {
                name: Some(name.to_owned()),
                entity: entity("diffuse", span),
            });
        (description.media, _) = self.media.finish("medium", diagnostics, |name, span| MediumEntity {
            name: name.to_owned(),
            entity: entity("homogeneous", span),
            motion: Motion::default(),
        });
        (description.objects, _) = self.objects.finish("object", diagnostics, |name, span| {
            ObjectDefinition { name: name.to_owned(), shapes: Vec::new(), span }
        });
        description
    }
}
