//! Finds the objects that move.

use crate::movers::{Mover, Movers, MovingBox};
use tenfold_geometry::{Geometry, Shape};
use tenfold_math::{Bounds3, Motion};
use tenfold_scene::{Description, InstanceEntity};

/// What the named objects do, whose shapes are among `geometries`.
pub(super) fn find_movers(description: &Description, geometries: &[Geometry]) -> Movers {
    let mut objects = vec![Object::default(); description.objects.len()];
    for instance in &description.instances {
        objects[instance.object.index()].instances.push(instance);
    }
    for geometry in geometries {
        if let Some(group) = geometry.group {
            objects[group.index()].shapes.push(geometry);
        }
    }
    description.objects.iter().zip(&objects).map(|(object, of)| (object.name.clone(), of.mover())).collect()
}

/// Where an object is, and what it is made of.
#[derive(Clone, Default)]
struct Object<'a> {
    instances: Vec<&'a InstanceEntity>,
    shapes: Vec<&'a Geometry>,
}

impl Object<'_> {
    fn mover(&self) -> Mover {
        let moves_itself = self.shapes.iter().any(|shape| shape.motion.is_some());
        let moving: Vec<_> =
            self.instances.iter().filter(|instance| moves_itself || instance.motion.is_moving()).collect();
        match moving[..] {
            [] => Mover::Still,
            [instance] => Mover::One(MovingBox { instance: instance.motion.clone(), parts: self.parts() }),
            _ => Mover::Several(moving.len()),
        }
    }

    fn parts(&self) -> Vec<(Motion, Bounds3)> {
        let still = self.shapes.iter().filter(|shape| shape.motion.is_none());
        let still = still.fold(Bounds3::EMPTY, |all, geometry| all.union(bounds(&geometry.shape)));
        let moving = self.shapes.iter().filter_map(|g| Some((g.motion.clone()?, bounds(&g.shape))));
        moving.chain([(Motion::default(), still)]).collect()
    }
}

fn bounds(shape: &Shape) -> Bounds3 {
    (0..shape.len()).fold(Bounds3::EMPTY, |all, i| all.union(shape.primitive(i).bounds()))
}
