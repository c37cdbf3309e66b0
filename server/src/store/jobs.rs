//! Jobs from the side of the API: submission, look-up, requests to stop or cancel, deletion.

use super::database::row::{FromRow, Row};
use super::database::statement::{Handle, sql};
use super::database::{Transaction, Turn};
use super::{Counts, JobRow, JobState, Store, StoreError, Work, events, results};
use std::ops::RangeInclusive;
use strum::VariantArray as _;

/// The priorities that a job may have.
pub(crate) const PRIORITIES: RangeInclusive<i64> = -10..=10;

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
    /// What it may need of the memory that the jobs of a process share, bytes.
    pub(crate) memory_bytes: i64,
    /// The client whose job it is.
    pub(crate) client: Option<String>,
    /// Jobs of greater priority are leased first; within [`PRIORITIES`].
    pub(crate) priority: i64,
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
    /// Only jobs with this in their name or identifier, in letters of either case.
    pub(crate) search: Option<String>,
    /// Maximum number of rows.
    pub(crate) limit: i64,
}

/// The pattern of texts that contain a text.
fn containing(text: &str) -> String {
    let literal = text
        .replace('!', "!!")
        .replace('%', "!%")
        .replace('_', "!_");
    format!("%{literal}%")
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
        let has_ample_room = self.queue_room.is_ample(limits.all);
        // Who looks for a key or counts does so alone, up to the end of its commit.
        if !has_ample_room || submission.key.is_some() || submission.client.is_some() {
            transaction.take_turn(Turn::Submission).await?;
        }
        if let Some((key, fingerprint)) = &submission.key
            && let Some(known) = find_key(&mut transaction, key).await?
        {
            // The next submission shall not wait for the turn of one that queues nothing.
            transaction.rollback().await?;
            return Ok(if known.fingerprint == *fingerprint {
                Submitted::Replayed(known.job)
            } else {
                Submitted::KeyReused
            });
        }
        let is_full =
            !has_ample_room && self.queue_room.count(&mut *transaction).await? >= limits.all;
        if is_full || exceeds_quota(&mut transaction, submission, limits.client).await? {
            transaction.rollback().await?;
            return Ok(if is_full {
                Submitted::QueueFull
            } else {
                Submitted::QuotaExceeded
            });
        }
        let job: JobRow = sql(concat!(
            "INSERT INTO jobs (id, state, work, name, scenario, targets, client, submitted_us, \
             priority, memory_bytes, turn) \
             VALUES ($1, 'queued', $2, $3, $4, $5, $6, $7, $8, $9, coalesce(\
             (SELECT max(turn) + 1 FROM jobs WHERE state = 'queued' AND parent IS NULL AND priority = $8 \
             AND client IS NOT DISTINCT FROM $6), \
             (SELECT min(turn) FROM jobs WHERE state = 'queued' AND parent IS NULL AND priority = $8), 0)) \
             RETURNING ",
            job_columns!()
        ))
        .bind(&submission.id)
        .bind(submission.work.into_str())
        .bind(&submission.name)
        .bind(&submission.scenario)
        .bind(submission.targets)
        .bind(&submission.client)
        .bind(now_us)
        .bind(submission.priority)
        .bind(submission.memory_bytes)
        .fetch_one(&mut *transaction)
        .await?;
        self.queue_room.saw(job.sequence);
        if has_ample_room && !self.queue_room.is_ample(limits.all) {
            // Others have submitted many jobs meanwhile.
            transaction.rollback().await?;
            return Box::pin(self.submit(submission, limits, now_us)).await;
        }
        if let Some((key, fingerprint)) = &submission.key {
            sql(
                "INSERT INTO idempotency_keys (key, fingerprint, job, created_us) \
                 VALUES ($1, $2, $3, $4)",
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
        let mut transaction = self.begin().await?;
        sql(
            "UPDATE jobs SET stop_requested_us = coalesce(stop_requested_us, $1) \
             WHERE id = $2 AND state = 'running'",
        )
        .bind(now_us)
        .bind(id)
        .execute(&mut *transaction)
        .await?;
        let job = find(&mut *transaction, id).await?;
        transaction.commit().await?;
        Ok(job)
    }

    /// Cancels a job: a queued one ends at once, a running one when its worker has noticed. Returns
    /// the updated job.
    pub(crate) async fn request_cancel(
        &self,
        id: &str,
        now_us: i64,
    ) -> Result<Option<JobRow>, StoreError> {
        let mut transaction = self.begin().await?;
        let job: Option<JobRow> = sql(concat!(
            "UPDATE jobs SET cancel_requested_us = coalesce(cancel_requested_us, $1), \
             finished_us = CASE state WHEN 'queued' THEN $1 END, \
             boot_id = CASE state WHEN 'running' THEN boot_id END, claimed_until_us = NULL, \
             state = CASE state WHEN 'queued' THEN 'cancelled' ELSE state END \
             WHERE id = $2 AND state IN ('queued', 'running') RETURNING ",
            job_columns!()
        ))
        .bind(now_us)
        .bind(id)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(job) = job else {
            return find(&mut *transaction, id).await;
        };
        if job.state()? == JobState::Cancelled {
            events::append(&mut transaction, "state", &job, now_us).await?;
            // An earlier attempt may have left a plan, or a part of a table.
            results::delete_unfinished(&mut transaction, job.sequence).await?;
        }
        transaction.commit().await?;
        Ok(Some(job))
    }

    /// Deletes a job and everything that refers to it; `false` when there is no such job.
    pub(crate) async fn delete(&self, id: &str) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let deleted = sql("DELETE FROM jobs WHERE id = $1")
            .bind(id)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(deleted > 0)
    }

    /// A job by its identifier.
    pub(crate) async fn job(&self, id: &str) -> Result<Option<JobRow>, StoreError> {
        find(&self.database, id).await
    }

    /// Jobs, the newest first.
    pub(crate) async fn jobs(&self, listing: &Listing) -> Result<Vec<JobRow>, StoreError> {
        let search = listing.search.as_deref().map(containing);
        sql(concat!(
            "SELECT ",
            job_columns!(),
            " FROM jobs WHERE parent IS NULL AND ($1 IS NULL OR sequence < $1) AND ($2 IS NULL OR state = $2) \
             AND ($3 IS NULL OR name = $3) AND ($4 IS NULL OR client = $4) \
             AND work = $6 AND ($7 IS NULL OR lower(name) LIKE lower($7) ESCAPE '!' \
             OR id LIKE lower($7) ESCAPE '!') ORDER BY sequence DESC LIMIT $5"
        ))
        .bind(listing.before)
        .bind(listing.state.map(|state| state.into_str()))
        .bind(&listing.name)
        .bind(&listing.client)
        .bind(listing.limit)
        .bind(listing.work.into_str())
        .bind(&search)
        .fetch_all(&self.database)
        .await
    }

    /// Number of queued jobs.
    pub(crate) async fn waiting(&self) -> Result<i64, StoreError> {
        let (count,) = sql("SELECT count(*) FROM jobs WHERE state = 'queued' AND parent IS NULL")
            .fetch_one(&self.database)
            .await?;
        Ok(count)
    }

    /// When the job was submitted that has waited longest of those that are queued; `None` when none is.
    pub(crate) async fn waiting_since_us(&self) -> Result<Option<i64>, StoreError> {
        let (since,) =
            sql("SELECT min(submitted_us) FROM jobs WHERE state = 'queued' AND parent IS NULL")
                .fetch_one(&self.database)
                .await?;
        Ok(since)
    }

    /// Number of jobs in every state.
    pub(crate) async fn counts(&self) -> Result<Vec<Counts>, StoreError> {
        let rows: Vec<(String, i64)> =
            sql("SELECT state, count(*) FROM jobs WHERE parent IS NULL GROUP BY state")
                .fetch_all(&self.database)
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

/// Whether the client of a job has as many queued ones as it may have.
async fn exceeds_quota(
    transaction: &mut Transaction,
    submission: &Submission,
    limit: i64,
) -> Result<bool, StoreError> {
    let Some(client) = &submission.client else {
        return Ok(false);
    };
    let (own,): (i64,) = sql("SELECT count(*) FROM jobs WHERE client = $1 AND state = 'queued'")
        .bind(client)
        .fetch_one(transaction)
        .await?;
    Ok(own >= limit)
}

async fn find<'c>(on: impl Into<Handle<'c>>, id: &str) -> Result<Option<JobRow>, StoreError> {
    sql(concat!(
        "SELECT ",
        job_columns!(),
        " FROM jobs WHERE id = $1 AND parent IS NULL"
    ))
    .bind(id)
    .fetch_optional(on)
    .await
}

/// The job of an idempotency key.
struct KnownRequest {
    fingerprint: String,
    job: JobRow,
}

impl FromRow for KnownRequest {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            fingerprint: row.get("fingerprint")?,
            job: JobRow::from_row(row)?,
        })
    }
}

async fn find_key(
    transaction: &mut Transaction,
    key: &str,
) -> Result<Option<KnownRequest>, StoreError> {
    sql(concat!(
        "SELECT fingerprint, ",
        job_columns!(),
        " FROM idempotency_keys JOIN jobs ON sequence = job WHERE key = $1"
    ))
    .bind(key)
    .fetch_optional(transaction)
    .await
}
