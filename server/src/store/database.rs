//! The two databases that the store speaks: SQLite, and Postgres from version 15 on.
//!
//! The texts of statements are written once, in the SQL that both understand, with `$1` for values.
//! What differs is here: how connections are made ([`sqlite`], [`postgres`]), how values and rows
//! pass ([`statement`], [`row`]), and some words of the statements ([`dialect`]).

pub(super) mod dialect;
pub(super) mod postgres;
pub(super) mod row;
pub(super) mod sqlite;
pub(super) mod statement;

use super::StoreError;
use postgres::PostgresDatabase;
use sqlite::SqliteDatabase;
use sqlx::{Postgres, Sqlite};
use statement::{Handle, sql};

/// An open database.
#[derive(Debug, Clone)]
pub(super) enum Database {
    /// A file, used by this process and perhaps by commands beside it.
    Sqlite(SqliteDatabase),
    /// A server, used by any number of processes.
    Postgres(PostgresDatabase),
}

/// A transaction; it is rolled back unless it is committed.
#[derive(Debug)]
pub(super) enum Transaction {
    /// Of SQLite.
    Sqlite(sqlx::Transaction<'static, Sqlite>),
    /// Of Postgres.
    Postgres(sqlx::Transaction<'static, Postgres>),
}

/// What transactions of Postgres that look before they write do one at a time. SQLite has one
/// writer anyway.
#[derive(Debug, Clone, Copy)]
pub(super) enum Turn {
    /// Count queued jobs, look for an idempotency key, and queue a job.
    Submission = 1,
    /// Store or delete legs, with the spacecraft that they refer to.
    Legs = 2,
    /// Look for the newest version of a spacecraft and store the next.
    Spacecraft = 3,
    /// Give what belongs to nobody to a client.
    Adoption = 4,
}

/// Distinguishes the locks of [`Turn`] from those of other programs in the same database.
const LOCKS: i64 = 0x736c_6577 << 8;

impl Database {
    /// Begins a transaction that writes.
    pub(super) async fn begin(&self) -> Result<Transaction, StoreError> {
        Ok(match self {
            Self::Sqlite(database) => Transaction::Sqlite(database.begin().await?),
            Self::Postgres(database) => {
                let begun = database.pool.begin().await;
                Transaction::Postgres(begun.map_err(postgres::error)?)
            }
        })
    }

    /// Begins a transaction that reads the database as of its first statement.
    pub(super) async fn snapshot(&self) -> Result<Transaction, StoreError> {
        Ok(match self {
            Self::Sqlite(database) => Transaction::Sqlite(database.readers.begin().await?),
            Self::Postgres(database) => {
                let begin = "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY";
                let begun = database.pool.begin_with(begin).await;
                Transaction::Postgres(begun.map_err(postgres::error)?)
            }
        })
    }

    /// Closes all connections.
    pub(super) async fn close(&self) {
        match self {
            Self::Sqlite(database) => database.close().await,
            Self::Postgres(database) => database.close().await,
        }
    }
}

impl Transaction {
    /// Commits it.
    pub(super) async fn commit(self) -> Result<(), sqlx::Error> {
        match self {
            Self::Sqlite(transaction) => transaction.commit().await,
            Self::Postgres(transaction) => transaction.commit().await,
        }
    }

    /// Rolls it back, and waits until that is done.
    pub(super) async fn rollback(self) -> Result<(), sqlx::Error> {
        match self {
            Self::Sqlite(transaction) => transaction.rollback().await,
            Self::Postgres(transaction) => transaction.rollback().await,
        }
    }

    /// Waits until no other transaction has this turn, and takes it until its end.
    pub(super) async fn take_turn(&mut self, turn: Turn) -> Result<(), StoreError> {
        if let Self::Postgres(_) = self {
            sql("SELECT 1 FROM (SELECT pg_advisory_xact_lock($1)) AS turn")
                .bind(LOCKS + turn as i64)
                .execute(self)
                .await?;
        }
        Ok(())
    }

    /// Has rows in the order of an index read from it until its end, as SQLite does anyway. Without this
    /// Postgres, whose statistics do not know a queue that has filled within a minute, expects a single
    /// row, and reads and sorts the whole queue for the first few of it.
    pub(super) async fn read_in_order(&mut self) -> Result<(), StoreError> {
        if let Self::Postgres(_) = self {
            sql("SELECT set_config('enable_sort', 'off', true)")
                .execute(self)
                .await?;
        }
        Ok(())
    }
}

impl<'c> From<&'c Database> for Handle<'c> {
    fn from(database: &'c Database) -> Self {
        match database {
            Database::Sqlite(database) => Self::SqlitePool(&database.readers),
            Database::Postgres(database) => Self::PostgresPool(&database.pool),
        }
    }
}

impl<'c> From<&'c mut Transaction> for Handle<'c> {
    fn from(transaction: &'c mut Transaction) -> Self {
        match transaction {
            Transaction::Sqlite(transaction) => Self::Sqlite(transaction),
            Transaction::Postgres(transaction) => Self::Postgres(transaction),
        }
    }
}
