//! The two levels: one hierarchy over the world, one for each group and for each moving geometry.

use super::{Geometry, WorldDesc, WorldError, WorldStats};
use crate::{
    Shape,
    bvh::{Bvh, LONGER, LeafPrimitive, Reference, References, Target, padded},
    mesh::is_degenerate,
};
use rayon::prelude::*;
use std::{collections::BTreeMap, ops::Range};
use tenfold_math::{Bounds3, Motion, Ray, Transform, Vec3};

/// Where a placement goes.
#[derive(Debug)]
enum Path {
    One(Motion),
    /// The motion of an instance after the own one of a geometry, of which one moves at least.
    Two(Box<[Motion; 2]>),
}

/// A hierarchy placed in the world.
#[derive(Debug)]
pub(super) struct Placement {
    /// Of [`Hierarchies::lower`].
    pub(super) hierarchy: u32,
    path: Path,
    /// Where it moves: boxes around it at the first and the last time, between which its box goes linearly.
    swept: Option<Box<[Bounds3; 2]>>,
}

impl Placement {
    fn new(hierarchy: u32, outer: &Motion, inner: Option<&Motion>) -> Self {
        let path = match inner {
            None => Path::One(outer.clone()),
            Some(inner) if outer.is_moving() || inner.is_moving() => {
                Path::Two(Box::new([outer.clone(), inner.clone()]))
            }
            Some(inner) => Path::One(Motion::still(*outer.start() * *inner.start())),
        };
        Self { hierarchy, path, swept: None }
    }

    /// Whether it changes its place in time.
    pub(super) fn is_moving(&self) -> bool {
        match &self.path {
            Path::One(motion) => motion.is_moving(),
            Path::Two(_) => true,
        }
    }

    /// Local to world at a time.
    #[inline]
    pub(super) fn at(&self, time: f32) -> Transform {
        match &self.path {
            Path::One(motion) => motion.at(time),
            Path::Two(motions) => motions[0].at(time) * motions[1].at(time),
        }
    }

    /// Whether a ray at fraction `s` of the time can meet anything here. Transforming it to find out costs more.
    #[inline]
    pub(super) fn may_be_hit(&self, ray: &Ray, s: f32, t_max: f32) -> bool {
        let Some([start, end]) = self.swept.as_deref() else { return true };
        let inverse = ray.direction.recip();
        let a = (start.min.lerp(end.min, s) - ray.origin) * inverse;
        let b = (start.max.lerp(end.max, s) - ray.origin) * inverse;
        // Room for rounding, as in the hierarchy; what is not a number decides nothing.
        let near = a.min(b).max_element().max(0.0);
        let far = a.max(b).min_element().min(t_max) * LONGER;
        !(far < near)
    }

    /// The box around it all the time, for what is in `local`; also prepares [`Placement::may_be_hit`].
    fn sweep(&mut self, local: &Bounds3, [from, to]: [f32; 2]) -> Bounds3 {
        let (outer, local) = match &self.path {
            Path::One(motion) => (motion, *local),
            Path::Two(motions) => (&motions[0], motions[1].bounds(local, from, to)),
        };
        let between = outer.keys().iter().map(|key| key.time).filter(|time| from < *time && *time < to);
        let times = between.chain([from, to]);
        let rounding = times.map(|time| rounding(&outer.at(time), &local)).fold(0.0, f32::max);
        let bounds = outer.bounds(&local, from, to).expanded(rounding);
        if outer.is_moving() && !bounds.is_empty() {
            // Interpolating rounds, too.
            let size = bounds.min.abs().max(bounds.max.abs()).max_element();
            let by = rounding + 4.0 * f32::EPSILON * size;
            self.swept = Some(Box::new(outer.linear_bounds(&local, from, to).map(|b| b.expanded(by))));
        }
        bounds
    }
}

/// Bound on the error of mapping any point of a box.
fn rounding(t: &Transform, b: &Bounds3) -> f32 {
    (0..8).map(|i| t.point_error(b.corner(i), Vec3::ZERO).max_element()).fold(0.0, f32::max)
}

/// Both levels.
#[derive(Debug)]
pub(super) struct Hierarchies {
    /// First time of any ray, and the inverse of the time from there to the last (0 where there is none).
    shutter: [f32; 2],
    pub(super) top: Bvh,
    pub(super) lower: Vec<Bvh>,
    pub(super) placements: Vec<Placement>,
}

impl Hierarchies {
    pub(super) fn build(desc: &WorldDesc) -> Result<(Self, WorldStats), WorldError> {
        let check = |what, count: usize| {
            if count < (1 << 30) - 1 { Ok(()) } else { Err(WorldError::TooLarge { what, count }) }
        };
        check("geometries", desc.geometries.len())?;
        check("primitives", desc.geometries.iter().map(|g| g.shape.len()).sum())?;

        // Lower hierarchies: for each group its still geometries, and each moving geometry on its own.
        let mut members: Vec<Vec<usize>> = Vec::new();
        let mut by_group: BTreeMap<usize, Vec<(u32, Option<&Motion>)>> = BTreeMap::new();
        let mut moving: Vec<(u32, &Motion)> = Vec::new();
        let mut still_of_group: BTreeMap<usize, u32> = BTreeMap::new();
        let mut top_members = Vec::new();
        for (i, geometry) in desc.geometries.iter().enumerate() {
            match (&geometry.motion, geometry.group) {
                (None, None) => top_members.push(i),
                (None, Some(group)) => {
                    let hierarchy = *still_of_group.entry(group.index()).or_insert_with(|| {
                        members.push(Vec::new());
                        let hierarchy = members.len() as u32 - 1;
                        by_group.entry(group.index()).or_default().push((hierarchy, None));
                        hierarchy
                    });
                    members[hierarchy as usize].push(i);
                }
                (Some(motion), group) => {
                    members.push(vec![i]);
                    let hierarchy = members.len() as u32 - 1;
                    match group {
                        None => moving.push((hierarchy, motion)),
                        Some(group) => {
                            by_group.entry(group.index()).or_default().push((hierarchy, Some(motion)))
                        }
                    }
                }
            }
        }
        let built: Vec<(Bvh, usize)> =
            members.par_iter().map(|members| build_still(&desc.geometries, members, &[])).collect();

        let mut placements = Vec::new();
        for (hierarchy, motion) in moving {
            placements.push(Placement::new(hierarchy, motion, None));
        }
        for instance in &desc.instances {
            for (hierarchy, inner) in by_group.get(&instance.group.index()).into_iter().flatten() {
                placements.push(Placement::new(*hierarchy, &instance.motion, *inner));
            }
        }
        check("instances", placements.len())?;
        let boxes: Vec<(Bounds3, u32)> = placements
            .par_iter_mut()
            .enumerate()
            .map(|(i, p)| (p.sweep(&built[p.hierarchy as usize].0.bounds(), desc.shutter), i as u32))
            .filter(|(b, _)| !b.is_empty())
            .collect();
        let (top, mut degenerate) = build_still(&desc.geometries, &top_members, &boxes);
        degenerate += built.iter().map(|(_, degenerate)| degenerate).sum::<usize>();
        let lower: Vec<Bvh> = built.into_iter().map(|(bvh, _)| bvh).collect();
        let all = || lower.iter().chain([&top]);
        let stats = WorldStats {
            primitives: desc.geometries.iter().map(|g| g.shape.len()).sum::<usize>() - degenerate,
            degenerate,
            instances: placements.len(),
            nodes: all().map(Bvh::node_count).sum(),
            bytes: all().map(Bvh::bytes).sum(),
        };
        let [from, to] = desc.shutter;
        let shutter = [from, if from < to { 1.0 / (to - from) } else { 0.0 }];
        Ok((Self { shutter, top, lower, placements }, stats))
    }

    /// The fraction of the time between first and last.
    #[inline]
    pub(super) fn fraction(&self, time: f32) -> f32 {
        ((time - self.shutter[0]) * self.shutter[1]).clamp(0.0, 1.0)
    }
}

/// A hierarchy over some geometries as they are, and placements; also counts the degenerate triangles left out.
fn build_still(geometries: &[Geometry], members: &[usize], placements: &[(Bounds3, u32)]) -> (Bvh, usize) {
    let corners = |id: LeafPrimitive| match &geometries[id.geometry()].shape {
        Shape::Triangles(mesh) => mesh.positions(id.index as usize),
        _ => [Vec3::ZERO; 3],
    };
    let still = Still::new(geometries, members, placements);
    (Bvh::build(&still, corners), still.left_out.len())
}

/// What does not move: placements, then primitives but for degenerate triangles.
struct Still<'a> {
    geometries: &'a [Geometry],
    placements: &'a [(Bounds3, u32)],
    /// Geometries, each behind the number of what comes before its first primitive.
    members: Vec<(usize, usize)>,
    /// How many there are with those that are left out.
    all: usize,
    /// Of each that is left out, how many come before it that are not.
    left_out: Vec<u32>,
}

impl<'a> Still<'a> {
    fn new(geometries: &'a [Geometry], members: &[usize], placements: &'a [(Bounds3, u32)]) -> Self {
        let mut still = Self {
            geometries,
            placements,
            members: Vec::with_capacity(members.len()),
            all: placements.len(),
            left_out: Vec::new(),
        };
        for &geometry in members {
            let (first, shape) = (still.all, &geometries[geometry].shape);
            if let Shape::Triangles(mesh) = shape {
                let degenerate =
                    (0..mesh.len()).into_par_iter().filter(|&i| is_degenerate(mesh.positions(i)));
                still.left_out.par_extend(degenerate.map(|i| (first + i) as u32));
            }
            still.members.push((first, geometry));
            still.all += shape.len();
        }
        still.left_out.iter_mut().enumerate().for_each(|(before, number)| *number -= before as u32);
        still
    }

    /// Which member holds the primitive of a number among all: none before the first.
    fn member(&self, number: usize) -> Option<usize> {
        self.members.partition_point(|(first, _)| *first <= number).checked_sub(1)
    }

    /// Makes those of some numbers among all, of which none is left out.
    fn make(&self, range: Range<usize>, to: &mut Vec<Reference>) {
        let placements = self.placements.len();
        let placed = &self.placements[range.start.min(placements)..range.end.min(placements)];
        to.extend(placed.iter().map(|(bounds, index)| reference(*bounds, Target::Placement(*index))));
        let from = self.member(range.start).unwrap_or(0);
        for &(first, geometry) in self.members[from..].iter().take_while(|(first, _)| *first < range.end) {
            let Geometry { shape, masked, .. } = &self.geometries[geometry];
            let id = |index: usize| LeafPrimitive::new(geometry as u32, index as u32, *masked);
            let part = range.start.saturating_sub(first)..shape.len().min(range.end - first);
            match shape {
                Shape::Triangles(mesh) => to.extend(
                    part.map(|i| reference(Bounds3::around(mesh.positions(i)), Target::Triangle(id(i)))),
                ),
                // Triangles alone have leaves of their own kind.
                _ => to.extend(part.map(|i| reference(shape.primitive(i).bounds(), Target::Shape(id(i))))),
            }
        }
    }
}

/// To what is in a box.
fn reference(bounds: Bounds3, target: Target) -> Reference {
    Reference::new(padded(bounds, bounds.diagonal().max_element()), target)
}

impl References for Still<'_> {
    fn len(&self) -> usize {
        self.all - self.left_out.len()
    }

    fn read(&self, range: Range<usize>, room: &mut Vec<Reference>) {
        room.clear();
        let mut start = range.start;
        let mut skipped = self.left_out.partition_point(|&before| before as usize <= start);
        while start < range.end {
            let end = self.left_out.get(skipped).map_or(range.end, |&before| range.end.min(before as usize));
            self.make(start + skipped..end + skipped, room);
            (start, skipped) = (end, skipped + 1);
        }
    }

    fn choose(&self, numbers: &[u32], room: &mut Vec<Reference>) {
        room.clear();
        // Numbers of what lies side by side in one geometry, from its index `from`: most come from where the last was.
        let (mut run, mut from, mut geometry) = (0..0, 0, 0);
        room.extend(numbers.iter().map(|&number| {
            let number = number as usize;
            if !run.contains(&number) {
                let skipped = self.left_out.partition_point(|&before| before as usize <= number);
                let Some(member) = self.member(number + skipped) else {
                    let (bounds, index) = self.placements[number];
                    return reference(bounds, Target::Placement(index));
                };
                let first;
                (first, geometry) = self.members[member];
                let left_out = |i: usize| self.left_out.get(i).map(|&before| before as usize);
                let start =
                    (first - skipped.min(first)).max(skipped.checked_sub(1).and_then(left_out).unwrap_or(0));
                let end = first + self.geometries[geometry].shape.len() - skipped;
                run = start..end.min(left_out(skipped).unwrap_or(end));
                from = start + skipped - first;
            }
            let (Geometry { shape, masked, .. }, index) =
                (&self.geometries[geometry], number - run.start + from);
            let id = LeafPrimitive::new(geometry as u32, index as u32, *masked);
            match shape {
                Shape::Triangles(mesh) => {
                    reference(Bounds3::around(mesh.positions(index)), Target::Triangle(id))
                }
                _ => reference(shape.primitive(index).bounds(), Target::Shape(id)),
            }
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshParts, Sphere, SphereParams, TriangleMesh};
    use std::sync::Arc;
    use tenfold_testkit::Rng;

    /// Of `n` triangles, those that `flat` names have no area.
    fn mesh(n: u32, flat: impl Fn(u32) -> bool, rng: &mut Rng) -> Geometry {
        let positions = (0..3 * n).map(|_| rng.vec3()).collect();
        let corner = |i: u32, corner: u32| 3 * i + if flat(i) { 0 } else { corner };
        let indices = (0..n).flat_map(|i| [0, 1, 2].map(|k| corner(i, k))).collect();
        let parts = MeshParts { positions, indices, ..MeshParts::default() };
        let mesh = TriangleMesh::new(parts, &Transform::IDENTITY, false).unwrap();
        geometry(Shape::Triangles(Arc::new(mesh)))
    }

    fn geometry(shape: Shape) -> Geometry {
        Geometry { shape, motion: None, group: None, user: 0, masked: false }
    }

    #[test]
    fn any_part_of_what_does_not_move_is_read_alike_without_degenerate_triangles() {
        let mut rng = Rng::new(1);
        let geometries = [
            mesh(50, |i| i == 0 || i % 7 > 4, &mut rng),
            mesh(3, |_| true, &mut rng),
            geometry(Shape::Sphere(
                Sphere::new(Transform::IDENTITY, false, SphereParams::whole(1.0)).unwrap(),
            )),
            mesh(0, |_| true, &mut rng),
            mesh(20, |_| false, &mut rng),
            mesh(9, |i| i > 5, &mut rng),
        ];
        let placements = [(Bounds3::around([Vec3::ZERO, Vec3::ONE]), 3), (Bounds3::around([Vec3::X]), 4)];
        let still = Still::new(&geometries, &[0, 1, 2, 3, 4, 5], &placements);
        let mut want: Vec<Target> = placements.iter().map(|p| Target::Placement(p.1)).collect();
        for (i, Geometry { shape, .. }) in geometries.iter().enumerate() {
            for index in 0..shape.len() {
                let id = LeafPrimitive::new(i as u32, index as u32, false);
                match shape {
                    Shape::Triangles(mesh) if is_degenerate(mesh.positions(index)) => {}
                    Shape::Triangles(_) => want.push(Target::Triangle(id)),
                    _ => want.push(Target::Shape(id)),
                }
            }
        }
        assert_eq!(still.len(), want.len());
        assert_eq!(still.left_out.len(), 1 + 7 * 2 + 3 + 3);
        let mut room = Vec::new();
        let numbers: Vec<u32> = (0..want.len() as u32).map(|i| i * 29 % want.len() as u32).collect();
        still.choose(&numbers, &mut room);
        let chosen: Vec<Target> = room.iter().map(Reference::target).collect();
        assert_eq!(chosen, numbers.iter().map(|&number| want[number as usize]).collect::<Vec<_>>());
        for start in 0..=want.len() {
            for end in start..=want.len() {
                still.read(start..end, &mut room);
                let targets: Vec<Target> = room.iter().map(Reference::target).collect();
                assert_eq!(targets, want[start..end]);
            }
        }
    }
}
