//! Room in the queue, known without counting the queue for every job.
//!
//! What is queued now was unfinished when it was counted last, or has been submitted since, and the numbers of
//! jobs tell how many those are. Only close to the limit is the queue counted, by one submission at a time.

use super::database::statement::{Handle, sql};
use super::{Store, StoreError};
use std::sync::{Arc, Mutex, PoisonError};

/// So close to the limit the queue is counted. More than the submissions that may be on their way at a time, which
/// no count finds.
const MARGIN: i64 = 256;

/// The last count of this process.
#[derive(Debug, Clone, Default)]
pub(super) struct QueueRoom(Arc<Mutex<Option<Count>>>);

#[derive(Debug, Clone, Copy)]
struct Count {
    /// Jobs that had not ended: one that runs may be queued again.
    unfinished: i64,
    /// The newest job before them.
    newest: i64,
}

impl QueueRoom {
    /// Whether the queue is certainly far from its limit when this job is the newest one.
    pub(super) fn is_ample(&self, newest: i64, limit: i64) -> bool {
        let count = *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        count.is_some_and(|count| count.unfinished + newest - count.newest + MARGIN < limit)
    }

    /// Counts the queued jobs. The job was the newest one before that.
    pub(super) async fn count<'c>(
        &self,
        on: impl Into<Handle<'c>>,
        newest: i64,
    ) -> Result<i64, StoreError> {
        let (unfinished, queued) = sql(
            "SELECT count(*), count(CASE WHEN state = 'queued' THEN 1 END) FROM jobs \
             WHERE state IN ('queued', 'running') AND parent IS NULL",
        )
        .fetch_one(on)
        .await?;
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Count { unfinished, newest });
        Ok(queued)
    }
}

/// The number of the newest job.
pub(super) async fn newest<'c>(on: impl Into<Handle<'c>>) -> Result<i64, StoreError> {
    let (newest,) = sql("SELECT coalesce(max(sequence), 0) FROM jobs")
        .fetch_one(on)
        .await?;
    Ok(newest)
}

impl Store {
    /// Whether a further job may be queued with this limit, as far as can be said without queueing it.
    pub(crate) async fn has_room(&self, limit: i64) -> Result<bool, StoreError> {
        let newest = newest(&self.database).await?;
        Ok(self.queue_room.is_ample(newest, limit)
            || self.queue_room.count(&self.database, newest).await? < limit)
    }
}
