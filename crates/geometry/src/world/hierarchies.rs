//! The two levels: one hierarchy over the world, one for each group and for each moving geometry.

use super::{Geometry, WorldDesc, WorldError, WorldStats};
use crate::{
    Shape,
    bvh::{Bvh, LONGER, LeafPrimitive, Reference, Target, padded, with_capacity},
    mesh::is_degenerate,
};
use rayon::prelude::*;
use std::collections::BTreeMap;
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
    let reference =
        |bounds: Bounds3, target| Reference::new(padded(bounds, bounds.diagonal().max_element()), target);
    let count = members.iter().map(|&i| geometries[i].shape.len()).sum::<usize>() + placements.len();
    let mut references = with_capacity(count);
    references.extend(placements.iter().map(|(bounds, index)| reference(*bounds, Target::Placement(*index))));
    let mut degenerate = 0;
    for &i in members {
        let Geometry { shape, masked, .. } = &geometries[i];
        let id = |index: usize| LeafPrimitive::new(i as u32, index as u32, *masked);
        match shape {
            Shape::Triangles(mesh) => {
                let areas = || (0..mesh.len()).into_par_iter().filter(|&i| !is_degenerate(mesh.positions(i)));
                let bounded = |index: usize| {
                    reference(Bounds3::around(mesh.positions(index)), Target::Triangle(id(index)))
                };
                let sound = areas().count();
                degenerate += mesh.len() - sound;
                if sound == mesh.len() {
                    references.par_extend((0..mesh.len()).into_par_iter().map(bounded));
                } else {
                    references.par_extend(areas().map(bounded));
                }
            }
            // Triangles alone have leaves of their own kind.
            _ => references.extend(
                (0..shape.len()).map(|i| reference(shape.primitive(i).bounds(), Target::Shape(id(i)))),
            ),
        }
    }
    (Bvh::build(references, corners), degenerate)
}
