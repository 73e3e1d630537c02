//! Solid textures made of noise (pbrt book, 4th edition, online chapter "Texture", §10.5).

use tenfold_math::ops;
use tenfold_math::{Vec3, lerp};

use super::{
    Mapping3, TextureContext,
    noise::{fbm, turbulence},
};

/// Fractional Brownian motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Fbm {
    /// Where it lies.
    pub mapping: Mapping3,
    /// Number of octaves.
    pub octaves: u32,
    /// Ratio of the amplitudes of neighbouring octaves.
    pub omega: f32,
}

impl Fbm {
    /// The value at a point, about 0 in the mean.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        let c = self.mapping.map(at);
        fbm(c.p, c.dpdx, c.dpdy, self.omega, self.octaves)
    }
}

/// Octaves of the magnitude of noise: creases.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrinkled {
    /// Where it lies.
    pub mapping: Mapping3,
    /// Number of octaves.
    pub octaves: u32,
    /// Ratio of the amplitudes of neighbouring octaves.
    pub omega: f32,
}

impl Wrinkled {
    /// The value at a point, at least 0.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        let c = self.mapping.map(at);
        turbulence(c.p, c.dpdx, c.dpdy, self.omega, self.octaves)
    }
}

/// Heights of waves in wind of changing strength.
#[derive(Clone, Debug, PartialEq)]
pub struct Windy {
    /// Where it lies.
    pub mapping: Mapping3,
}

impl Windy {
    /// The value at a point.
    pub fn eval(&self, at: &TextureContext) -> f32 {
        let c = self.mapping.map(at);
        let strength = fbm(0.1 * c.p, 0.1 * c.dpdx, 0.1 * c.dpdy, 0.5, 3).abs();
        strength * fbm(c.p, c.dpdx, c.dpdy, 0.5, 6)
    }
}

/// Layers disturbed by noise, coloured like marble.
#[derive(Clone, Debug, PartialEq)]
pub struct Marble {
    /// Where it lies.
    pub mapping: Mapping3,
    /// Number of octaves.
    pub octaves: u32,
    /// Ratio of the amplitudes of neighbouring octaves.
    pub omega: f32,
    /// Scale of the features.
    pub scale: f32,
    /// How much the noise disturbs the layers.
    pub variation: f32,
}

impl Marble {
    /// The linear sRGB colour at a point.
    pub fn eval(&self, at: &TextureContext) -> Vec3 {
        let c = self.mapping.map(at);
        let p = self.scale * c.p;
        let noise = fbm(p, self.scale * c.dpdx, self.scale * c.dpdy, self.omega, self.octaves);
        marble_color(0.5 + 0.5 * ops::sin(p.y + self.variation * noise))
    }
}

/// Pieces of a cubic spline through marble's colours, `t` in [0, 1] (colours and their scale of 1.5: pbrt-v4).
fn marble_color(t: f32) -> Vec3 {
    const LIGHT: Vec3 = Vec3::new(0.58, 0.58, 0.6);
    const COLORS: [Vec3; 9] = [
        LIGHT,
        LIGHT,
        LIGHT,
        Vec3::new(0.5, 0.5, 0.5),
        Vec3::new(0.6, 0.59, 0.58),
        LIGHT,
        LIGHT,
        Vec3::new(0.2, 0.2, 0.33),
        LIGHT,
    ];
    const PIECES: usize = COLORS.len() - 3;
    let x = t.clamp(0.0, 1.0) * PIECES as f32;
    let first = (x as usize).min(PIECES - 1);
    let t = x - first as f32;
    let mix = |a: Vec3, b: Vec3| Vec3::new(lerp(t, a.x, b.x), lerp(t, a.y, b.y), lerp(t, a.z, b.z));
    // De Casteljau's construction of the Bézier curve.
    let [a, b, c, d] = [COLORS[first], COLORS[first + 1], COLORS[first + 2], COLORS[first + 3]];
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    1.5 * mix(mix(ab, bc), mix(bc, cd))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::vec3;

    #[test]
    fn marble_runs_through_its_colours() {
        assert!((marble_color(0.0) - 1.5 * vec3(0.58, 0.58, 0.6)).length() < 1e-6);
        assert!((marble_color(1.0) - 1.5 * vec3(0.58, 0.58, 0.6)).length() < 1e-6);
        // The middle of the last piece: weights 1, 3, 3, 1 over 8 of its four colours.
        let want =
            1.5 * (4.0 * vec3(0.58, 0.58, 0.6) + 3.0 * vec3(0.2, 0.2, 0.33) + vec3(0.58, 0.58, 0.6)) / 8.0;
        assert!((marble_color(5.5 / 6.0) - want).length() < 1e-5);
    }

    #[test]
    fn values_are_those_of_the_noise() {
        let mapping = Mapping3::default();
        let at = TextureContext::at_point(vec3(0.3, 1.7, -0.4));
        let z = Vec3::ZERO;
        let fbm_texture = Fbm { mapping: mapping.clone(), octaves: 4, omega: 0.6 };
        assert_eq!(fbm_texture.eval(&at), fbm(at.p, z, z, 0.6, 4));
        let wrinkled = Wrinkled { mapping: mapping.clone(), octaves: 4, omega: 0.6 };
        assert_eq!(wrinkled.eval(&at), turbulence(at.p, z, z, 0.6, 4));
        let windy = Windy { mapping: mapping.clone() };
        assert_eq!(windy.eval(&at), fbm(0.1 * at.p, z, z, 0.5, 3).abs() * fbm(at.p, z, z, 0.5, 6));
        // Without disturbance marble is layered along y.
        let marble = Marble { mapping, octaves: 4, omega: 0.5, scale: 2.0, variation: 0.0 };
        assert_eq!(marble.eval(&at), marble_color(0.5 + 0.5 * ops::sin(3.4f32)));
    }
}
