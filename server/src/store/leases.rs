//! The life of a job while a process works on it.
//!
//! A lease carries a number, its fence. Whatever a lease writes later is written only while it is
//! still the newest one: a worker that was taken for dead cannot overwrite its successor.

use super::rows::job_columns;
use super::writing::Writing;
use super::{
    EndCode, Ended, JobRow, JobState, NewIncumbent, ProgressRow, Store, StoreError, events, results,
};
use sqlx::query::Query;
use sqlx::sqlite::SqliteArguments;
use sqlx::{Row, Sqlite};

/// Attempts after which a job whose process dies each time is given up.
const MAX_ATTEMPTS: i64 = 3;

/// The bound of a job that is told of another one (`?5`, or none): it never falls, unless the plan
/// of such a duration contradicts it.
macro_rules! bound_beside {
    ($incumbent:literal) => {
        concat!(
            "min(max(coalesce(lower_bound_s, ?5), coalesce(?5, lower_bound_s)), coalesce(",
            $incumbent,
            ", 9e999))"
        )
    };
}

/// A job that this process works on.
#[derive(Debug)]
pub(crate) struct Lease {
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

impl Store {
    /// Claims the job that waits longest.
    pub(crate) async fn lease(
        &self,
        boot_id: &str,
        lease_until_us: i64,
        now_us: i64,
    ) -> Result<Option<Lease>, StoreError> {
        let mut transaction = self.begin().await?;
        let row = sqlx::query(concat!(
            "UPDATE jobs SET state = 'running', attempt = attempt + 1, fence = fence + 1, \
             boot_id = ?, lease_until_us = ?, started_us = ?, stage = NULL, done = NULL, \
             total = NULL, \
             incumbent_s = (SELECT total_time_s FROM incumbents WHERE job = sequence) \
             WHERE sequence = \
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
        let lease = Lease {
            job: JobRow::of(&row)?,
            scenario: row.try_get("scenario")?,
        };
        events::append(&mut transaction, "state", &lease.job, now_us).await?;
        transaction.commit().await?;
        Ok(Some(lease))
    }

    /// Prolongs the lease of a lease; `false` when it has been lost.
    pub(crate) async fn beat(
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

    /// Records progress with its event, and the plan of a better order if there is one; `false`
    /// when the lease has been lost.
    ///
    /// What an earlier attempt knew stays: incumbents never rise and bounds never fall.
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
        let Some(_) = changed(&mut transaction, update, "progress", now_us).await? else {
            return Ok(false);
        };
        if let Some(incumbent) = incumbent {
            results::keep(&mut transaction, lease.sequence, incumbent).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    /// Records the end of a lease: state, result and event together; `false` when it has been lost.
    ///
    /// A cancellation that was acknowledged meanwhile wins. Of an end that came early, the better
    /// plan of an earlier attempt is the result. An end without a plan takes nothing away: the best
    /// plan so far can be read as before.
    pub(crate) async fn finish(
        &self,
        lease: &JobRow,
        ended: &Ended,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let kept = if ended.early {
            results::better(&mut transaction, lease.sequence, ended).await?
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
            ", finished_us = ?6, boot_id = NULL, lease_until_us = NULL \
             WHERE sequence = ?7 AND fence = ?8 AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .bind(ended.state.into_str())
        .bind(ended.code.map(EndCode::as_str))
        .bind(&ended.detail)
        .bind(ended.incumbent_s)
        .bind(ended.lower_bound_s)
        .bind(now_us)
        .bind(lease.sequence)
        .bind(lease.fence);
        let Some(job) = changed(&mut transaction, update, "state", now_us).await? else {
            return Ok(false);
        };
        if job.state()? == JobState::Cancelled {
            results::forget(&mut transaction, lease.sequence).await?;
        } else {
            results::conclude(&mut transaction, lease.sequence, ended).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    /// Gives a lease back unfinished; the attempt does not count.
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
        let released = changed(&mut transaction, update, "state", now_us).await?;
        transaction.commit().await?;
        Ok(released.is_some())
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
                    results::forget(&mut transaction, job.sequence).await?;
                }
                _ => recovered.dead += 1,
            }
            events::append(&mut transaction, "state", &job, now_us).await?;
        }
        transaction.commit().await?;
        Ok(recovered)
    }
}

/// Changes a job that is claimed, with the event that tells of it; the job as it is then, `None`
/// when the lease has been lost.
async fn changed(
    transaction: &mut Writing,
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
