//! The database: all SQL of the program, and nothing else.
//!
//! No transaction is open while anything is computed or sent.

// Before the others: their macros are known from here on.
#[macro_use]
mod row;
#[macro_use]
mod rows;
#[macro_use]
mod held;

mod address;
mod claims;
mod copy;
mod database;
mod ends;
mod error;
mod events;
mod exchange;
mod jobs;
mod keys;
mod leases;
mod leg_tables;
mod leg_times;
mod legs;
mod migrations;
mod notices;
mod packed;
mod queue_room;
mod recent;
mod results;
mod retention;
mod roles;
mod segments;
mod shards;
mod shared_clock;
mod spacecraft;
#[cfg(test)]
mod tests;
mod writing;

pub(crate) use address::DatabaseAddress;
pub(crate) use claims::{Claim, Lease, MemoryRoom};
pub(crate) use copy::{Copied, CopyLock, copy};
pub(crate) use database::sqlite::{DatabaseLock, backup};
pub(crate) use ends::{EndCode, Ended};
pub(crate) use error::StoreError;
pub(crate) use events::{EventRow, FormatEvent};
pub(crate) use exchange::{Exchange, Exchanged, JobEnd};
pub(crate) use jobs::{Listing, PRIORITIES, QueueLimits, Submission, Submitted};
pub(crate) use keys::{KeyRow, NewKey, Possessions};
pub(crate) use leases::OtherProcesses;
pub(crate) use leg_tables::{LegCounts, NewTablePart};
pub(crate) use leg_times::LegSnapshot;
pub(crate) use legs::{CachedLegRow, LegFilter, NewLeg, key as leg_key};
pub(crate) use notices::Notice;
pub(crate) use packed::PackedPlan;
pub(crate) use results::{NewIncumbent, ResultRow};
pub(crate) use rows::{Counts, JobRow, JobState, ProgressRow, Work};
pub(crate) use segments::SegmentRow;
pub(crate) use shards::{NewShard, ShardedJob};
pub(crate) use spacecraft::{SpacecraftName, SpacecraftRow};

use database::Database;
use database::postgres::{COPYING, DEFAULT_CONNECTIONS, PostgresDatabase};
use database::sqlite::SqliteDatabase;
use database::statement::sql;
use queue_room::QueueRoom;
use recent::RecentPlans;
use writing::SyncAlarm;

/// The database of the service.
#[derive(Debug, Clone)]
pub(crate) struct Store {
    database: Database,
    format_event: FormatEvent,
    alarm: SyncAlarm,
    recent: RecentPlans,
    queue_room: QueueRoom,
}

impl Store {
    /// Opens the database, creates a file that does not exist, and migrates the schema;
    /// `format_event` formats the events of jobs.
    ///
    /// # Errors
    ///
    /// When the database cannot be used, or is too old.
    pub(crate) async fn open(
        address: &DatabaseAddress,
        format_event: FormatEvent,
    ) -> Result<Self, StoreError> {
        Self::open_with(address, DEFAULT_CONNECTIONS, format_event).await
    }

    /// The same for a copy, which other copies do not take for a service.
    ///
    /// # Errors
    ///
    /// When the database cannot be used, or is too old.
    pub(crate) async fn open_quietly(
        address: &DatabaseAddress,
        format_event: FormatEvent,
    ) -> Result<Self, StoreError> {
        let address = match address {
            DatabaseAddress::Postgres(options) => {
                let options = options.as_ref().clone().application_name(COPYING);
                DatabaseAddress::Postgres(Box::new(options))
            }
            file @ DatabaseAddress::File(_) => file.clone(),
        };
        Self::open(&address, format_event).await
    }

    /// The same with a maximum number of connections to a server, beside those for notices.
    ///
    /// # Errors
    ///
    /// When the database cannot be used, or is too old.
    pub(crate) async fn open_with(
        address: &DatabaseAddress,
        connections: u32,
        format_event: FormatEvent,
    ) -> Result<Self, StoreError> {
        let alarm = SyncAlarm::default();
        let database = match address {
            DatabaseAddress::File(path) => SqliteDatabase::open(path, &alarm).await?,
            DatabaseAddress::Postgres(options) => {
                PostgresDatabase::open(options, connections).await?
            }
        };
        let store = Self {
            database,
            format_event,
            alarm,
            recent: RecentPlans::default(),
            queue_room: QueueRoom::default(),
        };
        store.compare_clocks().await?;
        Ok(store)
    }

    /// Closes all connections.
    pub(crate) async fn close(&self) {
        self.database.close().await;
    }

    /// Maximum number of connections of this process.
    pub(crate) fn max_connections(&self) -> u32 {
        match &self.database {
            Database::Sqlite(database) => database.max_connections(),
            Database::Postgres(database) => database.max_connections(),
        }
    }

    /// Numbers of connections of this process for its statements: in use, and open but free.
    pub(crate) fn connections(&self) -> [(&'static str, usize); 2] {
        let (open, free) = match &self.database {
            Database::Sqlite(SqliteDatabase {
                writer, readers, ..
            }) => (
                writer.size() + readers.size(),
                writer.num_idle() + readers.num_idle(),
            ),
            Database::Postgres(PostgresDatabase { pool, .. }) => (pool.size(), pool.num_idle()),
        };
        let in_use = (open as usize).saturating_sub(free);
        [("busy", in_use), ("idle", free)]
    }

    /// Sizes of the files of the database, bytes; on a server all of them together.
    pub(crate) async fn sizes(&self) -> Result<Vec<(&'static str, u64)>, StoreError> {
        match &self.database {
            Database::Sqlite(database) => Ok(database.sizes().into()),
            Database::Postgres(database) => Ok(vec![("database", database.size().await?)]),
        }
    }

    /// Commits a write, which proves that the database is writable.
    pub(crate) async fn check_writable(&self, now_us: i64) -> Result<(), StoreError> {
        let mut transaction = self.begin().await?;
        sql("INSERT INTO readiness (one, checked_us) VALUES (1, $1) \
             ON CONFLICT (one) DO UPDATE SET checked_us = excluded.checked_us")
        .bind(now_us)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await
    }
}
