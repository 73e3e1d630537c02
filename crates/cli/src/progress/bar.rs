use super::{Throttle, line};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use tenfold_render::schedule::Progress;

/// A bar on standard error, with a line of numbers.
pub(crate) struct Bar {
    bar: ProgressBar,
    throttle: Throttle,
}

impl Bar {
    pub(super) fn new() -> Self {
        let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::stderr());
        // A template is text of this program: where it were wrong, the standard one would do.
        if let Ok(style) = ProgressStyle::with_template("{bar:40.cyan/blue} {msg}") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        Self { bar, throttle: Throttle::new(Duration::from_millis(100)) }
    }

    pub(super) fn update(&self, progress: Progress) {
        if progress.done < progress.total && !self.throttle.passes() {
            return;
        }
        self.bar.set_length(progress.total);
        self.bar.set_position(progress.done);
        self.bar.set_message(line(progress));
    }

    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
