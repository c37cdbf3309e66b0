//! Jobs that ended long ago are deleted, a few at a time.

use crate::base::clock::now_us;
use crate::store::{Store, StoreError};
use std::time::Duration;

/// How often is looked for them.
const ROUND: Duration = Duration::from_hours(1);
/// Jobs that are deleted in one go, and the pause for other writers after that.
const BATCH: u64 = 100;
const PAUSE: Duration = Duration::from_millis(50);

/// Deletes jobs some time after their end, from now on and for ever.
pub(crate) async fn keep_for(store: Store, time: Duration) {
    loop {
        match forget(&store, time).await {
            Ok(0) => {}
            Ok(jobs) => tracing::info!(jobs, "jobs of the past were deleted"),
            Err(error) => tracing::warn!(%error, "jobs of the past cannot be deleted"),
        }
        tokio::time::sleep(ROUND).await;
    }
}

async fn forget(store: &Store, time: Duration) -> Result<u64, StoreError> {
    let kept_us = i64::try_from(time.as_micros()).unwrap_or(i64::MAX);
    let before = now_us().saturating_sub(kept_us);
    let mut all = 0;
    loop {
        let jobs = store.forget_ended(before, BATCH.cast_signed()).await?;
        all += jobs;
        if jobs < BATCH {
            return Ok(all);
        }
        tokio::time::sleep(PAUSE).await;
    }
}
