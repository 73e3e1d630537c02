//! How far a render is, told in one of several ways.

mod bar;
pub(crate) mod json;
mod plain;

use crate::units::{count, digits, duration};
use bar::Bar;
use clap::ValueEnum;
use json::Json;
use plain::Plain;
use std::{
    io::IsTerminal,
    sync::Mutex,
    time::{Duration, Instant},
};
use tenfold_render::schedule::Progress;

/// How to tell how far a render is.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Style {
    /// A bar on a terminal, else plain lines
    Auto,
    /// A bar
    Bar,
    /// A line every few seconds
    Plain,
    /// One JSON object a line on standard output
    Json,
    /// Nothing
    None,
}

/// Tells how far a render is.
pub(crate) enum Reporter {
    /// By a bar on standard error.
    Bar(Bar),
    /// By lines on standard error.
    Plain(Plain),
    /// By JSON on standard output.
    Json(Json),
    /// Not at all.
    Silent,
}

impl Reporter {
    /// The reporter of a style; a quiet one speaks to programs only.
    pub(crate) fn new(style: Style, quiet: bool) -> Self {
        match style {
            Style::Json => Self::Json(Json::new()),
            _ if quiet => Self::Silent,
            Style::Auto if std::io::stderr().is_terminal() => Self::Bar(Bar::new()),
            Style::Bar => Self::Bar(Bar::new()),
            Style::Auto | Style::Plain => Self::Plain(Plain::new()),
            Style::None => Self::Silent,
        }
    }

    /// Tells that `progress` has been made. Any thread may call it, as often as it likes.
    pub(crate) fn update(&self, progress: Progress) {
        match self {
            Self::Bar(bar) => bar.update(progress),
            Self::Plain(plain) => plain.update(progress),
            Self::Json(json) => json.update(progress),
            Self::Silent => {}
        }
    }

    /// Leaves the terminal clean.
    pub(crate) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish();
        }
    }
}

/// Samples a second, so far.
fn rate(progress: Progress) -> f64 {
    progress.done as f64 / progress.seconds.max(1e-6)
}

/// Seconds to go at the rate so far.
fn remaining(progress: Progress) -> f64 {
    progress.total.saturating_sub(progress.done) as f64 / rate(progress).max(1e-6)
}

/// The share that is done, in percent.
fn percent(progress: Progress) -> f64 {
    100.0 * progress.done as f64 / progress.total.max(1) as f64
}

/// A line for people: the share done, samples a second, the time left, the noise now and wanted.
fn line(progress: Progress) -> String {
    let (rate, left) = (count(rate(progress)), duration(remaining(progress)));
    let mut line = format!("{:3.0} %  {rate} samples/s  {left} left", percent(progress).floor());
    if let Some(noise) = progress.noise {
        line += &format!("  noise {}", digits(noise));
    }
    if let (Some(_), Some(target)) = (progress.noise, progress.target) {
        line += &format!(", target {target}");
    }
    line
}

/// Lets one call pass in a while.
struct Throttle {
    every: Duration,
    /// When a call passed last.
    last: Mutex<Instant>,
}

impl Throttle {
    fn new(every: Duration) -> Self {
        Self { every, last: Mutex::new(Instant::now()) }
    }

    /// Whether it is time. A thread that would have to wait for another to find out has its answer.
    fn passes(&self) -> bool {
        let Ok(mut last) = self.last.try_lock() else { return false };
        let passes = last.elapsed() >= self.every;
        if passes {
            *last = Instant::now();
        }
        passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_and_times_follow_from_the_samples() {
        let progress = Progress { done: 300, total: 1200, seconds: 3.0, ..Progress::default() };
        assert_eq!((rate(progress), remaining(progress), percent(progress)), (100.0, 9.0, 25.0));
        let none = Progress::default();
        assert!(rate(none) == 0.0 && remaining(none) == 0.0 && percent(none) == 0.0);
    }

    #[test]
    fn a_line_says_share_rate_time_and_noise() {
        let progress = Progress { done: 2_000_000, total: 8_000_000, seconds: 4.0, ..Progress::default() };
        assert_eq!(line(progress), " 25 %  500 k samples/s  12.0 s left");
        let noisy = Progress { noise: Some(0.012_34), target: Some(0.01), ..progress };
        assert_eq!(line(noisy), " 25 %  500 k samples/s  12.0 s left  noise 0.0123, target 0.01");
    }

    #[test]
    fn throttles_let_one_pass() {
        assert!(!Throttle::new(Duration::from_secs(60)).passes());
        assert!(Throttle::new(Duration::ZERO).passes());
    }
}
