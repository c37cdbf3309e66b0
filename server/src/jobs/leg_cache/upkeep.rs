//! The remembered legs of a service stay within bounds.

use crate::store::{Store, StoreError};
use std::time::Duration;

/// How often legs are counted.
const ROUND: Duration = Duration::from_mins(1);
/// Legs that are forgotten in one go, and the pause for other writers after that.
const BATCH: u64 = 100;
const PAUSE: Duration = Duration::from_millis(20);

/// Forgets what no solve can find any more, and from then on for ever the legs that were stored
/// first while there are more than so many.
pub(crate) async fn keep_within(store: Store, most: u64) {
    tell("legs of other versions", forget_foreign(&store).await);
    loop {
        tell("legs beyond --leg-cache", keep_newest(&store, most).await);
        tokio::time::sleep(ROUND).await;
    }
}

fn tell(what: &str, forgotten: Result<u64, StoreError>) {
    match forgotten {
        Ok(0) => {}
        Ok(legs) => tracing::info!(legs, "{what} were forgotten"),
        Err(error) => tracing::warn!(%error, "{what} cannot be forgotten"),
    }
}

async fn forget_foreign(store: &Store) -> Result<u64, StoreError> {
    let mut all = 0;
    loop {
        let legs = store.forget_foreign_legs(BATCH.cast_signed()).await?;
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
            .forget_oldest_legs(left.min(BATCH).cast_signed())
            .await?;
        if legs == 0 {
            break;
        }
        left = left.saturating_sub(legs);
        tokio::time::sleep(PAUSE).await;
    }
    Ok(surplus - left)
}
