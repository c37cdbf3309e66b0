//! Jobs and their events as JSON.

use super::leg_table_jobs::LegTableEventDocument;
use super::number::Number;
use crate::base::clock::rfc3339;
use crate::store::{JobRow, JobState, StoreError, Work};
use serde::Serialize;
use utoipa::ToSchema;

/// A planning job.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Job)]
pub(crate) struct JobDocument {
    /// Identifier of the job.
    #[schema(format = "uuid")]
    id: String,
    state: JobState,
    /// Name of the scenario.
    name: Option<String>,
    /// Number of targets.
    targets: i64,
    #[serde(flatten)]
    standing: Standing,
    /// Whether the plan that the job ended with violates a cone that is only reported; `null` before it
    /// has ended, without a plan, and for jobs of former versions.
    keep_out_violated: Option<bool>,
    #[serde(flatten)]
    history: JobHistory,
}

/// What has happened to a job.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct JobHistory {
    /// Jobs of greater priority are solved first; -10 to 10.
    priority: i64,
    /// How often the work has been begun; more than once only after the service was killed.
    attempt: i64,
    /// Whether the job was asked to finish with what it has so far.
    stop_requested: bool,
    /// Whether the job was abandoned.
    cancel_requested: bool,
    /// Why the job ended without a result of its own; what it had before that can still be read.
    detail: Option<String>,
    /// The same as a stable code of the error index: `memory_limit`, `internal_error` and
    /// `process_died` among others.
    code: Option<String>,
    /// When the job was submitted.
    #[schema(format = "date-time")]
    submitted_at: String,
    /// When its newest attempt began.
    #[schema(format = "date-time")]
    started_at: Option<String>,
    /// When it ended.
    #[schema(format = "date-time")]
    finished_at: Option<String>,
    /// Time between submission and the begin of the newest attempt, s.
    queued_s: Option<Number>,
    /// Time between the begin of the newest attempt and the end, s.
    solved_s: Option<Number>,
}

/// How far a job is.
#[derive(Debug, Serialize, ToSchema)]
struct Standing {
    /// What the solve is or was last busy with: `legs`, `search` or `verify`.
    stage: Option<String>,
    /// Steps of the stage that are done.
    done: Option<i64>,
    /// Steps of the stage in all, when known.
    total: Option<i64>,
    /// Duration of the best plan so far, s; `null` before there is one.
    incumbent_s: Option<Number>,
    /// No plan is shorter than this, s; `null` before anything is known.
    lower_bound_s: Option<Number>,
    /// `(incumbent - bound) / incumbent`.
    relative_gap: Option<Number>,
    /// Sum of the values of the targets that the best plan so far visits, where targets have values.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    value: Option<Number>,
    /// No plan has a greater sum.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    value_bound: Option<Number>,
}

impl Standing {
    fn of(job: &JobRow) -> Self {
        let gap = match (job.incumbent_s, job.lower_bound_s) {
            (Some(upper), Some(lower)) if upper > 0.0 => Some(((upper - lower) / upper).max(0.0)),
            _ => None,
        };
        Self {
            stage: job.stage.clone(),
            done: job.done,
            total: job.total,
            incumbent_s: job.incumbent_s.map(Number),
            lower_bound_s: job.lower_bound_s.map(Number),
            relative_gap: gap.map(Number),
            value: job.value.map(Number),
            value_bound: job.value_bound.map(Number),
        }
    }
}

impl JobDocument {
    /// The job of a row.
    ///
    /// # Errors
    ///
    /// When the row is inconsistent.
    pub(crate) fn new(job: &JobRow) -> Result<Self, StoreError> {
        Ok(Self {
            id: job.id.clone(),
            state: job.state()?,
            name: job.name.clone(),
            targets: job.targets,
            standing: Standing::of(job),
            keep_out_violated: job.keep_out_violated,
            history: JobHistory::of(job),
        })
    }
}

impl JobHistory {
    pub(super) fn of(job: &JobRow) -> Self {
        Self {
            priority: job.priority,
            attempt: job.attempt,
            stop_requested: job.stop_requested_us.is_some(),
            cancel_requested: job.cancel_requested_us.is_some(),
            detail: job.detail.clone(),
            code: job.code.clone(),
            submitted_at: rfc3339(job.submitted_us),
            started_at: job.started_us.map(rfc3339),
            finished_at: job.finished_us.map(rfc3339),
            queued_s: between(Some(job.submitted_us), job.started_us),
            solved_s: between(job.started_us, job.finished_us),
        }
    }
}

pub(super) fn between(begin_us: Option<i64>, end_us: Option<i64>) -> Option<Number> {
    Some(Number((end_us? - begin_us?) as f64 / 1e6))
}

/// Something that happened to a job, and how the job stood then.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = Event)]
pub(crate) struct EventDocument {
    state: JobState,
    #[serde(flatten)]
    standing: Standing,
    /// Why the job ended without a plan of its own.
    detail: Option<String>,
    /// The same as a stable code of the error index.
    code: Option<String>,
    /// Time since the begin of the attempt, s.
    elapsed_s: Option<Number>,
    /// When it happened.
    #[schema(format = "date-time")]
    at: String,
}

impl EventDocument {
    /// How a job stands now.
    ///
    /// # Errors
    ///
    /// When the row is inconsistent.
    fn new(job: &JobRow, now_us: i64) -> Result<Self, StoreError> {
        Ok(Self {
            state: job.state()?,
            standing: Standing::of(job),
            detail: job.detail.clone(),
            code: job.code.clone(),
            elapsed_s: between(job.started_us, Some(now_us)),
            at: rfc3339(now_us),
        })
    }
}

/// How a job stands now, as the JSON of an event.
///
/// # Errors
///
/// When the row is inconsistent.
pub(crate) fn tell(job: &JobRow, now_us: i64) -> Result<String, StoreError> {
    let event = match job.work()? {
        Work::Plan => serde_json::to_string(&EventDocument::new(job, now_us)?),
        Work::LegTable => serde_json::to_string(&LegTableEventDocument::new(job, now_us)?),
    };
    event.map_err(|error| StoreError::Inconsistent {
        table: "jobs",
        what: error.to_string(),
    })
}

/// A page of jobs, the newest first.
#[derive(Debug, Serialize, ToSchema)]
#[schema(as = JobList)]
pub(crate) struct JobListDocument {
    /// The jobs of this page.
    pub(crate) plans: Vec<JobDocument>,
    /// Where the next page begins; `null` on the last.
    pub(crate) next_cursor: Option<String>,
}
