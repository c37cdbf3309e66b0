//! What can go wrong with the database.

use std::io;
use std::path::PathBuf;

/// A failure of the store.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StoreError {
    /// SQLite or its driver.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The schema cannot be brought up to date.
    #[error("database schema: {0}")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// Another process uses the database.
    #[error("cannot lock {}: {source}; does another service use this database?", path.display())]
    Lock {
        /// The file that is locked.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// An embedded SQLite that must not be used.
    #[error("SQLite {0} can corrupt its write-ahead log; at least 3.51.3 is needed")]
    OldSqlite(String),
    /// A row that this program never writes.
    #[error("inconsistent row in {table}: {what}")]
    Inconsistent {
        /// The table.
        table: &'static str,
        /// What is wrong.
        what: String,
    },
}

/// Primary result codes of SQLite.
const FULL: u32 = 13;
const BUSY: u32 = 5;

impl StoreError {
    /// Whether the file system has no room left.
    pub(crate) fn is_disk_full(&self) -> bool {
        self.primary_code() == Some(FULL)
    }

    /// Whether waiting a little may help.
    pub(crate) fn is_busy(&self) -> bool {
        matches!(self, Self::Database(sqlx::Error::PoolTimedOut))
            || self.primary_code() == Some(BUSY)
    }

    fn primary_code(&self) -> Option<u32> {
        let Self::Database(sqlx::Error::Database(error)) = self else {
            return None;
        };
        let extended: u32 = error.code()?.parse().ok()?;
        Some(extended & 0xff)
    }
}
