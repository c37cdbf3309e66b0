//! Panics as a message of one line instead of a trace.

use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::{Mutex, PoisonError};

static FIRST: Mutex<Option<String>> = Mutex::new(None);

/// Runs work; a panic, also one propagated from another thread, becomes its description.
pub(super) fn contain<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    panic::set_hook(Box::new(remember));
    panic::catch_unwind(AssertUnwindSafe(work)).map_err(|_| {
        let mut first = FIRST.lock().unwrap_or_else(PoisonError::into_inner);
        first.take().unwrap_or_else(|| "unknown".into())
    })
}

/// The first panic is the cause; later ones may follow from it.
fn remember(info: &PanicHookInfo<'_>) {
    let message = info
        .payload_as_str()
        .unwrap_or("no message")
        .replace('\n', " ");
    let place = info.location().map_or_else(String::new, |at| {
        format!(" ({}:{}; please report this)", at.file(), at.line())
    });
    FIRST
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .get_or_insert_with(|| message + &place);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_one_line_with_its_place() {
        let caught = contain(|| -> () { panic!("first\nsecond") });
        let _ = panic::take_hook();
        let text = caught.unwrap_err();
        assert!(
            text.starts_with("first second (") && text.contains("panics.rs"),
            "{text}"
        );
        assert_eq!(text.lines().count(), 1);
    }
}
