//! The events of jobs, numbered per job.

use super::database::statement::{Value, sql};
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

/// An event that is not stored yet.
#[derive(Debug)]
pub(super) struct NewEvent {
    job: i64,
    kind: &'static str,
    data: String,
}

impl WriteTransaction {
    /// The event of a job as it is now.
    pub(super) fn event(
        &self,
        kind: &'static str,
        job: &JobRow,
        now_us: i64,
    ) -> Result<NewEvent, StoreError> {
        Ok(NewEvent {
            job: job.sequence,
            kind,
            data: (self.format_event)(job, now_us)?,
        })
    }
}

/// Appends an event with the present state of a job.
pub(super) async fn append(
    transaction: &mut WriteTransaction,
    kind: &'static str,
    job: &JobRow,
    now_us: i64,
) -> Result<(), StoreError> {
    let event = transaction.event(kind, job, now_us)?;
    append_all(transaction, &[event]).await
}

/// Appends events, those of a job in their order.
pub(super) async fn append_all(
    transaction: &mut WriteTransaction,
    events: &[NewEvent],
) -> Result<(), StoreError> {
    if events.is_empty() {
        return Ok(());
    }
    let row = |(number, event): (usize, &NewEvent)| {
        let of_job = events[..=number].iter().filter(|one| one.job == event.job);
        let place = i64::try_from(of_job.count()).unwrap_or(i64::MAX);
        let data = Value::from(event.data.clone());
        [event.job.into(), place.into(), event.kind.into(), data]
    };
    sql("INSERT INTO events (job, id, kind, data) SELECT new.job, \
         new.place + coalesce((SELECT max(id) FROM events WHERE events.job = new.job), 0), \
         new.kind, new.data \
         FROM {rows $1 job bigint, place bigint, kind text, data text} AS new")
    .rows(events.iter().enumerate().map(row).collect())
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
