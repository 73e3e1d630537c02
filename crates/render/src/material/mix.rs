use tenfold_math::{Id, ONE_MINUS_EPSILON};

use super::Material;
use crate::texture::FloatSlot;

/// One of two materials at every point, by chance.
#[derive(Clone, Debug)]
pub struct Mix {
    /// Which.
    pub materials: [Id<Material>; 2],
    /// The probability of the second.
    pub amount: FloatSlot,
}

impl Mix {
    /// Which material a number `u` in [0, 1) chooses when the second has probability `amount`, and a number that is
    /// again uniform, for the next choice.
    #[inline]
    pub(super) fn choose(&self, amount: f32, u: f32) -> (Id<Material>, f32) {
        let [first, second] = self.materials;
        if amount >= 1.0 {
            (second, u)
        } else if amount > 0.0 && u < amount {
            (second, (u / amount).min(ONE_MINUS_EPSILON))
        } else if amount > 0.0 {
            (first, ((u - amount) / (1.0 - amount)).min(ONE_MINUS_EPSILON))
        } else {
            // NaN too.
            (first, u)
        }
    }
}
