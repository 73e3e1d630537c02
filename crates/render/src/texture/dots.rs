//! Polka dots at random places in the cells of a grid.

use tenfold_math::{Vec2, Vec3};

use super::{Mapping2, TextureContext, noise::noise};

/// Dots of one texture on another (slots `S`).
#[derive(Clone, Debug, PartialEq)]
pub struct Dots<S> {
    /// How they lie on surfaces.
    pub mapping: Mapping2,
    /// The texture in the dots.
    pub inside: S,
    /// The texture around them.
    pub outside: S,
}

impl<S> Dots<S> {
    /// The texture that is seen at a point.
    #[inline]
    pub fn choose(&self, at: &TextureContext) -> &S {
        if inside_dot(self.mapping.map(at).st) { &self.inside } else { &self.outside }
    }
}

/// Whether a point is in a dot. Dots have radius 0.35 and fill about half of the cells, which are centred at whole
/// coordinates (pbrt book, 4th edition, online chapter "Texture", §10.5.1).
fn inside_dot(st: Vec2) -> bool {
    const RADIUS: f32 = 0.35;
    let cell = (st + Vec2::splat(0.5)).floor();
    let random = |s: f32, t: f32| noise(Vec3::new(cell.x + s, cell.y + t, 0.5));
    if random(0.5, 0.5) <= 0.0 {
        return false;
    }
    // Noise is within [-1, 1], so that a dot stays in its cell.
    let shift = (0.5 - RADIUS) * Vec2::new(random(1.5, 2.8), random(4.5, 9.8));
    (st - cell - shift).length_squared() < RADIUS * RADIUS
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::vec2;

    #[test]
    fn dots_cover_their_share_and_stay_in_their_cells() {
        let (mut inside, mut with_dot) = (0, 0);
        for s in 0..40 {
            for t in 0..40 {
                let cell = vec2(s as f32, t as f32);
                let mut count = 0;
                for i in 0..20 {
                    for j in 0..20 {
                        let d = (vec2(i as f32, j as f32) + 0.5) / 20.0 - 0.5;
                        count += i32::from(inside_dot(cell + d));
                    }
                }
                inside += count;
                with_dot += i32::from(count > 0);
                // Each dot lies whole in its cell: its area is π · 0.35².
                let area = count as f32 / 400.0;
                assert!(count == 0 || (area - 0.3848).abs() < 0.03, "{cell}: {area}");
            }
        }
        assert!((500..1100).contains(&with_dot), "{with_dot}");
        assert!(inside > 0);
    }
}
