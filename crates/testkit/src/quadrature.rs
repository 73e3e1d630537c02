//! Adaptive Gauss–Kronrod quadrature in double precision, globally: the interval or rectangle with the largest error is halved next.
//!
//! The estimated error of an integral is an upper bound for smooth integrands. Where an integrand has jumps or narrow
//! peaks, start from more `pieces`.

use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};
use tenfold_math::Vec3;
use tenfold_math::ops;

/// What to reach, and what it may cost.
#[derive(Copy, Clone, Debug)]
pub struct Tolerance {
    /// Absolute error to reach.
    pub absolute: f64,
    /// Error relative to the integral to reach; either of the two is enough.
    pub relative: f64,
    /// Into how many parts each axis is cut at first.
    pub pieces: usize,
    /// Evaluations after which to stop.
    pub evaluations: usize,
    /// Whether to look for jumps between the nodes and the sides of rectangles, where they would go unseen. Costs
    /// refinement where there are none, to no use below a relative error of 1e-4.
    pub jumps: bool,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { absolute: 1e-12, relative: 1e-9, pieces: 4, evaluations: 1_000_000, jumps: false }
    }
}

/// An integral and the estimate of its error.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// Bound on its absolute error, as far as the rule can tell.
    pub error: f64,
}

/// Nodes in `[0, 1]` of the 15-point Kronrod rule on `[-1, 1]`, its weights, and those of the 7-point Gauss rule
/// (Kronrod 1965; also in QUADPACK, Piessens et al. 1983).
const K15: [(f64, f64, f64); 8] = [
    (0.0, 0.209482141084727828012999174891714, 0.417959183673469387755102040816327),
    (0.207784955007898467600689403773245, 0.204432940075298892414161999234649, 0.0),
    (
        0.405845151377397166906606412076961,
        0.190350578064785409913256402421014,
        0.381830050505118944950369775488975,
    ),
    (0.586087235467691130294144691693013, 0.169004726639267902826583426598550, 0.0),
    (
        0.741531185599394439863864773280788,
        0.140653259715525918745189590510238,
        0.279705391489276667901467771423780,
    ),
    (0.864864423359769072789712788640926, 0.104790010322250183839876322541518, 0.0),
    (
        0.949107912342758524526189684047851,
        0.063092092629978553290700663189204,
        0.129484966168869693270611432679082,
    ),
    (0.991455371120812639206854697526329, 0.022935322010529224963732008058970, 0.0),
];

/// The same for the 7-point Kronrod and the 3-point Gauss rule.
const K7: [(f64, f64, f64); 4] = [
    (0.0, 0.450916538658474142345110087045571, 0.888888888888888888888888888888889),
    (0.434243749346802558002071502844628, 0.401397414775962222905051818618432, 0.0),
    (
        0.774596669241483377035853079956480,
        0.268488089868333440728569280666710,
        0.555555555555555555555555555555556,
    ),
    (0.960491268708020283423507092629080, 0.104656226026467265193823857192073, 0.0),
];

/// A part of the domain, ordered by its error.
struct Part<T> {
    region: T,
    value: f64,
    error: f64,
}

impl<T> PartialEq for Part<T> {
    fn eq(&self, other: &Self) -> bool {
        self.error.total_cmp(&other.error).is_eq()
    }
}
impl<T> Eq for Part<T> {}
impl<T> PartialOrd for Part<T> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl<T> Ord for Part<T> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.error.total_cmp(&other.error)
    }
}

/// Halves the worst part until the sum of the errors is small enough. `split` returns two parts and where they came from.
fn refine<T>(
    mut parts: BinaryHeap<Part<T>>,
    cost: usize,
    tolerance: &Tolerance,
    mut split: impl FnMut(T) -> [Part<T>; 2],
) -> Integral {
    let total = |parts: &BinaryHeap<Part<T>>| {
        let value = parts.iter().map(|p| p.value).sum::<f64>();
        (value, parts.iter().map(|p| p.error).sum::<f64>())
    };
    let mut used = cost * parts.len();
    let (mut value, mut error) = total(&parts);
    while error > tolerance.absolute.max(tolerance.relative * value.abs()) && used < tolerance.evaluations {
        let Some(worst) = parts.pop() else { break };
        value -= worst.value;
        error -= worst.error;
        let mut halves = split(worst.region);
        // A jump may lie between the nodes and the side of a part, where the rules agree on a wrong value. But the
        // halves then disagree with the whole, and must not be more certain than that.
        let surprise = 0.5 * (worst.value - halves[0].value - halves[1].value).abs();
        for part in &mut halves {
            part.error = part.error.max(surprise);
        }
        for part in halves {
            value += part.value;
            error += part.error;
            parts.push(part);
        }
        used += 2 * cost;
    }
    // The running sums have gathered rounding errors.
    let (value, error) = total(&parts);
    Integral { value, error }
}

/// Makes the first parts no more certain than their sum is near to the `whole` measured at once.
fn surprised<T>(whole: f64, mut parts: Vec<Part<T>>) -> BinaryHeap<Part<T>> {
    let surprise = (whole - parts.iter().map(|p| p.value).sum::<f64>()).abs() / parts.len() as f64;
    for part in &mut parts {
        part.error = part.error.max(surprise);
    }
    parts.into()
}

/// `∫ f(x) dx` over `[a, b]`.
pub fn interval(a: f64, b: f64, tolerance: &Tolerance, f: impl Fn(f64) -> f64) -> Integral {
    let measure = |region: (f64, f64)| {
        let (middle, half) = (0.5 * (region.0 + region.1), 0.5 * (region.1 - region.0));
        let (mut kronrod, mut gauss) = (0.0, 0.0);
        for (i, &(x, wk, wg)) in K15.iter().enumerate() {
            let y = if i == 0 { f(middle) } else { f(middle - half * x) + f(middle + half * x) };
            kronrod += wk * y;
            gauss += wg * y;
        }
        Part { region, value: kronrod * half, error: ((kronrod - gauss) * half).abs() }
    };
    let n = tolerance.pieces.max(1);
    let at = |i: usize| a + (b - a) * i as f64 / n as f64;
    let parts = surprised(measure((a, b)).value, (0..n).map(|i| measure((at(i), at(i + 1)))).collect());
    refine(parts, 15, tolerance, |(low, high)| {
        let middle = 0.5 * (low + high);
        [measure((low, middle)), measure((middle, high))]
    })
}

/// `∫∫ f(x, y) dx dy` over the rectangle from `low` to `high`.
pub fn rectangle(
    low: [f64; 2],
    high: [f64; 2],
    tolerance: &Tolerance,
    f: impl Fn(f64, f64) -> f64,
) -> Integral {
    #[derive(Copy, Clone)]
    struct Rectangle {
        low: [f64; 2],
        high: [f64; 2],
        axis: usize,
    }
    let measure = |low: [f64; 2], high: [f64; 2]| {
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        let half = [0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])];
        let node = |axis: usize, i: usize| {
            let (x, wk, wg) = K7[i.abs_diff(3)];
            (middle[axis] + half[axis] * if i < 3 { -x } else { x }, wk, wg)
        };
        // Kronrod's rule in both axes, and Gauss's in one of them: their difference says which axis is to be halved.
        let (mut both, mut gauss_x, mut gauss_y) = (0.0, 0.0, 0.0);
        for j in 0..7 {
            let (y, wky, wgy) = node(1, j);
            for i in 0..7 {
                let (x, wkx, wgx) = node(0, i);
                let value = f(x, y);
                both += wkx * wky * value;
                gauss_x += wgx * wky * value;
                gauss_y += wkx * wgy * value;
            }
        }
        let area = half[0] * half[1];
        let (mut ex, mut ey) = ((both - gauss_x).abs(), (both - gauss_y).abs());
        if tolerance.jumps {
            // What the strips between the outermost nodes and the sides hold, if it is as in the middle of the side.
            let difference = |axis: usize, sign: f64| {
                let at = |offset: f64| {
                    let mut p = middle;
                    p[axis] += sign * half[axis] * offset;
                    f(p[0], p[1])
                };
                (at(1.0 - 1e-6) - at(K7[3].0)).abs()
            };
            let strip = 2.0 * (1.0 - K7[3].0);
            ex += strip * (difference(0, -1.0) + difference(0, 1.0));
            ey += strip * (difference(1, -1.0) + difference(1, 1.0));
        }
        let axis = usize::from(ey > ex);
        Part { region: Rectangle { low, high, axis }, value: both * area, error: (ex + ey) * area }
    };
    let n = tolerance.pieces.max(1);
    let at = |axis: usize, i: usize| low[axis] + (high[axis] - low[axis]) * i as f64 / n as f64;
    let parts = (0..n * n)
        .map(|k| (k % n, k / n))
        .map(|(i, j)| measure([at(0, i), at(1, j)], [at(0, i + 1), at(1, j + 1)]))
        .collect();
    let parts = surprised(measure(low, high).value, parts);
    refine(parts, 49, tolerance, |r| {
        let middle = 0.5 * (r.low[r.axis] + r.high[r.axis]);
        let (mut first, mut second) = (r.high, r.low);
        first[r.axis] = middle;
        second[r.axis] = middle;
        [measure(r.low, first), measure(second, r.high)]
    })
}

/// `∫ f(ω) dω` in steradians over the whole sphere.
pub fn sphere(tolerance: &Tolerance, f: impl Fn(Vec3) -> f64) -> Integral {
    directions([-1.0, 0.0], [1.0, TAU], tolerance, f)
}

/// `∫ f(ω) dω` in steradians over the hemisphere around +z.
pub fn hemisphere(tolerance: &Tolerance, f: impl Fn(Vec3) -> f64) -> Integral {
    directions([0.0, 0.0], [1.0, TAU], tolerance, f)
}

/// `∫ f(ω) dω` over the directions with `(cos θ, φ)` from `low` to `high`.
pub fn directions(low: [f64; 2], high: [f64; 2], tolerance: &Tolerance, f: impl Fn(Vec3) -> f64) -> Integral {
    // Over θ, not cos θ: the map from θ to directions is smooth at the poles.
    let theta = |z: f64| ops::acos(z.clamp(-1.0, 1.0));
    rectangle([theta(high[0]), low[1]], [theta(low[0]), high[1]], tolerance, |theta, phi| {
        let (sin_theta, cos_theta) = ops::sin_cos(theta);
        let (sin_phi, cos_phi) = ops::sin_cos(phi);
        let direction = [sin_theta * cos_phi, sin_theta * sin_phi, cos_theta];
        sin_theta * f(Vec3::from_array(direction.map(|x| x as f32)))
    })
}

/// `∫ f(x) dx` over `[a, b]` with the default tolerance.
pub fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    interval(a, b, &Tolerance::default(), f).value
}

/// Solid angle of the whole sphere.
pub const SPHERE: f64 = 4.0 * PI;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_peaks() {
        assert!((integrate(-1.0, 2.0, |x| x.powi(21)) - (2f64.powi(22) - 1.0) / 22.0).abs() < 1e-6);
        let peak = interval(-1.0, 1.0, &Tolerance::default(), |x| 1.0 / (1e-6 + (x - 0.1).powi(2)));
        let exact = (ops::atan(900.0f64) + ops::atan(1100.0f64)) * 1e3;
        assert!((peak.value / exact - 1.0).abs() < 1e-9, "{peak:?}");
    }

    #[test]
    fn rectangles_and_jumps() {
        let t = Tolerance::default();
        assert!(
            (rectangle([0.0, 0.0], [1.0, 2.0], &t, |x, y| x.powi(9) * y.powi(7)).value - 3.2).abs() < 1e-12
        );
        let t = Tolerance { absolute: 1e-4, ..t };
        let disk = rectangle([-1.0, -1.0], [1.0, 1.0], &t, |x, y| f64::from(x * x + y * y < 1.0));
        assert!((disk.value - PI).abs() < 1e-4, "{disk:?}");
    }

    #[test]
    fn spheres() {
        let t = Tolerance { absolute: 1e-6, relative: 1e-6, ..Tolerance::default() };
        assert!((sphere(&t, |_| 1.0).value - SPHERE).abs() < 1e-6);
        assert!((hemisphere(&t, |d| f64::from(d.z)).value - PI).abs() < 1e-5);
        assert!((sphere(&t, |d| f64::from(d.x * d.x)).value - SPHERE / 3.0).abs() < 1e-5);
    }
}
