//! Deletion of jobs that ended long ago, with everything that refers to them.

use super::database::statement::sql;
use super::{Store, StoreError};

impl Store {
    /// Deletes at most `at_most` jobs that ended before a time. Returns their number. Small batches
    /// let other writes come in between.
    pub(crate) async fn delete_ended_jobs(
        &self,
        before_us: i64,
        at_most: i64,
    ) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        let deleted = sql("DELETE FROM jobs WHERE sequence IN \
             (SELECT sequence FROM jobs WHERE finished_us < $1 ORDER BY finished_us LIMIT $2)")
        .bind(before_us)
        .bind(at_most)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(deleted)
    }
}
