//! The protocol for programs: one JSON object a line on standard output, the last one, and only that, with the event
//! `completed` or `failed`.

use super::{Throttle, percent, rate, remaining};
use crate::failure::Failure;
use serde_json::{Value, json};
use std::{
    io::Write,
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};
use tenfold_render::schedule::Progress;
use tenfold_scene::{Diagnostic, SourceMap};

/// Whether the last line has been written. It also keeps lines of several threads apart.
static ENDED: Mutex<bool> = Mutex::new(false);

/// Progress in JSON.
pub(crate) struct Json {
    throttle: Throttle,
    /// Whether everything was said to be done.
    finished: AtomicBool,
}

impl Json {
    pub(super) fn new() -> Self {
        Self { throttle: Throttle::new(Duration::from_millis(500)), finished: AtomicBool::new(false) }
    }

    pub(super) fn update(&self, progress: Progress) {
        let full = progress.done >= progress.total && !self.finished.swap(true, Ordering::Relaxed);
        if full || self.throttle.passes() {
            write(
                json!({
                    "event": "progress",
                    "done": progress.done,
                    "total": progress.total,
                    "percent": percent(progress),
                    "seconds": progress.seconds,
                    "samples_per_second": rate(progress),
                    "seconds_left": remaining(progress),
                    "noise": progress.noise,
                    "noise_target": progress.target,
                }),
                false,
            );
        }
    }
}

/// A render begins: `fields` say which.
pub(crate) fn started(fields: Value) {
    write(with_event("started", fields), false);
}

/// A finding about the scene.
pub(crate) fn diagnostic(diagnostic: &Diagnostic, sources: &SourceMap) {
    let place = diagnostic.span.map(|span| (sources.file(span.file).path.display(), sources.location(span)));
    let fields = json!({
        "severity": diagnostic.severity.to_string(),
        "message": diagnostic.message,
        "help": diagnostic.help,
        "file": place.as_ref().map(|(path, _)| path.to_string()),
        "line": place.as_ref().map(|(_, at)| at.line),
        "column": place.as_ref().map(|(_, at)| at.column),
    });
    write(with_event("diagnostic", fields), false);
}

/// The last line of a render that was done: `fields` say what it took.
pub(crate) fn completed(fields: Value) {
    write(with_event("completed", fields), true);
}

/// The last line of all other runs.
pub(crate) fn failed(failure: &Failure) {
    write(json!({ "event": "failed", "exit_code": failure.code(), "message": failure.message() }), true);
}

fn with_event(event: &str, fields: Value) -> Value {
    let mut object = json!({ "event": event });
    if let (Value::Object(object), Value::Object(fields)) = (&mut object, fields) {
        object.extend(fields);
    }
    object
}

/// Writes a line, unless the last one has been written. Where nobody listens there is nobody to tell.
fn write(line: Value, last: bool) {
    let mut ended = ENDED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if !*ended {
        let mut out = std::io::stdout().lock();
        let _ = writeln!(out, "{line}").and_then(|()| out.flush());
        *ended = last;
    }
}
