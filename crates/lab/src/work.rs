use std::{
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};
use tenfold_render::{
    scene::Scene,
    schedule::{self, Progress, Render, RenderSettings},
};

/// The observer of an experiment ended it.
#[derive(Copy, Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

/// The work of an experiment, counted in samples and told to an observer while it is done.
///
/// The observer gets the progress of the whole experiment, from any thread, and returns whether to go on.
pub struct Work<'a> {
    observe: &'a (dyn Fn(Progress) -> bool + Sync),
    start: Instant,
    total: u64,
    done: u64,
}

impl<'a> Work<'a> {
    /// Work of `total` samples in all.
    pub fn new(total: u64, observe: &'a (dyn Fn(Progress) -> bool + Sync)) -> Self {
        Self { observe, start: Instant::now(), total, done: 0 }
    }

    /// Renders a scene, as a part of the work.
    ///
    /// # Errors
    /// [`Interrupted`] where the observer did not want to go on.
    pub fn render(&mut self, scene: &Scene, settings: &RenderSettings) -> Result<Render, Interrupted> {
        // A render of one piece of work is complete before anybody can end it; the experiment is not.
        let ended = AtomicBool::new(false);
        let render = schedule::render(scene, settings, &|progress| {
            let go_on = (self.observe)(self.progress(self.done + progress.done));
            ended.fetch_or(!go_on, Ordering::Relaxed);
            go_on
        });
        self.done += render.statistics.samples;
        if render.complete && !ended.into_inner() { Ok(render) } else { Err(Interrupted) }
    }

    /// Tells that `samples` more have been taken.
    ///
    /// # Errors
    /// As [`Work::render`].
    pub fn advance(&mut self, samples: u64) -> Result<(), Interrupted> {
        self.done += samples;
        if (self.observe)(self.progress(self.done)) { Ok(()) } else { Err(Interrupted) }
    }

    fn progress(&self, done: u64) -> Progress {
        Progress {
            done,
            total: self.total.max(done),
            seconds: self.start.elapsed().as_secs_f64(),
            ..Progress::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn progress_adds_up_until_the_observer_ends_it() {
        let seen = Mutex::new(Vec::new());
        let observe = |p: Progress| {
            seen.lock().unwrap().push((p.done, p.total));
            p.done < 9
        };
        let mut work = Work::new(10, &observe);
        assert_eq!(work.advance(4), Ok(()));
        assert_eq!(work.advance(4), Ok(()));
        assert_eq!(work.advance(4), Err(Interrupted));
        assert_eq!(*seen.lock().unwrap(), [(4, 10), (8, 10), (12, 12)]);
    }
}
