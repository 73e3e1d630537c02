use std::f64::consts::PI;
use tenfold_math::ops;

/// Nodes in `(0, 1)` and weights, summing to one, of Gauss–Legendre quadrature with `n` points: Newton's iteration on the
/// roots of the Legendre polynomial (Abramowitz and Stegun 1964, eq. 25.4.29).
pub(crate) fn gauss_legendre(n: usize) -> Vec<GaussNode> {
    let mut nodes = Vec::with_capacity(n);
    for i in 0..n {
        let mut x = ops::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut p, mut q) = (1.0, 0.0);
            for j in 0..n {
                (p, q) = (((2 * j + 1) as f64 * x * p - j as f64 * q) / (j + 1) as f64, p);
            }
            slope = n as f64 * (x * p - q) / (x * x - 1.0);
            let step = p / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        nodes.push(GaussNode { x: 0.5 * (1.0 - x), weight: 1.0 / ((1.0 - x * x) * slope * slope) });
    }
    nodes
}

/// A node of quadrature on the unit interval.
#[derive(Copy, Clone, Debug)]
pub(crate) struct GaussNode {
    pub(crate) x: f64,
    pub(crate) weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in [1, 2, 5, 24, 64] {
            let nodes = gauss_legendre(n);
            for power in 0..2 * n as i32 {
                let sum: f64 = nodes.iter().map(|node| node.weight * node.x.powi(power)).sum();
                assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-13, "{n} {power}: {sum}");
            }
        }
    }
}
