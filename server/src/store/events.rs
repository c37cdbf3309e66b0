//! The events of jobs, numbered per job.

use super::database::statement::sql;
use super::writing::WriteTransaction;
use super::{JobRow, Store, StoreError};

row! {
    columns event_columns;
    /// An event of a job.
    #[derive(Debug, Clone)]
    pub(crate) struct EventRow {
        /// Counts from 1 within the job.
        pub(crate) id: i64,
        /// `state` or `progress`.
        pub(crate) kind: String,
        /// The event as JSON.
        pub(crate) data: String,
    }
}

/// Formats the state of a job at a time (microseconds since 1970) as the JSON of an event.
pub(crate) type FormatEvent = fn(&JobRow, i64) -> Result<String, StoreError>;

/// Maximum number of events per read.
const BATCH: i64 = 256;

/// Appends an event with the present state of a job.
pub(super) async fn append(
    transaction: &mut WriteTransaction,
    kind: &'static str,
    job: &JobRow,
    now_us: i64,
) -> Result<(), StoreError> {
    let data = (transaction.format_event)(job, now_us)?;
    sql("INSERT INTO events (job, id, kind, data) \
         SELECT $1, 1 + coalesce(max(id), 0), $2, $3 FROM events WHERE job = $1")
    .bind(job.sequence)
    .bind(kind)
    .bind(data)
    .execute(&mut **transaction)
    .await?;
    Ok(())
}

impl Store {
    /// The next events of a job after the event with the number `known`.
    pub(crate) async fn events_after(
        &self,
        job: i64,
        known: i64,
    ) -> Result<Vec<EventRow>, StoreError> {
        sql(concat!(
            "SELECT ",
            event_columns!(),
            " FROM events WHERE job = $1 AND id > $2 ORDER BY id LIMIT $3",
        ))
        .bind(job)
        .bind(known)
        .bind(BATCH)
        .fetch_all(&self.database)
        .await
    }
}
