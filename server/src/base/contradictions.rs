//! What was flown and contradicts what was claimed: logged as an error, and counted.

use slewplan_solver::run::contradiction::Contradiction;
use slewplan_solver::run::progress::{Observer, Progress};
use std::sync::atomic::{AtomicU64, Ordering};

static COUNT: AtomicU64 = AtomicU64::new(0);

/// Contradictions since the process began.
pub(crate) fn count() -> u64 {
    COUNT.load(Ordering::Relaxed)
}

/// Logs and counts a contradiction; the span of the log names the job or the request.
pub(crate) fn tell(contradiction: &Contradiction) {
    COUNT.fetch_add(1, Ordering::Relaxed);
    tracing::error!(%contradiction, "a flight contradicts a claim; the answer carries no such claim");
}

/// Listens for contradictions only.
pub(crate) struct Unwatched;

impl Observer for Unwatched {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, contradiction: &Contradiction) {
        tell(contradiction);
    }
}
