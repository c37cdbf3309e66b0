//! Errors of the store.

use sqlx::migrate::MigrateError;
use sqlx::postgres::PgDatabaseError;
use std::io;
use std::path::PathBuf;

/// A failure of the store.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StoreError {
    /// The database or its driver.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// No connection to a server became free or could be made in time.
    #[error("database: no connection to the Postgres server in time")]
    NoConnection,
    /// The schema cannot be brought up to date.
    #[error("database schema: {0}")]
    Migration(MigrateError),
    /// The schema is that of a newer version of the program.
    #[error(
        "the database has been used by a newer version of slewplan (its migration {0} is not known \
         here): use that version, or another database"
    )]
    NewerSchema(i64),
    /// The schema is that of an older version, and this role may not change it.
    #[error(
        "the database has not been prepared for this version of slewplan, and this role may not do it: \
         run slewplan migrate as the role that owns the tables, with --grant-to for this one"
    )]
    OldSchema,
    /// Another database than this one was expected.
    #[error("the database to copy to is not empty: {table} has {rows} rows")]
    NotEmpty {
        /// The first table that is not empty.
        table: &'static str,
        /// Its number of rows.
        rows: i64,
    },
    /// Services or workers use the database.
    #[error(
        "services or workers use the database ({0} connections): stop them first, because what they \
         write meanwhile would be lost"
    )]
    InUse(i64),
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
    /// The server is too old to be used.
    #[error("Postgres {0} is too old; at least version 15 is needed")]
    OldPostgres(String),
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

impl From<MigrateError> for StoreError {
    fn from(error: MigrateError) -> Self {
        match error {
            MigrateError::VersionMissing(version) => Self::NewerSchema(version),
            other => Self::Migration(other),
        }
    }
}

/// Primary result codes of SQLite, and the bits that have them.
const PRIMARY: u32 = 0xff;
const BUSY: u32 = 5;
const FULL: u32 = 13;
/// Extended result codes of SQLite: the sync of a file or of its folder failed.
const IOERR_FSYNC: u32 = 1034;
const IOERR_DIR_FSYNC: u32 = 1290;

/// SQLSTATE of Postgres: no room is left.
const DISK_FULL: &str = "53100";
/// The server, or the user of it, may only read at present.
const READ_ONLY: &str = "25006";
/// The server has no connection left, ends or begins; nobody may connect to the database, or it is not
/// there any more.
const AWAY: [&str; 6] = ["53300", "55000", "57P01", "57P02", "57P03", "3D000"];
/// Classes of errors of the connection, of who connects (all was well when the process started), and of
/// the machine of the server, whose files cannot be read or written.
const AWAY_CLASSES: [&str; 3] = ["08", "28", "58"];
/// Other transactions were in the way: serialization, deadlock, a lock or a statement took too long.
const IN_THE_WAY: [&str; 4] = ["40001", "40P01", "55P03", "57014"];

/// The code of an error of a database.
enum ErrorCode {
    /// Extended result code of SQLite.
    Sqlite(u32),
    /// SQLSTATE of Postgres.
    Postgres(String),
}

impl StoreError {
    /// Whether the file system has no room left.
    pub(crate) fn is_disk_full(&self) -> bool {
        match self.code() {
            Some(ErrorCode::Sqlite(code)) => code & PRIMARY == FULL,
            Some(ErrorCode::Postgres(code)) => code == DISK_FULL,
            None => false,
        }
    }

    /// Whether the same operation may succeed a little later.
    pub(crate) fn is_busy(&self) -> bool {
        match self.code() {
            Some(ErrorCode::Sqlite(code)) => code & PRIMARY == BUSY,
            Some(ErrorCode::Postgres(code)) => IN_THE_WAY.contains(&code.as_str()),
            None => matches!(self, Self::Database(sqlx::Error::PoolTimedOut)),
        }
    }

    /// Whether the server of the database only reads at present, as one that follows another does.
    pub(crate) fn is_read_only(&self) -> bool {
        matches!(self.code(), Some(ErrorCode::Postgres(code)) if code == READ_ONLY)
    }

    /// Whether the server of the database cannot be reached, or cannot work.
    pub(crate) fn is_away(&self) -> bool {
        match self.code() {
            Some(ErrorCode::Postgres(code)) => {
                AWAY.contains(&code.as_str())
                    || AWAY_CLASSES.iter().any(|class| code.starts_with(class))
            }
            Some(ErrorCode::Sqlite(_)) => false,
            None => matches!(
                self,
                Self::NoConnection | Self::Database(sqlx::Error::Io(_) | sqlx::Error::Protocol(_))
            ),
        }
    }

    /// Whether a commit may not have reached the disk. A server ends by itself then.
    pub(super) fn is_failed_sync(&self) -> bool {
        matches!(
            self.code(),
            Some(ErrorCode::Sqlite(IOERR_FSYNC | IOERR_DIR_FSYNC))
        )
    }

    fn code(&self) -> Option<ErrorCode> {
        let Self::Database(sqlx::Error::Database(error)) = self else {
            return None;
        };
        let code = error.code()?;
        if error.try_downcast_ref::<PgDatabaseError>().is_some() {
            return Some(ErrorCode::Postgres(code.into_owned()));
        }
        code.parse().ok().map(ErrorCode::Sqlite)
    }
}
