//! That the queue was full a moment ago.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A moment: what changed a job may be heard of late, or never.
const MOMENT: Duration = Duration::from_millis(100);

/// When the queue was last found full.
#[derive(Debug, Default)]
pub(super) struct FullQueue(Mutex<Option<Found>>);

#[derive(Debug)]
struct Found {
    at: Instant,
    /// How many changes of jobs this process had heard of.
    changes: u64,
}

impl FullQueue {
    /// Remembers that the queue was full after so many changes of jobs.
    pub(super) fn found(&self, changes: u64) {
        let at = Instant::now();
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Found { at, changes });
    }

    /// Whether the queue was full a moment ago, and nothing has changed since.
    pub(super) fn is_recent(&self, changes: u64) -> bool {
        let found = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        found
            .as_ref()
            .is_some_and(|found| found.changes == changes && found.at.elapsed() < MOMENT)
    }
}
