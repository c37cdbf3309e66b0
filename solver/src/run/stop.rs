//! Stopping as an injected, polled object.

use super::sharing;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::{Duration, Instant};

/// Why a solve should stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The caller wants the best answer so far.
    Requested,
    /// The caller no longer wants an answer.
    Cancelled,
    /// The wall-clock limit has passed.
    TimeLimit,
}

/// A stop request shared between the caller and every worker of one solve.
///
/// Cloning shares the flag. The deadline is the only clock the solver reads.
#[derive(Debug, Clone, Default)]
pub struct StopSignal {
    flag: Arc<AtomicU8>,
    deadline: Option<Instant>,
}

const RUNNING: u8 = 0;
const REQUESTED: u8 = 1;
const CANCELLED: u8 = 2;

impl StopSignal {
    /// A signal that has not been given and has no deadline.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The same flag with a deadline from now.
    #[must_use]
    pub fn with_time_limit(&self, limit: Duration) -> Self {
        Self {
            flag: Arc::clone(&self.flag),
            deadline: Instant::now().checked_add(limit),
        }
    }

    /// Asks for the best answer so far.
    pub fn request(&self) {
        // A cancellation is never weakened to a request.
        let _ =
            self.flag
                .compare_exchange(RUNNING, REQUESTED, Ordering::Relaxed, Ordering::Relaxed);
    }

    /// Abandons the solve.
    pub fn cancel(&self) {
        self.flag.store(CANCELLED, Ordering::Relaxed);
    }

    /// The reason to stop, if there is one. Where solves share threads, others may compute before the
    /// answer.
    #[must_use]
    pub fn reason(&self) -> Option<StopReason> {
        sharing::offer_slot();
        match self.flag.load(Ordering::Relaxed) {
            REQUESTED => Some(StopReason::Requested),
            CANCELLED => Some(StopReason::Cancelled),
            _ => self
                .deadline
                .is_some_and(|at| Instant::now() >= at)
                .then_some(StopReason::TimeLimit),
        }
    }

    /// Whether the solve is cancelled: not even the best answer so far is wanted.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.flag.load(Ordering::Relaxed) == CANCELLED
    }

    /// Whether to stop now.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.reason().is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_the_flag_and_cancel_outranks_request() {
        let signal = StopSignal::new();
        let worker = signal.with_time_limit(Duration::from_hours(1));
        assert!(!worker.is_set());
        signal.request();
        assert!(worker.is_set() && !worker.is_cancelled());
        signal.cancel();
        signal.request();
        assert!(worker.is_cancelled());
        assert_eq!(worker.reason(), Some(StopReason::Cancelled));
    }

    #[test]
    fn a_passed_deadline_is_a_reason() {
        let signal = StopSignal::new().with_time_limit(Duration::ZERO);
        assert_eq!(signal.reason(), Some(StopReason::TimeLimit));
    }
}
