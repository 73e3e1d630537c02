//! Ctrl-C, and being told to end: a render stops and writes what it has.

use crate::{failure::Failure, progress::json};
use std::{
    process,
    sync::atomic::{AtomicBool, Ordering},
};

/// Whether the user wants to end.
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Whether a render is running that will look at [`REQUESTED`].
static RENDERING: AtomicBool = AtomicBool::new(false);

/// Listens to the signals. Where nothing is being rendered, or at the second time, they end the program.
pub(crate) fn listen(json: bool) {
    let handler = move || {
        let again = REQUESTED.swap(true, Ordering::SeqCst);
        if again || !RENDERING.load(Ordering::SeqCst) {
            let failure = Failure::Failed("interrupted, nothing was written".to_owned());
            failure.print();
            if json {
                json::failed(&failure);
            }
            process::exit(failure.code().into());
        }
    };
    // Without a handler the signals end the program at once, as they do everywhere.
    if let Err(error) = ctrlc::set_handler(handler) {
        tracing::warn!("cannot listen to signals: {error}");
    }
}

/// From now on a render is running, or no longer.
pub(crate) fn rendering(running: bool) {
    RENDERING.store(running, Ordering::SeqCst);
}

/// Whether the user wants to end.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
