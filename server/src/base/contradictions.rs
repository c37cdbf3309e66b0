//! Contradictions between a propagated flight and a proved bound or a stored leg: logged and counted.

use prometheus::IntCounter;
use slewplan_solver::run::contradiction::Contradiction;
use slewplan_solver::run::progress::{Observer, Progress};
use std::sync::LazyLock;

static COUNTER: LazyLock<IntCounter> = LazyLock::new(|| {
    IntCounter::new(
        "slewplan_contradictions_total",
        "Flights that contradicted a certified bound or a stored leg: defects of the planner.",
    )
    .expect("a valid metric")
});

/// Contradictions since the process began.
pub(crate) fn counter() -> &'static IntCounter {
    &COUNTER
}

/// Logs and counts a contradiction; the span of the log names the job or the request.
pub(crate) fn record(contradiction: &Contradiction) {
    COUNTER.inc();
    tracing::error!(%contradiction, "a flight contradicts a proved bound or a stored leg, which the answer leaves out");
}

/// Listens for contradictions only.
pub(crate) struct ContradictionObserver;

impl Observer for ContradictionObserver {
    fn progress(&self, _: Progress) {}

    fn contradicted(&self, contradiction: &Contradiction) {
        record(contradiction);
    }
}
