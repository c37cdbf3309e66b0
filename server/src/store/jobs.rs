//! The queue and the life of a job.
//!
//! A claim carries a number, its fence. Whatever a claim writes later is written only while it is
//! still the newest one: a worker that was taken for dead cannot overwrite its successor.

use super::rows::job_columns;
use super::{Counts, Ended, JobRow, JobState, ProgressRow, Store, StoreError, events, results};
use sqlx::{FromRow, Row, SqliteConnection};

/// Attempts after which a job whose process dies each time is given up.
const MOST_ATTEMPTS: i64 = 3;

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
    /// The caller's idempotency key and the fingerprint of the request.
    pub(crate) key: Option<(String, String)>,
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
}

/// A job that this process works on.
#[derive(Debug)]
pub(crate) struct Claim {
    /// The job as claimed.
    pub(crate) job: JobRow,
    /// Its scenario as JSON.
    pub(crate) scenario: Vec<u8>,
}

/// What became of jobs whose process has died.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Recovered {
    /// Queued again.
    pub(crate) queued: usize,
    /// Had been cancelled.
    pub(crate) cancelled: usize,
    /// Given up.
    pub(crate) dead: usize,
}

/// Which jobs to list.
#[derive(Debug, Default)]
pub(crate) struct Listing {
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
        queue_limit: i64,
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
        if waiting >= queue_limit {
            return Ok(Submitted::QueueFull);
        }
        let row = sqlx::query(concat!(
            "INSERT INTO jobs (id, state, name, scenario, targets, submitted_us) \
             VALUES (?, 'queued', ?, ?, ?, ?) RETURNING ",
            job_columns!()
        ))
        .bind(&submission.id)
        .bind(&submission.name)
        .bind(&submission.scenario)
        .bind(submission.targets)
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

    /// Claims the job that waits longest.
    pub(crate) async fn claim(
        &self,
        boot_id: &str,
        lease_until_us: i64,
        now_us: i64,
    ) -> Result<Option<Claim>, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET state = 'running', attempt = attempt + 1, fence = fence + 1, \
             boot_id = ?, lease_until_us = ?, started_us = ?, stage = NULL, done = NULL, \
             total = NULL, incumbent_s = NULL, lower_bound_s = NULL WHERE sequence = \
             (SELECT sequence FROM jobs WHERE state = 'queued' ORDER BY sequence LIMIT 1) \
             RETURNING scenario, ",
            job_columns!()
        ))
        .bind(boot_id)
        .bind(lease_until_us)
        .bind(now_us)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(row) = row else {
            return Ok(None);
        };
        let claim = Claim {
            job: JobRow::of(&row)?,
            scenario: row.try_get("scenario")?,
        };
        events::append(&mut transaction, "state", &claim.job, now_us).await?;
        transaction.commit().await?;
        Ok(Some(claim))
    }

    /// Prolongs the lease of a claim; `false` when it has been lost.
    pub(crate) async fn beat(
        &self,
        claim: &JobRow,
        lease_until_us: i64,
    ) -> Result<bool, StoreError> {
        let done = sqlx::query(
            "UPDATE jobs SET lease_until_us = ? \
             WHERE sequence = ? AND fence = ? AND state = 'running'",
        )
        .bind(lease_until_us)
        .bind(claim.sequence)
        .bind(claim.fence)
        .execute(&self.writer)
        .await?;
        Ok(done.rows_affected() > 0)
    }

    /// Records progress with its event; `false` when the claim has been lost.
    pub(crate) async fn progress(
        &self,
        claim: &JobRow,
        progress: &ProgressRow,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET stage = ?, done = ?, total = ?, incumbent_s = ?, lower_bound_s = ? \
             WHERE sequence = ? AND fence = ? AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(progress.stage)
        .bind(progress.done)
        .bind(progress.total)
        .bind(progress.incumbent_s)
        .bind(progress.lower_bound_s)
        .bind(claim.sequence)
        .bind(claim.fence)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(row) = row else {
            return Ok(false);
        };
        events::append(&mut transaction, "progress", &JobRow::of(&row)?, now_us).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Records the end of a claim: state, result and event together; `false` when it has been lost.
    ///
    /// A cancellation that was acknowledged meanwhile wins.
    pub(crate) async fn finish(
        &self,
        claim: &JobRow,
        ended: &Ended,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NULL THEN ? ELSE 'cancelled' \
             END, incumbent_s = coalesce(?, incumbent_s), lower_bound_s = coalesce(?, lower_bound_s), detail = ?, finished_us = ?, \
             boot_id = NULL, lease_until_us = NULL \
             WHERE sequence = ? AND fence = ? AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(ended.state.as_str())
        .bind(ended.incumbent_s)
        .bind(ended.lower_bound_s)
        .bind(&ended.detail)
        .bind(now_us)
        .bind(claim.sequence)
        .bind(claim.fence)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(row) = row else {
            return Ok(false);
        };
        let job = JobRow::of(&row)?;
        if let Some(document) = &ended.document
            && job.state()? != JobState::Cancelled
        {
            results::insert(&mut transaction, claim.sequence, document).await?;
        }
        events::append(&mut transaction, "state", &job, now_us).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Gives a claim back unfinished; the attempt does not count.
    pub(crate) async fn release(&self, claim: &JobRow, now_us: i64) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET state = 'queued', attempt = attempt - 1, boot_id = NULL, \
             lease_until_us = NULL WHERE sequence = ? AND fence = ? AND state = 'running' \
             RETURNING ",
            job_columns!()
        ))
        .bind(claim.sequence)
        .bind(claim.fence)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(row) = row else {
            return Ok(false);
        };
        events::append(&mut transaction, "state", &JobRow::of(&row)?, now_us).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Takes running jobs from processes that are no more: of another boot, or with their lease
    /// run out.
    pub(crate) async fn recover(
        &self,
        boot_id: &str,
        now_us: i64,
    ) -> Result<Recovered, StoreError> {
        let mut transaction = self.begin().await?;
        let rows = sqlx::query(concat!(
            "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NOT NULL THEN 'cancelled' \
             WHEN attempt >= ?1 THEN 'dead' ELSE 'queued' END, \
             finished_us = CASE WHEN cancel_requested_us IS NULL AND attempt < ?1 THEN NULL \
             ELSE ?2 END, \
             detail = CASE WHEN cancel_requested_us IS NULL AND attempt >= ?1 THEN \
             'its process ended unexpectedly at every attempt' END, \
             boot_id = NULL, lease_until_us = NULL \
             WHERE state = 'running' AND (boot_id <> ?3 OR lease_until_us < ?2) RETURNING ",
            job_columns!()
        ))
        .bind(MOST_ATTEMPTS)
        .bind(now_us)
        .bind(boot_id)
        .fetch_all(&mut *transaction)
        .await?;
        let mut recovered = Recovered::default();
        for row in &rows {
            let job = JobRow::of(row)?;
            match job.state()? {
                JobState::Queued => recovered.queued += 1,
                JobState::Cancelled => recovered.cancelled += 1,
                _ => recovered.dead += 1,
            }
            events::append(&mut transaction, "state", &job, now_us).await?;
        }
        transaction.commit().await?;
        Ok(recovered)
    }

    /// Notes that a running job shall finish with the best so far; the job as it is then.
    pub(crate) async fn request_stop(
        &self,
        id: &str,
        now_us: i64,
    ) -> Result<Option<JobRow>, StoreError> {
        let mut transaction = self.begin().await?;
        sqlx::query(
            "UPDATE jobs SET stop_requested_us = coalesce(stop_requested_us, ?) \
             WHERE id = ? AND state = 'running'",
        )
        .bind(now_us)
        .bind(id)
        .execute(&mut *transaction)
        .await?;
        let job = find(&mut transaction, id).await?;
        transaction.commit().await?;
        Ok(job)
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
            events::append(&mut transaction, "state", &JobRow::of(&row)?, now_us).await?;
        }
        sqlx::query(
            "UPDATE jobs SET cancel_requested_us = coalesce(cancel_requested_us, ?) \
             WHERE id = ? AND state = 'running'",
        )
        .bind(now_us)
        .bind(id)
        .execute(&mut *transaction)
        .await?;
        let job = find(&mut transaction, id).await?;
        transaction.commit().await?;
        Ok(job)
    }

    /// Deletes a job with all that belongs to it; `false` when there is none.
    pub(crate) async fn delete(&self, id: &str) -> Result<bool, StoreError> {
        let done = sqlx::query("DELETE FROM jobs WHERE id = ?")
            .bind(id)
            .execute(&self.writer)
            .await?;
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
             AND (?3 IS NULL OR name = ?3) ORDER BY sequence DESC LIMIT ?4"
        ))
        .bind(listing.before)
        .bind(listing.state.map(JobState::as_str))
        .bind(&listing.name)
        .bind(listing.limit)
        .fetch_all(&self.readers)
        .await?)
    }

    /// Number of jobs in every state.
    pub(crate) async fn counts(&self) -> Result<Vec<Counts>, StoreError> {
        let rows: Vec<(String, i64)> =
            sqlx::query_as("SELECT state, count(*) FROM jobs GROUP BY state")
                .fetch_all(&self.readers)
                .await?;
        let of = |state: JobState| rows.iter().find(|(text, _)| text == state.as_str());
        Ok(JobState::ALL
            .iter()
            .map(|&state| Counts {
                state,
                jobs: of(state).map_or(0, |(_, jobs)| *jobs),
            })
            .collect())
    }
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
