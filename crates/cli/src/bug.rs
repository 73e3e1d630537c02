//! Faults of the program itself: they end in a short message and an exit code, like everything else.

use crate::failure::Failure;
use std::{
    panic::{AssertUnwindSafe, catch_unwind, set_hook},
    sync::Mutex,
};

/// What the last fault said and where it was: the one that ends the program, where it was not caught.
static LAST: Mutex<Option<String>> = Mutex::new(None);

/// Keeps faults from writing to the terminal: some are caught and dealt with, and [`contain`] tells of the others.
pub(crate) fn catch_reports() {
    set_hook(Box::new(|info| {
        let payload = info.payload();
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("unknown");
        let place = info.location().map_or(String::new(), |l| format!(" ({}:{})", l.file(), l.line()));
        tracing::debug!("caught a fault: {text}{place}");
        let mut last = LAST.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // A fault that merely passes on that of another thread says nothing.
        if !text.contains("a scoped thread panicked") || last.is_none() {
            *last = Some(format!("{text}{place}"));
        }
    }));
}

/// Runs the program; a fault in it becomes a [`Failure::Bug`].
pub(crate) fn contain(run: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| {
        let text = LAST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
        Err(Failure::Bug(text.unwrap_or_else(|| "unknown".to_owned())))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_become_failures() {
        catch_reports();
        let failure = contain(|| panic!("seven of nine")).unwrap_err();
        assert!(matches!(&failure, Failure::Bug(text) if text.contains("seven of nine (")), "{failure:?}");
        assert_eq!(failure.code(), 1);
        // What passes a fault on does not hide it.
        let failure = contain(|| {
            std::thread::scope(|scope| {
                scope.spawn(|| panic!("in a thread"));
            });
            Ok(())
        });
        assert!(failure.unwrap_err().message().contains("in a thread"));
        assert_eq!(contain(|| Ok(())), Ok(()));
        // Other tests' faults are to be seen.
        drop(std::panic::take_hook());
    }
}
