//! What happens where a ray comes to a leaf.

use super::World;
use crate::{
    Candidate, Hit, InstanceId, PrimitiveId, ShapeHit,
    bvh::{LeafPrimitive, Visitor},
};
use tenfold_math::{Id, Ray, next_up};

/// What was found so far.
#[derive(Copy, Clone)]
struct State {
    best: Option<Hit>,
    t_max: f32,
}

/// A ray on its way through one hierarchy: through the world's (`TOP`) or one of those below it.
pub(super) struct Search<'a, const ANY: bool, const TOP: bool, F> {
    world: &'a World,
    /// As the caller gave it.
    ray: &'a Ray,
    /// In the space of this hierarchy.
    local: &'a Ray,
    instance: InstanceId,
    filter: &'a F,
    state: State,
}

impl<'a, const ANY: bool, F> Search<'a, ANY, true, F> {
    /// Of a ray that sets out.
    #[inline(always)]
    pub(super) fn new(world: &'a World, ray: &'a Ray, t_max: f32, filter: &'a F) -> Self {
        let state = State { best: None, t_max };
        Self { world, ray, local: ray, instance: InstanceId::NONE, filter, state }
    }

    /// What was found.
    #[inline(always)]
    pub(super) fn found(&self) -> Option<Hit> {
        self.state.best
    }
}

impl<const ANY: bool, const TOP: bool, F: Fn(&Candidate<'_>) -> bool> Search<'_, ANY, TOP, F> {
    #[inline(always)]
    fn hit(&self, id: LeafPrimitive, hit: ShapeHit) -> Hit {
        let primitive = PrimitiveId { geometry: Id::new(id.geometry()), index: id.index };
        Hit { t: hit.t, u: hit.u, v: hit.v, primitive, instance: self.instance }
    }

    /// Whether a hit comes before the best one so far. Of hits at the same distance that of the first primitive and instance counts: it must not depend
    /// on the way through the hierarchy.
    #[inline(always)]
    fn is_before(&self, id: LeafPrimitive, hit: ShapeHit) -> bool {
        hit.t < self.state.t_max
            || hit.t == self.state.t_max
                && self.state.best.is_some_and(|best| {
                    let found = self.hit(id, hit);
                    (found.primitive, found.instance) < (best.primitive, best.instance)
                })
    }

    #[inline(always)]
    fn accepts(&self, id: LeafPrimitive, hit: ShapeHit) -> bool {
        self.is_before(id, hit)
            && (!id.is_masked() || {
                let user = self.world.geometries[id.geometry()].user;
                (self.filter)(&Candidate { world: self.world, ray: self.ray, hit: self.hit(id, hit), user })
            })
    }

    /// [`Search::accepts`] in few instructions for most hits.
    #[inline(always)]
    fn accepts_shape(&self, id: LeafPrimitive, hit: ShapeHit) -> bool {
        (hit.t < self.state.t_max && !id.is_masked()) || self.accepts_rare(id, hit)
    }

    #[inline(never)]
    fn accepts_rare(&self, id: LeafPrimitive, hit: ShapeHit) -> bool {
        self.accepts(id, hit)
    }

    #[inline(always)]
    fn take(&mut self, id: LeafPrimitive, hit: ShapeHit) {
        self.state = State { best: Some(self.hit(id, hit)), t_max: hit.t };
    }
}

impl<const ANY: bool, const TOP: bool, F: Fn(&Candidate<'_>) -> bool> Visitor for Search<'_, ANY, TOP, F> {
    const ANY: bool = ANY;

    #[inline(always)]
    fn t_max(&self) -> f32 {
        self.state.t_max
    }

    #[inline(always)]
    fn triangle(&mut self, id: LeafPrimitive, hit: ShapeHit) -> bool {
        if !self.accepts(id, hit) {
            return false;
        }
        self.take(id, hit);
        ANY
    }

    fn shape(&mut self, id: LeafPrimitive) -> bool {
        // Shapes look for hits below the limit.
        let limit = next_up(self.state.t_max);
        let primitive = self.world.geometries[id.geometry()].shape.primitive(id.index as usize);
        let found = primitive.intersect(self.local, limit, |hit| self.accepts_shape(id, hit));
        match found {
            Some(hit) => {
                self.take(id, hit);
                ANY
            }
            None => false,
        }
    }

    fn placement(&mut self, index: usize) -> bool {
        if !TOP {
            return false;
        }
        let hierarchies = &self.world.hierarchies;
        let placement = &hierarchies.placements[index];
        if !placement.may_be_hit(self.ray, hierarchies.fraction(self.ray.time), self.state.t_max) {
            return false;
        }
        let local = placement.at(self.ray.time).inverse().ray(self.ray);
        let mut below = Search::<ANY, false, F> {
            world: self.world,
            ray: self.ray,
            local: &local,
            instance: InstanceId(index as u32),
            filter: self.filter,
            state: self.state,
        };
        let hierarchy = &hierarchies.lower[placement.hierarchy as usize];
        let over = hierarchy.traverse(self.world.level, &local, &mut below);
        self.state = below.state;
        over
    }
}
