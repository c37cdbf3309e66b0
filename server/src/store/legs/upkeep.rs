//! Deletion of legs in small batches, so that other writes come in between.

use super::super::database::Turn;
use super::super::database::statement::{Statement, sql};
use super::super::{Store, StoreError};
use super::SOLVER_VERSION;
use std::collections::HashSet;

impl Store {
    /// Deletes at most `at_most` legs of other versions of the solver. Returns their number.
    pub(crate) async fn delete_legs_of_other_versions(
        &self,
        at_most: i64,
    ) -> Result<u64, StoreError> {
        // Each half can use the index; `<>` could not.
        let foreign = sql("DELETE FROM legs WHERE sequence IN \
             (SELECT sequence FROM legs WHERE solver_version < $1 \
             UNION ALL SELECT sequence FROM legs WHERE solver_version > $1 LIMIT $2) \
             RETURNING spacecraft");
        self.delete_legs(foreign.bind(SOLVER_VERSION).bind(at_most))
            .await
    }

    /// Deletes the `count` oldest legs. Returns the number of those that existed.
    pub(crate) async fn delete_oldest_legs(&self, count: i64) -> Result<u64, StoreError> {
        let oldest = sql("DELETE FROM legs WHERE sequence IN \
             (SELECT sequence FROM legs ORDER BY sequence LIMIT $1) RETURNING spacecraft");
        self.delete_legs(oldest.bind(count)).await
    }

    /// Deletes legs, and spacecraft without any legs left.
    async fn delete_legs(&self, delete: Statement<'_>) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        transaction.take_turn(Turn::Legs).await?;
        let gone: Vec<(String,)> = delete.fetch_all(&mut *transaction).await?;
        let count = gone.len() as u64;
        for (spacecraft,) in gone.into_iter().collect::<HashSet<_>>() {
            sql("DELETE FROM leg_spacecraft WHERE key = $1 \
                 AND NOT EXISTS (SELECT 1 FROM legs WHERE spacecraft = $1)")
            .bind(spacecraft)
            .execute(&mut *transaction)
            .await?;
        }
        transaction.commit().await?;
        Ok(count)
    }
}
