use tenfold_math::UVec2;

/// A half-open rectangle of pixels: `min` lies within, `max` does not.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct PixelBounds {
    /// Left column and top row.
    pub min: UVec2,
    /// One past the right column and the bottom row.
    pub max: UVec2,
}

impl PixelBounds {
    /// The whole of a picture.
    pub fn full(resolution: UVec2) -> Self {
        Self { min: UVec2::ZERO, max: resolution }
    }

    /// Width and height.
    pub fn size(&self) -> UVec2 {
        self.max.saturating_sub(self.min)
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.size().x as usize * self.size().y as usize
    }

    /// Whether there is no pixel.
    pub fn is_empty(&self) -> bool {
        self.area() == 0
    }

    /// The pixels in both.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Whether `p` lies within.
    pub fn contains(&self, p: UVec2) -> bool {
        p.cmpge(self.min).all() && p.cmplt(self.max).all()
    }

    /// The place of `p` in row-major order.
    #[inline]
    pub fn index(&self, p: UVec2) -> usize {
        debug_assert!(self.contains(p));
        let d = p - self.min;
        d.y as usize * (self.max.x - self.min.x) as usize + d.x as usize
    }

    /// All pixels, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = UVec2> + use<> {
        let (min, max) = (self.min, self.max);
        (min.y..max.y).flat_map(move |y| (min.x..max.x).map(move |x| UVec2::new(x, y)))
    }

    /// The pieces of at most `side × side` pixels that make up the rectangle, row by row.
    pub fn tiles(&self, side: u32) -> Vec<Self> {
        let count = self.size().map(|n| n.div_ceil(side));
        (0..count.y)
            .flat_map(|y| (0..count.x).map(move |x| UVec2::new(x, y)))
            .map(|tile| {
                let min = self.min + tile * side;
                Self { min, max: (min + side).min(self.max) }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let bounds = PixelBounds { min: UVec2::new(3, 5), max: UVec2::new(40, 22) };
        let mut seen = vec![0; bounds.area()];
        for tile in bounds.tiles(16) {
            tile.pixels().for_each(|p| seen[bounds.index(p)] += 1);
        }
        assert!(seen.iter().all(|&n| n == 1));
    }
}
