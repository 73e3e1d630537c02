use crate::integrator::RayCounts;
use tenfold_math::UVec2;

/// Remembered dropped samples are at most this many; all are counted.
const MOST_REMEMBERED: usize = 16;

/// A sample that was not finite: replay it with this pixel and index.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct DroppedSample {
    /// The pixel.
    pub pixel: UVec2,
    /// The index of the sample within the pixel.
    pub index: u32,
}

/// What a render did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Samples taken, dropped ones included.
    pub samples: u64,
    /// Rays traced.
    pub rays: RayCounts,
    /// Samples left out because they were not finite.
    pub dropped: u64,
    /// The first of them, by pixel and index.
    pub first_dropped: Vec<DroppedSample>,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

impl Statistics {
    pub(super) fn drop_sample(&mut self, sample: DroppedSample) {
        self.dropped += 1;
        if self.first_dropped.len() < MOST_REMEMBERED {
            self.first_dropped.push(sample);
        }
    }

    pub(super) fn merge(&mut self, other: Self) {
        self.samples += other.samples;
        self.rays.merge(&other.rays);
        self.dropped += other.dropped;
        self.first_dropped.extend(other.first_dropped);
        // Threads finish in any order; the report does not depend on it.
        self.first_dropped.sort_by_key(|d| (d.pixel.y, d.pixel.x, d.index));
        self.first_dropped.truncate(MOST_REMEMBERED);
    }
}
