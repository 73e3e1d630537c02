//! What lies beyond the edges of an image.

/// How pixel coordinates outside of an image are brought back into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WrapMode {
    /// The image tiles the plane.
    Repeat,
    /// Zero outside.
    Black,
    /// The nearest pixel of the edge.
    Clamp,
    /// The image is an equal-area octahedral map of the sphere (Clarberg 2008): crossing an edge continues on the
    /// other half of the same edge, so the map is continuous everywhere.
    OctahedralSphere,
}

impl WrapMode {
    /// The pixel of an image of `resolution` (width, height, neither zero) that stands at (x, y); `None` where
    /// that is black.
    ///
    /// For `OctahedralSphere` the point just beyond an edge is the point just inside of it, mirrored over the
    /// edge's middle. (pbrt-v4's `RemapPixelCoords` is one texel off beyond the left and top edges.)
    #[inline]
    pub fn remap(self, x: i32, y: i32, resolution: (u32, u32)) -> Option<(u32, u32)> {
        let (width, height) = resolution;
        if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
            && x < width
            && y < height
        {
            return Some((x, y));
        }
        // 64 bits, since neither unsigned sizes nor negated coordinates fit 32.
        let (x, y, w, h) = (i64::from(x), i64::from(y), i64::from(width), i64::from(height));
        let (x, y) = match self {
            WrapMode::Repeat => (x.rem_euclid(w), y.rem_euclid(h)),
            WrapMode::Black => return None,
            WrapMode::Clamp => (x.clamp(0, w - 1), y.clamp(0, h - 1)),
            WrapMode::OctahedralSphere => {
                // Every crossing of an edge, vertical or horizontal, turns the map by half a turn; two cancel.
                let (column, row) = (x.rem_euclid(w), y.rem_euclid(h));
                let crossings = x.div_euclid(w) + y.div_euclid(h);
                if crossings % 2 == 0 { (column, row) } else { (w - 1 - column, h - 1 - row) }
            }
        };
        Some((x as u32, y as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inside_is_left_alone() {
        for wrap in [WrapMode::Repeat, WrapMode::Black, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            assert_eq!(wrap.remap(2, 1, (3, 2)), Some((2, 1)));
            assert_eq!(wrap.remap(0, 0, (3, 2)), Some((0, 0)));
        }
    }

    #[test]
    fn repeat_clamp_and_black() {
        assert_eq!(WrapMode::Repeat.remap(-1, 5, (3, 2)), Some((2, 1)));
        assert_eq!(WrapMode::Clamp.remap(-1, 5, (3, 2)), Some((0, 1)));
        assert_eq!(WrapMode::Black.remap(-1, 0, (3, 2)), None);
        assert_eq!(WrapMode::Black.remap(0, 2, (3, 2)), None);
    }

    #[test]
    fn the_octahedral_map_folds_over_its_edges() {
        let map = |x, y| WrapMode::OctahedralSphere.remap(x, y, (4, 4));
        assert_eq!(map(-1, 0), Some((0, 3)));
        assert_eq!(map(4, 1), Some((3, 2)));
        assert_eq!(map(1, -1), Some((2, 0)));
        assert_eq!(map(0, 4), Some((3, 3)));
        // Beyond a corner lies the opposite corner: all four corners are one point of the sphere.
        assert_eq!(map(-1, -1), Some((3, 3)));
        assert_eq!(WrapMode::OctahedralSphere.remap(-1, 7, (1, 1)), Some((0, 0)));
    }

    #[test]
    fn extreme_coordinates_stay_inside() {
        for wrap in [WrapMode::Repeat, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            for x in [i32::MIN, i32::MAX] {
                for y in [i32::MIN, i32::MAX] {
                    let (x, y) = wrap.remap(x, y, (7, 3)).unwrap();
                    assert!(x < 7 && y < 3);
                }
            }
        }
    }
}
