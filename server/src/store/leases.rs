//! Leases: the claims of worker processes on running jobs.
//!
//! Every lease has a number, its fence, which grows with each lease of the job. Writes under a
//! lease succeed only while its fence is the newest, so that a worker that was presumed dead cannot
//! overwrite the work of its successor.

use super::database::row::{FromRow, Row};
use super::database::statement::{Statement, sql};
use super::writing::WriteTransaction;
use super::{
    EndCode, Ended, JobRow, JobState, NewIncumbent, ProgressRow, Store, StoreError, events, results,
};
use slewplan_solver::bounds;

/// Attempts after which a job whose process died at each of them becomes `dead`.
const MAX_ATTEMPTS: i64 = 3;

/// The greater of the lower bound of a job and of that of a report (`$5`); either may be null.
macro_rules! greater_bound {
    () => {
        "(CASE WHEN lower_bound_s >= $5 THEN lower_bound_s ELSE coalesce($5, lower_bound_s) END)"
    };
}

/// The lower bound of a job after a report: the greater one, but no more than the duration of the
/// plan.
macro_rules! bound_beside {
    ($incumbent:literal) => {
        concat!(
            "CASE WHEN ",
            greater_bound!(),
            " > ",
            $incumbent,
            " THEN ",
            $incumbent,
            " ELSE ",
            greater_bound!(),
            " END"
        )
    };
}

/// The claim of this process on a running job.
#[derive(Debug)]
pub(crate) struct Lease {
    /// The job when it was leased.
    pub(crate) job: JobRow,
    /// Its scenario as JSON.
    pub(crate) scenario: Vec<u8>,
    /// What it may need of the memory that the jobs of a process share, bytes.
    pub(crate) memory_bytes: i64,
    /// Whether further jobs wait.
    pub(crate) more_wait: bool,
}

impl FromRow for Lease {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            job: JobRow::from_row(row)?,
            scenario: row.get("scenario")?,
            memory_bytes: row.get("memory_bytes")?,
            more_wait: row.get("more_wait")?,
        })
    }
}

/// The memory that a process has left for a further job, beside those that it works on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MemoryRoom {
    /// Jobs that may need more, bytes, are passed over,
    pub(crate) bytes: i64,
    /// but none that was submitted before this time: no other job is begun before it.
    pub(crate) passed_over_since_us: i64,
}

impl MemoryRoom {
    /// The process works on no job: each has room.
    pub(crate) const ALL: Self = Self {
        bytes: i64::MAX,
        passed_over_since_us: 0,
    };
}

/// What is known of other processes that have leased jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OtherProcesses {
    /// This process alone uses the database: the others have ended.
    Ended,
    /// They may live as long as they prolong their leases.
    MayLive,
}

/// Numbers of jobs taken from dead processes, by their new state.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Recovered {
    /// Queued again.
    pub(crate) queued: usize,
    /// Cancelled, as was requested before.
    pub(crate) cancelled: usize,
    /// Dead: no attempts left.
    pub(crate) dead: usize,
}

impl Recovered {
    /// Whether there was none.
    pub(crate) fn is_empty(self) -> bool {
        self == Self::default()
    }
}

impl Store {
    /// Leases the job whose turn it is; `None` when no job is queued that has room. A lower bound of
    /// an earlier attempt is kept if this version of the bounds gave it.
    pub(crate) async fn lease(
        &self,
        boot_id: &str,
        lease_until_us: i64,
        room: MemoryRoom,
        now_us: i64,
    ) -> Result<Option<Lease>, StoreError> {
        let mut transaction = self.begin().await?;
        let lease: Option<Lease> = sql(concat!(
            "UPDATE jobs SET state = 'running', attempt = attempt + 1, fence = fence + 1, \
             boot_id = $1, lease_until_us = $2, started_us = $3, stage = NULL, done = NULL, \
             total = NULL, \
             lower_bound_s = CASE bound_version WHEN $4 THEN lower_bound_s END, bound_version = $4, \
             incumbent_s = (SELECT total_time_s FROM incumbents WHERE job = sequence) \
             WHERE sequence = \
             (SELECT sequence FROM jobs WHERE state = 'queued' \
             AND (memory_bytes <= $5 OR submitted_us < $6) \
             ORDER BY priority DESC, turn, sequence LIMIT 1 {skip_locked}) \
             AND memory_bytes <= $5 RETURNING scenario, memory_bytes, \
             EXISTS (SELECT 1 FROM jobs AS others WHERE others.state = 'queued' \
             AND others.sequence <> jobs.sequence) AS more_wait, ",
            job_columns!()
        ))
        .bind(boot_id)
        .bind(lease_until_us)
        .bind(now_us)
        .bind(bounds::VERSION)
        .bind(room.bytes)
        .bind(room.passed_over_since_us)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(lease) = lease else {
            // A job without room is locked, and nobody else finds it while it is.
            transaction.rollback().await?;
            return Ok(None);
        };
        events::append(&mut transaction, "state", &lease.job, now_us).await?;
        transaction.commit().await?;
        Ok(Some(lease))
    }

    /// Prolongs a lease; `false` when it has been lost.
    pub(crate) async fn prolong(
        &self,
        lease: &JobRow,
        lease_until_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let prolonged = sql("UPDATE jobs SET lease_until_us = $1 \
             WHERE sequence = $2 AND fence = $3 AND state = 'running'")
        .bind(lease_until_us)
        .bind(lease.sequence)
        .bind(lease.fence)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(prolonged > 0)
    }

    /// Records progress with its event, and a better plan if there is one; `false` when the lease
    /// has been lost.
    ///
    /// Results of earlier attempts are kept: incumbents never rise and bounds never fall.
    pub(crate) async fn progress(
        &self,
        lease: &JobRow,
        progress: &ProgressRow,
        incumbent: Option<&NewIncumbent>,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let update = sql(concat!(
            "UPDATE jobs SET stage = $1, done = $2, total = $3, \
             incumbent_s = CASE WHEN incumbent_s <= $4 THEN incumbent_s \
             ELSE coalesce($4, incumbent_s) END, lower_bound_s = ",
            bound_beside!(
                "(CASE WHEN incumbent_s <= $4 THEN incumbent_s ELSE coalesce($4, incumbent_s) END)"
            ),
            " WHERE sequence = $6 AND fence = $7 AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(progress.stage)
        .bind(progress.done)
        .bind(progress.total)
        .bind(progress.incumbent_s)
        .bind(progress.lower_bound_s)
        .bind(lease.sequence)
        .bind(lease.fence);
        let Some(_) = update_leased(&mut transaction, update, "progress", now_us).await? else {
            return Ok(false);
        };
        if let Some(incumbent) = incumbent {
            results::store_incumbent(&mut transaction, lease.sequence, incumbent).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    /// Records the end of a leased job: state, result and event together; `false` when the lease
    /// has been lost.
    ///
    /// A cancellation acknowledged in the meantime takes precedence. If the solve was cut short, a
    /// better plan of an earlier attempt becomes the result. If the job ends without a plan, its
    /// best plan so far remains readable.
    pub(crate) async fn finish(
        &self,
        lease: &JobRow,
        ended: &Ended,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let kept = if ended.early {
            results::better_incumbent(&mut transaction, lease.sequence, ended).await?
        } else {
            None
        };
        let ended = kept.as_ref().unwrap_or(ended);
        let update = sql(concat!(
            "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NULL THEN $1 \
             ELSE 'cancelled' END, \
             code = CASE WHEN cancel_requested_us IS NULL THEN $2 END, detail = $3, \
             incumbent_s = coalesce($4, incumbent_s), lower_bound_s = ",
            bound_beside!("coalesce($4, incumbent_s)"),
            ", finished_us = $6, keep_out_violated = $7, boot_id = NULL, lease_until_us = NULL \
             WHERE sequence = $8 AND fence = $9 AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(ended.state.into_str())
        .bind(ended.code.map(EndCode::as_str))
        .bind(&ended.detail)
        .bind(ended.incumbent_s)
        .bind(ended.lower_bound_s)
        .bind(now_us)
        .bind(ended.keep_out_violated)
        .bind(lease.sequence)
        .bind(lease.fence);
        let Some(job) = update_leased(&mut transaction, update, "state", now_us).await? else {
            return Ok(false);
        };
        if job.state()? == JobState::Cancelled {
            results::delete_unfinished(&mut transaction, lease.sequence).await?;
        } else {
            results::store_result(&mut transaction, lease.sequence, ended).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    /// Returns a leased job to the queue; the attempt does not count.
    pub(crate) async fn release(&self, lease: &JobRow, now_us: i64) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let update = sql(concat!(
            "UPDATE jobs SET state = 'queued', attempt = attempt - 1, boot_id = NULL, \
             lease_until_us = NULL WHERE sequence = $1 AND fence = $2 AND state = 'running' \
             RETURNING ",
            job_columns!()
        ))
        .bind(lease.sequence)
        .bind(lease.fence);
        let released = update_leased(&mut transaction, update, "state", now_us).await?;
        transaction.commit().await?;
        Ok(released.is_some())
    }

    /// Takes running jobs from dead processes: those whose lease has expired, and, where the others
    /// have ended, all those of another boot.
    pub(crate) async fn recover(
        &self,
        boot_id: &str,
        others: OtherProcesses,
        now_us: i64,
    ) -> Result<Recovered, StoreError> {
        let mut transaction = self.begin().await?;
        let jobs: Vec<JobRow> = sql(concat!(
            "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NOT NULL THEN 'cancelled' \
             WHEN attempt >= $1 THEN 'dead' ELSE 'queued' END, \
             finished_us = CASE WHEN cancel_requested_us IS NULL AND attempt < $1 THEN NULL \
             ELSE $2 END, \
             detail = CASE WHEN cancel_requested_us IS NULL AND attempt >= $1 THEN \
             'its process ended unexpectedly at every attempt' END, \
             code = CASE WHEN cancel_requested_us IS NULL AND attempt >= $1 THEN $4 END, \
             boot_id = NULL, lease_until_us = NULL \
             WHERE state = 'running' AND (($5 AND boot_id <> $3) OR lease_until_us < $2) RETURNING ",
            job_columns!()
        ))
        .bind(MAX_ATTEMPTS)
        .bind(now_us)
        .bind(boot_id)
        .bind(EndCode::ProcessDied.as_str())
        .bind(others == OtherProcesses::Ended)
        .fetch_all(&mut *transaction)
        .await?;
        let mut recovered = Recovered::default();
        for job in &jobs {
            match job.state()? {
                JobState::Queued => recovered.queued += 1,
                JobState::Cancelled => {
                    recovered.cancelled += 1;
                    results::delete_unfinished(&mut transaction, job.sequence).await?;
                }
                _ => recovered.dead += 1,
            }
            events::append(&mut transaction, "state", job, now_us).await?;
        }
        transaction.commit().await?;
        Ok(recovered)
    }
}

/// Updates a leased job and appends the event. Returns the updated job, `None` when the lease has
/// been lost.
pub(super) async fn update_leased(
    transaction: &mut WriteTransaction,
    update: Statement<'_>,
    kind: &'static str,
    now_us: i64,
) -> Result<Option<JobRow>, StoreError> {
    let job: Option<JobRow> = update.fetch_optional(&mut **transaction).await?;
    let Some(job) = job else {
        return Ok(None);
    };
    events::append(transaction, kind, &job, now_us).await?;
    Ok(Some(job))
}
