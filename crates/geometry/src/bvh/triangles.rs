//! A block of triangles against a ray: [`RayShear::intersect`](crate::shape::RayShear::intersect), side by side.

use super::{
    node::{LANES, TriangleBlock},
    simd::Vector,
};
use crate::shape::RayShear;
use tenfold_math::{Vec3, gamma};

/// A [`RayShear`] in all lanes.
#[derive(Copy, Clone)]
pub(super) struct Shear<V> {
    scalar: RayShear,
    /// Origin by permuted axis.
    origin: [V; 3],
    shear: [V; 3],
}

/// Lanes that were hit, one bit each, and where.
pub(super) struct BlockHits {
    pub(super) lanes: u32,
    pub(super) t: [f32; LANES],
    pub(super) u: [f32; LANES],
    pub(super) v: [f32; LANES],
}

impl<V: Vector> Shear<V> {
    #[inline(always)]
    pub(super) fn new(scalar: RayShear) -> Self {
        let o = scalar.permuted_origin();
        let s = scalar.shear;
        Self {
            scalar,
            origin: [V::splat(o.x), V::splat(o.y), V::splat(o.z)],
            shear: [V::splat(s.x), V::splat(s.y), V::splat(s.z)],
        }
    }

    /// The triangles hit with `t_error < t <= t_max`.
    #[inline(always)]
    pub(super) fn intersect(&self, block: &TriangleBlock, t_max: f32) -> Option<BlockHits> {
        let [kx, ky, kz] = self.scalar.axes;
        let [ox, oy, oz] = self.origin;
        let [sx, sy, sz] = self.shear;
        let z: [V; 3] = from_fn(|i| V::load(&block.axes[kz][i]).sub(oz));
        let x: [V; 3] = from_fn(|i| V::load(&block.axes[kx][i]).sub(ox).add(sx.mul(z[i])));
        let y: [V; 3] = from_fn(|i| V::load(&block.axes[ky][i]).sub(oy).add(sy.mul(z[i])));
        let edge = |i: usize, j: usize| x[i].mul(y[j]).sub(y[i].mul(x[j]));
        let e = [edge(1, 2), edge(2, 0), edge(0, 1)];
        let zero = V::splat(0.0);
        let lowest = e[0].min(e[1].min(e[2]));
        let highest = e[0].max(e[1].max(e[2]));
        let inside = zero.le(lowest) | highest.le(zero);
        if inside == 0 {
            return None;
        }
        let det = e[0].add(e[1]).add(e[2]);
        let inv_det = V::splat(1.0).div(det);
        let tz = from_fn(|i| z[i].mul(sz));
        let t = e[0].mul(tz[0]).add(e[1].mul(tz[1])).add(e[2].mul(tz[2])).mul(inv_det);
        let flat = inside & det.eq(zero);
        let lanes = inside & !flat & in_front(t, [x, y, z], tz, inv_det) & t.le(V::splat(t_max));
        if lanes | flat == 0 {
            return None;
        }
        let mut hits = BlockHits {
            lanes,
            t: t.to_array(),
            u: e[1].mul(inv_det).to_array(),
            v: e[2].mul(inv_det).to_array(),
        };
        if flat != 0 {
            self.flat_lanes(block, t_max, flat, &mut hits);
        }
        Some(hits)
    }

    /// Lanes whose edge functions all cancelled, one by one.
    #[cold]
    fn flat_lanes(&self, block: &TriangleBlock, t_max: f32, flat: u32, hits: &mut BlockHits) {
        for lane in (0..LANES).filter(|lane| flat >> lane & 1 != 0) {
            let p = std::array::from_fn(|vertex| {
                Vec3::new(
                    block.axes[0][vertex][lane],
                    block.axes[1][vertex][lane],
                    block.axes[2][vertex][lane],
                )
            });
            if let Some(hit) = self.scalar.intersect(p, t_max.next_up()) {
                hits.lanes |= 1 << lane;
                (hits.t[lane], hits.u[lane], hits.v[lane]) = (hit.t, hit.u, hit.v);
            }
        }
    }
}

#[inline(always)]
fn from_fn<V>(f: impl Fn(usize) -> V) -> [V; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
fn max<V: Vector>(a: [V; 3]) -> V {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// As `is_in_front` of the triangle shape.
#[inline(always)]
fn in_front<V: Vector>(t: V, coordinates: [[V; 3]; 3], z: [V; 3], inv_det: V) -> u32 {
    let c = |x: f32| V::splat(x);
    let delta_t = c(gamma(8)).mul(max(z));
    let nearest = z[0].min(z[1].min(z[2]));
    let [x, y, z_] = coordinates;
    let (max_x, max_y, max_z) = (max(x), max(y), max(z_));
    let delta_x = c(gamma(5)).mul(max_x.add(max_z));
    let delta_y = c(gamma(5)).mul(max_y.add(max_z));
    let delta_e =
        c(2.0).mul(c(gamma(2)).mul(max_x).mul(max_y).add(delta_y.mul(max_x)).add(delta_x.mul(max_y)));
    let range = z[0].max(z[1].max(z[2])).sub(nearest);
    let error = delta_t.add(c(3.0).mul(delta_e).mul(range).mul(inv_det.abs()));
    delta_t.lt(nearest) | error.lt(t)
}
