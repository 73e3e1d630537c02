//! One step down the light tree for the points in all slots: as for each alone, to the bit.

use super::{
    clusters::{LANES, Views},
    tree::Node,
};
use tenfold_geometry::ReferencePoints;
use tenfold_math::{Floats, ONE_MINUS_EPSILON, Slots, WIDTH, vectorized};

/// The weights of the lanes of a node for the point in each slot, and room for the views that lead to them.
pub(super) struct Weights {
    lanes: [Floats; LANES],
    views: [Views; WIDTH],
}

impl Weights {
    pub(super) const ZERO: Self = Self { lanes: [[0.0; WIDTH]; LANES], views: [Views::ZERO; WIDTH] };

    /// Those of the nodes of some indices, for the points in `slots`; others stay as they are.
    pub(super) fn weigh(
        &mut self,
        nodes: &[Node],
        indices: &[u32; WIDTH],
        slots: Slots,
        from: &ReferencePoints,
    ) {
        weigh(nodes, indices, slots, from, self);
    }
}

vectorized! {
    /// See [`Weights::weigh`].
    fn weigh(
        nodes: &[Node],
        indices: &[u32; WIDTH],
        slots: Slots,
        from: &ReferencePoints,
        weights: &mut Weights,
    ) {
        let Weights { lanes, views } = weights;
        for slot in slots {
            nodes[indices[slot] as usize].clusters.look(from.p.get(slot), &mut views[slot]);
        }
        for slot in slots {
            let clusters = &nodes[indices[slot] as usize].clusters;
            let importance = clusters.importance_of(&views[slot], from.ns.get(slot), from.one_sided[slot]);
            for (lane, weight) in importance.into_iter().enumerate() {
                lanes[lane][slot] = weight;
            }
        }
    }
}

/// Choices under way.
pub(super) struct Descents {
    pub(super) node: [u32; WIDTH],
    /// What is left of the numbers that choose; as it was where rounding leaves the choice open.
    u: Floats,
    /// The probabilities of having come here.
    pub(super) pmf: Floats,
    /// The lanes that were chosen; [`LANES`] where rounding leaves the choice to the last that may be.
    lane: [u32; WIDTH],
}

impl Descents {
    /// At the root.
    pub(super) fn new(u: &Floats) -> Self {
        Self { node: [0; WIDTH], u: *u, pmf: [1.0; WIDTH], lane: [0; WIDTH] }
    }

    /// Draws a lane in every slot.
    pub(super) fn choose(&mut self, weights: &Weights) {
        choose(self, weights);
    }

    /// The lane that was drawn in a slot; `None` where there is none of positive weight.
    #[inline]
    pub(super) fn lane(&mut self, slot: usize, weights: &Weights) -> Option<usize> {
        let lane = self.lane[slot] as usize;
        if lane < LANES { Some(lane) } else { self.last(slot, weights) }
    }

    /// The last lane of positive weight takes what rounding leaves over.
    #[cold]
    fn last(&mut self, slot: usize, weights: &Weights) -> Option<usize> {
        let last = weights.lanes.iter().rposition(|weights| weights[slot] > 0.0)?;
        let weight = weights.lanes[last][slot];
        // Of all weights, too: those behind are none.
        let sum = weights.lanes[..=last].iter().fold(0.0, |sum, weights| sum + weights[slot]);
        self.pmf[slot] *= weight / sum;
        self.u[slot] = remainder(self.u[slot] * sum, sum, weight);
        Some(last)
    }
}

/// What is left of a number that has chosen, in `[0, 1)` again.
#[inline(always)]
pub(super) fn remainder(x: f32, sum: f32, weight: f32) -> f32 {
    ((x - (sum - weight)) / weight).clamp(0.0, ONE_MINUS_EPSILON)
}

vectorized! {
    /// See [`Descents::choose`].
    fn choose(descents: &mut Descents, weights: &Weights) {
        let mut sums = [[0.0; WIDTH]; LANES];
        let mut total = [0.0; WIDTH];
        for lane in 0..LANES {
            for i in 0..WIDTH {
                total[i] += weights.lanes[lane][i];
            }
            sums[lane] = total;
        }
        for i in 0..WIDTH {
            let x = descents.u[i] * total[i];
            // How many lanes' sums, up to each, `x` is not below.
            let mut below = 0;
            for sums in &sums {
                below += u32::from(sums[i] <= x);
            }
            let (mut weight, mut sum) = (0.0, 0.0);
            for lane in 0..LANES {
                let is_chosen = below == lane as u32;
                let (its_weight, its_sum) = (weights.lanes[lane][i], sums[lane][i]);
                weight = if is_chosen { its_weight } else { weight };
                sum = if is_chosen { its_sum } else { sum };
            }
            let chosen = below < LANES as u32;
            let pmf = descents.pmf[i] * (weight / total[i]);
            let u = remainder(x, sum, weight);
            descents.pmf[i] = if chosen { pmf } else { descents.pmf[i] };
            descents.u[i] = if chosen { u } else { descents.u[i] };
            descents.lane[i] = below;
        }
    }
}
