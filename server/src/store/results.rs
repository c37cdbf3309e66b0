//! Finished plans.

use super::{Store, StoreError};
use sqlx::{FromRow, SqliteConnection};

/// A stored plan.
#[derive(Debug, Clone, FromRow)]
pub(crate) struct ResultRow {
    /// The plan as JSON.
    pub(crate) document: Vec<u8>,
    /// SHA-256 of the document, hex.
    pub(crate) digest: String,
}

/// Stores the plan of a job that ends in the same transaction.
pub(super) async fn insert(
    connection: &mut SqliteConnection,
    job: i64,
    document: &[u8],
) -> Result<(), StoreError> {
    sqlx::query("INSERT INTO results (job, document, digest) VALUES (?, ?, ?)")
        .bind(job)
        .bind(document)
        .bind(crate::digest::hex(document))
        .execute(connection)
        .await?;
    Ok(())
}

impl Store {
    /// The plan of a job.
    pub(crate) async fn result(&self, job: i64) -> Result<Option<ResultRow>, StoreError> {
        Ok(
            sqlx::query_as("SELECT document, digest FROM results WHERE job = ?")
                .bind(job)
                .fetch_optional(&self.readers)
                .await?,
        )
    }
}
