//! Cameras: from a point on the film, a point on the lens and an instant to a ray.

mod lens;
mod projection;
mod shutter;
mod time_strategy;

pub use lens::ThinLens;
pub use projection::{Projection, ScreenWindow};
pub use shutter::{Shutter, ShutterCurve, ShutterSample};
use tenfold_math::{
    Affine3A, Floats, Mat3, Motion, Ray, Rays, Slots, UVec2, Vec2, Vec2s, Vec3, WIDTH, normalize, vectorized,
};
pub use time_strategy::{PathTimes, TimeStrategy};

/// A camera, perhaps moving. Camera space has the view along +z, +y up and +x to the right.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Camera space to world space.
    pub world_from_camera: Motion,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// The lens; `None` for a pinhole.
    pub lens: Option<ThinLens>,
    /// When the shutter is open.
    pub shutter: Shutter,
    /// Pixels of the whole picture.
    pub resolution: UVec2,
}

/// How far the points under neighbouring pixels lie apart on a surface; see [`Camera::pixel_differentials`].
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PixelDifferentials {
    /// From a point to the one a pixel to the right.
    pub dpdx: Vec3,
    /// From a point to the one a pixel down.
    pub dpdy: Vec3,
}

impl Camera {
    /// Whether it has a lens, so that it matters where rays leave from it.
    #[inline]
    pub fn has_lens(&self) -> bool {
        self.lens.is_some()
    }

    /// The ray through `film` (in pixels from the upper left corner of the picture) and the point of the lens that
    /// `u_lens` chooses, at an instant. Its direction has unit length, and its weight is one.
    #[inline]
    pub fn ray(&self, film: Vec2, u_lens: Vec2, time: f32) -> Ray {
        let mut ray = self.projection.ray(film / self.resolution.as_vec2());
        if let Some(lens) = &self.lens {
            ray = lens.refract(ray, u_lens);
        }
        Placement::new(self.world_from_camera.at(time).affine()).ray(ray, time)
    }

    /// [`Camera::ray`] of each slot of `slots`; any ray in the others.
    pub fn rays(&self, slots: Slots, film: &Vec2s, u_lens: &Vec2s, time: &Floats) -> Rays {
        let mut rays = Rays::default();
        if self.world_from_camera.is_moving() {
            slots.for_each(|i| rays.set(i, self.ray(film.get(i), u_lens.get(i), time[i])));
        } else {
            still_rays(self, film, u_lens, time, &mut rays);
        }
        rays
    }

    /// The footprint of a pixel at a point `p` with normal `n` of a surface, as though the camera saw the tangent
    /// plane there directly. Right for points seen directly, and about right, erring to the small side, for
    /// those seen in mirrors (pbrt book, 4th edition, §10.1.1). `scale` narrows it where a pixel has many samples.
    pub fn pixel_differentials(&self, p: Vec3, n: Vec3, time: f32, scale: f32) -> PixelDifferentials {
        let camera_from_world = self.world_from_camera.at(time).inverse();
        let p_camera = camera_from_world.point(p);
        let n_camera = camera_from_world.normal(n);
        let pixel = self.projection.pixel_size(self.resolution);
        let world = camera_from_world.inverse();
        // Where the ray moved by one pixel meets the tangent plane.
        let step = |moved: Ray| {
            let along = moved.direction.dot(n_camera);
            if along == 0.0 {
                return Vec3::ZERO;
            }
            let t = (p_camera - moved.origin).dot(n_camera) / along;
            let d = world.vector(moved.at(t) - p_camera) * scale;
            if d.is_finite() { d } else { Vec3::ZERO }
        };
        let moved = |offset: Vec2| self.projection.ray_to(p_camera, offset);
        PixelDifferentials {
            dpdx: step(moved(Vec2::new(pixel.x, 0.0))),
            dpdy: step(moved(Vec2::new(0.0, -pixel.y))),
        }
    }
}

/// Where a camera is at an instant, in scalars.
#[derive(Copy, Clone)]
struct Placement {
    matrix: Mat3,
    translation: Vec3,
}

impl Placement {
    #[inline]
    fn new(world_from_camera: &Affine3A) -> Self {
        Self { matrix: world_from_camera.matrix3.into(), translation: world_from_camera.translation.into() }
    }

    /// The ray of the world that is `ray` in camera space.
    #[inline(always)]
    fn ray(&self, ray: Ray, time: f32) -> Ray {
        let origin = self.matrix * ray.origin + self.translation;
        Ray::new(origin, normalize(self.matrix * ray.direction), time)
    }
}

vectorized! {
    /// The rays of a camera that stands still.
    fn still_rays(camera: &Camera, film: &Vec2s, u_lens: &Vec2s, time: &Floats, out: &mut Rays) {
        let resolution = camera.resolution.as_vec2();
        // A loop for each projection: its branches are not to be those of the slots.
        match camera.projection {
            Projection::Perspective { window } => {
                for i in 0..WIDTH {
                    out.set(i, Projection::Perspective { window }.ray(film.get(i) / resolution));
                }
            }
            Projection::Orthographic { window } => {
                for i in 0..WIDTH {
                    out.set(i, Projection::Orthographic { window }.ray(film.get(i) / resolution));
                }
            }
        }
        if let Some(lens) = camera.lens {
            for i in 0..WIDTH {
                out.set(i, lens.refract(out.get(i), u_lens.get(i)));
            }
        }
        let placement = Placement::new(camera.world_from_camera.start().affine());
        for i in 0..WIDTH {
            out.set(i, placement.ray(out.get(i), time[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::ops;
    use tenfold_math::{Transform, vec2};

    fn camera(projection: Projection, lens: Option<ThinLens>) -> Camera {
        Camera {
            world_from_camera: Motion::still(Transform::IDENTITY),
            projection,
            lens,
            shutter: Shutter { open: 0.0, close: 1.0, curve: ShutterCurve::Box },
            resolution: UVec2::new(200, 100),
        }
    }

    #[test]
    fn corners_of_the_film_see_the_field_of_view() {
        let c = camera(Projection::perspective(90f32.to_radians(), ScreenWindow::for_aspect(2.0)), None);
        let d = c.ray(vec2(0.0, 0.0), Vec2::splat(0.5), 0.0).direction;
        // The narrower axis spans 90°; the film's upper left is at -x and +y.
        assert!((d / d.z - Vec3::new(-2.0, 1.0, 1.0)).length() < 1e-5, "{d}");
        let d = c.ray(vec2(100.0, 50.0), Vec2::splat(0.5), 0.0).direction;
        assert!((d - Vec3::Z).length() < 1e-6);
    }

    #[test]
    fn slots_have_the_rays_of_each_alone() {
        let lens = ThinLens { radius: 0.3, focal_distance: 5.0 };
        let window = ScreenWindow::for_aspect(2.0);
        let turned = |angle| {
            let turn = Transform::rotate(angle, Vec3::new(1.0, 2.0, 3.0)).unwrap();
            Transform::translate(Vec3::new(1.0, -2.0, 0.5)) * turn
        };
        let motions = [Motion::still(turned(0.7)), Motion::new(turned(0.7), 0.0, turned(0.9), 1.0)];
        let number = |i: usize, k: usize| ((i + 1) * k % 97) as f32 / 97.0;
        for projection in [Projection::perspective(0.6, window), Projection::orthographic(window)] {
            for (lens, motion) in [None, Some(lens)].iter().flat_map(|l| motions.iter().map(move |m| (l, m)))
            {
                let c = Camera { world_from_camera: motion.clone(), ..camera(projection, *lens) };
                let (mut film, mut u) = (Vec2s::ZERO, Vec2s::ZERO);
                let time = std::array::from_fn(|i| number(i, 13));
                for i in 0..WIDTH {
                    film.set(i, vec2(200.0 * number(i, 5), 100.0 * number(i, 7)));
                    // The centre of the lens too.
                    u.set(i, if i == 3 { Vec2::splat(0.5) } else { vec2(number(i, 11), number(i, 17)) });
                }
                let slots = Slots::first(WIDTH - 2);
                let rays = c.rays(slots, &film, &u, &time);
                for i in slots {
                    assert_eq!(rays.get(i), c.ray(film.get(i), u.get(i), time[i]), "{c:?}");
                }
            }
        }
    }

    #[test]
    fn all_rays_through_the_lens_meet_in_the_plane_of_focus() {
        let lens = ThinLens { radius: 0.3, focal_distance: 5.0 };
        for projection in [
            Projection::perspective(0.6, ScreenWindow::for_aspect(2.0)),
            Projection::orthographic(ScreenWindow::for_aspect(2.0)),
        ] {
            let c = camera(projection, Some(lens));
            let film = vec2(31.0, 77.0);
            let meet = |u: Vec2| {
                let r = c.ray(film, u, 0.0);
                r.at((5.0 - r.origin.z) / r.direction.z)
            };
            let focus = meet(Vec2::splat(0.5));
            for u in [vec2(0.0, 0.1), vec2(0.9, 0.4), vec2(0.3, 0.99)] {
                assert!((meet(u) - focus).length() < 1e-5);
            }
        }
    }

    #[test]
    fn a_lens_focuses_however_far() {
        let pinhole = camera(Projection::perspective(0.6, ScreenWindow::for_aspect(2.0)), None);
        let film = vec2(31.0, 77.0);
        let chief = pinhole.ray(film, Vec2::ZERO, 0.0).direction;
        for focal_distance in [1e19, 1e30, f32::MAX] {
            let lens = Camera { lens: Some(ThinLens { radius: 0.3, focal_distance }), ..pinhole.clone() };
            let seen = lens.ray(film, vec2(0.9, 0.4), 0.0);
            assert!(
                (seen.direction - chief).length() < 1e-6 && seen.origin != Vec3::ZERO,
                "{focal_distance}"
            );
        }
    }

    /// A point at depth z is seen through the whole lens: its image spreads over a circle of confusion whose
    /// radius follows from similar triangles, `r_film(z) = R · |z - f| / z · (pixels per unit at depth f)`, which is
    /// the thin lens formula with the film at the conjugate of the plane of focus.
    #[test]
    fn circle_of_confusion_follows_the_lens_formula() {
        let lens = ThinLens { radius: 0.25, focal_distance: 4.0 };
        let fov = 0.7f32;
        let c = camera(Projection::perspective(fov, ScreenWindow::for_aspect(2.0)), Some(lens));
        for depth in [2.0f32, 3.0, 6.0, 20.0] {
            // For every lens point, find the film point whose ray passes the point (0, 0, depth): the film point
            // of the chief ray through where the line lens → point crosses the plane of focus.
            let pixels_per_unit = 50.0 / (ops::tan(fov / 2.0) * lens.focal_distance);
            let expected = lens.radius * (depth - lens.focal_distance).abs() / depth * pixels_per_unit;
            let mut largest = 0f32;
            for i in 0..64 {
                let u = vec2(i as f32 / 64.0, 0.0);
                let on_lens = c.ray(vec2(100.0, 50.0), u, 0.0).origin;
                let at_focus =
                    on_lens + (Vec3::new(0.0, 0.0, depth) - on_lens) * (lens.focal_distance / depth);
                let film = vec2(100.0 + at_focus.x * pixels_per_unit, 50.0 - at_focus.y * pixels_per_unit);
                let ray = c.ray(film, u, 0.0);
                let p = ray.at((depth - ray.origin.z) / ray.direction.z);
                assert!(p.truncate().length() < 1e-4, "{p}");
                largest = largest.max(film.distance(vec2(100.0, 50.0)));
            }
            assert!((largest / expected - 1.0).abs() < 1e-3, "{depth}: {largest} {expected}");
        }
    }

    #[test]
    fn the_footprint_is_the_distance_between_neighbouring_pixels() {
        for projection in [
            Projection::perspective(0.6, ScreenWindow::for_aspect(2.0)),
            Projection::orthographic(ScreenWindow::for_aspect(2.0)),
        ] {
            let c = camera(projection, None);
            let n = Vec3::new(0.1, 0.2, -1.0).normalize();
            let hit = |film: Vec2| {
                let r = c.ray(film, Vec2::splat(0.5), 0.0);
                r.at((Vec3::new(0.0, 0.0, 7.0) - r.origin).dot(n) / r.direction.dot(n))
            };
            let film = vec2(120.0, 40.0);
            let f = c.pixel_differentials(hit(film), n, 0.0, 1.0);
            let near = |a: Vec3, b: Vec3| (a - b).length() < 0.01 * b.length();
            assert!(near(f.dpdx, hit(film + vec2(1.0, 0.0)) - hit(film)), "{f:?}");
            assert!(near(f.dpdy, hit(film + vec2(0.0, 1.0)) - hit(film)), "{f:?}");
        }
    }
}
