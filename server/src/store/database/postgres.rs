//! Postgres, from version 15 on, shared by any number of processes.

use super::Database;
use crate::store::notices::Notices;
use crate::store::shared_clock::ClockOffset;
use crate::store::{StoreError, migrations};
use sqlx::error::DatabaseError;
use sqlx::migrate::{MigrateError, Migration};
use sqlx::postgres::{PgConnectOptions, PgPool, PgPoolOptions};
use std::time::Duration;

const OLDEST_POSTGRES: i32 = 150_000;
/// SQLSTATE: the role may not do this.
const FORBIDDEN: &str = "42501";
/// How services and workers call themselves to the server.
pub(in crate::store) const APPLICATION: &str = "slewplan";
/// How a copy calls itself: it is none of them.
pub(in crate::store) const COPYING: &str = "slewplan copy";
/// Maximum number of connections of a process for its statements, where nothing else is said.
pub(in crate::store) const DEFAULT_CONNECTIONS: u32 = 10;
/// One that sends notices and one that listens.
const NOTICE_CONNECTIONS: u32 = 2;
/// Longest wait for one of them.
const ACQUIRE_TIMEOUT: Duration = Duration::from_secs(5);
/// Settings of every connection.
const SETTINGS: [(&str, &str); 3] = [
    // Longest time of a statement, and of a transaction that does nothing: no connection is held by a
    // process that has stopped in the middle.
    ("statement_timeout", "30s"),
    ("idle_in_transaction_session_timeout", "30s"),
    // A bitmap of a whole queue is made before its first row is read. The statistics do not know a queue that has
    // filled within a minute, and such plans are chosen for it.
    ("enable_bitmapscan", "off"),
];

/// An open database.
#[derive(Debug, Clone)]
pub(in crate::store) struct PostgresDatabase {
    pub(in crate::store) pool: PgPool,
    pub(in crate::store) notices: Notices,
    pub(in crate::store) clock: ClockOffset,
}

impl PostgresDatabase {
    /// Connects, with a maximum number of connections for statements, and migrates the schema.
    pub(in crate::store) async fn open(
        options: &PgConnectOptions,
        connections: u32,
    ) -> Result<Database, StoreError> {
        let mut options = options.clone().options(SETTINGS);
        if options.get_application_name() != Some(COPYING) {
            options = options.application_name(APPLICATION);
        }
        let pool = PgPoolOptions::new()
            .max_connections(connections)
            .acquire_timeout(ACQUIRE_TIMEOUT)
            .connect_with(options.clone())
            .await?;
        check_version(&pool).await?;
        migrate(&pool).await?;
        let notices = PgPoolOptions::new()
            .max_connections(NOTICE_CONNECTIONS)
            .acquire_timeout(ACQUIRE_TIMEOUT)
            .connect_lazy_with(options.options([("synchronous_commit", "off")]));
        Ok(Database::Postgres(Self {
            pool,
            notices: Notices::new(notices),
            clock: ClockOffset::default(),
        }))
    }

    /// Closes all connections.
    pub(super) async fn close(&self) {
        self.notices.close().await;
        self.pool.close().await;
    }

    /// Maximum number of connections, with those for notices.
    pub(in crate::store) fn max_connections(&self) -> u32 {
        self.pool.options().get_max_connections() + NOTICE_CONNECTIONS
    }

    /// Size of the database with all of its tables and indexes, bytes.
    pub(in crate::store) async fn size(&self) -> Result<u64, StoreError> {
        let size = sqlx::query_scalar("SELECT pg_database_size(current_database())");
        let bytes: i64 = size.fetch_one(&self.pool).await?;
        Ok(u64::try_from(bytes).unwrap_or(0))
    }
}

/// The error of a statement. A server that is away is noticed by waiting for a connection.
pub(super) fn error(error: sqlx::Error) -> StoreError {
    match error {
        sqlx::Error::PoolTimedOut => StoreError::NoConnection,
        other => other.into(),
    }
}

/// Migrates the schema, unless it is already that of this version: a role that may not change it can
/// use it.
async fn migrate(pool: &PgPool) -> Result<(), StoreError> {
    let known = "SELECT to_regclass('_sqlx_migrations') IS NOT NULL";
    if sqlx::query_scalar(known).fetch_one(pool).await? {
        let applied = "SELECT version, checksum FROM _sqlx_migrations WHERE success";
        let applied: Vec<(i64, Vec<u8>)> = sqlx::query_as(applied).fetch_all(pool).await?;
        let migrator = migrations::of_postgres();
        let newer = applied
            .iter()
            .find(|(version, _)| !migrator.version_exists(*version));
        if let Some((version, _)) = newer {
            return Err(StoreError::NewerSchema(*version));
        }
        let is_applied = |known: &Migration| {
            let mut applied = applied.iter();
            applied
                .any(|(version, digest)| *version == known.version && **digest == *known.checksum)
        };
        if applied.len() == migrator.iter().count() && migrator.iter().all(is_applied) {
            return Ok(());
        }
    }
    let migrated = migrations::of_postgres().run(pool).await;
    migrated.map_err(|error| match error {
        MigrateError::Execute(error) | MigrateError::ExecuteMigration(error, _)
            if is_forbidden(&error) =>
        {
            StoreError::OldSchema
        }
        other => other.into(),
    })
}

/// Whether the role may not do this.
fn is_forbidden(error: &sqlx::Error) -> bool {
    let code = error.as_database_error().and_then(DatabaseError::code);
    code.is_some_and(|code| code == FORBIDDEN)
}

async fn check_version(pool: &PgPool) -> Result<(), StoreError> {
    let version = "SELECT current_setting('server_version'), \
         CAST(current_setting('server_version_num') AS integer)";
    let (text, number): (String, i32) = sqlx::query_as(version).fetch_one(pool).await?;
    if number < OLDEST_POSTGRES {
        return Err(StoreError::OldPostgres(text));
    }
    Ok(())
}
