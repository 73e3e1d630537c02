use tenfold_math::Slots;

/// The slots whose paths have come to a vertex from which they go on, by what they met.
#[derive(Copy, Clone, Debug, Default)]
pub(super) struct Vertices {
    /// At even reflectors.
    pub(super) even: Slots,
    /// At rough boundaries of transparent bodies.
    pub(super) boundary: Slots,
    /// At rough metals.
    pub(super) metal: Slots,
    /// At other surfaces.
    pub(super) other: Slots,
    /// Those of `other` that scatter not only in single directions.
    pub(super) glossy: Slots,
    /// Those of `other` whose wavelengths part.
    pub(super) parting: Slots,
}

impl Vertices {
    /// Those whose scattering is computed side by side.
    #[inline]
    pub(super) fn wide(&self) -> Slots {
        self.even.or(self.boundary).or(self.metal)
    }
}
