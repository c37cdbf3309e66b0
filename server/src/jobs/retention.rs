//! Deletion of jobs that ended long ago, in small batches.

use crate::base::clock::now_us;
use crate::store::{Store, StoreError};
use std::time::Duration;

/// Interval between two rounds.
const ROUND: Duration = Duration::from_hours(1);
/// Jobs deleted per transaction, and the pause for other writers after it.
const BATCH: u64 = 100;
const PAUSE: Duration = Duration::from_millis(50);

/// Deletes jobs some time after their end; never returns.
pub(crate) async fn keep_for(store: Store, time: Duration) {
    loop {
        match delete_ended(&store, time).await {
            Ok(0) => {}
            Ok(jobs) => tracing::info!(jobs, "old jobs were deleted"),
            Err(error) => tracing::warn!(%error, "old jobs cannot be deleted"),
        }
        tokio::time::sleep(ROUND).await;
    }
}

async fn delete_ended(store: &Store, time: Duration) -> Result<u64, StoreError> {
    let kept_us = i64::try_from(time.as_micros()).unwrap_or(i64::MAX);
    let before = now_us().saturating_sub(kept_us);
    let mut all = 0;
    loop {
        let jobs = store.delete_ended_jobs(before, BATCH.cast_signed()).await?;
        all += jobs;
        if jobs < BATCH {
            return Ok(all);
        }
        tokio::time::sleep(PAUSE).await;
    }
}
