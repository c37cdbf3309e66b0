//! Checkpoints of the write-ahead log (WAL).
//!
//! SQLite's automatic checkpoint after a commit does not report a failed sync. Here a failed sync
//! raises the same alarm as that of a commit.

use crate::store::StoreError;
use crate::store::writing::SyncAlarm;
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool, SqlitePoolOptions};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;

/// Pages by which the WAL grows between two checkpoints, SQLite's own default: about 4 MB.
const STEP: i64 = 1000;
/// Pages from which on a checkpoint blocks writers, so that the WAL can restart from its beginning.
const RESTART_PAGES: i64 = 2 * STEP;
/// Pages from which on writers are delayed while a backup keeps the WAL from restarting: about 32
/// MB.
const DELAY_PAGES: i64 = 8 * STEP;
/// First delay of writers, doubled with each further step: negligible during most backups, half a
/// second at a WAL of 64 MB.
const FIRST_DELAY: Duration = Duration::from_millis(2);
/// Number of steps after which the delay no longer grows.
const MAX_STEPS: i64 = 8;
/// Longest wait for readers before the WAL restarts, while writers are blocked. Longer readers are
/// assumed to be backups.
const READERS: Duration = Duration::from_millis(50);

/// Checkpoints the WAL on a connection of its own.
#[derive(Debug)]
pub(super) struct WalCheckpoint {
    /// One connection.
    own: SqlitePool,
    writer: SqlitePool,
    /// Pages in the WAL at the last checkpoint.
    checkpointed_at: i64,
}

impl WalCheckpoint {
    /// Checkpoints for a database with this writer.
    pub(super) fn new(options: SqliteConnectOptions, writer: SqlitePool) -> Self {
        let own = SqlitePoolOptions::new()
            .max_connections(1)
            .connect_lazy_with(options.busy_timeout(READERS));
        Self {
            own,
            writer,
            checkpointed_at: 0,
        }
    }

    /// The connection, to be closed with the database.
    pub(super) fn own(&self) -> SqlitePool {
        self.own.clone()
    }

    /// Checkpoints whenever the WAL has grown enough, until the database is closed.
    pub(super) async fn keep_small(mut self, alarm: SyncAlarm, written: Arc<Notify>) {
        loop {
            match self.checkpoint_if_grown().await {
                Ok(()) => {}
                Err(StoreError::Database(sqlx::Error::PoolClosed)) => return,
                Err(error) => {
                    let error = alarm.check(error);
                    // The WAL still has everything, and the next write triggers another attempt.
                    tracing::warn!(%error, "the write-ahead log cannot be checkpointed");
                }
            }
            // A notification that arrived in the meantime is not lost.
            written.notified().await;
        }
    }

    async fn checkpoint_if_grown(&mut self) -> Result<(), StoreError> {
        let WalSize { pages, .. } = self.checkpoint("PRAGMA wal_checkpoint(NOOP)").await?;
        if pages < self.checkpointed_at {
            // The WAL has restarted.
            self.checkpointed_at = 0;
        }
        if pages < self.checkpointed_at + STEP && pages < DELAY_PAGES {
            return Ok(());
        }
        // Does most of the work without blocking writers.
        let wal = self.checkpoint("PRAGMA wal_checkpoint(PASSIVE)").await?;
        // While writes continue, some pages always remain and the WAL never restarts; holding the
        // writer stops them. The queue for the writer is fair. If more remains than was written
        // just now, a reader is making a backup.
        let backup = wal.pages - wal.checkpointed >= STEP;
        if backup && wal.pages >= DELAY_PAGES {
            let _turn = self.writer.acquire().await?;
            tokio::time::sleep(delay(wal.pages)).await;
        } else if !backup && wal.pages >= RESTART_PAGES {
            let _turn = self.writer.acquire().await?;
            self.checkpoint("PRAGMA wal_checkpoint(RESTART)").await?;
        }
        // Set only after success, so that the next write tries again after a failure.
        self.checkpointed_at = wal.pages;
        Ok(())
    }

    /// Runs a checkpoint pragma and returns the size of the WAL. Readers may keep the checkpoint
    /// from being complete.
    async fn checkpoint(&self, pragma: &'static str) -> Result<WalSize, StoreError> {
        let (_, pages, checkpointed): (i64, i64, i64) =
            sqlx::query_as(pragma).fetch_one(&self.own).await?;
        Ok(WalSize {
            pages,
            checkpointed,
        })
    }
}

/// The delay of writers during a backup, by the number of pages in the WAL.
fn delay(pages: i64) -> Duration {
    let steps = ((pages - DELAY_PAGES) / STEP).clamp(0, MAX_STEPS);
    FIRST_DELAY * (1 << steps)
}

/// Size of the WAL, pages.
struct WalSize {
    pages: i64,
    /// Those of them that are in the database already.
    checkpointed: i64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_delay_of_writers_grows_with_the_wal() {
        let megabytes = |count: i64| count * (1 << 20) / 4096;
        assert_eq!(delay(megabytes(32)), FIRST_DELAY);
        assert!(delay(megabytes(40)) <= Duration::from_millis(10));
        assert!(delay(megabytes(64)) >= Duration::from_millis(500));
        assert_eq!(delay(megabytes(6400)), delay(megabytes(65)));
    }
}
