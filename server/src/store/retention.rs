//! Jobs that ended long ago are forgotten, with everything that belongs to them.

use super::{Store, StoreError};

impl Store {
    /// Forgets jobs that ended before a time, at most so many, so that others can write in between;
    /// how many they were.
    pub(crate) async fn forget_ended(
        &self,
        before_us: i64,
        at_most: i64,
    ) -> Result<u64, StoreError> {
        let mut transaction = self.begin().await?;
        let done = sqlx::query(
            "DELETE FROM jobs WHERE sequence IN \
             (SELECT sequence FROM jobs WHERE finished_us < ? ORDER BY finished_us LIMIT ?)",
        )
        .bind(before_us)
        .bind(at_most)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(done.rows_affected())
    }
}
