//! Values at the corners of the unit square, interpolated between them (and beyond).

use std::ops::{Add, Mul};

use super::{Mapping2, TextureContext};

/// Corner values (`V`: numbers or spectra) and how the square lies on surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Bilerp<V> {
    /// How it lies.
    pub mapping: Mapping2,
    /// Values at (s, t) = (0, 0), (0, 1), (1, 0) and (1, 1).
    pub corners: [V; 4],
}

impl<T> Bilerp<T> {
    /// The value at a point.
    #[inline]
    pub(crate) fn eval<V>(&self, at: &TextureContext, value: impl Fn(&T) -> V) -> V
    where
        V: Add<Output = V> + Mul<f32, Output = V>,
    {
        let st = self.mapping.map(at).st;
        let [v00, v01, v10, v11] = &self.corners;
        value(v00) * ((1.0 - st.x) * (1.0 - st.y))
            + value(v01) * ((1.0 - st.x) * st.y)
            + value(v10) * (st.x * (1.0 - st.y))
            + value(v11) * (st.x * st.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::{Vec2, vec2};

    #[test]
    fn corners_and_centre() {
        let t = Bilerp { mapping: Mapping2::default(), corners: [1.0, 2.0, 4.0, 8.0] };
        let at = |uv: Vec2| t.eval(&TextureContext::at_uv(uv), |v: &f32| *v);
        assert_eq!(at(vec2(0.0, 0.0)), 1.0);
        assert_eq!(at(vec2(0.0, 1.0)), 2.0);
        assert_eq!(at(vec2(1.0, 0.0)), 4.0);
        assert_eq!(at(vec2(1.0, 1.0)), 8.0);
        assert_eq!(at(vec2(0.5, 0.5)), 3.75);
        assert_eq!(at(vec2(0.25, 0.0)), 1.75);
    }
}
