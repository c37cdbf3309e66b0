//! Forgetting legs, a few at a time, so that others can write in between.

use super::super::{Store, StoreError};
use super::SOLVER_VERSION;
use sqlx::Sqlite;
use sqlx::query::QueryScalar;
use sqlx::sqlite::SqliteArguments;
use std::collections::HashSet;

impl Store {
    /// Forgets legs of other versions of the solver, at most so many; how many they were.
    pub(crate) async fn forget_foreign_legs(&self, at_most: i64) -> Result<u64, StoreError> {
        // Each half has the index; an inequality has not.
        let foreign = sqlx::query_scalar(
            "DELETE FROM legs WHERE sequence IN \
             (SELECT sequence FROM legs WHERE solver_version < ?1 \
             UNION ALL SELECT sequence FROM legs WHERE solver_version > ?1 LIMIT ?2) \
             RETURNING spacecraft",
        );
        self.forget_legs(foreign.bind(SOLVER_VERSION).bind(at_most))
            .await
    }

    /// Forgets so many of the legs that were stored first; how many there were.
    pub(crate) async fn forget_oldest_legs(&self, count: i64) -> Result<u64, StoreError> {
        let oldest = sqlx::query_scalar(
            "DELETE FROM legs WHERE sequence IN \
             (SELECT sequence FROM legs ORDER BY sequence LIMIT ?) RETURNING spacecraft",
        );
        self.forget_legs(oldest.bind(count)).await
    }

    /// Forgets legs, and spacecraft of which there are none left.
    async fn forget_legs(
        &self,
        delete: QueryScalar<'_, Sqlite, String, SqliteArguments>,
    ) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        let gone = delete.fetch_all(&mut *transaction).await?;
        let count = gone.len() as u64;
        for spacecraft in gone.into_iter().collect::<HashSet<_>>() {
            sqlx::query(
                "DELETE FROM leg_spacecraft WHERE key = ?1 \
                 AND NOT EXISTS (SELECT 1 FROM legs WHERE spacecraft = ?1)",
            )
            .bind(spacecraft)
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit().await?;
        Ok(count)
    }
}
