use super::{Throttle, line};
use crate::diagnostics::say;
use std::time::Duration;
use tenfold_render::schedule::Progress;

/// A line on standard error every few seconds.
pub(crate) struct Plain {
    throttle: Throttle,
}

impl Plain {
    pub(super) fn new() -> Self {
        Self { throttle: Throttle::new(Duration::from_secs(5)) }
    }

    pub(super) fn update(&self, progress: Progress) {
        if progress.done < progress.total && self.throttle.passes() {
            say(&line(progress));
        }
    }
}
