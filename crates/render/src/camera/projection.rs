use tenfold_math::ops;
use tenfold_math::{Ray, UVec2, Vec2, Vec3, normalize, vec2};

/// The part of the plane z = 1 (perspective, in units of tan(fov / 2)) or of the film (orthographic) in view.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ScreenWindow {
    /// Left and bottom.
    pub min: Vec2,
    /// Right and top.
    pub max: Vec2,
}

impl ScreenWindow {
    /// The window with this ratio of width to height whose shorter side goes from -1 to 1.
    pub fn for_aspect(aspect: f32) -> Self {
        let half = if aspect > 1.0 { vec2(aspect, 1.0) } else { vec2(1.0, 1.0 / aspect) };
        Self { min: -half, max: half }
    }

    /// The point at fractions `f` of width and height from the upper left corner.
    #[inline(always)]
    fn at(&self, f: Vec2) -> Vec2 {
        vec2(self.min.x + (self.max.x - self.min.x) * f.x, self.max.y + (self.min.y - self.max.y) * f.y)
    }
}

/// How directions go with points of the film.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Projection {
    /// Through one point.
    Perspective {
        /// What is in view on the plane z = 1.
        window: ScreenWindow,
    },
    /// Parallel to z.
    Orthographic {
        /// What is in view on the plane z = 0.
        window: ScreenWindow,
    },
}

impl Projection {
    /// A perspective in which the extent from -1 to 1 of `window` spans the angle `fov`, in radians.
    pub fn perspective(fov: f32, window: ScreenWindow) -> Self {
        let tan = ops::tan(0.5 * fov);
        Self::Perspective { window: ScreenWindow { min: window.min * tan, max: window.max * tan } }
    }

    /// A parallel projection.
    pub fn orthographic(window: ScreenWindow) -> Self {
        Self::Orthographic { window }
    }

    /// The ray at fractions `f` of the picture from its upper left corner, in camera space, of unit length.
    #[inline(always)]
    pub fn ray(&self, f: Vec2) -> Ray {
        match self {
            Self::Perspective { window } => Ray::new(Vec3::ZERO, normalize(window.at(f).extend(1.0)), 0.0),
            Self::Orthographic { window } => Ray::new(window.at(f).extend(0.0), Vec3::Z, 0.0),
        }
    }

    /// Width and height of a pixel on the window.
    pub(super) fn pixel_size(&self, resolution: UVec2) -> Vec2 {
        let (Self::Perspective { window } | Self::Orthographic { window }) = self;
        (window.max - window.min) / resolution.as_vec2()
    }

    /// The ray that sees the point `p` of camera space, moved by `offset` on the window.
    pub(super) fn ray_to(&self, p: Vec3, offset: Vec2) -> Ray {
        match self {
            Self::Perspective { .. } => Ray::new(Vec3::ZERO, (p.truncate() / p.z + offset).extend(1.0), 0.0),
            Self::Orthographic { .. } => Ray::new((p.truncate() + offset).extend(0.0), Vec3::Z, 0.0),
        }
    }
}
