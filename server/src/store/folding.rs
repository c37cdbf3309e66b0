//! Folding the write-ahead log into the database.
//!
//! SQLite would do so by itself after a commit, but keeps to itself when the disk fails to keep
//! what is folded. Here a failed sync raises the same alarm as that of a commit.

use super::StoreError;
use super::writing::Alarm;
use sqlx::sqlite::{SqliteConnection, SqlitePool};
use std::sync::Arc;
use tokio::sync::Notify;

/// Pages in the log from which on it is folded, as many as SQLite's own choice: some 4 MB.
const PAGES: i64 = 1000;

/// Folds the log whenever it has grown, until the database is closed.
///
/// On the connection that writes, whose queue is fair: who writes more than can be folded waits.
pub(super) async fn keep_small(writer: SqlitePool, alarm: Alarm, written: Arc<Notify>) {
    loop {
        match writer.acquire().await {
            Ok(mut connection) => {
                if let Err(error) = fold(&mut connection).await {
                    let error = alarm.heed(error);
                    // The log keeps everything, and the next write tries again.
                    tracing::warn!(%error, "the log is not folded into the database");
                }
            }
            Err(sqlx::Error::PoolClosed) => return,
            Err(error) => tracing::debug!(%error, "the log is folded later"),
        }
        // A notification that came meanwhile is kept.
        written.notified().await;
    }
}

async fn fold(connection: &mut SqliteConnection) -> Result<(), StoreError> {
    // Asks only: whether somebody else folds, pages in the log, and those of them already folded.
    let look = "PRAGMA wal_checkpoint(NOOP)";
    let (_, pages, _): (i64, i64, i64) = sqlx::query_as(look).fetch_one(&mut *connection).await?;
    if pages >= PAGES {
        sqlx::query("PRAGMA wal_checkpoint(PASSIVE)")
            .execute(connection)
            .await?;
    }
    Ok(())
}
