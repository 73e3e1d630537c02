//! Sigmoid polynomials of all colours of a colour space, by interpolation in a table.

use std::io::{Read, Write};

use glam::DVec3;
use tenfold_math::{Vec3, Vec4};

use super::Solver;
use crate::{Rgb, SigmoidPolynomial};

/// Bytes of a coefficient that are stored: the mantissa keeps 15 bits.
const STORED_BYTES: usize = 3;

/// Coefficients on a grid over (which component is the largest, its value z, the others over z), as Jakob and Hanika 2019,
/// section 4.1. Departures, for precision with few nodes: z has nodes at smoothstep(smoothstep(k / (n − 1))), k = 1 … n − 1, and is
/// interpolated in the coefficient of a grey of 0.9 z; the others have denser nodes near 0.
#[derive(Clone, PartialEq, Debug)]
pub struct SigmoidTable {
    /// Nodes along each of the other components.
    n: usize,
    /// Values of z at its nodes, increasing up to 1.
    z: Vec<f32>,
    /// For every interval of z, [`places`]' depth at its lower end, and the inverse of the depth's increase over it.
    depth: Vec<[f32; 2]>,
    /// `n - 1`, the last place along the other axes.
    last: f32,
    /// `[largest][z][y][x]`, lanes: coefficients of 1, t, t², and nothing.
    coefficients: Vec<Vec4>,
}

impl SigmoidTable {
    fn empty(n: usize) -> Self {
        let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
        let z: Vec<f32> = (1..n).map(|k| smooth(smooth(k as f64 / (n - 1) as f64)) as f32).collect();
        let depths: Vec<f32> = z.iter().map(|&z| places(z, 0.0, 0.0)[2]).collect();
        let depth = depths.windows(2).map(|d| [d[0], 1.0 / (d[1] - d[0])]).collect();
        Self { n, z, depth, last: (n - 1) as f32, coefficients: vec![Vec4::ZERO; 3 * (n - 1) * n * n] }
    }

    fn index(&self, largest: usize, z: usize, y: usize, x: usize) -> usize {
        ((largest * self.z.len() + z) * self.n + y) * self.n + x
    }

    /// Solves for a table of `n` nodes along each side.
    pub(crate) fn build(solver: &Solver, n: usize) -> Self {
        let mut table = Self::empty(n.max(3));
        let (n, nz) = (table.n, table.z.len());
        let middle = nz / 2;
        for largest in 0..3 {
            for y in 0..n {
                for x in 0..n {
                    let color = |z: usize| {
                        let mut rgb = [f64::from(table.z[z]); 3];
                        rgb[(largest + 1) % 3] *= f64::from(node(x as f32 / (n - 1) as f32));
                        rgb[(largest + 2) % 3] *= f64::from(node(y as f32 / (n - 1) as f32));
                        DVec3::from_array(rgb)
                    };
                    // Outward from the middle, each solution the first guess of the next.
                    let start = solver.solve_from_grey(color(middle)).0;
                    let mut column = vec![start; nz];
                    for z in middle + 1..nz {
                        column[z] = solver.solve(color(z), column[z - 1]).0;
                    }
                    for z in (0..middle).rev() {
                        // Coefficients of a dark colour grow as 1 / √z.
                        let grow = f64::from(table.z[z + 1] / table.z[z]).sqrt().min(1.5);
                        column[z] = solver.solve(color(z), column[z + 1] * grow).0;
                    }
                    for (z, c) in column.into_iter().enumerate() {
                        let i = table.index(largest, z, y, x);
                        table.coefficients[i] = c.as_vec3().extend(0.0);
                    }
                }
            }
        }
        table
    }

    /// The sigmoid polynomial of a colour; components outside [0, 1] are clamped. Greys are exact.
    #[inline]
    pub fn lookup(&self, rgb: Rgb) -> SigmoidPolynomial {
        let c = rgb.0.clamp(Vec3::ZERO, Vec3::ONE);
        if c.x == c.y && c.y == c.z {
            return SigmoidPolynomial::constant(c.x);
        }
        let (largest, z, a, b) = if c.z >= c.x && c.z >= c.y {
            (2, c.z, c.x, c.y)
        } else if c.y >= c.x {
            (1, c.y, c.z, c.x)
        } else {
            (0, c.x, c.y, c.z)
        };
        // Of colours too dark to divide by, only the least values differ.
        let z = z.max(1e-30);
        let [u, v, d] = places(z, a / z, b / z);
        let (xi, xt) = split(u * self.last, self.n);
        let (yi, yt) = split(v * self.last, self.n);
        // Below the first node, the first interval goes on.
        let zi = self.z[1..self.z.len() - 1].partition_point(|&node| node <= z);
        let [d0, inverse] = self.depth[zi];
        let zt = (d - d0) * inverse;

        let plane = self.n * self.n;
        let at = self.index(largest, zi, yi, xi);
        let bilinear = |i: usize| {
            let c = &self.coefficients;
            let row0 = c[i] + (c[i + 1] - c[i]) * xt;
            let row1 = c[i + self.n] + (c[i + self.n + 1] - c[i + self.n]) * xt;
            row0 + (row1 - row0) * yt
        };
        let (low, high) = (bilinear(at), bilinear(at + plane));
        let v = low + (high - low) * zt;
        SigmoidPolynomial { c: [v.x, v.y, v.z] }
    }

    /// Writes the table: the number of nodes as a little-endian `u32`, then, compressed by zlib, the leading bytes
    /// of all coefficients, plane by plane.
    ///
    /// # Errors
    /// Where the writer fails.
    pub fn write(&self, mut out: impl Write) -> std::io::Result<()> {
        out.write_all(&(self.n as u32).to_le_bytes())?;
        let mut z = flate2::write::ZlibEncoder::new(out, flate2::Compression::best());
        for byte in 0..STORED_BYTES {
            for lane in 0..3 {
                let plane: Vec<u8> =
                    self.coefficients.iter().map(|c| round_to_stored(c[lane]).to_be_bytes()[byte]).collect();
                z.write_all(&plane)?;
            }
        }
        z.finish()?;
        Ok(())
    }

    /// Reads what [`Self::write`] wrote.
    ///
    /// # Errors
    /// Where the data end early or are not such a table.
    pub fn read(data: &[u8]) -> std::io::Result<Self> {
        let invalid = || std::io::Error::from(std::io::ErrorKind::InvalidData);
        let (head, body) = data.split_first_chunk::<4>().ok_or_else(invalid)?;
        let n = u32::from_le_bytes(*head) as usize;
        if !(3..=256).contains(&n) {
            return Err(invalid());
        }
        let mut table = Self::empty(n);
        let count = table.coefficients.len();
        let mut planes = Vec::new();
        flate2::read::ZlibDecoder::new(body).read_to_end(&mut planes)?;
        if planes.len() != 3 * STORED_BYTES * count {
            return Err(invalid());
        }
        for (i, c) in table.coefficients.iter_mut().enumerate() {
            let lane = |lane: usize| {
                let mut bytes = [0; 4];
                for (byte, b) in bytes.iter_mut().take(STORED_BYTES).enumerate() {
                    *b = planes[(byte * 3 + lane) * count + i];
                }
                f32::from_be_bytes(bytes)
            };
            *c = Vec4::new(lane(0), lane(1), lane(2), 0.0);
        }
        Ok(table)
    }
}

/// Share of the linear part in [`node`].
const LINEAR: f32 = 0.2;

/// Value, over the largest one, of another component at the place `u` in [0, 1] along its axis: more nodes near 0, where the coefficients
/// of saturated colours bend most.
fn node(u: f32) -> f32 {
    u * (LINEAR + (1.0 - LINEAR) * u)
}

/// Places along the axes of a colour of largest component `z` and the others `a` and `b` times it: for `a` and `b` the inverse of
/// [`node`], in [0, 1]; for `z` its depth, the coefficient of a grey of value 0.9 z. Coefficients of a colour that darkens are
/// nearly linear in the depth (the 0.9 stands for the colour's other components being less), down to black, where the
/// sigmoid falls off as 1 / 4x²: so dark colours keep their relative precision.
#[inline]
fn places(z: f32, a: f32, b: f32) -> [f32; 3] {
    const QUADRATIC: f32 = 4.0 * (1.0 - LINEAR);
    let g = 0.9 * z;
    let squares =
        Vec4::new(LINEAR * LINEAR + QUADRATIC * a, LINEAR * LINEAR + QUADRATIC * b, g * (1.0 - g), 1.0);
    let roots = squares.sqrt();
    let v = Vec4::new(2.0 * a, 2.0 * b, g - 0.5, 0.0) / (roots + Vec4::new(LINEAR, LINEAR, 0.0, 0.0));
    [v.x, v.y, v.z]
}

/// Grid cell and place within it of a coordinate in [0, n − 1].
#[inline]
fn split(v: f32, n: usize) -> (usize, f32) {
    let i = (v as i32).min(n as i32 - 2);
    (i as usize, v - i as f32)
}

/// The nearest number whose last byte is 0.
fn round_to_stored(v: f32) -> f32 {
    f32::from_bits((v.to_bits() + 0x80) & !0xff)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RgbColorSpace;

    #[test]
    fn tables_survive_their_file() {
        let table = SigmoidTable::build(RgbColorSpace::srgb().solver(), 4);
        let mut file = Vec::new();
        table.write(&mut file).unwrap();
        let back = SigmoidTable::read(&file).unwrap();
        for (a, b) in table.coefficients.iter().zip(&back.coefficients) {
            assert!((*a - *b).abs().max_element() <= 2f32.powi(-16) * a.abs().max_element());
        }
        assert!(SigmoidTable::read(&file[..file.len() / 2]).is_err());
        assert!(SigmoidTable::read(&[]).is_err());
        assert!(SigmoidTable::read(&[255; 64]).is_err());
    }

    #[test]
    fn nodes_come_back_exactly() {
        let solver = RgbColorSpace::srgb().solver();
        let table = SigmoidTable::build(solver, 5);
        for (k, &z) in table.z.iter().enumerate() {
            let rgb = Rgb::new(node(0.25) * z, z, node(0.5) * z);
            let got = table.lookup(rgb).c;
            // The green is the largest: x is the blue, y the red.
            let want = table.coefficients[table.index(1, k, 1, 2)];
            for (lane, g) in got.iter().enumerate() {
                assert!((g - want[lane]).abs() < 1e-3 * (1.0 + want[lane].abs()), "{got:?} {want}");
            }
        }
    }
}
