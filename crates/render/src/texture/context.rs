use tenfold_geometry::SurfaceInteraction;
use tenfold_math::{Vec2, Vec3};

/// How the surface point moves when the point of the film moves by one pixel in x and in y: what a texture must
/// average over. All zero where the texture is to be sampled at a point.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Footprint {
    /// ∂u/∂x.
    pub dudx: f32,
    /// ∂u/∂y.
    pub dudy: f32,
    /// ∂v/∂x.
    pub dvdx: f32,
    /// ∂v/∂y.
    pub dvdy: f32,
    /// ∂p/∂x.
    pub dpdx: Vec3,
    /// ∂p/∂y.
    pub dpdy: Vec3,
}

impl Footprint {
    /// The footprint on a surface when one pixel in x and in y are `dpdx` and `dpdy` on it.
    #[inline]
    pub fn new(surface: &SurfaceInteraction, dpdx: Vec3, dpdy: Vec3) -> Self {
        let (dpdu, dpdv) = (surface.dpdu, surface.dpdv);
        // Least squares for dpdx ≈ dudx · dpdu + dvdx · dpdv (pbrt book, 4th edition, §10.1.1).
        let (uu, uv, vv) = (dpdu.length_squared(), dpdu.dot(dpdv), dpdv.length_squared());
        let det = uu * vv - uv * uv;
        let inverse = if det == 0.0 { 0.0 } else { 1.0 / det };
        let solve = |d: Vec3| {
            let (du, dv) = (dpdu.dot(d), dpdv.dot(d));
            let solution = Vec2::new(vv * du - uv * dv, uu * dv - uv * du) * inverse;
            // Grazing views make footprints without end, and degenerate parametrisations none at all.
            let bounded = |x: f32| if x.is_finite() { x.clamp(-1e8, 1e8) } else { 0.0 };
            Vec2::new(bounded(solution.x), bounded(solution.y))
        };
        let (x, y) = (solve(dpdx), solve(dpdy));
        Self { dudx: x.x, dudy: y.x, dvdx: x.y, dvdy: y.y, dpdx, dpdy }
    }
}

/// Where on a surface a texture is evaluated.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct TextureContext {
    /// The point, in world space.
    pub p: Vec3,
    /// The geometric normal there, of unit length.
    pub n: Vec3,
    /// The surface's parameters.
    pub uv: Vec2,
    /// What to average over.
    pub footprint: Footprint,
    /// Which face of a mesh, for textures kept per face.
    pub face_index: u32,
}

impl TextureContext {
    /// The point sample where a ray meets a surface.
    #[inline]
    pub fn at(surface: &SurfaceInteraction) -> Self {
        Self {
            p: surface.p,
            n: surface.n,
            uv: surface.uv,
            footprint: Footprint::default(),
            face_index: surface.face_index,
        }
    }

    /// The surface around where a ray meets it, when one pixel in x and in y are `dpdx` and `dpdy` on it.
    #[inline]
    pub fn with_differentials(surface: &SurfaceInteraction, dpdx: Vec3, dpdy: Vec3) -> Self {
        Self { footprint: Footprint::new(surface, dpdx, dpdy), ..Self::at(surface) }
    }

    /// The point sample at `uv` of a surface at the origin: for tests and for tables over the parameters.
    pub fn at_uv(uv: Vec2) -> Self {
        Self { uv, n: Vec3::Z, ..Self::default() }
    }

    /// The point sample at the world-space point `p`.
    pub fn at_point(p: Vec3) -> Self {
        Self { p, n: Vec3::Z, ..Self::default() }
    }
}
