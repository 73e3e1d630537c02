use tenfold_sampling::distribution::PiecewiseConstant1D;

/// Cells over the extent of a filter; within one, the weight makes up for what a constant density misses.
const CELLS: usize = 512;

/// A filter profile sampled in proportion to its magnitude.
#[derive(Clone, Debug)]
pub(super) struct Tabulated {
    density: PiecewiseConstant1D,
    /// `f / (pdf · ∫f)` at the borders of the cells, one pair a cell: linear between.
    weights: Vec<[f32; 2]>,
    radius: f32,
}

impl Tabulated {
    /// Tabulates `f` over `±radius`; `None` where its integral is not a positive number.
    pub(super) fn new(f: impl Fn(f32) -> f32, radius: f32) -> Option<Self> {
        let step = 2.0 * radius / CELLS as f32;
        let border = |i: usize| -radius + i as f32 * step;
        // The trapezium over each cell is exact for the linear profile that the weights stand for.
        let means: Vec<f64> =
            (0..CELLS).map(|i| 0.5 * (f(border(i)) as f64 + f(border(i + 1)) as f64)).collect();
        let integral: f64 = means.iter().sum::<f64>() * step as f64;
        let magnitude: f64 = means.iter().map(|m| m.abs()).sum::<f64>() * step as f64;
        if !(integral > 0.0 && magnitude.is_finite()) {
            return None;
        }
        let weights = (0..CELLS)
            .map(|i| {
                let pdf = means[i].abs() / magnitude;
                let weight = |x: f32| if pdf > 0.0 { (f(x) as f64 / (pdf * integral)) as f32 } else { 0.0 };
                [weight(border(i)), weight(border(i + 1))]
            })
            .collect();
        let magnitudes: Vec<f32> = means.iter().map(|m| m.abs() as f32).collect();
        Some(Self { density: PiecewiseConstant1D::new(&magnitudes), weights, radius })
    }

    /// Position and weight.
    #[inline]
    pub(super) fn sample(&self, u: f32) -> (f32, f32) {
        let s = self.density.sample(u);
        let [a, b] = self.weights[s.cell];
        ((2.0 * s.x - 1.0) * self.radius, a + (b - a) * s.offset)
    }
}
