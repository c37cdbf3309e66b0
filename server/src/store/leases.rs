//! Leases: the claims of worker processes on running jobs.
//!
//! Every lease has a number, its fence, which grows with each lease of the job. Writes under a
//! lease succeed only while its fence is the newest, so that a worker that was presumed dead cannot
//! overwrite the work of its successor.

use super::database::statement::{Statement, sql};
use super::held::held;
use super::writing::WriteTransaction;
use super::{
    EndCode, JobRow, JobState, NewIncumbent, ProgressRow, Store, StoreError, events, results,
};

/// Attempts after which a job whose process died at each of them becomes `dead`.
const MAX_ATTEMPTS: i64 = 3;

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
    /// Not kept for a process any more: they were queued and still are.
    pub(crate) unclaimed: u64,
}

impl Recovered {
    /// Whether there was none.
    pub(crate) fn is_empty(self) -> bool {
        self == Self::default()
    }
}

impl Store {
    /// Prolongs a lease; `false` when it has been lost.
    pub(crate) async fn prolong(
        &self,
        lease: &JobRow,
        lease_until_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let prolonged = sql(concat!(
            "UPDATE jobs SET lease_until_us = CASE state WHEN 'running' THEN CAST($1 AS bigint) END, \
             claimed_until_us = CASE state WHEN 'queued' THEN CAST($1 AS bigint) END \
             FROM {rows $2 leased bigint, held bigint} AS lease WHERE ",
            is_held!()
        ))
        .bind(lease_until_us)
        .rows(vec![held(lease)])
        .execute(&mut *transaction)
        .await?;
        transaction.commit().await?;
        Ok(prolonged > 0)
    }

    /// Records progress with its event, and a better plan if there is one; `false` when the lease
    /// has been lost.
    ///
    /// Results of earlier attempts are kept: incumbents never get worse and bounds never weaker.
    pub(crate) async fn progress(
        &self,
        lease: &JobRow,
        progress: &ProgressRow,
        incumbent: Option<&NewIncumbent>,
        now_us: i64,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let update = sql(concat!(
            "UPDATE jobs SET stage = told_stage, done = told_done, total = told_total, \
             incumbent_s = ",
            better_of!("plan_s", "incumbent_s"),
            ", value = ",
            better_of!("told_value", "value"),
            ", value_bound = ",
            least_value_bound!(),
            ", lower_bound_s = ",
            bound_beside!(better_of!("plan_s", "incumbent_s")),
            " FROM {rows $1 leased bigint, held bigint, told_stage text, told_done bigint, \
             told_total bigint, plan_s double precision, told_bound_s double precision, \
             told_value double precision, told_value_bound double precision} AS told WHERE ",
            is_held!(),
            " RETURNING ",
            job_columns!()
        ))
        .rows(vec![[
            lease.sequence.into(),
            lease.fence.into(),
            progress.stage.into(),
            progress.done.into(),
            progress.total.into(),
            progress.incumbent_s.into(),
            progress.lower_bound_s.into(),
            progress.value.into(),
            progress.value_bound.into(),
        ]]);
        let Some(_) = update_leased(&mut transaction, update, "progress", now_us).await? else {
            return Ok(false);
        };
        if let Some(incumbent) = incumbent {
            results::store_incumbent(&mut transaction, lease.sequence, incumbent).await?;
        }
        transaction.commit().await?;
        Ok(true)
    }

    /// Returns a leased job to the queue; the attempt does not count.
    pub(crate) async fn release(&self, lease: &JobRow, now_us: i64) -> Result<bool, StoreError> {
        let mut transaction = self.begin().await?;
        let update = sql(concat!(
            "UPDATE jobs SET state = 'queued', attempt = attempt - 1, boot_id = NULL, \
             lease_until_us = NULL FROM {rows $1 leased bigint, held bigint} AS lease WHERE ",
            is_held!(),
            " AND state = 'running' RETURNING ",
            job_columns!()
        ))
        .rows(vec![held(lease)]);
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
             boot_id = NULL, lease_until_us = NULL WHERE sequence IN \
             (SELECT sequence FROM jobs WHERE state = 'running' \
             AND (($5 AND boot_id <> $3) OR lease_until_us < $2) {skip_locked}) RETURNING ",
            job_columns!()
        ))
        .bind(MAX_ATTEMPTS)
        .bind(now_us)
        .bind(boot_id)
        .bind(EndCode::ProcessDied.as_str())
        .bind(others == OtherProcesses::Ended)
        .fetch_all(&mut *transaction)
        .await?;
        let (mut recovered, mut told) = (Recovered::default(), Vec::new());
        for job in &jobs {
            match job.state()? {
                JobState::Queued => recovered.queued += 1,
                JobState::Cancelled => {
                    recovered.cancelled += 1;
                    results::delete_unfinished(&mut transaction, job.sequence).await?;
                }
                _ => recovered.dead += 1,
            }
            told.push(transaction.event("state", job, now_us)?);
        }
        events::append_all(&mut transaction, &told).await?;
        // Nobody has seen these begin: they wait as before.
        recovered.unclaimed = sql("UPDATE jobs SET boot_id = NULL, claimed_until_us = NULL \
             WHERE sequence IN (SELECT sequence FROM jobs \
             WHERE claimed_until_us IS NOT NULL AND state = 'queued' \
             AND (($2 AND boot_id <> $1) OR claimed_until_us < $3) {skip_locked})")
        .bind(boot_id)
        .bind(others == OtherProcesses::Ended)
        .bind(now_us)
        .execute(&mut *transaction)
        .await?;
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
