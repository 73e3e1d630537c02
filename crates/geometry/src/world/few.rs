//! Worlds of few primitives: each is tested against the rays of all slots side by side, without a hierarchy.

use super::{Geometry, leads_somewhere};
use crate::{
    Hit, InstanceId, Primitive, PrimitiveId, ShapeHit,
    bvh::{LONGER, MOST_VERTICES, RayCourses, padded},
    mesh::is_degenerate,
    shape::{Ball, Parallelogram, RayShear, ShearedTriangle, permuted, sheared_vertex},
};
use tenfold_math::{Bounds3, Floats, Id, Rays, Slots, Vec3, Vec3s, WIDTH, higher, lower, vectorized};

/// Worlds of more primitives are faster by their hierarchy.
const MOST: usize = 64;

/// All primitives of a world, in the order of their names: of hits at one distance that of the first counts.
#[derive(Debug)]
pub(super) struct Few {
    names: Vec<PrimitiveId>,
    runs: Vec<Run>,
}

/// Primitives that follow each other and are tested by the same code.
#[derive(Debug)]
struct Run {
    bounds: Bounds3,
    /// The place of the first in the list of names.
    first: u32,
    primitives: Kind,
}

#[derive(Debug)]
enum Kind {
    Triangles(Triangles),
    Ball(Ball),
    Parallelogram(Parallelogram),
    /// One that rays are tested against one by one.
    Other,
}

/// Triangles that follow each other, with each of their vertices once.
#[derive(Debug, Default)]
struct Triangles {
    vertices: Vec<Vec3>,
    /// By the places of the vertices.
    corners: Vec<[u8; 3]>,
}

impl Triangles {
    /// Adds a triangle if there is room for it. Returns whether there was.
    fn add(&mut self, corners: [Vec3; 3]) -> bool {
        let before = self.vertices.len();
        let places = corners.map(|p| {
            // Not `==`, for which 0 and −0 are the same.
            let bits = |p: Vec3| p.to_array().map(f32::to_bits);
            let known = self.vertices.iter().position(|v| bits(*v) == bits(p));
            known.unwrap_or_else(|| {
                self.vertices.push(p);
                self.vertices.len() - 1
            }) as u8
        });
        let fits = self.vertices.len() <= MOST_VERTICES;
        if fits {
            self.corners.push(places);
        } else {
            self.vertices.truncate(before);
        }
        fits
    }
}

/// What rays have found so far.
#[derive(Copy, Clone, Debug)]
struct Found {
    /// How far they still go; not above 0 where that is nowhere.
    t_max: Floats,
    u: Floats,
    v: Floats,
    /// The place of the primitive in the list of names.
    place: [u32; WIDTH],
}

/// Instead of a place, where nothing was found.
const NOTHING: u32 = u32::MAX;

impl Few {
    /// The primitives of a world without instances, if they are few, stand still, and are hit by every ray.
    pub(super) fn of(geometries: &[Geometry]) -> Option<Self> {
        let is_plain = |g: &Geometry| g.motion.is_none() && g.group.is_none() && !g.masked;
        if !geometries.iter().all(is_plain) || geometries.iter().map(|g| g.shape.len()).sum::<usize>() > MOST
        {
            return None;
        }
        let mut few = Self { names: Vec::new(), runs: Vec::new() };
        for (geometry, Geometry { shape, .. }) in geometries.iter().enumerate() {
            let mut triangles = None;
            for index in 0..shape.len() {
                few.add(geometry, index, &shape.primitive(index), &mut triangles);
            }
        }
        Some(few)
    }

    /// Adds a primitive, to the run of `triangles` with room for more if it is one.
    fn add(
        &mut self,
        geometry: usize,
        index: usize,
        primitive: &Primitive<'_>,
        triangles: &mut Option<usize>,
    ) {
        let bounds = primitive.bounds();
        let bounds = padded(bounds, bounds.diagonal().max_element());
        let first = self.names.len() as u32;
        let name = PrimitiveId { geometry: Id::new(geometry), index: index as u32 };
        let primitives = match primitive {
            Primitive::Triangle(triangle) => {
                let corners = triangle.positions();
                if is_degenerate(corners) {
                    return;
                }
                if let Some(Run { bounds: all, primitives: Kind::Triangles(run), .. }) =
                    triangles.map(|i| &mut self.runs[i])
                    && run.add(corners)
                {
                    *all = all.union(bounds);
                    self.names.push(name);
                    return;
                }
                *triangles = Some(self.runs.len());
                let mut run = Triangles::default();
                run.add(corners);
                Kind::Triangles(run)
            }
            Primitive::Patch(patch) => patch.parallelogram().map_or(Kind::Other, Kind::Parallelogram),
            _ => primitive.ball().map_or(Kind::Other, |ball| Kind::Ball(*ball)),
        };
        self.names.push(name);
        self.runs.push(Run { bounds, first, primitives });
    }

    /// The closest hits of the rays in `slots`; `hits` of other slots stay as they are.
    pub(super) fn intersect(
        &self,
        geometries: &[Geometry],
        slots: Slots,
        rays: &Rays,
        courses: &mut RayCourses,
        hits: &mut [Option<Hit>; WIDTH],
    ) {
        let mut found = Found::nothing();
        trace(self, geometries, slots, rays, courses, &[f32::INFINITY; WIDTH], false, &mut found);
        for slot in slots {
            let Found { t_max, u, v, place } = &found;
            hits[slot] = self.names.get(place[slot] as usize).map(|&primitive| Hit {
                t: t_max[slot],
                u: u[slot],
                v: v[slot],
                primitive,
                instance: InstanceId::NONE,
            });
        }
    }

    /// Those of `slots` whose rays hit anything before `t_max`.
    pub(super) fn occluded(
        &self,
        geometries: &[Geometry],
        slots: Slots,
        rays: &Rays,
        courses: &mut RayCourses,
        t_max: &Floats,
    ) -> Slots {
        let mut found = Found::nothing();
        trace(self, geometries, slots, rays, courses, t_max, true, &mut found);
        slots.keep(|slot| found.place[slot] != NOTHING)
    }

    /// Tests the primitive at a place against the rays one by one.
    #[inline(never)]
    fn hit_one_by_one(
        &self,
        place: u32,
        geometries: &[Geometry],
        entered: &[bool; WIDTH],
        rays: &Rays,
        found: &mut Found,
    ) {
        let PrimitiveId { geometry, index } = self.names[place as usize];
        let primitive = geometries[geometry.index()].shape.primitive(index as usize);
        for slot in (0..WIDTH).filter(|&slot| entered[slot]) {
            if let Some(hit) = primitive.intersect(&rays.get(slot), found.t_max[slot], |_| true) {
                found.take(slot, hit, place, true);
            }
        }
    }
}

impl Found {
    const fn nothing() -> Self {
        Self { t_max: [0.0; WIDTH], u: [0.0; WIDTH], v: [0.0; WIDTH], place: [NOTHING; WIDTH] }
    }

    /// Takes a hit in `slot` if it is one.
    #[inline(always)]
    fn take(&mut self, slot: usize, hit: ShapeHit, place: u32, is_hit: bool) {
        self.t_max[slot] = if is_hit { hit.t } else { self.t_max[slot] };
        self.u[slot] = if is_hit { hit.u } else { self.u[slot] };
        self.v[slot] = if is_hit { hit.v } else { self.v[slot] };
        self.place[slot] = if is_hit { place } else { self.place[slot] };
    }
}

vectorized! {
    /// The closest hits of the rays in `slots` before `t_max`, or `any` hits.
    fn trace(
        few: &Few,
        geometries: &[Geometry],
        slots: Slots,
        rays: &Rays,
        courses: &mut RayCourses,
        t_max: &Floats,
        any: bool,
        found: &mut Found,
    ) {
        let flags = slots.flags();
        for i in 0..WIDTH {
            let is_live = flags[i] & leads_somewhere(&rays.get(i), t_max[i]);
            found.t_max[i] = if is_live { t_max[i] } else { 0.0 };
        }
        let RayCourses { inverse, shear, axis, origin, vertices: turned, .. } = courses;
        for run in &few.runs {
            let mut entered = [false; WIDTH];
            for i in 0..WIDTH {
                entered[i] = enters(&run.bounds, rays.origin.get(i), inverse.get(i), found.t_max[i]);
            }
            if entered == [false; WIDTH] {
                continue;
            }
            match &run.primitives {
                Kind::Triangles(triangles) => {
                    for (vertex, out) in triangles.vertices.iter().zip(turned.iter_mut()) {
                        for i in 0..WIDTH {
                            let p = permuted(*vertex, axis[i]) - origin.get(i);
                            out.set(i, sheared_vertex(p, shear.get(i)));
                        }
                    }
                    for (place, corners) in (run.first..).zip(&triangles.corners) {
                        let vertices = corners.map(|i| &turned[usize::from(i) % MOST_VERTICES]);
                        let flat = hit_triangle(vertices, place, &entered, shear, found);
                        if flat != [false; WIDTH] {
                            let corners = corners.map(|i| triangles.vertices[usize::from(i)]);
                            hit_flat(&corners, place, &flat, rays, axis, shear, found);
                        }
                    }
                }
                Kind::Ball(ball) => {
                    for i in 0..WIDTH {
                        let (hit, is_hit) = ball.hit(&rays.get(i), found.t_max[i]);
                        found.take(i, hit, run.first, entered[i] & is_hit);
                    }
                }
                Kind::Parallelogram(parallelogram) => {
                    for i in 0..WIDTH {
                        let (hit, is_hit) = parallelogram.hit(&rays.get(i), found.t_max[i]);
                        found.take(i, hit, run.first, entered[i] & is_hit);
                    }
                }
                Kind::Other => few.hit_one_by_one(run.first, geometries, &entered, rays, found),
            }
            if any {
                let mut goes_on = false;
                for i in 0..WIDTH {
                    found.t_max[i] = if found.place[i] == NOTHING { found.t_max[i] } else { 0.0 };
                    goes_on |= found.t_max[i] > 0.0;
                }
                if !goes_on {
                    return;
                }
            }
        }
    }
}

/// Whether a ray enters a box before `t_max`, with room for rounding as in the hierarchy.
#[inline(always)]
fn enters(bounds: &Bounds3, origin: Vec3, inverse: Vec3, t_max: f32) -> bool {
    let (a, b) = ((bounds.min - origin) * inverse, (bounds.max - origin) * inverse);
    let near = higher(lower(a.x, b.x), higher(lower(a.y, b.y), higher(lower(a.z, b.z), 0.0)));
    let far = lower(higher(a.x, b.x), lower(higher(a.y, b.y), higher(a.z, b.z)));
    (t_max > 0.0) & (near <= LONGER * lower(far, t_max))
}

/// The hits of a triangle with these sheared vertices by the rays that have entered its box, before those that were found: as the hierarchy tests them, to the
/// bit. Returns where the edge functions all cancelled.
#[inline(always)]
fn hit_triangle(
    vertices: [&Vec3s; 3],
    place: u32,
    entered: &[bool; WIDTH],
    shear: &Vec3s,
    found: &mut Found,
) -> [bool; WIDTH] {
    let mut flat = [false; WIDTH];
    let mut inside = [false; WIDTH];
    let mut edges = Vec3s::ZERO;
    for i in 0..WIDTH {
        let triangle = ShearedTriangle::new(vertices.map(|v| v.get(i)));
        edges.set(i, triangle.edges.into());
        inside[i] = entered[i] & triangle.is_inside();
    }
    if inside == [false; WIDTH] {
        return flat;
    }
    for i in 0..WIDTH {
        let triangle =
            ShearedTriangle { vertices: vertices.map(|v| v.get(i)), edges: edges.get(i).to_array() };
        let (hit, is_in_front) = triangle.hit(shear.z[i]);
        flat[i] = inside[i] & (triangle.determinant() == 0.0);
        found.take(i, hit, place, inside[i] & !flat[i] & is_in_front & (hit.t < found.t_max[i]));
    }
    flat
}

/// [`hit_triangle`] where the edge functions all cancelled.
#[cold]
#[inline(never)]
fn hit_flat(
    corners: &[Vec3; 3],
    place: u32,
    is_flat: &[bool; WIDTH],
    rays: &Rays,
    axis: &[u32; WIDTH],
    shear: &Vec3s,
    found: &mut Found,
) {
    for slot in (0..WIDTH).filter(|&slot| is_flat[slot]) {
        let ray = RayShear::known(rays.origin.get(slot), axis[slot] as usize, shear.get(slot));
        if let Some(hit) = ray.intersect(*corners, found.t_max[slot]) {
            found.take(slot, hit, place, true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Shape, Sphere, SphereParams};
    use tenfold_math::Transform;

    #[test]
    fn few_primitives_that_every_ray_may_hit_make_a_list() {
        let ball = Geometry {
            shape: Shape::Sphere(Sphere::new(Transform::IDENTITY, false, SphereParams::whole(1.0)).unwrap()),
            motion: None,
            group: None,
            user: 0,
            masked: false,
        };
        let is_list = |geometries: &[Geometry]| Few::of(geometries).is_some();
        let balls = vec![ball.clone(); MOST + 1];
        assert!(is_list(&[]) && is_list(&balls[..1]) && is_list(&balls[..MOST]));
        assert!(!is_list(&balls));
        let masked = Geometry { masked: true, ..ball.clone() };
        assert!(!is_list(&[ball, masked]));
    }
}
