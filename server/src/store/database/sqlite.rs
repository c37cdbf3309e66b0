//! SQLite: one connection writes, a few read, one checkpoints the write-ahead log.
//!
//! Every write transaction begins IMMEDIATE, so that it cannot fail at its commit because of another
//! writer.

mod backup;
mod wal_checkpoint;

pub(crate) use backup::backup;

use super::Database;
use crate::store::writing::SyncAlarm;
use crate::store::{StoreError, migrations};
use sqlx::sqlite::{
    Sqlite, SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions,
    SqliteSynchronous,
};
use sqlx::{Connection as _, Transaction};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Notify;
use wal_checkpoint::WalCheckpoint;

/// Older versions can corrupt the write-ahead log when a write and a checkpoint coincide.
const OLDEST_SQLITE: i32 = 3_051_003;
const _: () = assert!(
    libsqlite3_sys::SQLITE_VERSION_NUMBER >= OLDEST_SQLITE,
    "the embedded SQLite can corrupt its write-ahead log"
);
const READERS: u32 = 4;
/// Rows that a connection has read ahead of who asked for them: with few, both threads wait for each other over and
/// over again.
const ROW_BUFFER: usize = 1024;
const BUSY_TIMEOUT: Duration = Duration::from_secs(5);

/// An open file.
#[derive(Debug, Clone)]
pub(in crate::store) struct SqliteDatabase {
    pub(in crate::store) writer: SqlitePool,
    pub(in crate::store) readers: SqlitePool,
    checkpointer: SqlitePool,
    /// Notified after every commit.
    pub(in crate::store) written: Arc<Notify>,
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

impl SqliteDatabase {
    /// Opens or creates a file and migrates its schema.
    pub(in crate::store) async fn open(
        path: &Path,
        alarm: &SyncAlarm,
    ) -> Result<Database, StoreError> {
        let options = SqliteConnectOptions::new()
            .filename(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            // Acknowledged writes survive a loss of power, not only the end of the process.
            .synchronous(SqliteSynchronous::Full)
            .busy_timeout(BUSY_TIMEOUT)
            .row_buffer_size(ROW_BUFFER)
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
        migrations::of_sqlite().run(&writer).await?;
        let wal_checkpoint = WalCheckpoint::new(options.clone(), writer.clone());
        let checkpointer = wal_checkpoint.own();
        let readers = SqlitePoolOptions::new()
            .max_connections(READERS)
            .acquire_timeout(BUSY_TIMEOUT)
            .connect_with(options.read_only(true).create_if_missing(false))
            .await?;
        let written = Arc::default();
        tokio::spawn(wal_checkpoint.keep_small(alarm.clone(), Arc::clone(&written)));
        Ok(Database::Sqlite(Self {
            writer,
            readers,
            checkpointer,
            written,
            path: path.to_owned(),
        }))
    }

    /// Begins a transaction that holds the write lock from its begin.
    pub(super) async fn begin(&self) -> Result<Transaction<'static, Sqlite>, sqlx::Error> {
        self.writer.begin_with("BEGIN IMMEDIATE").await
    }

    /// Closes all connections, which checkpoints the write-ahead log.
    pub(super) async fn close(&self) {
        self.readers.close().await;
        self.checkpointer.close().await;
        self.writer.close().await;
    }

    /// Maximum number of connections to the file.
    pub(in crate::store) fn max_connections(&self) -> u32 {
        let pools = [&self.writer, &self.readers, &self.checkpointer];
        pools
            .map(|pool| pool.options().get_max_connections())
            .iter()
            .sum()
    }

    /// Sizes of the database and of its write-ahead log, bytes; 0 for a file that does not exist.
    pub(in crate::store) fn sizes(&self) -> [(&'static str, u64); 2] {
        let mut log = self.path.as_os_str().to_owned();
        log.push("-wal");
        let size = |path: &Path| path.metadata().map_or(0, |file| file.len());
        [
            ("database", size(&self.path)),
            ("log", size(Path::new(&log))),
        ]
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
