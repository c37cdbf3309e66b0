//! Jobs as their callers see them: submitted, read, asked to end, deleted.

use super::rows::job_columns;
use super::writing::Writing;
use super::{Counts, JobRow, JobState, Store, StoreError, events, results};
use sqlx::{FromRow, Row, SqliteConnection};
use strum::VariantArray as _;

/// A job to be queued.
#[derive(Debug)]
pub(crate) struct Submission {
    /// Public identifier, unique.
    pub(crate) id: String,
    /// Name of the scenario.
    pub(crate) name: Option<String>,
    /// The scenario as JSON, complete in itself.
    pub(crate) scenario: Vec<u8>,
    /// Number of its targets.
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

/// What became of a submission.
#[derive(Debug)]
pub(crate) enum Submitted {
    /// Queued.
    New(JobRow),
    /// The same request was submitted before under the same key.
    Replayed(JobRow),
    /// Another request was submitted before under the same key.
    KeyReused,
    /// Too many jobs wait already.
    QueueFull,
    /// Too many jobs of this client wait already.
    QuotaExceeded,
}

/// Which jobs to list.
#[derive(Debug, Default)]
pub(crate) struct Listing {
    /// Only jobs of this client.
    pub(crate) client: Option<String>,
    /// Only jobs submitted before this one.
    pub(crate) before: Option<i64>,
    /// Only jobs in this state.
    pub(crate) state: Option<JobState>,
    /// Only jobs of this name.
    pub(crate) name: Option<String>,
    /// At most so many.
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
        let waiting: i64 = sqlx::query_scalar("SELECT count(*) FROM jobs WHERE state = 'queued'")
            .fetch_one(&mut *transaction)
            .await?;
        if waiting >= limits.all {
            return Ok(Submitted::QueueFull);
        }
        if let Some(client) = &submission.client {
            let own: i64 = sqlx::query_scalar(
                "SELECT count(*) FROM jobs WHERE client = ? AND state = 'queued'",
            )
            .bind(client)
            .fetch_one(&mut *transaction)
            .await?;
            if own >= limits.client {
                return Ok(Submitted::QuotaExceeded);
            }
        }
        let row = sqlx::query(concat!(
            "INSERT INTO jobs (id, state, name, scenario, targets, client, submitted_us) \
             VALUES (?, 'queued', ?, ?, ?, ?, ?) RETURNING ",
            job_columns!()
        ))
        .bind(&submission.id)
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

    /// Notes that a running job shall finish with the best so far; the job as it is then.
    pub(crate) async fn request_stop(
        &self,
        id: &str,
        now_us: i64,
    ) -> Result<Option<JobRow>, StoreError> {
        let note = "UPDATE jobs SET stop_requested_us = coalesce(stop_requested_us, ?) \
             WHERE id = ? AND state = 'running'";
        noted(self.begin().await?, note, id, now_us).await
    }

    /// Abandons a job: a queued one ends at once, a running one when its worker has noticed; the
    /// job as it is then.
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
            // It may have been begun before.
            results::forget(&mut transaction, job.sequence).await?;
        }
        let note = "UPDATE jobs SET cancel_requested_us = coalesce(cancel_requested_us, ?) \
             WHERE id = ? AND state = 'running'";
        noted(transaction, note, id, now_us).await
    }

    /// Deletes a job with all that belongs to it; `false` when there is none.
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
             ORDER BY sequence DESC LIMIT ?5"
        ))
        .bind(listing.before)
        .bind(listing.state.map(|state| state.into_str()))
        .bind(&listing.name)
        .bind(&listing.client)
        .bind(listing.limit)
        .fetch_all(&self.readers)
        .await?)
    }

    /// Number of jobs that wait.
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

/// Notes a request with a running job; the job as it is then.
async fn noted(
    mut transaction: Writing,
    note: &'static str,
    id: &str,
    now_us: i64,
) -> Result<Option<JobRow>, StoreError> {
    sqlx::query(note)
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
