use super::{Throttle, percent, rate, remaining};
use crate::{
    diagnostics::say,
    units::{count, duration},
};
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

fn line(progress: Progress) -> String {
    let (rate, left) = (count(rate(progress)), duration(remaining(progress)));
    format!("{:3.0} %  {rate} samples/s  {left} left", percent(progress).floor())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_share_rate_and_time() {
        let progress = Progress { done: 2_000_000, total: 8_000_000, seconds: 4.0 };
        assert_eq!(line(progress), " 25 %  500 k samples/s  12.0 s left");
    }
}
