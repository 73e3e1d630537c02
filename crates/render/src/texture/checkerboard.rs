//! Two textures in turn, in squares or cubes of side one.

use tenfold_math::{Vec2, Vec3, ops::floor};

use super::{Mapping2, Mapping3, TextureContext};

/// How a board lies on surfaces.
#[derive(Clone, Debug, PartialEq)]
pub enum Board {
    /// Squares.
    Squares(Mapping2),
    /// Cubes.
    Cubes(Mapping3),
}

/// A checkerboard of two textures (slots `S`).
#[derive(Clone, Debug, PartialEq)]
pub struct Checkerboard<S> {
    /// How it lies.
    pub board: Board,
    /// The texture of the field at the origin and that of its neighbours.
    pub textures: [S; 2],
}

impl Board {
    /// The weight of the second texture, in [0, 1]: 0 or 1 for a vanishing footprint, else its share under a tent
    /// filter of 1.5 footprints to either side (as pbrt-v4).
    #[inline]
    pub fn weight(&self, at: &TextureContext) -> f32 {
        const RADIUS: f32 = 1.5;
        let sign = match self {
            Self::Squares(mapping) => {
                let c = mapping.map(at);
                let r: Vec2 = RADIUS * c.dstdx.abs().max(c.dstdy.abs());
                wave(c.st.x, r.x) * wave(c.st.y, r.y)
            }
            Self::Cubes(mapping) => {
                let c = mapping.map(at);
                let r: Vec3 = RADIUS * c.dpdx.abs().max(c.dpdy.abs());
                wave(c.p.x, r.x) * wave(c.p.y, r.y) * wave(c.p.z, r.z)
            }
        };
        0.5 - 0.5 * sign
    }
}

/// The square wave that is 1 on [0, 1) and −1 on [1, 2), under a tent filter of half width `r`.
#[inline]
fn wave(x: f32, r: f32) -> f32 {
    let field = floor(x - r);
    if field == floor(x + r) {
        return if floor(0.5 * field) == 0.5 * field { 1.0 } else { -1.0 };
    }
    filtered_wave(x, r)
}

/// [`wave`] where the filter reaches over a border.
#[inline(never)]
fn filtered_wave(x: f32, r: f32) -> f32 {
    // A tent is a box applied to itself, so its integral is the second difference of the wave's second
    // antiderivative. The part of that which grows with x cancels and is left out for the sake of rounding.
    let second_antiderivative = |x: f32| {
        let y = 0.5 * x - floor(0.5 * x) - 0.5;
        y * (1.0 - 2.0 * y.abs())
    };
    let difference =
        second_antiderivative(x + r) - 2.0 * second_antiderivative(x) + second_antiderivative(x - r);
    (difference / (r * r)).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Footprint;
    use tenfold_math::{vec2, vec3};

    #[test]
    fn point_sampled_squares_alternate() {
        let board = Board::Squares(Mapping2::default());
        for (uv, want) in [
            (vec2(0.5, 0.5), 0.0),
            (vec2(1.5, 0.5), 1.0),
            (vec2(0.0, 0.0), 0.0),
            (vec2(1.0, 0.0), 1.0),
            (vec2(0.999_999, 0.5), 0.0),
            (vec2(-0.5, 0.5), 1.0),
            (vec2(-0.5, -0.5), 0.0),
            (vec2(-2.5, 1.5), 0.0),
            (vec2(1001.5, 2.5), 1.0),
        ] {
            assert_eq!(board.weight(&TextureContext::at_uv(uv)), want, "{uv}");
        }
    }

    #[test]
    fn point_sampled_cubes_alternate() {
        let board = Board::Cubes(Mapping3::default());
        for (p, want) in [(vec3(0.5, 0.5, 0.5), 0.0), (vec3(0.5, 0.5, 1.5), 1.0), (vec3(-0.5, 0.5, 1.5), 0.0)]
        {
            assert_eq!(board.weight(&TextureContext::at_point(p)), want, "{p}");
        }
    }

    #[test]
    fn filtered_squares_are_the_integral_under_the_tent() {
        let f = Footprint { dudx: 0.2, dudy: -0.1, dvdx: 0.05, dvdy: 0.4, ..Footprint::default() };
        let board = Board::Squares(Mapping2::default());
        for uv in [vec2(0.95, 0.3), vec2(3.1, -2.2), vec2(500.02, 0.9)] {
            let got = board.weight(&TextureContext { footprint: f, ..TextureContext::at_uv(uv) });
            let n = 2000;
            let along = |x: f32, r: f64| {
                (0..n)
                    .map(|i| {
                        let t = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                        let cell = (f64::from(x) + t * r).floor() as i64;
                        (1.0 - t.abs()) * if cell.rem_euclid(2) == 0 { 1.0 } else { -1.0 }
                    })
                    .sum::<f64>()
                    * 2.0
                    / f64::from(n)
            };
            let want = 0.5 - 0.5 * along(uv.x, 0.3) * along(uv.y, 0.6);
            assert!((f64::from(got) - want).abs() < 2e-3, "{uv}: {got}, not {want}");
        }
    }

    #[test]
    fn a_wide_footprint_gives_the_mean() {
        let f = Footprint { dudx: 50.3, dvdy: 71.7, ..Footprint::default() };
        let at = TextureContext { footprint: f, ..TextureContext::at_uv(vec2(0.3, 0.4)) };
        assert!((Board::Squares(Mapping2::default()).weight(&at) - 0.5).abs() < 1e-3);
    }
}
