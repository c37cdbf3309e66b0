//! Jobs that make tables of leg times, and their events, as JSON.

use super::jobs::{JobHistory, between};
use super::number::Number;
use crate::base::clock::rfc3339;
use crate::store::{JobRow, JobState, StoreError};
use serde::Serialize;
use utoipa::ToSchema;

/// A job that makes a table of leg times.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegTableJob)]
pub(crate) struct LegTableJobDocument {
    /// Identifier of the job.
    #[schema(format = "uuid")]
    id: String,
    state: JobState,
    #[serde(flatten)]
    counts: LegCountsDocument,
    #[serde(flatten)]
    history: JobHistory,
}

/// How far a table is.
#[derive(Debug, Serialize, ToSchema)]
struct LegCountsDocument {
    /// Number of legs of the table.
    legs: i64,
    /// Legs whose rows can be read.
    done: i64,
    /// Of these found in the cache, those of earlier attempts of this job included.
    cached: i64,
    /// Of these solved, or proved.
    computed: i64,
    /// Of these without a time: their status says why.
    missing: i64,
}

impl LegCountsDocument {
    fn of(job: &JobRow) -> Self {
        Self {
            legs: job.targets,
            done: job.done.unwrap_or(0),
            cached: job.legs_cached.unwrap_or(0),
            computed: job.legs_computed.unwrap_or(0),
            missing: job.legs_missing.unwrap_or(0),
        }
    }
}

impl LegTableJobDocument {
    /// The job of a row.
    ///
    /// # Errors
    ///
    /// When the row is inconsistent.
    pub(crate) fn new(job: &JobRow) -> Result<Self, StoreError> {
        Ok(Self {
            id: job.id.clone(),
            state: job.state()?,
            counts: LegCountsDocument::of(job),
            history: JobHistory::of(job),
        })
    }
}

/// Something that happened to such a job, and how far it was then.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegTableEvent)]
pub(crate) struct LegTableEventDocument {
    state: JobState,
    #[serde(flatten)]
    counts: LegCountsDocument,
    /// Why the job ended without a whole table.
    detail: Option<String>,
    /// The same as a stable code of the error index.
    code: Option<String>,
    /// Time since the begin of the attempt, s.
    elapsed_s: Option<Number>,
    /// When it happened.
    #[schema(format = "date-time")]
    at: String,
}

impl LegTableEventDocument {
    /// How a job stands now.
    ///
    /// # Errors
    ///
    /// When the row is inconsistent.
    pub(super) fn new(job: &JobRow, now_us: i64) -> Result<Self, StoreError> {
        Ok(Self {
            state: job.state()?,
            counts: LegCountsDocument::of(job),
            detail: job.detail.clone(),
            code: job.code.clone(),
            elapsed_s: between(job.started_us, Some(now_us)),
            at: rfc3339(now_us),
        })
    }
}

/// A page of such jobs, the newest first.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = LegTableJobList)]
pub(crate) struct LegTableJobListDocument {
    /// The jobs of this page.
    pub(crate) leg_tables: Vec<LegTableJobDocument>,
    /// Where the next page begins; `null` on the last.
    pub(crate) next_cursor: Option<String>,
}
