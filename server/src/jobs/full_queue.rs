//! Whether the queue is full: a flood of submissions does not reach the database, which answers for all of them.

use crate::store::StoreError;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::Mutex as Turn;

/// For so long a full queue is one, unless a job changes: of a change this process may hear late, or never.
const MOMENT: Duration = Duration::from_millis(100);

/// When the queue was last found full.
#[derive(Debug, Default)]
pub(super) struct FullQueue {
    found: Mutex<Option<Found>>,
    asking: Turn<()>,
}

#[derive(Debug, Clone, Copy)]
struct Found {
    at: Instant,
    /// How many changes of jobs this process had heard of.
    changes: u64,
}

impl FullQueue {
    /// Whether the queue is full, or was a moment ago, when this process has heard of so many changes of jobs.
    /// While one asks again after a change, others are answered by what was found before.
    pub(super) async fn is_full(
        &self,
        changes: u64,
        ask: impl AsyncFnOnce() -> Result<bool, StoreError>,
    ) -> Result<bool, StoreError> {
        let _turn = match self.asking.try_lock() {
            Ok(turn) => turn,
            Err(_) if self.last().is_some() => return Ok(true),
            Err(_) => self.asking.lock().await,
        };
        if self.last().is_some_and(|found| found.changes == changes) {
            return Ok(true);
        }
        let is_full = ask().await?;
        let at = Instant::now();
        let found = is_full.then_some(Found { at, changes });
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = found;
        Ok(is_full)
    }

    /// What was found last, if that is recent.
    fn last(&self) -> Option<Found> {
        let found = *self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.filter(|found| found.at.elapsed() < MOMENT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: Result<bool, StoreError> = Ok(true);

    async fn known(queue: &FullQueue, changes: u64) -> bool {
        let mut is_known = true;
        let ask = async || {
            is_known = false;
            FULL
        };
        assert!(queue.is_full(changes, ask).await.expect("answered"));
        is_known
    }

    #[tokio::test]
    async fn a_full_queue_stays_so_for_a_moment_until_a_job_changes() {
        let queue = FullQueue::default();
        assert!(!known(&queue, 3).await);
        assert!(known(&queue, 3).await);
        assert!(!known(&queue, 4).await);
        tokio::time::sleep(MOMENT).await;
        assert!(!known(&queue, 4).await);
        let has_room = queue.is_full(5, async || Ok(false)).await;
        assert!(!has_room.expect("answered"));
        assert!(!known(&queue, 5).await);
    }

    #[tokio::test]
    async fn while_one_asks_others_are_answered_by_what_was_found() {
        let queue = FullQueue::default();
        assert!(!known(&queue, 3).await);
        let ask = async || {
            assert!(known(&queue, 4).await);
            FULL
        };
        assert!(queue.is_full(4, ask).await.expect("answered"));
    }
}
