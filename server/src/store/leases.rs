//! Leases: the claims of worker processes on running jobs.
//!
//! Every lease has a number, its fence, which grows with each lease of the job. Writes under a
//! lease succeed only while its fence is the newest, so that a worker that was presumed dead cannot
//! overwrite the work of its successor.

use super::writing::WriteTransaction;
use super::{
    EndCode, Ended, JobRow, JobState, NewIncumbent, ProgressRow, Store, StoreError, events, results,
};
use slewplan_solver::bounds;
use sqlx::query::Query;
use sqlx::sqlite::SqliteArguments;
use sqlx::{Row, Sqlite};

/// Attempts after which a job whose process died at each of them becomes `dead`.
const MAX_ATTEMPTS: i64 = 3;

/// The lower bound of a job after the report of another one (`?5`, or null): the greater of the
/// two, but no more than the duration of the plan.
macro_rules! bound_beside {
    ($incumbent:literal) => {
        concat!(
            "min(max(coalesce(lower_bound_s, ?5), coalesce(?5, lower_bound_s)), coalesce(",
            $incumbent,
            ", 9e999))"
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

impl Store {
    /// Leases the job that has waited longest; `None` when no job is queued. A lower bound of an
    /// earlier attempt is kept if this version of the bounds gave it.
    pub(crate) async fn lease(
        &self,
        boot_id: &str,
        lease_until_us: i64,
        now_us: i64,
    ) -> Result<Option<Lease>, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET state = 'running', attempt = attempt + 1, fence = fence + 1, \
             boot_id = ?1, lease_until_us = ?2, started_us = ?3, stage = NULL, done = NULL, \
             total = NULL, \
             lower_bound_s = CASE bound_version WHEN ?4 THEN lower_bound_s END, bound_version = ?4, \
             incumbent_s = (SELECT total_time_s FROM incumbents WHERE job = sequence) \
             WHERE sequence = \
             (SELECT sequence FROM jobs WHERE state = 'queued' ORDER BY sequence LIMIT 1) \
             RETURNING scenario, ",
            job_columns!()
        ))
        .bind(boot_id)
        .bind(lease_until_us)
        .bind(now_us)
        .bind(bounds::VERSION)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some(row) = row else {
            return Ok(None);
        };
        let lease = Lease {
            job: JobRow::of(&row)?,
            scenario: row.try_get("scenario")?,
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
        let done = sqlx::query(
            "UPDATE jobs SET lease_until_us = ? \
             WHERE sequence = ? AND fence = ? AND state = 'running'",
        )
        .bind(lease_until_us)
        .bind(lease.sequence)
        .bind(lease.fence)
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(done.rows_affected() > 0)
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
        let update = sqlx::query(concat!(
            "UPDATE jobs SET stage = ?, done = ?, total = ?, \
             incumbent_s = coalesce(min(incumbent_s, ?4), ?4, incumbent_s), lower_bound_s = ",
            bound_beside!("min(incumbent_s, ?4), ?4, incumbent_s"),
            " WHERE sequence = ?6 AND fence = ?7 AND state = 'running' RETURNING ",
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
        let update = sqlx::query(concat!(
            "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NULL THEN ?1 \
             ELSE 'cancelled' END, \
             code = CASE WHEN cancel_requested_us IS NULL THEN ?2 END, detail = ?3, \
             incumbent_s = coalesce(?4, incumbent_s), lower_bound_s = ",
            bound_beside!("?4, incumbent_s"),
            ", finished_us = ?6, keep_out_violated = ?7, boot_id = NULL, lease_until_us = NULL \
             WHERE sequence = ?8 AND fence = ?9 AND state = 'running' RETURNING ",
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
        let update = sqlx::query(concat!(
            "UPDATE jobs SET state = 'queued', attempt = attempt - 1, boot_id = NULL, \
             lease_until_us = NULL WHERE sequence = ? AND fence = ? AND state = 'running' \
             RETURNING ",
            job_columns!()
        ))
        .bind(lease.sequence)
        .bind(lease.fence);
        let released = update_leased(&mut transaction, update, "state", now_us).await?;
        transaction.commit().await?;
        Ok(released.is_some())
    }

    /// Takes running jobs from dead processes: those of another boot, and those whose lease has
    /// expired.
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
             code = CASE WHEN cancel_requested_us IS NULL AND attempt >= ?1 THEN ?4 END, \
             boot_id = NULL, lease_until_us = NULL \
             WHERE state = 'running' AND (boot_id <> ?3 OR lease_until_us < ?2) RETURNING ",
            job_columns!()
        ))
        .bind(MAX_ATTEMPTS)
        .bind(now_us)
        .bind(boot_id)
        .bind(EndCode::ProcessDied.as_str())
        .fetch_all(&mut *transaction)
        .await?;
        let mut recovered = Recovered::default();
        for row in &rows {
            let job = JobRow::of(row)?;
            match job.state()? {
                JobState::Queued => recovered.queued += 1,
                JobState::Cancelled => {
                    recovered.cancelled += 1;
                    results::delete_unfinished(&mut transaction, job.sequence).await?;
                }
                _ => recovered.dead += 1,
            }
            events::append(&mut transaction, "state", &job, now_us).await?;
        }
        transaction.commit().await?;
        Ok(recovered)
    }
}

/// Updates a leased job and appends the event. Returns the updated job, `None` when the lease has
/// been lost.
pub(super) async fn update_leased(
    transaction: &mut WriteTransaction,
    update: Query<'_, Sqlite, SqliteArguments>,
    kind: &'static str,
    now_us: i64,
) -> Result<Option<JobRow>, StoreError> {
    let Some(row) = update.fetch_optional(&mut **transaction).await? else {
        return Ok(None);
    };
    let job = JobRow::of(&row)?;
    events::append(transaction, kind, &job, now_us).await?;
    Ok(Some(job))
}
