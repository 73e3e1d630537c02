/// How a render decides over its samples by the noise. At least a target or a time limit should be given: without either,
/// every pixel gets the most samples it may.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct NoiseSettings {
    /// The noise to reach.
    pub target: Option<f64>,
    /// Samples that every pixel has in the picture at least, and in the first stage.
    pub min_spp: u32,
    /// Samples that no pixel gets more of, those of all stages together.
    pub max_spp: u32,
    /// Seconds that the render may take.
    pub time_limit: Option<f64>,
    /// Which pixels get the samples.
    pub allocation: Allocation,
}

impl Default for NoiseSettings {
    fn default() -> Self {
        Self {
            target: None,
            min_spp: 16,
            max_spp: u32::MAX,
            time_limit: None,
            allocation: Allocation::default(),
        }
    }
}

/// Which pixels get the samples.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Allocation {
    /// Those whose error is large.
    #[default]
    Adaptive,
    /// All alike: to compare.
    Uniform,
}
