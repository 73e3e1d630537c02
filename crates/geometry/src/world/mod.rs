//! Everything that rays can hit, immutable once built.

mod few;
mod hierarchies;
mod plain;
mod search;

use crate::{
    Candidate, Hit, InstanceId, Primitive, PrimitiveId, Shape, ShapeHit, SurfaceInteraction,
    bvh::{Course, Level, RayCourses},
    interaction::toward_origin,
};
use few::Few;
use hierarchies::Hierarchies;
use search::Search;
use std::array::from_fn;
use tenfold_math::{Bounds3, Floats, Id, Motion, Ray, Rays, Slots, Transform, Vec2, Vec3, WIDTH};

/// A shape in a world: what [`PrimitiveId::geometry`] names.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// The shape, in world space; in that of its group where it has one; before its motion where it moves.
    pub shape: Shape,
    /// How it moves, if it does.
    pub motion: Option<Motion>,
    /// The group it belongs to; `None` for the world itself. Geometries of groups are seen only through instances.
    pub group: Option<Id<Group>>,
    /// Whatever the renderer wants to find again.
    pub user: u32,
    /// Whether rays ask their filter before they hit it (for masks of opacity).
    pub masked: bool,
}

/// Names a set of geometries that instances place together.
#[derive(Copy, Clone, Debug)]
pub struct Group;

/// A placement of a group in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// What is placed.
    pub group: Id<Group>,
    /// Where, and how it moves.
    pub motion: Motion,
}

/// What a [`World`] is built from.
#[derive(Clone, Debug, Default)]
pub struct WorldDesc {
    /// The geometries: [`PrimitiveId::geometry`] counts in this order.
    pub geometries: Vec<Geometry>,
    /// The instances.
    pub instances: Vec<Instance>,
    /// First and last time of any ray.
    pub shutter: [f32; 2],
}

/// Why a world cannot be built.
#[derive(Copy, Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WorldError {
    /// There are more primitives or instances than indices.
    #[error("{count} {what} are too many")]
    TooLarge {
        /// Of what there are too many.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
}

/// What was built, in numbers.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct WorldStats {
    /// Primitives in the hierarchies; those of a group count once.
    pub primitives: usize,
    /// Triangles without area, which no ray can hit: left out.
    pub degenerate: usize,
    /// Placements of groups and of moving geometries.
    pub instances: usize,
    /// Nodes of all hierarchies.
    pub nodes: usize,
    /// Memory of all hierarchies in bytes, without the meshes.
    pub bytes: usize,
}

/// Hierarchies of so many nodes are slow enough to load that going through them with several rays at once is worth what it takes.
const INTERLEAVED_FROM: usize = 1 << 17;
/// And with so many rays.
const FEWEST_AT_ONCE: usize = 4;

/// How rays in slots go through the hierarchy.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Company {
    /// One after another.
    Alone,
    /// At once, each in order: where nodes are slow to load.
    Interleaved,
    /// At once, in no order: where most pass what they come to.
    Streaming,
}

/// Everything that rays can hit.
#[derive(Debug)]
pub struct World {
    geometries: Vec<Geometry>,
    hierarchies: Hierarchies,
    few: Option<Few>,
    company: Company,
    level: Level,
    bounds: Bounds3,
    stats: WorldStats,
}

impl World {
    /// Builds the hierarchies. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// Where there is more than 30-bit indices can name.
    pub fn build(desc: WorldDesc) -> Result<Self, WorldError> {
        let (hierarchies, stats) = Hierarchies::build(&desc)?;
        let bounds = hierarchies.top.bounds();
        let few = if desc.instances.is_empty() { Few::of(&desc.geometries) } else { None };
        let company = match &hierarchies.top {
            top if top.is_sparse() => Company::Streaming,
            top if top.node_count() >= INTERLEAVED_FROM => Company::Interleaved,
            _ => Company::Alone,
        };
        let level = Level::detect();
        Ok(Self { geometries: desc.geometries, hierarchies, few, company, level, bounds, stats })
    }

    /// The same world without vector instructions in its hierarchies: it answers with the same bits.
    #[must_use]
    pub fn portable(mut self) -> Self {
        self.level = Level::Portable;
        self
    }

    /// The same world, whose rays in slots go through the hierarchy at once, however small it is: it answers with the same bits.
    #[must_use]
    pub fn interleaved(mut self) -> Self {
        (self.few, self.company) = (None, Company::Interleaved);
        self
    }

    /// The same world, whose rays in slots go through the hierarchy at once and in no order, whatever is in it: it answers with the same bits.
    #[must_use]
    pub fn streaming(mut self) -> Self {
        (self.few, self.company) = (None, Company::Streaming);
        self
    }

    /// A box around everything at all times of the shutter.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Whether anything moves, so that it matters when rays are.
    pub fn is_moving(&self) -> bool {
        self.hierarchies.placements.iter().any(|placement| placement.is_moving())
    }

    /// What was built, in numbers.
    pub fn stats(&self) -> &WorldStats {
        &self.stats
    }

    /// A geometry.
    #[inline]
    pub fn geometry(&self, id: Id<Geometry>) -> &Geometry {
        &self.geometries[id.index()]
    }

    /// A primitive, in the space of its shape.
    #[inline]
    pub fn primitive(&self, id: PrimitiveId) -> Primitive<'_> {
        self.geometries[id.geometry.index()].shape.primitive(id.index as usize)
    }

    /// The closest hit with `0 < t < t_max`, of those that `filter` accepts; of hits at the same distance that of the first primitive. The filter is asked about masked
    /// geometries only, and not only about the closest hits.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32, filter: impl Fn(&Candidate<'_>) -> bool) -> Option<Hit> {
        self.query::<false>(ray, t_max, filter)
    }

    /// [`World::intersect`] for the rays in `slots`, with no limit to their way; `hits` of other slots stay as they are. The filter is told the slot.
    pub fn intersect_slots(
        &self,
        slots: Slots,
        rays: &Rays,
        courses: &mut RayCourses,
        filter: impl Fn(usize, &Candidate<'_>) -> bool,
        hits: &mut [Option<Hit>; WIDTH],
    ) {
        courses.prepare(rays);
        if let Some(few) = &self.few {
            return few.intersect(&self.geometries, slots, rays, courses, hits);
        }
        if self.takes_at_once(slots) {
            let t_max = [f32::INFINITY; WIDTH];
            return self
                .query_slots::<false>(slots, rays, courses, &t_max, filter, |slot, hit| hits[slot] = hit);
        }
        for slot in slots {
            let course = courses.of(slot, rays.get(slot));
            hits[slot] = self.query::<false>(&course, f32::INFINITY, |candidate| filter(slot, candidate));
        }
    }

    /// Whether there is any hit with `0 < t < t_max` that `filter` accepts.
    #[inline]
    pub fn occluded(&self, ray: &Ray, t_max: f32, filter: impl Fn(&Candidate<'_>) -> bool) -> bool {
        self.query::<true>(ray, t_max, filter).is_some()
    }

    /// Those of `slots` for whose rays, which go on for `t_max` each, [`World::occluded`] holds. The filter is told the slot.
    pub fn occluded_slots(
        &self,
        slots: Slots,
        rays: &Rays,
        courses: &mut RayCourses,
        t_max: &Floats,
        filter: impl Fn(usize, &Candidate<'_>) -> bool,
    ) -> Slots {
        courses.prepare(rays);
        if let Some(few) = &self.few {
            return few.occluded(&self.geometries, slots, rays, courses, t_max);
        }
        if self.takes_at_once(slots) {
            let mut occluded = Slots::NONE;
            self.query_slots::<true>(slots, rays, courses, t_max, filter, |slot, hit| {
                occluded.insert_if(slot, hit.is_some());
            });
            return occluded;
        }
        slots.keep(|slot| {
            let course = courses.of(slot, rays.get(slot));
            self.query::<true>(&course, t_max[slot], |candidate| filter(slot, candidate)).is_some()
        })
    }

    fn query<const ANY: bool>(
        &self,
        course: &impl Course,
        t_max: f32,
        filter: impl Fn(&Candidate<'_>) -> bool,
    ) -> Option<Hit> {
        let ray = course.ray();
        if !leads_somewhere(ray, t_max) {
            return None;
        }
        let mut search = Search::<ANY, true, _>::new(self, ray, t_max, &filter);
        self.hierarchies.top.traverse(self.level, course, &mut search);
        search.found()
    }

    /// Whether [`World::query_slots`] is the way for the rays in `slots`.
    #[inline]
    fn takes_at_once(&self, slots: Slots) -> bool {
        self.company != Company::Alone && slots.len() >= FEWEST_AT_ONCE
    }

    /// [`World::query`] for the rays in `slots`, whose courses are prepared, at once: `take` is told what each has found.
    fn query_slots<const ANY: bool>(
        &self,
        slots: Slots,
        rays: &Rays,
        room: &mut RayCourses,
        t_max: &Floats,
        filter: impl Fn(usize, &Candidate<'_>) -> bool,
        mut take: impl FnMut(usize, Option<Hit>),
    ) {
        let courses = from_fn(|slot| room.of(slot, rays.get(slot)));
        let filters: [_; WIDTH] = from_fn(|slot| {
            let filter = &filter;
            move |candidate: &Candidate<'_>| filter(slot, candidate)
        });
        let mut searches: [_; WIDTH] = from_fn(|slot| {
            Search::<ANY, true, _>::new(self, courses[slot].ray(), t_max[slot], &filters[slot])
        });
        let leading = slots.keep(|slot| leads_somewhere(courses[slot].ray(), t_max[slot]));
        let Self { hierarchies: Hierarchies { top, .. }, level, .. } = self;
        match self.company {
            Company::Streaming => {
                top.traverse_stream(*level, leading, &courses, &mut searches, &mut room.streams);
            }
            _ => top.traverse_slots(*level, leading, &courses, &mut searches),
        }
        slots.for_each(|slot| take(slot, searches[slot].found()));
    }

    fn to_local(&self, instance: InstanceId, ray: &Ray) -> Ray {
        match self.placement_at(instance, ray.time) {
            Some(t) => t.inverse().ray(ray),
            None => *ray,
        }
    }

    /// The transform of an instance at a time; `None` for the world itself.
    #[inline]
    pub fn placement_at(&self, instance: InstanceId, time: f32) -> Option<Transform> {
        instance.is_some().then(|| self.hierarchies.placements[instance.0 as usize].at(time))
    }

    /// The surface at a hit of `ray`, in world space.
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let shape_hit = ShapeHit { t: hit.t, u: hit.u, v: hit.v };
        let placement = self.placement_at(hit.instance, ray.time);
        let local = placement.as_ref().map_or(*ray, |t| t.inverse().ray(ray));
        let mut surface = self.primitive(hit.primitive).interaction(&local, &shape_hit);
        if let Some(t) = placement {
            surface = surface.transformed(&t);
            surface.wo = toward_origin(ray);
        }
        surface.primitive = hit.primitive;
        surface.instance = hit.instance;
        surface
    }

    /// Texture coordinates at a hit of `ray`.
    pub fn uv(&self, ray: &Ray, hit: &Hit) -> Vec2 {
        let shape_hit = ShapeHit { t: hit.t, u: hit.u, v: hit.v };
        self.primitive(hit.primitive).uv(&self.to_local(hit.instance, ray), &shape_hit)
    }
}

/// Whether a ray may hit anything: those that lead nowhere would visit everything in vain.
#[inline(always)]
fn leads_somewhere(ray: &Ray, t_max: f32) -> bool {
    let Vec3 { x, y, z } = ray.direction;
    let is_finite = |v: Vec3| v.x.is_finite() & v.y.is_finite() & v.z.is_finite();
    is_finite(ray.direction) & is_finite(ray.origin) & ((x != 0.0) | (y != 0.0) | (z != 0.0)) & (t_max > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshParts, TriangleMesh};
    use std::sync::Arc;
    use tenfold_testkit::Rng;

    /// So many triangles of a size, anywhere in the unit cube.
    fn cloud(count: usize, size: f32) -> World {
        let mut rng = Rng::new(5);
        let positions = (0..count).flat_map(|_| {
            let at = rng.vec3();
            [at, at + size * rng.direction(), at + size * rng.direction()]
        });
        let parts = MeshParts {
            positions: positions.collect(),
            indices: (0..3 * count as u32).collect(),
            ..MeshParts::default()
        };
        let shape =
            Shape::Triangles(Arc::new(TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap()));
        let geometry = Geometry { shape, motion: None, group: None, user: 0, masked: false };
        let desc = WorldDesc { geometries: vec![geometry], shutter: [0.0, 1.0], ..WorldDesc::default() };
        World::build(desc).unwrap()
    }

    #[test]
    fn rays_stream_through_what_they_mostly_pass() {
        assert_eq!(cloud(1000, 0.002).company, Company::Streaming);
        // Larger ones fill their leaves.
        assert_eq!(cloud(1000, 0.1).company, Company::Alone);
        // So many are in the way of every ray.
        assert_eq!(cloud(200_000, 0.006).company, Company::Alone);
    }
}
