//! Jobs from the side of the API: submission, look-up, requests to stop or cancel, deletion.

use super::writing::WriteTransaction;
use super::{Counts, JobRow, JobState, Store, StoreError, Work, events, results};
use sqlx::{FromRow, Row, SqliteConnection};
use strum::VariantArray as _;

/// A job to be queued.
#[derive(Debug)]
pub(crate) struct Submission {
    /// Public identifier, unique.
    pub(crate) id: String,
    /// What it makes.
    pub(crate) work: Work,
    /// Name of the scenario.
    pub(crate) name: Option<String>,
    /// The scenario or the query as JSON, with its spacecraft written out.
    pub(crate) scenario: Vec<u8>,
    /// Number of its targets; of legs, for a table.
    pub(crate) targets: i64,
    /// The client whose job it is.
    pub(crate) client: Option<String>,
    /// The caller's idempotency key and the fingerprint of the request.
    pub(crate) key: Option<(String, String)>,
}

/// How many jobs may wait.
#[derive(Debug, Clone, Copy)]
pub(crate) struct QueueLimits {
    /// Of all clients together.
    pub(crate) all: i64,
    /// Of one client with a key.
    pub(crate) client: i64,
}

/// The outcome of a submission.
#[derive(Debug)]
pub(crate) enum Submitted {
    /// Queued.
    New(JobRow),
    /// The same request was submitted before under the same key.
    Replayed(JobRow),
    /// Another request was submitted before under the same key.
    KeyReused,
    /// The queue is full.
    QueueFull,
    /// The client has as many waiting jobs as it may have.
    QuotaExceeded,
}

/// Which jobs to list.
#[derive(Debug, Default)]
pub(crate) struct Listing {
    /// Only jobs that make this.
    pub(crate) work: Work,
    /// Only jobs of this client.
    pub(crate) client: Option<String>,
    /// Only jobs submitted before this one.
    pub(crate) before: Option<i64>,
    /// Only jobs in this state.
    pub(crate) state: Option<JobState>,
    /// Only jobs of this name.
    pub(crate) name: Option<String>,
    /// Maximum number of rows.
    pub(crate) limit: i64,
}

impl Store {
    /// Queues a job together with its first event and its idempotency key.
    pub(crate) async fn submit(
        &self,
        submission: &Submission,
        limits: QueueLimits,
        now_us: i64,
    ) -> Result<Submitted, StoreError> {
        let mut transaction = self.begin().await?;
        if let Some((key, fingerprint)) = &submission.key
            && let Some((known, job)) = find_key(&mut transaction, key).await?
        {
            return Ok(if known == *fingerprint {
                Submitted::Replayed(job)
            } else {
                Submitted::KeyReused
            });
        }
        if let Some(refusal) = refusal(&mut transaction, submission, limits).await? {
            return Ok(refusal);
        }
        let row = sqlx::query(concat!(
            "INSERT INTO jobs (id, state, work, name, scenario, targets, client, submitted_us) \
             VALUES (?, 'queued', ?, ?, ?, ?, ?, ?) RETURNING ",
            job_columns!()
        ))
        .bind(&submission.id)
        .bind(submission.work.into_str())
        .bind(&submission.name)
        .bind(&submission.scenario)
        .bind(submission.targets)
        .bind(&submission.client)
        .bind(now_us)
        .fetch_one(&mut *transaction)
        .await?;
        let job = JobRow::of(&row)?;
        if let Some((key, fingerprint)) = &submission.key {
            sqlx::query(
                "INSERT INTO idempotency_keys (key, fingerprint, job, created_us) \
                 VALUES (?, ?, ?, ?)",
            )
            .bind(key)
            .bind(fingerprint)
            .bind(job.sequence)
            .bind(now_us)
            .execute(&mut *transaction)
            .await?;
        }
        events::append(&mut transaction, "state", &job, now_us).await?;
        transaction.commit().await?;
        Ok(Submitted::New(job))
    }

    /// Records that a running job shall finish with its best plan so far. Returns the updated job.
    pub(crate) async fn request_stop(
        &self,
        id: &str,
        now_us: i64,
    ) -> Result<Option<JobRow>, StoreError> {
        let update = "UPDATE jobs SET stop_requested_us = coalesce(stop_requested_us, ?) \
             WHERE id = ? AND state = 'running'";
        record_request(self.begin().await?, update, id, now_us).await
    }

    /// Cancels a job: a queued one ends at once, a running one when its worker has noticed. Returns
    /// the updated job.
    pub(crate) async fn request_cancel(
        &self,
        id: &str,
        now_us: i64,
    ) -> Result<Option<JobRow>, StoreError> {
        let mut transaction = self.begin().await?;
        let ended = sqlx::query(concat!(
            "UPDATE jobs SET state = 'cancelled', cancel_requested_us = ?1, finished_us = ?1 \
             WHERE id = ?2 AND state = 'queued' RETURNING ",
            job_columns!()
        ))
        .bind(now_us)
        .bind(id)
        .fetch_optional(&mut *transaction)
        .await?;
        if let Some(row) = ended {
            let job = JobRow::of(&row)?;
            events::append(&mut transaction, "state", &job, now_us).await?;
            // An earlier attempt may have left a plan, or a part of a table.
            results::delete_unfinished(&mut transaction, job.sequence).await?;
        }
        let update = "UPDATE jobs SET cancel_requested_us = coalesce(cancel_requested_us, ?) \
             WHERE id = ? AND state = 'running'";
        record_request(transaction, update, id, now_us).await
    }

    /// Deletes a job and everything that refers to it; `false` when there is no such job.
    pub(crate) async fn delete(&self, id: &str) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let done = sqlx::query("DELETE FROM jobs WHERE id = ?")
            .bind(id)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(done.rows_affected() > 0)
    }

    /// A job by its identifier.
    pub(crate) async fn job(&self, id: &str) -> Result<Option<JobRow>, StoreError> {
        find(&mut *self.readers.acquire().await?, id).await
    }

    /// Jobs, the newest first.
    pub(crate) async fn jobs(&self, listing: &Listing) -> Result<Vec<JobRow>, StoreError> {
        Ok(sqlx::query_as(concat!(
            "SELECT ",
            job_columns!(),
            " FROM jobs WHERE (?1 IS NULL OR sequence < ?1) AND (?2 IS NULL OR state = ?2) \
             AND (?3 IS NULL OR name = ?3) AND (?4 IS NULL OR client = ?4) \
             AND work = ?6 ORDER BY sequence DESC LIMIT ?5"
        ))
        .bind(listing.before)
        .bind(listing.state.map(|state| state.into_str()))
        .bind(&listing.name)
        .bind(&listing.client)
        .bind(listing.limit)
        .bind(listing.work.into_str())
        .fetch_all(&self.readers)
        .await?)
    }

    /// Number of queued jobs.
    pub(crate) async fn waiting(&self) -> Result<i64, StoreError> {
        let count = sqlx::query_scalar("SELECT count(*) FROM jobs WHERE state = 'queued'");
        Ok(count.fetch_one(&self.readers).await?)
    }

    /// Number of jobs in every state.
    pub(crate) async fn counts(&self) -> Result<Vec<Counts>, StoreError> {
        let rows: Vec<(String, i64)> =
            sqlx::query_as("SELECT state, count(*) FROM jobs GROUP BY state")
                .fetch_all(&self.readers)
                .await?;
        let of = |state: JobState| rows.iter().find(|(text, _)| text == state.into_str());
        Ok(JobState::VARIANTS
            .iter()
            .map(|&state| Counts {
                state,
                jobs: of(state).map_or(0, |(_, jobs)| *jobs),
            })
            .collect())
    }
}

/// Why a job cannot be queued now, if it cannot.
async fn refusal(
    connection: &mut SqliteConnection,
    submission: &Submission,
    limits: QueueLimits,
) -> Result<Option<Submitted>, StoreError> {
    let waiting: i64 = sqlx::query_scalar("SELECT count(*) FROM jobs WHERE state = 'queued'")
        .fetch_one(&mut *connection)
        .await?;
    if waiting >= limits.all {
        return Ok(Some(Submitted::QueueFull));
    }
    let Some(client) = &submission.client else {
        return Ok(None);
    };
    let own: i64 =
        sqlx::query_scalar("SELECT count(*) FROM jobs WHERE client = ? AND state = 'queued'")
            .bind(client)
            .fetch_one(connection)
            .await?;
    Ok((own >= limits.client).then_some(Submitted::QuotaExceeded))
}

/// Runs an update that records a request on a running job. Returns the updated job.
async fn record_request(
    mut transaction: WriteTransaction,
    update: &'static str,
    id: &str,
    now_us: i64,
) -> Result<Option<JobRow>, StoreError> {
    sqlx::query(update)
        .bind(now_us)
        .bind(id)
        .execute(&mut *transaction)
        .await?;
    let job = find(&mut transaction, id).await?;
    transaction.commit().await?;
    Ok(job)
}

async fn find(connection: &mut SqliteConnection, id: &str) -> Result<Option<JobRow>, StoreError> {
    Ok(sqlx::query_as(concat!(
        "SELECT ",
        job_columns!(),
        " FROM jobs WHERE id = ?"
    ))
    .bind(id)
    .fetch_optional(connection)
    .await?)
}

async fn find_key(
    connection: &mut SqliteConnection,
    key: &str,
) -> Result<Option<(String, JobRow)>, StoreError> {
    let row = sqlx::query(concat!(
        "SELECT fingerprint, ",
        job_columns!(),
        " FROM idempotency_keys JOIN jobs ON sequence = job WHERE key = ?"
    ))
    .bind(key)
    .fetch_optional(connection)
    .await?;
    row.map(|row| Ok((row.try_get("fingerprint")?, JobRow::from_row(&row)?)))
        .transpose()
}
