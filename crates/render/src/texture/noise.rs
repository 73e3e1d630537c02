//! Perlin's improved gradient noise (Perlin 2002, "Improving Noise") and its sums over octaves, scaled and
//! antialiased as in the pbrt book, 4th edition (online chapter "Texture", §10.5.2 and §10.5.3).

use tenfold_math::ops;
use tenfold_math::{Vec3, lerp};

/// Perlin's permutation of 0 … 255 (the reference implementation of the paper).
static PERMUTATION: [u8; 256] = parse(include_bytes!("../../data/perlin_permutation.txt"));

const fn parse(text: &[u8]) -> [u8; 256] {
    let (mut table, mut entry, mut at) = ([0u8; 256], 0, 0);
    while at < text.len() {
        if text[at].is_ascii_digit() {
            let mut value = 0;
            while at < text.len() && text[at].is_ascii_digit() {
                value = value * 10 + (text[at] - b'0');
                at += 1;
            }
            table[entry] = value;
            entry += 1;
        } else {
            at += 1;
        }
    }
    assert!(entry == 256);
    table
}

/// Product of `d` with the gradient at the lattice point (x, y, z).
#[inline]
fn gradient(x: i32, y: i32, z: i32, d: Vec3) -> f32 {
    let hash = |i: i32| i32::from(PERMUTATION[(i & 255) as usize]);
    let h = hash(hash(hash(x) + y) + z) & 15;
    let u = if h < 8 || h == 12 || h == 13 { d.x } else { d.y };
    let v = if h < 4 || h == 12 || h == 13 { d.y } else { d.z };
    (if h & 1 != 0 { -u } else { u }) + (if h & 2 != 0 { -v } else { v })
}

/// Noise in about [−1, 1], zero at all points with whole coordinates.
pub(crate) fn noise(p: Vec3) -> f32 {
    // The lattice has period 256: reducing first keeps the fractions of far points.
    let p = Vec3::new(p.x % 256.0, p.y % 256.0, p.z % 256.0);
    let corner = p.floor();
    let d = p - corner;
    let (x, y, z) = (corner.x as i32, corner.y as i32, corner.z as i32);
    let at =
        |i: i32, j: i32, k: i32| gradient(x + i, y + j, z + k, d - Vec3::new(i as f32, j as f32, k as f32));
    let fade = |t: f32| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (wx, wy, wz) = (fade(d.x), fade(d.y), fade(d.z));
    let along_x = |j, k| lerp(wx, at(0, j, k), at(1, j, k));
    let along_y = |k| lerp(wy, along_x(0, k), along_x(1, k));
    lerp(wz, along_y(0), along_y(1))
}

/// How many octaves a footprint leaves visible, at most `max`.
fn visible_octaves(dpdx: Vec3, dpdy: Vec3, max: u32) -> f32 {
    let widest = dpdx.length_squared().max(dpdy.length_squared());
    if widest > 0.0 { (-1.0 - 0.5 * ops::log2(widest)).clamp(0.0, max as f32) } else { max as f32 }
}

fn smooth_step(x: f32, a: f32, b: f32) -> f32 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Frequencies of neighbouring octaves: not quite 2, so that their zeros do not fall together.
const LACUNARITY: f32 = 1.99;
/// The mean of |noise|, which stands for octaves too fine to be seen.
const MEAN_MAGNITUDE: f32 = 0.2;

/// Fractional Brownian motion: octaves of noise with amplitudes 1, `omega`, `omega`², …
pub(crate) fn fbm(p: Vec3, dpdx: Vec3, dpdy: Vec3, omega: f32, octaves: u32) -> f32 {
    let n = visible_octaves(dpdx, dpdy, octaves);
    let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
    for _ in 0..n as u32 {
        sum += amplitude * noise(frequency * p);
        frequency *= LACUNARITY;
        amplitude *= omega;
    }
    sum + amplitude * smooth_step(n.fract(), 0.3, 0.7) * noise(frequency * p)
}

/// As [`fbm`], of the magnitude of noise.
pub(crate) fn turbulence(p: Vec3, dpdx: Vec3, dpdy: Vec3, omega: f32, octaves: u32) -> f32 {
    let n = visible_octaves(dpdx, dpdy, octaves);
    let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
    for _ in 0..n as u32 {
        sum += amplitude * noise(frequency * p).abs();
        frequency *= LACUNARITY;
        amplitude *= omega;
    }
    let blend = smooth_step(n.fract(), 0.3, 0.7);
    sum += amplitude * lerp(blend, MEAN_MAGNITUDE, noise(frequency * p).abs());
    for _ in n as u32..octaves {
        sum += amplitude * MEAN_MAGNITUDE;
        amplitude *= omega;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use tenfold_math::vec3;

    #[test]
    fn the_permutation_is_one() {
        let mut sorted = PERMUTATION;
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i == usize::from(v)));
    }

    #[test]
    fn noise_vanishes_on_the_lattice_and_is_bounded_and_smooth() {
        let (mut sum, mut least, mut most) = (0.0f64, 0f32, 0f32);
        for i in 0..20_000 {
            let f = i as f32;
            let p =
                vec3((f * 0.7548777) % 300.0 - 150.0, (f * 0.5698403) % 300.0, (f * 0.3319) % 300.0 - 150.0);
            assert_eq!(noise(p.floor()), 0.0);
            let v = noise(p);
            assert!(v.abs() <= 1.1);
            assert!((noise(p + vec3(1e-3, 0.0, 0.0)) - v).abs() < 6e-3);
            (least, most) = (least.min(v), most.max(v));
            sum += f64::from(v);
        }
        assert!((sum / 20_000.0).abs() < 0.02 && least < -0.6 && most > 0.6);
    }

    #[test]
    fn noise_between_two_lattice_points_is_the_blend_of_their_gradients() {
        // On the x axis between 0 and 1: hash(0, 0, 0) = P[P[P[0]]] and hash(1, 0, 0) = P[P[P[1]]].
        let p = |i: usize| usize::from(PERMUTATION[i]);
        let slope = |x: usize| {
            let h = p(p(p(x))) & 15;
            let along_x = if h < 8 || h == 12 || h == 13 { 1.0 } else { 0.0 };
            if h & 1 == 1 { -along_x } else { along_x }
        };
        let want = 0.5 * (slope(0) * 0.5 + slope(1) * -0.5);
        assert!((noise(vec3(0.5, 0.0, 0.0)) - want).abs() < 1e-6);
        // And it repeats every 256.
        let q = vec3(3.25, 7.5, 9.75);
        assert_eq!(noise(q), noise(q + Vec3::splat(256.0)));
        assert_eq!(noise(q), noise(q - Vec3::splat(256.0)));
    }

    #[test]
    fn octaves_fade_with_the_footprint() {
        let p = vec3(0.3, 0.8, 0.1);
        let sharp = fbm(p, Vec3::ZERO, Vec3::ZERO, 0.5, 3);
        let by_hand = noise(p) + 0.5 * noise(1.99 * p) + 0.25 * noise(1.99 * 1.99 * p);
        assert!((sharp - by_hand).abs() < 1e-6);
        assert_eq!(fbm(p, Vec3::X, Vec3::Y, 0.5, 3), 0.0);
        // Nothing seen: the mean of all octaves, the partial one included.
        let blurred = turbulence(p, Vec3::X, Vec3::Y, 0.5, 2);
        assert!((blurred - 0.2 * (1.0 + 1.0 + 0.5)).abs() < 1e-6);
    }
}
