use crate::Vec3;

/// An axis-aligned box; empty where `min > max`.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Bounds3 {
    /// The corner of least coordinates.
    pub min: Vec3,
    /// The corner of greatest coordinates.
    pub max: Vec3,
}

impl Bounds3 {
    /// The box around nothing: the identity of [`Bounds3::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box with two opposite corners `a` and `b`.
    #[inline]
    pub fn new(a: Vec3, b: Vec3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box around `points`.
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::include)
    }

    /// The smallest box around this one and the point `p`.
    #[inline]
    #[must_use]
    pub fn include(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    #[inline]
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// This box grown by `by` on every side.
    #[inline]
    #[must_use]
    pub fn expanded(self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Whether the box holds no point.
    #[inline]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Edge lengths (negative where empty).
    #[inline]
    pub fn diagonal(&self) -> Vec3 {
        self.max - self.min
    }

    /// The middle.
    #[inline]
    pub fn centroid(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Half the surface area: what the surface area heuristic compares; 0 where empty.
    #[inline]
    pub fn half_area(&self) -> f32 {
        let d = self.diagonal().max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The axis (0, 1, 2) of the longest edge.
    pub fn longest_axis(&self) -> usize {
        let d = self.diagonal();
        if d.x > d.y && d.x > d.z {
            0
        } else if d.y > d.z {
            1
        } else {
            2
        }
    }

    /// Whether `p` lies inside or on the border.
    #[inline]
    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// Corner `i` of 8; bit `k` of `i` chooses the greater coordinate on axis `k`.
    #[inline]
    pub fn corner(&self, i: usize) -> Vec3 {
        let pick = |axis: usize| if i >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    }

    /// Centre and radius of the sphere through the corners; radius 0 where empty.
    pub fn bounding_sphere(&self) -> (Vec3, f32) {
        if self.is_empty() {
            return (Vec3::ZERO, 0.0);
        }
        let centre = self.centroid();
        (centre, centre.distance(self.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn union_with_empty_changes_nothing() {
        let b = Bounds3::new(Vec3::ONE, Vec3::ZERO);
        assert_eq!(b.union(Bounds3::EMPTY), b);
        assert!(Bounds3::EMPTY.is_empty() && !b.is_empty());
        assert_eq!(b.half_area(), 3.0);
        assert_eq!(Bounds3::around((0..8).map(|i| b.corner(i))), b);
    }
}
