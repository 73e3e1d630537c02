//! What moves, by the name that the scene file gives it.

use crate::{
    camera::{PathTimes, TimeStrategy},
    scene::Scene,
};
use std::{collections::BTreeMap, sync::Arc};
use tenfold_math::{Bounds3, Motion, Vec3};
use tenfold_scene::nearest;

/// The name of the camera among the things that move.
const CAMERA: &str = "camera";

/// The objects of a scene and how they move.
pub type Movers = BTreeMap<String, Mover>;

/// What an object does while the shutter is open.
#[derive(Clone, Debug)]
pub enum Mover {
    /// It stands still wherever it is, or is nowhere.
    Still,
    /// It moves, in this many places.
    Several(usize),
    /// It moves, in one place.
    One(MovingBox),
}

/// The boxes around the shapes of an object that moves.
#[derive(Clone, Debug)]
pub struct MovingBox {
    /// Of the object.
    pub instance: Motion,
    /// The boxes of its shapes, with their own motion in the object.
    pub parts: Vec<(Motion, Bounds3)>,
}

impl MovingBox {
    /// The centre of the object's bounding box, in the object's own space, taken to the world.
    pub fn centre(&self, time: f32) -> Vec3 {
        let boxes = self.parts.iter().map(|(motion, bounds)| motion.at(time).bounds(bounds));
        self.instance.at(time).point(boxes.fold(Bounds3::EMPTY, Bounds3::union).centroid())
    }
}

/// Why something has no path.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PathError {
    /// There is nothing of that name.
    #[error("the scene has no object \"{name}\"; {hint}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// What there is.
        hint: String,
    },
    /// It does not move.
    #[error("\"{0}\" does not move while the shutter is open: it has no path")]
    Still(String),
    /// It moves in several places.
    #[error("\"{name}\" moves in {places} places: the path must be that of one")]
    Several {
        /// The object.
        name: String,
        /// In how many.
        places: usize,
    },
}

impl Scene {
    /// Time sampled uniformly along the path of an object's centre, or of the `camera`.
    ///
    /// # Errors
    /// Where there is no such object, or not one path of it.
    pub fn time_along_path(&self, name: &str) -> Result<TimeStrategy, PathError> {
        let shutter = &self.camera.shutter;
        let path = match self.movers.get(name) {
            _ if name == CAMERA => {
                let motion = &self.camera.world_from_camera;
                PathTimes::new(name, |time| motion.at(time).point(Vec3::ZERO), shutter)
            }
            Some(Mover::One(moving)) => PathTimes::new(name, |time| moving.centre(time), shutter),
            Some(Mover::Several(places)) => {
                return Err(PathError::Several { name: name.to_owned(), places: *places });
            }
            Some(Mover::Still) => None,
            None => return Err(self.unknown(name)),
        };
        let path = path.ok_or_else(|| PathError::Still(name.to_owned()))?;
        Ok(TimeStrategy::Path(Arc::new(path)))
    }

    fn unknown(&self, name: &str) -> PathError {
        let known = || self.movers.keys().map(String::as_str).chain([CAMERA]);
        let hint = match nearest(name, known()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None if self.movers.is_empty() => format!("there is the {CAMERA}"),
            None => {
                let some: Vec<_> = known().take(8).collect();
                format!("there are {}", some.join(", "))
            }
        };
        PathError::Unknown { name: name.to_owned(), hint }
    }
}
