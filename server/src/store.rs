//! The database: all SQL of the program, and nothing else.
//!
//! One connection writes, a few read, one checkpoints the write-ahead log. Every write transaction
//! begins IMMEDIATE, so that it cannot fail at its commit because of another writer; no transaction
//! is open while anything is computed or sent.

// Before the others: their macros are known from here on.
#[macro_use]
mod row;
#[macro_use]
mod rows;

mod backup;
mod ends;
mod error;
mod events;
mod jobs;
mod keys;
mod leases;
mod leg_tables;
mod leg_times;
mod legs;
mod migrations;
mod packed;
mod recent;
mod results;
mod retention;
mod segments;
mod spacecraft;
#[cfg(test)]
mod tests;
mod wal_checkpoint;
mod writing;

pub(crate) use backup::backup;
pub(crate) use ends::{EndCode, Ended};
pub(crate) use error::StoreError;
pub(crate) use events::{EventRow, FormatEvent};
pub(crate) use jobs::{Listing, QueueLimits, Submission, Submitted};
pub(crate) use keys::{KeyRow, NewKey, Possessions};
pub(crate) use leases::Lease;
pub(crate) use leg_tables::{LegCounts, NewTablePart};
pub(crate) use leg_times::LegSnapshot;
pub(crate) use legs::{CachedLegRow, LegFilter, NewLeg, key as leg_key};
pub(crate) use packed::PackedPlan;
pub(crate) use results::{NewIncumbent, ResultRow};
pub(crate) use rows::{Counts, JobRow, JobState, ProgressRow, Work};
pub(crate) use segments::SegmentRow;
pub(crate) use spacecraft::SpacecraftRow;

use recent::RecentPlans;
use sqlx::Connection as _;
use sqlx::sqlite::{
    SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions, SqliteSynchronous,
};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;
use wal_checkpoint::WalCheckpoint;
use writing::SyncAlarm;

/// Older versions can corrupt the write-ahead log when a write and a checkpoint coincide.
const OLDEST_SQLITE: i32 = 3_051_003;
const _: () = assert!(
    libsqlite3_sys::SQLITE_VERSION_NUMBER >= OLDEST_SQLITE,
    "the embedded SQLite can corrupt its write-ahead log"
);
const READERS: u32 = 4;
const BUSY_TIMEOUT: Duration = Duration::from_secs(5);

/// The database of the service.
#[derive(Debug, Clone)]
pub(crate) struct Store {
    writer: SqlitePool,
    readers: SqlitePool,
    checkpointer: SqlitePool,
    format_event: FormatEvent,
    alarm: SyncAlarm,
    /// Notified after every commit.
    written: Arc<Notify>,
    recent: RecentPlans,
    path: PathBuf,
}

/// Locks the database against other services until it is dropped.
#[derive(Debug)]
pub(crate) struct DatabaseLock {
    _file: File,
}

impl DatabaseLock {
    /// Takes the lock.
    ///
    /// # Errors
    ///
    /// When another process holds it, or its file cannot be opened.
    pub(crate) fn take(database: &Path) -> Result<Self, StoreError> {
        let mut path = database.as_os_str().to_owned();
        path.push(".lock");
        let path = PathBuf::from(path);
        let unusable = |source| StoreError::Lock {
            path: path.clone(),
            source,
        };
        let file = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&path)
            .map_err(unusable)?;
        file.try_lock().map_err(|error| unusable(error.into()))?;
        Ok(Self { _file: file })
    }
}

impl Store {
    /// Opens or creates the database and migrates its schema; `format_event` formats the events of jobs.
    ///
    /// # Errors
    ///
    /// When the file cannot be used, or the embedded SQLite is older than [`OLDEST_SQLITE`].
    pub(crate) async fn open(path: &Path, format_event: FormatEvent) -> Result<Self, StoreError> {
        let options = SqliteConnectOptions::new()
            .filename(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            // Acknowledged writes survive a loss of power, not only the end of the process.
            .synchronous(SqliteSynchronous::Full)
            .busy_timeout(BUSY_TIMEOUT)
            .foreign_keys(true)
            .pragma("temp_store", "memory")
            .pragma("trusted_schema", "off")
            .pragma("journal_size_limit", "67108864")
            // `wal_checkpoint` checkpoints and reports failed syncs, which SQLite's own checkpoint
            // hides.
            .pragma("wal_autocheckpoint", "0");
        let writer = SqlitePoolOptions::new()
            .max_connections(1)
            .acquire_timeout(BUSY_TIMEOUT)
            // A failed COMMIT can leave a connection inside a transaction that no code will end.
            .before_acquire(|connection, _| {
                Box::pin(async move { Ok(!connection.is_in_transaction()) })
            })
            .connect_with(options.clone())
            .await?;
        check_version(&writer).await?;
        migrations::migrator().run(&writer).await?;
        let wal_checkpoint = WalCheckpoint::new(options.clone(), writer.clone());
        let checkpointer = wal_checkpoint.own();
        let readers = SqlitePoolOptions::new()
            .max_connections(READERS)
            .acquire_timeout(BUSY_TIMEOUT)
            .connect_with(options.read_only(true).create_if_missing(false))
            .await?;
        let (alarm, written) = (SyncAlarm::default(), Arc::default());
        tokio::spawn(wal_checkpoint.keep_small(alarm.clone(), Arc::clone(&written)));
        Ok(Self {
            writer,
            readers,
            checkpointer,
            format_event,
            alarm,
            written,
            recent: RecentPlans::default(),
            path: path.to_owned(),
        })
    }

    /// Closes all connections, which checkpoints the write-ahead log.
    pub(crate) async fn close(&self) {
        self.readers.close().await;
        self.checkpointer.close().await;
        self.writer.close().await;
    }

    /// Sizes of the database and of its write-ahead log, bytes; 0 for a file that does not exist.
    pub(crate) fn sizes(&self) -> [(&'static str, u64); 2] {
        let mut log = self.path.as_os_str().to_owned();
        log.push("-wal");
        let size = |path: &Path| path.metadata().map_or(0, |file| file.len());
        [
            ("database", size(&self.path)),
            ("log", size(Path::new(&log))),
        ]
    }

    /// Commits a write, which proves that the database is writable.
    pub(crate) async fn check_writable(&self, now_us: i64) -> Result<(), StoreError> {
        let mut transaction = self.begin().await?;
        sqlx::query(
            "INSERT INTO readiness (one, checked_us) VALUES (1, ?) \
             ON CONFLICT (one) DO UPDATE SET checked_us = excluded.checked_us",
        )
        .bind(now_us)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await
    }
}

async fn check_version(pool: &SqlitePool) -> Result<(), StoreError> {
    let text: String = sqlx::query_scalar("SELECT sqlite_version()")
        .fetch_one(pool)
        .await?;
    let mut parts = text.split('.').map(|part| part.parse::<i32>().unwrap_or(0));
    let mut next = || parts.next().unwrap_or(0);
    let number = next() * 1_000_000 + next() * 1000 + next();
    if number < OLDEST_SQLITE {
        return Err(StoreError::OldSqlite(text));
    }
    Ok(())
}
