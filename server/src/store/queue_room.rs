//! Room in the queue, known without counting the queue for every job.
//!
//! What is queued now was unfinished when it was counted last, or has been submitted since, and the numbers of
//! jobs tell how many those are. Only close to the limit is the queue counted, by one submission at a time.

use super::database::statement::{Handle, sql};
use super::{Store, StoreError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// So close to the limit the queue is counted. More than the submissions that may be on their way at a time, which
/// no count finds.
const MARGIN: i64 = 256;

/// What this process knows of the queue.
#[derive(Debug, Clone, Default)]
pub(super) struct QueueRoom(Arc<Mutex<Known>>);

#[derive(Debug, Default)]
struct Known {
    /// The last count; `None` before the first.
    count: Option<Count>,
    /// The newest job that was seen.
    newest: i64,
}

#[derive(Debug)]
struct Count {
    /// Jobs that had not ended: one that runs may be queued again.
    unfinished: i64,
    /// The newest job before them.
    newest: i64,
}

impl QueueRoom {
    fn known(&self) -> MutexGuard<'_, Known> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the queue was certainly far from its limit when the newest job was submitted that was seen.
    pub(super) fn is_ample(&self, limit: i64) -> bool {
        let known = self.known();
        let queued_at_most = |count: &Count| count.unfinished + known.newest - count.newest;
        known
            .count
            .as_ref()
            .is_some_and(|count| queued_at_most(count) + MARGIN < limit)
    }

    /// Remembers a new job.
    pub(super) fn saw(&self, job: i64) {
        let mut known = self.known();
        known.newest = known.newest.max(job);
    }

    /// Counts the queued jobs.
    pub(super) async fn count<'c>(&self, on: impl Into<Handle<'c>>) -> Result<i64, StoreError> {
        let (unfinished, queued, newest) = sql(
            "SELECT count(*), count(CASE WHEN state = 'queued' THEN 1 END), \
             (SELECT coalesce(max(sequence), 0) FROM jobs) FROM jobs \
             WHERE state IN ('queued', 'running') AND parent IS NULL",
        )
        .fetch_one(on)
        .await?;
        let mut known = self.known();
        known.count = Some(Count { unfinished, newest });
        known.newest = known.newest.max(newest);
        Ok(queued)
    }
}

impl Store {
    /// Whether the queue is certainly far from its limit, as far as this process knows.
    pub(crate) fn has_ample_room(&self, limit: i64) -> bool {
        self.queue_room.is_ample(limit)
    }

    /// Whether a further job may be queued with this limit, as far as can be said without queueing it.
    pub(crate) async fn has_room(&self, limit: i64) -> Result<bool, StoreError> {
        Ok(self.queue_room.count(&self.database).await? < limit)
    }
}
