//! Triangles to shoot at: made by formula, or from an OBJ file.

use std::fs;
use tenfold_geometry::MeshParts;
use tenfold_math::{Vec3, ops};
use tenfold_testkit::Rng;

/// A mesh, and where to look at it from.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) parts: MeshParts,
    pub(crate) view: View,
    /// Where in the list of indices the objects begin.
    starts: Vec<usize>,
}

/// A camera, and the middle and radius of a light.
pub(crate) struct View {
    pub(crate) eye: Vec3,
    pub(crate) target: Vec3,
    pub(crate) light: (Vec3, f32),
}

impl Subject {
    /// `blob-N` and `hall-N` with about N triangles; anything else is the path of an OBJ file.
    pub(crate) fn named(name: &str) -> Result<Self, String> {
        let made =
            |kind: &str| name.strip_prefix(kind).and_then(|n| n.parse::<f64>().ok()).map(|n| n as usize);
        if let Some(n) = made("blob-") {
            let parts = blob(n);
            return Ok(Self { name: name.into(), view: View::outside(&parts), parts, starts: vec![0] });
        }
        if let Some(n) = made("hall-") {
            let view = View {
                eye: Vec3::new(-0.95, 0.4, -1.8),
                target: Vec3::new(0.1, -0.45, 0.3),
                light: (Vec3::new(0.0, 0.9, 0.0), 0.08),
            };
            let (parts, starts) = hall(n);
            return Ok(Self { name: name.into(), parts, view, starts });
        }
        let text = fs::read_to_string(name).map_err(|e| format!("{name}: {e}"))?;
        let parts = obj(&text);
        let stem = name.rsplit('/').next().unwrap_or(name);
        let view = View::outside(&parts);
        Ok(Self { name: stem.trim_end_matches(".obj").into(), view, parts, starts: vec![0] })
    }

    /// The objects, each with vertices of its own. A single one is cut in two, by the order of its triangles.
    pub(crate) fn objects(&self) -> Vec<MeshParts> {
        let mut starts = self.starts.clone();
        let all = self.parts.indices.len();
        if starts.len() == 1 {
            starts.push(all / 6 * 3);
        }
        starts.push(all);
        let objects = starts.windows(2).map(|range| {
            let indices = &self.parts.indices[range[0]..range[1]];
            let low = indices.iter().copied().min().unwrap_or(0);
            let high = indices.iter().copied().max().unwrap_or(0);
            MeshParts {
                positions: self.parts.positions[low as usize..=high as usize].to_vec(),
                indices: indices.iter().map(|i| i - low).collect(),
                ..MeshParts::default()
            }
        });
        objects.collect()
    }
}

impl View {
    fn outside(parts: &MeshParts) -> Self {
        let bounds = tenfold_math::Bounds3::around(parts.positions.iter().copied());
        let (centre, radius) = bounds.bounding_sphere();
        Self {
            eye: centre + 2.0 * radius * Vec3::new(0.3, 0.4, 0.85).normalize(),
            target: centre,
            light: (centre + 3.0 * radius * Vec3::new(-0.5, 0.8, 0.4).normalize(), 0.5 * radius),
        }
    }
}

/// A hash of a lattice point to [-1, 1].
fn lattice(p: [i32; 3]) -> f32 {
    let mut h = 0x9e37_79b9u32;
    for x in p {
        h = (h ^ x as u32).wrapping_mul(0x85eb_ca6b);
        h ^= h >> 15;
    }
    h = h.wrapping_mul(0xc2b2_ae35);
    (h >> 8) as f32 * (2.0 / 16_777_216.0) - 1.0
}

/// Value noise, interpolated smoothly.
fn noise(p: Vec3) -> f32 {
    let base = p.floor();
    let f = p - base;
    let f = f * f * (Vec3::splat(3.0) - 2.0 * f);
    let b = base.as_ivec3();
    let mut sum = 0.0;
    for corner in 0..8 {
        let o = [corner & 1, corner >> 1 & 1, corner >> 2];
        let w = |axis: usize| if o[axis] == 1 { f[axis] } else { 1.0 - f[axis] };
        sum += w(0) * w(1) * w(2) * lattice([b.x + o[0], b.y + o[1], b.z + o[2]]);
    }
    sum
}

/// Octaves of noise, each of half the size and height of the one before.
fn fractal(p: Vec3, octaves: i32) -> f32 {
    (0..octaves).map(|i| 0.5f32.powi(i) * noise(p * 2f32.powi(i))).sum()
}

/// A sphere around `centre`, lifted by noise, of about `triangles` triangles.
fn ball(parts: &mut MeshParts, centre: Vec3, radius: f32, bump: f32, triangles: usize) {
    use std::f32::consts::{PI, TAU};
    let rings = ((triangles as f32 / 4.0).sqrt().round() as u32).max(2);
    let segments = 2 * rings;
    let first = parts.positions.len() as u32;
    // Detail down to the size of the triangles.
    let octaves = rings.ilog2() as i32;
    for i in 0..=rings {
        for j in 0..segments {
            let (theta, phi) = (PI * i as f32 / rings as f32, TAU * j as f32 / segments as f32);
            let d = tenfold_math::spherical_direction(ops::sin(theta), ops::cos(theta), phi);
            let d = Vec3::new(d.x, d.z, d.y);
            parts.positions.push(centre + radius * (1.0 + bump * fractal(3.0 * d + centre, octaves)) * d);
        }
    }
    let at = |i: u32, j: u32| first + i * segments + j % segments;
    for i in 0..rings {
        for j in 0..segments {
            // The triangles at the poles that have no area are left out.
            if i > 0 {
                parts.indices.extend([at(i, j), at(i + 1, j), at(i, j + 1)]);
            }
            if i + 1 < rings {
                parts.indices.extend([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
}

/// One rugged surface, seen from outside, as of a scan.
fn blob(triangles: usize) -> MeshParts {
    let mut parts = MeshParts::default();
    ball(&mut parts, Vec3::ZERO, 1.0, 0.25, triangles);
    parts
}

/// A rod with six sides from `a` to `b`: long thin triangles.
fn rod(parts: &mut MeshParts, a: Vec3, b: Vec3, radius: f32) {
    let (x, y) = (b - a).normalize().any_orthonormal_pair();
    let first = parts.positions.len() as u32;
    for k in 0..6 {
        let (sin, cos) = ops::sin_cos(std::f64::consts::TAU * f64::from(k) / 6.0);
        let offset = radius * (x * cos as f32 + y * sin as f32);
        parts.positions.extend([a + offset, b + offset]);
    }
    for k in 0..6 {
        let at = |k: u32, end: u32| first + 2 * (k % 6) + end;
        parts.indices.extend([at(k, 0), at(k, 1), at(k + 1, 1), at(k, 0), at(k + 1, 1), at(k + 1, 0)]);
    }
}

/// A closed room, seen from inside: large walls, rugged balls of all sizes, and slanted rods, a tenth of the triangles. Also
/// where in the list of indices the objects begin: first walls and rods, then each ball.
fn hall(triangles: usize) -> (MeshParts, Vec<usize>) {
    let mut rng = Rng::new(3);
    let mut parts = MeshParts::default();
    let (low, high) = (Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, 1.0, 2.0));
    let room = tenfold_math::Bounds3::new(low, high);
    parts.positions.extend((0..8).map(|i| room.corner(i)));
    for quad in [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]] {
        parts.indices.extend([quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]]);
    }
    let in_room = |rng: &mut Rng, margin: f32| {
        let u = rng.vec3();
        low + margin + (high - low - 2.0 * margin) * u
    };
    let rods = triangles / 120;
    for _ in 0..rods {
        let a = in_room(&mut rng, 0.05);
        let b = a + 0.4 * rng.direction() * (0.2 + rng.f32());
        rod(&mut parts, a, b.clamp(low, high), 0.001 + 0.02 / (rods as f32).sqrt());
    }
    // Half of the rest in a few balls, half in many.
    let rest = triangles - parts.indices.len() / 3;
    let few = 12;
    let many = (rest / 2 / 80).clamp(1, 20_000);
    let mut starts = vec![0];
    for (count, size) in [(few, 0.25), (many, 0.5 / ops::cbrt(many as f32))] {
        for _ in 0..count {
            let mut centre = in_room(&mut rng, 0.3);
            // They pile up on the floor.
            centre.y = low.y + size + (centre.y - low.y) * 0.5 * rng.f32();
            let radius = size * (0.4 + 0.6 * rng.f32());
            starts.push(parts.indices.len());
            ball(&mut parts, centre, radius, 0.2, rest / 2 / count);
        }
    }
    (parts, starts)
}

/// Vertices and faces of an OBJ file; faces of more corners become fans.
fn obj(text: &str) -> MeshParts {
    let mut parts = MeshParts::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f32> = words.filter_map(|w| w.parse().ok()).collect();
                parts.positions.push(Vec3::new(p[0], p[1], p[2]));
            }
            Some("f") => {
                let face: Vec<u32> =
                    words.filter_map(|w| w.split('/').next()?.parse::<u32>().ok()).map(|i| i - 1).collect();
                for i in 2..face.len() {
                    parts.indices.extend([face[0], face[i - 1], face[i]]);
                }
            }
            _ => {}
        }
    }
    parts
}
