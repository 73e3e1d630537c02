use tenfold_math::{Ray, Vec2, normalize};
use tenfold_sampling::warp;

/// A thin lens: rays from one film point through any point of the lens meet in the plane of focus
/// (Cook, Porter and Carpenter 1984; pbrt book, 4th edition, §5.2.3).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ThinLens {
    /// Radius of the aperture.
    pub radius: f32,
    /// Distance from the lens to the plane of focus, along z.
    pub focal_distance: f32,
}

impl ThinLens {
    /// The ray through the lens point that `u` chooses, for the pinhole's ray `chief` in camera space.
    #[inline(always)]
    pub fn refract(&self, chief: Ray, u: Vec2) -> Ray {
        let t = self.focal_distance / chief.direction.z;
        let on_lens = (self.radius * warp::sample_uniform_disk_concentric(u)).extend(0.0);
        // From the lens to the focus, over the larger of `t` and one: the squares of far and near distances stay in range.
        let to_focus = if t > 1.0 { chief.direction - on_lens / t } else { t * chief.direction - on_lens };
        // Perspective: all chief rays start at the centre of the lens. Orthographic: each at its own place.
        Ray::new(chief.origin + on_lens, normalize(to_focus), chief.time)
    }
}
