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
    /// A copy of the database cannot be written.
    #[error("cannot copy the database to {}: {source}", path.display())]
    Copy {
        /// The copy.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// An embedded SQLite that must not be used.
    #[error("SQLite {0} can corrupt its write-ahead log; at least 3.51.3 is needed")]
    OldSqlite(String),
    /// A document that is no longer what was stored.
    #[error("the stored {what} is not what was stored: the database file is damaged")]
    Damaged {
        /// The document.
        what: &'static str,
    },
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
const BUSY: u32 = 5;
const FULL: u32 = 13;
/// Extended result codes of SQLite: a file or its folder could not be brought to the disk.
const IOERR_FSYNC: u32 = 1034;
const IOERR_DIR_FSYNC: u32 = 1290;

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
