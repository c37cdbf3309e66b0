//! What a process tells of the jobs that it holds, and the next ones that it asks for, in one transaction.

use super::claims::{self, Claim, Lease};
use super::database::statement::{Value, sql};
use super::events::{self, NewEvent};
use super::held::held;
use super::legs::put_legs;
use super::writing::WriteTransaction;
use super::{
    EndCode, Ended, JobRow, JobState, NewLeg, ProgressRow, Store, StoreError, results, shards,
};

/// The end of a job that is to be stored.
#[derive(Debug, Clone)]
pub(crate) struct JobEnd {
    /// The lease.
    pub(crate) lease: JobRow,
    /// The job at its begin, if that is not stored yet.
    pub(crate) begun: Option<JobRow>,
    /// How it stood last, where that is not stored yet.
    pub(crate) progress: Option<ProgressRow>,
    /// How it ended.
    pub(crate) ended: Ended,
    /// Whether parts of its tables of legs may be left.
    pub(crate) has_shards: bool,
    /// When.
    pub(crate) at_us: i64,
}

/// What a process has to say.
#[derive(Debug, Default)]
pub(crate) struct Exchange<'a> {
    /// Jobs that have ended.
    pub(crate) ends: &'a [JobEnd],
    /// Legs that were solved for them.
    pub(crate) legs: &'a [NewLeg],
    /// Jobs that have begun, as they were then.
    pub(crate) begun: &'a [JobRow],
    /// Claimed jobs that have not begun, and are given back.
    pub(crate) returned: &'a [JobRow],
    /// What it asks for.
    pub(crate) claim: Option<Claim<'a>>,
}

/// What came of it.
#[derive(Debug)]
pub(crate) struct Exchanged {
    /// The ends that are not stored, since their leases have been lost.
    pub(crate) lost_ends: Vec<i64>,
    /// The jobs whose begin is not stored, for the same reason.
    pub(crate) lost_begins: Vec<i64>,
    /// The next jobs, in their order.
    pub(crate) leases: Vec<Lease>,
    /// Number of jobs that still wait, as far as they are counted; none are without a claim.
    pub(crate) waiting: usize,
}

impl Store {
    /// Stores begins, ends with their results and legs, and what is given back, and claims the next jobs:
    /// all of it or nothing.
    ///
    /// A cancellation acknowledged in the meantime takes precedence over an end. If a solve was cut short, a
    /// better plan of an earlier attempt becomes the result. If a job ends without a plan, its best plan so
    /// far remains readable.
    pub(crate) async fn exchange(
        &self,
        exchange: &Exchange<'_>,
        now_us: i64,
    ) -> Result<Exchanged, StoreError> {
        let mut transaction = self.begin().await?;
        let mut told = Vec::new();
        let lost_begins = begin(&mut transaction, exchange.begun, &mut told).await?;
        let lost_ends = end(&mut transaction, exchange.ends, &mut told).await?;
        give_back(&mut transaction, exchange.returned).await?;
        let (leases, waiting) = match &exchange.claim {
            Some(claim) => claims::claim(&mut transaction, claim, now_us, &mut told).await?,
            None => (Vec::new(), 0),
        };
        events::append_all(&mut transaction, &told).await?;
        // Last: others wait for the turn to store legs.
        put_legs(&mut transaction, exchange.legs, now_us).await?;
        if exchange.is_empty() && leases.is_empty() {
            // A job without room is locked, and nobody else finds it while it is.
            transaction.rollback().await?;
        } else {
            transaction.commit().await?;
        }
        Ok(Exchanged {
            lost_ends,
            lost_begins,
            leases,
            waiting,
        })
    }
}

impl Exchange<'_> {
    /// Whether there is nothing to store.
    fn is_empty(&self) -> bool {
        self.ends.is_empty()
            && self.legs.is_empty()
            && self.begun.is_empty()
            && self.returned.is_empty()
    }
}

/// The jobs of these that are not among the rows that a statement has changed.
fn lost<'a>(jobs: impl Iterator<Item = &'a JobRow>, changed: &[i64]) -> Vec<i64> {
    let numbers = jobs.map(|job| job.sequence);
    numbers.filter(|job| !changed.contains(job)).collect()
}

/// Stores that claimed jobs have begun.
async fn begin(
    transaction: &mut WriteTransaction,
    begun: &[JobRow],
    told: &mut Vec<NewEvent>,
) -> Result<Vec<i64>, StoreError> {
    if begun.is_empty() {
        return Ok(Vec::new());
    }
    let row = |job: &JobRow| -> [Value<'_>; 3] {
        let [leased, fence] = held(job);
        [leased, fence, job.started_us.into()]
    };
    let changed: Vec<(i64,)> = sql(concat!(
        "UPDATE jobs SET state = 'running', attempt = attempt + 1, started_us = begun_us, \
         lease_until_us = claimed_until_us, claimed_until_us = NULL \
         FROM {rows $1 leased bigint, held bigint, begun_us bigint} AS begun WHERE ",
        is_held!(),
        " AND state = 'queued' RETURNING sequence"
    ))
    .rows(begun.iter().map(row).collect())
    .fetch_all(&mut **transaction)
    .await?;
    let changed: Vec<i64> = changed.into_iter().map(|(job,)| job).collect();
    for job in begun.iter().filter(|job| changed.contains(&job.sequence)) {
        told.push(transaction.event("state", job, job.started_us.unwrap_or_default())?);
    }
    Ok(lost(begun.iter(), &changed))
}

/// Stores ends: state, result and event together.
async fn end(
    transaction: &mut WriteTransaction,
    ends: &[JobEnd],
    told: &mut Vec<NewEvent>,
) -> Result<Vec<i64>, StoreError> {
    if ends.is_empty() {
        return Ok(Vec::new());
    }
    let mut ends = ends.to_vec();
    for end in ends.iter_mut().filter(|end| end.ended.early) {
        let kept = results::better_incumbent(transaction, end.lease.sequence, &end.ended).await?;
        end.ended = kept.unwrap_or_else(|| end.ended.clone());
    }
    let changed = update_ended(transaction, &ends).await?;
    let mut with_result = Vec::new();
    for job in &changed {
        let Some(end) = ends.iter().find(|end| end.lease.sequence == job.sequence) else {
            continue;
        };
        if let Some(begun) = &end.begun {
            told.push(transaction.event("state", begun, begun.started_us.unwrap_or_default())?);
        }
        told.push(transaction.event("state", job, end.at_us)?);
        if job.state()? == JobState::Cancelled {
            results::delete_unfinished(transaction, job.sequence).await?;
        } else {
            with_result.push(end);
        }
    }
    results::store_results(transaction, &with_result).await?;
    for end in ends.iter().filter(|end| end.has_shards) {
        shards::delete(transaction, end.lease.sequence).await?;
    }
    let changed: Vec<i64> = changed.into_iter().map(|job| job.sequence).collect();
    Ok(lost(ends.iter().map(|end| &end.lease), &changed))
}

/// Updates the jobs whose leases are held. Returns them.
async fn update_ended(
    transaction: &mut WriteTransaction,
    ends: &[JobEnd],
) -> Result<Vec<JobRow>, StoreError> {
    sql(concat!(
        "UPDATE jobs SET state = CASE WHEN cancel_requested_us IS NULL THEN end_state \
         ELSE 'cancelled' END, \
         code = CASE WHEN cancel_requested_us IS NULL THEN end_code END, detail = why, \
         incumbent_s = coalesce(plan_s, incumbent_s), \
         value = CASE WHEN plan_s IS NULL THEN value ELSE told_value END, value_bound = ",
        least_value_bound!(),
        ", lower_bound_s = ",
        bound_beside!("coalesce(plan_s, incumbent_s)"),
        ", keep_out_violated = violates, finished_us = end_us, \
         attempt = CASE WHEN begun_us IS NULL OR state = 'running' THEN attempt ELSE attempt + 1 END, \
         started_us = coalesce(begun_us, started_us), \
         stage = coalesce(told_stage, stage), done = coalesce(told_done, done), \
         total = CASE WHEN told_stage IS NULL THEN total ELSE told_total END, \
         boot_id = NULL, lease_until_us = NULL, claimed_until_us = NULL \
         FROM {rows $1 leased bigint, held bigint, end_state text, end_code text, why text, \
         plan_s double precision, told_bound_s double precision, violates boolean, end_us bigint, \
         begun_us bigint, told_stage text, told_done bigint, told_total bigint, \
         told_value double precision, told_value_bound double precision} AS told WHERE ",
        is_held!(),
        " RETURNING ",
        job_columns!()
    ))
    .rows(ends.iter().map(JobEnd::row).collect())
    .fetch_all(&mut **transaction)
    .await
}

impl JobEnd {
    fn row(&self) -> [Value<'_>; 15] {
        let ended = &self.ended;
        let [leased, fence] = held(&self.lease);
        let progress = self.progress.as_ref();
        [
            leased,
            fence,
            ended.state.into_str().into(),
            ended.code.map(EndCode::as_str).into(),
            (&ended.detail).into(),
            ended.incumbent_s.into(),
            ended.lower_bound_s.into(),
            ended.keep_out_violated.into(),
            self.at_us.into(),
            self.begun.as_ref().and_then(|job| job.started_us).into(),
            progress.map(|progress| progress.stage).into(),
            progress.map(|progress| progress.done).into(),
            progress.and_then(|progress| progress.total).into(),
            ended.value.into(),
            ended.value_bound.into(),
        ]
    }
}

/// Gives claimed jobs back that have not begun.
async fn give_back(
    transaction: &mut WriteTransaction,
    returned: &[JobRow],
) -> Result<(), StoreError> {
    if returned.is_empty() {
        return Ok(());
    }
    sql(concat!(
        "UPDATE jobs SET boot_id = NULL, claimed_until_us = NULL \
         FROM {rows $1 leased bigint, held bigint} AS returned WHERE ",
        is_held!(),
        " AND state = 'queued'"
    ))
    .rows(returned.iter().map(held).collect())
    .execute(&mut **transaction)
    .await?;
    Ok(())
}
