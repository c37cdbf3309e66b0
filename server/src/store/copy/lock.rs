//! Whether something still writes to a database that is copied: it would be missing in the copy.

use crate::store::database::Database;
use crate::store::database::postgres::APPLICATION;
use crate::store::database::sqlite::DatabaseLock;
use crate::store::{DatabaseAddress, Store, StoreError};

/// Keeps services from a file while it is copied, or copied to.
#[derive(Debug)]
pub(crate) struct CopyLock(
    #[expect(dead_code, reason = "held until it is dropped")] Option<DatabaseLock>,
);

impl CopyLock {
    /// Locks a file, before it is opened.
    ///
    /// # Errors
    ///
    /// When a service uses it.
    pub(crate) fn exclude(address: &DatabaseAddress) -> Result<Self, StoreError> {
        let lock = match address {
            DatabaseAddress::File(path) => Some(DatabaseLock::take(path)?),
            DatabaseAddress::Postgres(_) => None,
        };
        Ok(Self(lock))
    }
}

impl Store {
    /// Refuses a server on whose database other processes of this program work.
    ///
    /// # Errors
    ///
    /// When there are some.
    pub(crate) async fn refuse_others(&self) -> Result<(), StoreError> {
        let Database::Postgres(database) = &self.database else {
            return Ok(());
        };
        let others = "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() \
             AND application_name = $1";
        let others: i64 = sqlx::query_scalar(others)
            .bind(APPLICATION)
            .fetch_one(&database.pool)
            .await?;
        if others > 0 {
            return Err(StoreError::InUse(others));
        }
        Ok(())
    }
}
