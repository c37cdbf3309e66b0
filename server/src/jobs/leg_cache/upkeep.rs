//! Keeps the number of cached legs within its limit.

use crate::store::{Store, StoreError};
use std::time::Duration;

/// Interval between two counts of the legs.
const ROUND: Duration = Duration::from_mins(1);
/// Legs deleted per transaction, and the pause for other writers after it.
const BATCH: u64 = 100;
const PAUSE: Duration = Duration::from_millis(20);

/// Deletes legs of other versions, which no solve can find; then, without end, the oldest legs
/// beyond a maximum number.
pub(crate) async fn keep_within(store: Store, most: u64) {
    log(
        "legs of other versions",
        delete_other_versions(&store).await,
    );
    loop {
        log("legs beyond --leg-cache", keep_newest(&store, most).await);
        tokio::time::sleep(ROUND).await;
    }
}

fn log(what: &str, deleted: Result<u64, StoreError>) {
    match deleted {
        Ok(0) => {}
        Ok(legs) => tracing::info!(legs, "{what} were deleted"),
        Err(error) => tracing::warn!(%error, "{what} cannot be deleted"),
    }
}

async fn delete_other_versions(store: &Store) -> Result<u64, StoreError> {
    let mut all = 0;
    loop {
        let legs = store
            .delete_legs_of_other_versions(BATCH.cast_signed())
            .await?;
        all += legs;
        if legs < BATCH {
            return Ok(all);
        }
        tokio::time::sleep(PAUSE).await;
    }
}

async fn keep_newest(store: &Store, most: u64) -> Result<u64, StoreError> {
    let count = u64::try_from(store.leg_count().await?).unwrap_or(0);
    let surplus = count.saturating_sub(most);
    let mut left = surplus;
    while left > 0 {
        let legs = store
            .delete_oldest_legs(left.min(BATCH).cast_signed())
            .await?;
        if legs == 0 {
            break;
        }
        left = left.saturating_sub(legs);
        tokio::time::sleep(PAUSE).await;
    }
    Ok(surplus - left)
}
