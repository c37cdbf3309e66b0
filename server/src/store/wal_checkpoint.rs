//! Folding the write-ahead log into the database.
//!
//! SQLite would do so by itself after a commit, but keeps to itself when the disk fails to keep
//! what is folded. Here a failed sync raises the same alarm as that of a commit.

use super::StoreError;
use super::writing::Alarm;
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool, SqlitePoolOptions};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;

/// Pages by which the log grows before it is folded, as many as SQLite's own choice: some 4 MB.
const STEP: i64 = 1000;
/// Pages in the log from which on writers wait, so that it can begin anew.
const LONG: i64 = 2 * STEP;
/// Pages from which on they wait after every write while somebody makes a copy, which keeps the log
/// from beginning anew: some 32 MB.
const TOO_LONG: i64 = 8 * STEP;
/// How long they wait then, twice as long with each step: hardly at first, so that most copies are
/// made before anybody notices, and half a second where the log has 64 MB.
const PAUSE: Duration = Duration::from_millis(2);
/// Steps after which the wait is long enough.
const MAX_STEPS: i64 = 8;
/// Longest wait for readers before the log begins anew, while nobody can write. Who reads longer makes
/// a copy.
const READERS: Duration = Duration::from_millis(50);

/// Folds the log on a connection of its own, beside those who write and read.
#[derive(Debug)]
pub(super) struct Folding {
    /// One connection.
    own: SqlitePool,
    writer: SqlitePool,
    /// Pages in the log when it was last folded.
    folded_at: i64,
}

impl Folding {
    /// Folding for a database that this writer writes.
    pub(super) fn new(options: SqliteConnectOptions, writer: SqlitePool) -> Self {
        let own = SqlitePoolOptions::new()
            .max_connections(1)
            .connect_lazy_with(options.busy_timeout(READERS));
        Self {
            own,
            writer,
            folded_at: 0,
        }
    }

    /// The connection, to be closed with the database.
    pub(super) fn own(&self) -> SqlitePool {
        self.own.clone()
    }

    /// Folds the log whenever it has grown, until the database is closed.
    pub(super) async fn keep_small(mut self, alarm: Alarm, written: Arc<Notify>) {
        loop {
            match self.fold().await {
                Ok(()) => {}
                Err(StoreError::Database(sqlx::Error::PoolClosed)) => return,
                Err(error) => {
                    let error = alarm.heed(error);
                    // The log keeps everything, and the next write tries again.
                    tracing::warn!(%error, "the log is not folded into the database");
                }
            }
            // A notification that came meanwhile is kept.
            written.notified().await;
        }
    }

    async fn fold(&mut self) -> Result<(), StoreError> {
        let Log { pages, .. } = self.checkpoint("PRAGMA wal_checkpoint(NOOP)").await?;
        if pages < self.folded_at {
            // It has begun anew.
            self.folded_at = 0;
        }
        if pages < self.folded_at + STEP && pages < TOO_LONG {
            return Ok(());
        }
        // Most of the work, while others write.
        let log = self.checkpoint("PRAGMA wal_checkpoint(PASSIVE)").await?;
        // As long as others write, there is always something left, and the log never begins anew.
        // The queue for the writer is fair: who writes more than can be folded waits. A copy keeps more
        // from being folded than was written just now.
        let copied = log.pages - log.folded >= STEP;
        if copied && log.pages >= TOO_LONG {
            let _turn = self.writer.acquire().await?;
            tokio::time::sleep(pause(log.pages)).await;
        } else if !copied && log.pages >= LONG {
            let _turn = self.writer.acquire().await?;
            self.checkpoint("PRAGMA wal_checkpoint(RESTART)").await?;
        }
        // After a failure too little is remembered, so that the next write tries again.
        self.folded_at = log.pages;
        Ok(())
    }

    /// The log after some kind of wal_checkpoint, which readers may keep from being complete.
    async fn checkpoint(&self, kind: &'static str) -> Result<Log, StoreError> {
        let (_, pages, folded): (i64, i64, i64) = sqlx::query_as(kind).fetch_one(&self.own).await?;
        Ok(Log { pages, folded })
    }
}

/// How long writers wait while a copy is made and the log has so many pages.
fn pause(pages: i64) -> Duration {
    let steps = ((pages - TOO_LONG) / STEP).clamp(0, MAX_STEPS);
    PAUSE * (1 << steps)
}

/// How long the log is, pages.
struct Log {
    pages: i64,
    /// Those of them that are in the database.
    folded: i64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longer_the_log_the_longer_the_wait() {
        let megabytes = |count: i64| count * (1 << 20) / 4096;
        assert_eq!(pause(megabytes(32)), PAUSE);
        assert!(pause(megabytes(40)) <= Duration::from_millis(10));
        assert!(pause(megabytes(64)) >= Duration::from_millis(500));
        assert_eq!(pause(megabytes(6400)), pause(megabytes(65)));
    }
}
