//! What happened to a job, in order.

use super::writing::Writing;
use super::{JobRow, Store, StoreError};
use sqlx::FromRow;

/// Something that happened to a job.
#[derive(Debug, Clone, FromRow)]
pub(crate) struct EventRow {
    /// Counts from 1 within the job.
    pub(crate) id: i64,
    /// `state` or `progress`.
    pub(crate) kind: String,
    /// The event as JSON.
    pub(crate) data: String,
}

/// Writes how a job stands at a time (microseconds since 1970), as JSON: an event that is kept as it is.
pub(crate) type TellJob = fn(&JobRow, i64) -> Result<String, StoreError>;

/// Most events that are read at once.
const BATCH: i64 = 256;

/// Appends an event that tells how a job stands now.
pub(super) async fn append(
    transaction: &mut Writing,
    kind: &'static str,
    job: &JobRow,
    now_us: i64,
) -> Result<(), StoreError> {
    let data = (transaction.tell)(job, now_us)?;
    sqlx::query(
        "INSERT INTO events (job, id, kind, data) \
         SELECT ?1, 1 + coalesce(max(id), 0), ?2, ?3 FROM events WHERE job = ?1",
    )
    .bind(job.sequence)
    .bind(kind)
    .bind(data)
    .execute(&mut **transaction)
    .await?;
    Ok(())
}

impl Store {
    /// The next events of a job after one that is known.
    pub(crate) async fn events_after(
        &self,
        job: i64,
        known: i64,
    ) -> Result<Vec<EventRow>, StoreError> {
        Ok(sqlx::query_as(
            "SELECT id, kind, data FROM events WHERE job = ? AND id > ? ORDER BY id LIMIT ?",
        )
        .bind(job)
        .bind(known)
        .bind(BATCH)
        .fetch_all(&self.readers)
        .await?)
    }
}
