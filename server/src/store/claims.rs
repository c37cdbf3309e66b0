//! Claims on queued jobs: which jobs a process gets next.
//!
//! A claimed job is kept for its process. Usually its begin is stored with the claim. A process that ends
//! many tiny jobs a second stores the begin later, most often with the end, and claims a few of them
//! ahead: until then these look queued to everybody else, as they are.

use super::database::row::{FromRow, Row};
use super::database::statement::sql;
use super::events::NewEvent;
use super::writing::WriteTransaction;
use super::{JobRow, JobState, StoreError, Work};
use slewplan_solver::bounds;

/// Up to this number of queued jobs are counted, parts of tables of legs not among them.
const COUNTED: i64 = 256;
/// Maximum number of targets of a job whose begin may be stored later.
const TINY_TARGETS: i64 = 12;

/// The claim of this process on a job.
#[derive(Debug)]
pub(crate) struct Lease {
    /// The job when it was claimed.
    pub(crate) job: JobRow,
    /// Its scenario as JSON.
    pub(crate) scenario: Vec<u8>,
    /// What it may need of the memory that the jobs of a process share, bytes.
    pub(crate) memory_bytes: i64,
}

impl Lease {
    /// Whether its begin is stored.
    pub(crate) fn has_begun(&self) -> Result<bool, StoreError> {
        Ok(self.job.state()? == JobState::Running)
    }
}

impl FromRow for Lease {
    fn from_row(row: Row<'_>) -> Result<Self, StoreError> {
        Ok(Self {
            job: JobRow::from_row(row)?,
            scenario: row.get("scenario")?,
            memory_bytes: row.get("memory_bytes")?,
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

/// What a process asks for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Claim<'a> {
    /// The process.
    pub(crate) boot_id: &'a str,
    /// Until when it keeps the jobs without a further word.
    pub(crate) lease_until_us: i64,
    /// Memory for each of them.
    pub(crate) room: MemoryRoom,
    /// Whether it takes parts of tables of legs too, since it has nothing else to do.
    pub(crate) takes_shards: bool,
    /// Maximum number of jobs. All but the first are tiny.
    pub(crate) at_most: usize,
    /// Whether the begin of tiny jobs is stored later.
    pub(crate) begins_later: bool,
}

row! {
    /// A job that could be claimed.
    struct Candidate {
        sequence: i64,
        work: String,
        targets: i64,
        fence: i64,
        memory_bytes: i64,
        waiting: i64,
    }
}

impl Candidate {
    /// Whether its begin may be stored later. A job that was claimed before may have ended its process:
    /// every further attempt shall count.
    fn is_tiny(&self) -> bool {
        self.work == Work::Plan.into_str() && self.targets <= TINY_TARGETS && self.fence == 0
    }
}

/// The jobs to be claimed of those whose turn it is, each with whether its begin is stored at once.
fn chosen(candidates: &[Candidate], claim: &Claim<'_>) -> Vec<(i64, bool)> {
    let fits = |job: &&Candidate| job.memory_bytes <= claim.room.bytes;
    let first = candidates.first().filter(fits);
    let Some(first) = first else {
        return Vec::new();
    };
    if !(claim.begins_later && first.is_tiny()) {
        return vec![(first.sequence, true)];
    }
    let tiny = candidates
        .iter()
        .take_while(|job| fits(job) && job.is_tiny());
    tiny.map(|job| (job.sequence, false)).collect()
}

/// Claims the jobs whose turn it is, in their order; none when none is queued that has room. Their begins,
/// where they are stored at once, are added to the events. Returns the number of jobs left, as far as they
/// are counted. A lower bound of an earlier attempt is kept if this version of the bounds gave it.
pub(super) async fn claim(
    transaction: &mut WriteTransaction,
    claim: &Claim<'_>,
    now_us: i64,
    events: &mut Vec<NewEvent>,
) -> Result<(Vec<Lease>, usize), StoreError> {
    transaction.read_in_order().await?;
    let candidates: Vec<Candidate> = sql("SELECT sequence, work, targets, fence, memory_bytes, \
         (SELECT count(*) FROM (SELECT 1 FROM jobs WHERE state = 'queued' AND boot_id IS NULL \
         AND parent IS NULL LIMIT $4) AS counted) AS waiting \
         FROM jobs WHERE state = 'queued' AND boot_id IS NULL \
         AND (memory_bytes <= $1 OR submitted_us < $2) AND ($5 OR parent IS NULL) \
         ORDER BY priority DESC, turn, sequence LIMIT $3 {skip_locked}")
    .bind(claim.room.bytes)
    .bind(claim.room.passed_over_since_us)
    .bind(i64::try_from(claim.at_most).unwrap_or(1))
    .bind(COUNTED)
    .bind(claim.takes_shards)
    .fetch_all(&mut **transaction)
    .await?;
    let chosen = chosen(&candidates, claim);
    let waiting = candidates.first().map_or(0, |first| first.waiting);
    let left = usize::try_from(waiting)
        .unwrap_or(0)
        .saturating_sub(chosen.len());
    if chosen.is_empty() {
        return Ok((Vec::new(), left));
    }
    let rows = chosen
        .iter()
        .map(|(job, begins)| [(*job).into(), (*begins).into()]);
    let mut leases: Vec<Lease> = sql(concat!(
        "UPDATE jobs SET state = CASE WHEN begins THEN 'running' ELSE state END, \
         attempt = CASE WHEN begins THEN attempt + 1 ELSE attempt END, fence = fence + 1, \
         boot_id = $1, lease_until_us = CASE WHEN begins THEN CAST($2 AS bigint) END, \
         claimed_until_us = CASE WHEN begins THEN NULL ELSE CAST($2 AS bigint) END, \
         started_us = CASE WHEN NOT begins THEN started_us WHEN submitted_us > $3 THEN submitted_us \
         ELSE CAST($3 AS bigint) END, \
         stage = NULL, done = NULL, total = NULL, \
         lower_bound_s = CASE bound_version WHEN $4 THEN lower_bound_s END, \
         value_bound = CASE bound_version WHEN $4 THEN value_bound END, bound_version = $4, \
         incumbent_s = (SELECT total_time_s FROM incumbents WHERE job = jobs.sequence), \
         value = (SELECT i.value FROM incumbents i WHERE i.job = jobs.sequence) \
         FROM {rows $5 candidate bigint, begins boolean} AS chosen WHERE sequence = candidate \
         RETURNING scenario, memory_bytes, ",
        job_columns!()
    ))
    .bind(claim.boot_id)
    .bind(claim.lease_until_us)
    .bind(now_us)
    .bind(bounds::VERSION)
    .rows(rows.collect())
    .fetch_all(&mut **transaction)
    .await?;
    leases.sort_by_key(|lease| {
        chosen
            .iter()
            .position(|(job, _)| *job == lease.job.sequence)
    });
    for lease in &leases {
        if lease.has_begun()? {
            events.push(transaction.event("state", &lease.job, now_us)?);
        }
    }
    Ok((leases, left))
}
