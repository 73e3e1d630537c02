//! The sigmoid polynomial of a colour, by solving for its coefficients.

use glam::{DMat3, DVec3};
use tenfold_math::ops;

use crate::spectrum::SAMPLES;
use crate::{DenselySampled, LAMBDA_MIN, Observer};

/// Largest magnitude of a coefficient of a colour with a component of 1; it grows as the coefficients do when the colour is
/// dimmed, by 1 / √z. Colours out of reach of the sigmoids, whose coefficients would run away to infinity, stop there:
/// their spectra stay smooth at the scale of a few nm.
const LARGEST: f64 = 200.0;
/// Difference in CIELAB that counts as none.
const TOLERANCE: f64 = 1e-7;
const MAX_STEPS: usize = 60;
/// A step that takes off less than this share of the difference is the last: the colour is out of reach.
const LEAST_PROGRESS: f64 = 1e-5;

/// Finds, for a colour under an illuminant, the sigmoid polynomial whose reflectance has that colour, by the
/// Levenberg–Marquardt method on the difference in CIELAB (Jakob and Hanika 2019, section 4, use Gauss–Newton). A
/// colour that no sigmoid polynomial has gets one of a near colour. All in `f64`.
#[derive(Debug)]
pub(crate) struct Solver {
    /// Contribution of a reflectance of 1 in each nanometre to XYZ over the white's XYZ.
    weights: Vec<DVec3>,
    /// RGB to XYZ over the white's XYZ.
    rgb_to_relative: DMat3,
}

impl Solver {
    /// For the RGB of a matrix to XYZ, under an illuminant that is white there.
    pub(crate) fn new(rgb_to_xyz: DMat3, illuminant: &DenselySampled) -> Self {
        let observer = Observer::cie1931();
        let mut weights: Vec<DVec3> = (0..SAMPLES)
            .map(|i| {
                let lambda = LAMBDA_MIN + i as f32;
                observer.matching(lambda).0.as_dvec3() * f64::from(illuminant.eval(lambda))
            })
            .collect();
        let white: DVec3 = weights.iter().sum();
        for w in &mut weights {
            *w /= white;
        }
        let rgb_white = rgb_to_xyz * DVec3::ONE;
        Self { weights, rgb_to_relative: DMat3::from_diagonal(rgb_white.recip()) * rgb_to_xyz }
    }

    /// Coefficients of 1, t and t² for an RGB colour in [0, 1], from a first guess of them, and the difference in
    /// CIELAB that is left.
    pub(crate) fn solve(&self, rgb: DVec3, guess: DVec3) -> (DVec3, f64) {
        // Relative to the largest component, so that dark colours are met as well as bright ones.
        let z = rgb.max_element().clamp(1e-12, 1.0);
        let target_lab = lab(self.rgb_to_relative * rgb / z);
        let bound = LARGEST / z.sqrt();
        let mut c = guess.clamp(DVec3::splat(-bound), DVec3::splat(bound));
        let (mut residual, mut jacobian) = self.residual(c, z, target_lab);
        let mut damping = 1e-3;
        for _ in 0..MAX_STEPS {
            if residual.length() < TOLERANCE {
                break;
            }
            let normal = jacobian.transpose() * jacobian;
            let gradient = jacobian.transpose() * residual;
            let diagonal = DVec3::new(normal.x_axis.x, normal.y_axis.y, normal.z_axis.z);
            let damped = normal + DMat3::from_diagonal(damping * (diagonal + DVec3::splat(1e-12)));
            let next = (c - damped.inverse() * gradient).clamp(DVec3::splat(-bound), DVec3::splat(bound));
            let (r, j) = self.residual(next, z, target_lab);
            if r.is_finite() && r.length_squared() < residual.length_squared() {
                let progress = 1.0 - r.length() / residual.length();
                (c, residual, jacobian) = (next, r, j);
                damping = (damping * 0.1).max(1e-12);
                if progress < LEAST_PROGRESS {
                    break;
                }
            } else if damping > 1e8 {
                break;
            } else {
                damping *= 10.0;
            }
        }
        (c, residual.length())
    }

    /// Solves without a guess: from a grey of the colour's luminance.
    pub(crate) fn solve_from_grey(&self, rgb: DVec3) -> (DVec3, f64) {
        let z = rgb.max_element();
        if z > 0.0 && z < 0.1 {
            // Dark colours by way of brighter ones: coefficients grow as 1 / √z.
            let brighter = (10.0 * z).min(0.1);
            let guess = self.solve_from_grey(rgb * (brighter / z)).0;
            return self.solve(rgb, guess * (brighter / z).sqrt());
        }
        let y = (self.rgb_to_relative * rgb).y.clamp(1e-7, 1.0 - 1e-4);
        self.solve(rgb, DVec3::new((y - 0.5) / (y * (1.0 - y)).sqrt(), 0.0, 0.0))
    }

    /// Difference in CIELAB of the sigmoid polynomial's colour over `z` to the target, and its derivatives by the
    /// coefficients.
    fn residual(&self, c: DVec3, z: f64, target: DVec3) -> (DVec3, DMat3) {
        let mut xyz = DVec3::ZERO;
        let mut by_c = [DVec3::ZERO; 3];
        let half = 0.5 * (SAMPLES - 1) as f64;
        for (i, &w) in self.weights.iter().enumerate() {
            let t = i as f64 / half - 1.0;
            let x = (c.z * t + c.y) * t + c.x;
            let root = (1.0 + x * x).sqrt();
            let tail = 0.5 / (root * (root + x.abs()));
            let s = if x < 0.0 { tail } else { 1.0 - tail };
            let slope = w * (0.5 / (root * root * root));
            xyz += w * s;
            by_c[0] += slope;
            by_c[1] += slope * t;
            by_c[2] += slope * (t * t);
        }
        xyz /= z;
        let f = xyz.map(cube_root_response);
        let scale = xyz.map(cube_root_slope);
        let to_lab = LAB_FROM_RESPONSE * DMat3::from_diagonal(scale / z);
        let jacobian = to_lab * DMat3::from_cols(by_c[0], by_c[1], by_c[2]);
        (LAB_FROM_RESPONSE * f + LAB_OFFSET - target, jacobian)
    }
}

/// CIELAB from the responses of X, Y, Z: L = 116 f_Y − 16, a = 500 (f_X − f_Y), b = 200 (f_Y − f_Z) (CIE 015).
const LAB_FROM_RESPONSE: DMat3 =
    DMat3::from_cols_array(&[0.0, 500.0, 0.0, 116.0, -500.0, 200.0, 0.0, 0.0, -200.0]);
const LAB_OFFSET: DVec3 = DVec3::new(-16.0, 0.0, 0.0);

fn lab(relative: DVec3) -> DVec3 {
    LAB_FROM_RESPONSE * relative.map(cube_root_response) + LAB_OFFSET
}

const LINEAR_BELOW: f64 = 6.0 / 29.0;

/// CIELAB's f: a cube root, made linear near 0 (CIE 015).
fn cube_root_response(t: f64) -> f64 {
    if t > LINEAR_BELOW.powi(3) { ops::cbrt(t) } else { t / (3.0 * LINEAR_BELOW * LINEAR_BELOW) + 4.0 / 29.0 }
}

fn cube_root_slope(t: f64) -> f64 {
    if t > LINEAR_BELOW.powi(3) {
        let root = ops::cbrt(t);
        1.0 / (3.0 * root * root)
    } else {
        1.0 / (3.0 * LINEAR_BELOW * LINEAR_BELOW)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lab_of_known_colours() {
        assert!((lab(DVec3::ONE) - DVec3::new(100.0, 0.0, 0.0)).length() < 1e-12);
        assert!(lab(DVec3::ZERO).length() < 1e-12);
        // Y = 0.18 is L = 49.496.
        assert!((lab(DVec3::splat(0.18)).x - 49.496).abs() < 1e-3);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let cs = crate::RgbColorSpace::srgb();
        let solver = cs.solver();
        for c in [DVec3::new(-1.0, 2.0, -0.5), DVec3::new(3.0, -4.0, 1.0), DVec3::new(-20.0, 1.0, 1.0)] {
            let (r, j) = solver.residual(c, 0.3, DVec3::ZERO);
            for axis in 0..3 {
                let mut d = c;
                d[axis] += 1e-6;
                let numeric = (solver.residual(d, 0.3, DVec3::ZERO).0 - r) / 1e-6;
                assert!((numeric - j.col(axis)).length() < 1e-4 * (1.0 + j.col(axis).length()));
            }
        }
    }
}
