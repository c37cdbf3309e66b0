//! Errors of the store.

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
        /// The error of the operating system.
        source: io::Error,
    },
    /// A copy of the database cannot be written.
    #[error("cannot copy the database to {}: {source}", path.display())]
    Copy {
        /// The copy.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The embedded SQLite is too old to be used.
    #[error("SQLite {0} can corrupt its write-ahead log; at least 3.51.3 is needed")]
    OldSqlite(String),
    /// A document does not match its stored hash.
    #[error("the stored {what} does not match its hash: the database file is damaged")]
    Damaged {
        /// The document.
        what: &'static str,
    },
    /// A row with contents that this program never writes.
    #[error("inconsistent row in {table}: {what}")]
    Inconsistent {
        /// The table.
        table: &'static str,
        /// What is wrong.
        what: String,
    },
}

/// Primary result codes of SQLite.
const BUSY: u32 = 5;
const FULL: u32 = 13;
/// Extended result codes of SQLite: the sync of a file or of its folder failed.
const IOERR_FSYNC: u32 = 1034;
const IOERR_DIR_FSYNC: u32 = 1290;

impl StoreError {
    /// Whether the file system has no room left.
    pub(crate) fn is_disk_full(&self) -> bool {
        self.primary_code() == Some(FULL)
    }

    /// Whether the same operation may succeed a little later.
    pub(crate) fn is_busy(&self) -> bool {
        matches!(self, Self::Database(sqlx::Error::PoolTimedOut))
            || self.primary_code() == Some(BUSY)
    }

    /// Whether a commit may not have reached the disk.
    pub(super) fn is_failed_sync(&self) -> bool {
        matches!(self.extended_code(), Some(IOERR_FSYNC | IOERR_DIR_FSYNC))
    }

    fn primary_code(&self) -> Option<u32> {
        Some(self.extended_code()? & 0xff)
    }

    fn extended_code(&self) -> Option<u32> {
        let Self::Database(sqlx::Error::Database(error)) = self else {
            return None;
        };
        error.code()?.parse().ok()
    }
}
